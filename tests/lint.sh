#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# lint.sh: checks the house rules that a compiler does not check. Prints every violation, and exits 1 if there is one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

breaches=0
complain() { echo "lint: $*" >&2; breaches=$((breaches + 1)); }
# need FILE WHY: FILE must exist.
need() { [ -e "$1" ] || complain "$1 is missing: $2"; }
# ban PATTERN WHY FILE...: no line of the files may match the Perl expression.
ban() {
    local pattern=$1 why=$2 hits
    shift 2
    hits=$(grep -nHP -e "$pattern" -- "$@" /dev/null || true)
    [ -z "$hits" ] || complain "$why"$'\n'"$hits"
}

# The files of the tree. In a clone, these are the files that git tracks or would add, so that build folders do not
# count.
if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    mapfile -t files < <(git ls-files --cached --others --exclude-standard |
        while read -r f; do [ ! -e "$f" ] || echo "$f"; done)
else
    mapfile -t files < <(find . -path ./build -prune -o -type f -print | sed 's|^\./||')
fi
mapfile -t cplusplus < <(printf '%s\n' "${files[@]}" | grep -E '\.(cpp|h)$')

# clang-format runs in parallel with the other checks, and takes many files at once: to start takes it ten times as long
# as a file. (Its --dry-run does not accept the comment that it writes itself after an inline namespace.)
form=$(mktemp)
trap 'rm -f "$form"' EXIT
# shellcheck disable=SC2016  # for the inner shell
name_misshapen='clang-format-14 "$@" | cmp -s - <(cat "$@") ||
    for file; do clang-format-14 "$file" | cmp -s - "$file" || echo "$file"; done'
if command -v clang-format-14 >/dev/null; then
    printf '%s\n' "${cplusplus[@]}" | xargs -P "$(nproc)" -n 32 bash -c "$name_misshapen" name_misshapen >"$form" 2>&1 &
else
    echo 'lint: note: clang-format-14 is not installed: the form of C++ sources is not checked'
fi

select_files() { printf '%s\n' "${files[@]}" | grep -E "$1" || true; }
stem() {
    local name=${1##*/}
    echo "${name%.*}"
}

# -- the tree -----------------------------------------------------------------------------------------------
top=' CMakeLists.txt CMakePresets.json README.md LICENSE CHANGELOG.md CONTRIBUTING.md SECURITY.md'
top+=' .clang-format .clang-tidy .gitignore .ci libtex tools tests samples man findings '
for name in $(printf '%s\n' "${files[@]}" | cut -d/ -f1 | sort -u); do
    case $top in *" $name "*) ;; *) complain "$name does not belong at the top level" ;; esac
done

# -- folders include each other in one direction --------------------------------------------------------------
if graph=$(tests/graph.sh 2>&1); then
    diff <(sed -n '/^batch: /,/^```/p' tests/RECIPES.md | sed '$d') - <<<"$graph" >&2 ||
        complain 'the graph of folders in tests/RECIPES.md is not that of tests/graph.sh'
else
    complain "folders include each other in a circle"$'\n'"$graph"
fi

# -- one type for each name ------------------------------------------------------------------------------------
# Tests are linked with the library of the tools, in one namespace, so a linker would mix up types of one name.
types() { grep -hoE '^(class|struct) [A-Z][A-Za-z0-9]+' -- "$@" | cut -d' ' -f2 | sort -u; }
mapfile -t tool_headers < <(select_files '^tools/.*\.h$')
mapfile -t cli_tests < <(select_files '^tests/cli/.*\.(cpp|h)$')
for name in $(comm -12 <(types "${tool_headers[@]}") <(types "${cli_tests[@]}")); do
    complain "$name is a type of tools and of tests/cli: one of them needs another name"
done

# -- one word, one stem, everywhere ---------------------------------------------------------------------------
# A word has a section in a header, a source and a unit test. Sections of values alone have no source.
value_sections=' angular_error borders execution materials mip_chain names normal_map result texture '
sections=$(sed -nE 's|^// -- ([a-z ]+[a-z]) -+$|\1|p' libtex/include/tex/*.h | tr ' ' _)
for name in $sections; do
    case $value_sections in *" $name "*) continue ;; esac
    need "libtex/src/$name.cpp" "a section of the headers promises functions"
done
for header in libtex/include/tex/*.h; do
    name=$(stem "$header")
    case $name in tex | tex_c) continue ;; esac
    grep -q "<tex/$name.h>" libtex/include/tex/tex.h || complain "tex.h does not include $name.h"
done
for source in libtex/src/*.cpp; do
    name=$(stem "$source")
    [ "$name" = tex ] || grep -qx "$name" <<<"$sections" || complain "$source has no section in a public header"
    need "tests/unit/${name}_test.cpp" "$source has no unit test"
done
for source in $(select_files '^libtex/src/[a-z]+/([a-z0-9]+/)?[a-z0-9_]+\.cpp$'); do
    [ -e "${source%.cpp}.h" ] || [ -e "${source%_*}.h" ] || complain "$source has no header"
done
# A kernel, a block codec or a container is tested under its own name, by a test that includes its header, or through a
# stem that includes it in at most three steps.
tested() {
    local source=$1 depth=$2 header=${1#libtex/src/} user users
    header=${header%.*}.h
    [ ! -e "tests/unit/$(stem "$source")_test.cpp" ] || return 0
    ! grep -rqF "\"$header\"" tests/unit || return 0
    [ "$depth" -gt 0 ] || return 1
    [ -e "libtex/src/$header" ] || header=${header%_*}.h
    mapfile -t users < <(grep -rlF "\"$header\"" libtex/src | grep -v "^${source%.*}\.")
    for user in "${users[@]}"; do
        ! tested "$user" $((depth - 1)) || return 0
    done
    return 1
}
for source in $(select_files '^libtex/src/(blocks|formats|kernels)/([a-z0-9]+/)?[a-z0-9_]+\.cpp$'); do
    tested "$source" 3 || complain "$source has no unit test"
done
for source in $(select_files '^tools/[a-z]+-normals\.cpp$'); do
    name=$(stem "$source")
    need "man/$name.1.in" "$source has no man page"
    [ -n "$(select_files "^tests/cli/${name//-/_}[a-z_]*\.")" ] || complain "$source has no tests/cli/${name//-/_}*"
    grep -q "\`$name\`\|\*\*$name\*\*\|\[$name\]" README.md || complain "README.md does not name $name"
done
for source in $(select_files '^tests/fuzz/[a-z0-9_]+_fuzz\.cpp$'); do
    name=$(stem "$source")
    need "tests/fuzz/corpus/${name%_fuzz}" "$source has no corpus"
done

# -- every file -----------------------------------------------------------------------------------------------
mapfile -t scripts < <({ select_files '\.sh$'; select_files '^\.ci/run$'; })
mapfile -t builds < <(select_files 'CMakeLists\.txt$')
while read -r file; do complain "$file does not begin with its licence"; done < <(awk '
    FNR <= 2 && /SPDX-License-Identifier: Apache-2.0/ { licensed[FILENAME] = 1 }
    FNR > 2 { nextfile }
    END { for (k = 1; k < ARGC; k++) if (!(ARGV[k] in licensed)) print ARGV[k] }
' "${cplusplus[@]}" "${scripts[@]}" "${builds[@]}")
while read -r lines file; do
    case $file in
        man/*.md | total) continue ;; # pages are made by tests/manual.sh
        libtex/src/kernels/*) most=600 ;;
        tests/golden/interface.txt) most=2000 ;; # a test writes it
        libtex/include/tex/*) most=850 ;; # sixteen headers are the whole interface
        libtex/* | tools/*) most=400 ;;
        *) most=500 ;;
    esac
    [ "$lines" -le "$most" ] || complain "$file has $lines lines: more than $most"
done < <(select_files '\.(cpp|h|sh|txt|md|in|mdoc)$|^\.ci/run$' | xargs wc -l)
mapfile -t written < <(select_files '\.(cpp|h|sh|md|in|mdoc|txt|json)$|^\.ci/run$' |
    grep -v '^tests/lint\.sh$\|^man/.*\.md$')
ban '\b(TODO|FIXME|XXX)\b' 'unfinished work' "${written[@]}"
ban '[[:blank:]]+$' 'trailing blanks' "${written[@]}"
# A comment names its subject in its first words.
headless=$(awk 'FNR == 1 { before = "" }
    { text = $0; sub(/^[[:blank:]]+/, "", text) }
    text ~ /^\/\/ (That|Those|Of|As|The same)[ ,]/ && before !~ /^\/\// { print FILENAME ":" FNR ": " text }
    { before = text }' "${cplusplus[@]}")
[ -z "$headless" ] || complain "comments that begin with That, Those, Of, As or The same"$'\n'"$headless"
mapfile -t tests < <(select_files '^tests/.*\.(cpp|h)$' | grep -v '^tests/scratch\.h$')
ban '\bTempDir\(|temp_directory_path|mkdtemp' 'a file of a test lies outside a Scratch folder' "${tests[@]}"
ban $'\t' 'tabs' "${written[@]}"
mapfile -t code < <(select_files '\.(cpp|h|sh|cmake|cmake\.in)$|CMakeLists\.txt$|^\.ci/run$')
LC_ALL=C.UTF-8 ban '^.{121}' 'more than 120 columns' "${code[@]}"

# Finds types of the same name in the same namespace in two files, because the linker uses one of them for both. A class
# inside a function or another class, or in an unnamed namespace, does not count. clang-format writes the comment that
# closes a namespace.
mapfile -t typed < <(select_files '^(libtex|tools)/.*\.(cpp|h)$' | grep -v '_\(windows\|bsd\|other\)\.cpp$')
twice=$(awk '
    FNR == 1 { depth = 0 }
    /^(inline )?namespace .*\{$/ { space[++depth] = $(NF - 1) == "namespace" ? "" : $(NF - 1) }
    /^}  \/\/ namespace/ { --depth }
    /^(struct|class|enum) .*[{,:]$/ || /^(struct|class|enum) .*\{.*\};/ {
        if ($0 ~ /;$/ && $0 !~ /\{/) next
        for (k = 2; $k == "class" || $k == "struct" || $k ~ /^\[\[/; ++k) {}
        name = $k
        if (name !~ /^[A-Za-z_0-9]+$/) next
        for (k = depth; k >= 1; --k) {
            if (space[k] == "") next
            name = space[k] "::" name
        }
        if (name in first && first[name] != FILENAME) print name, first[name], FILENAME
        else first[name] = FILENAME
    }' "${typed[@]}")
while read -r name files_of_it; do
    [ -z "$name" ] || complain "two types are called $name: $files_of_it"
done <<<"$twice"

# -- who may know what ------------------------------------------------------------------------------------------
mapfile -t library < <(select_files '^libtex/src/.*\.(cpp|h)$')
mapfile -t public < <(select_files '^libtex/include/')
mapfile -t outside_kernels < <(select_files '^(libtex|tools)/.*\.(cpp|h)$' | grep -v '/kernels/' || true)
mapfile -t outside_formats_and_tools < <(select_files '^(libtex|tools)/.*\.(cpp|h)$' | grep -v '/formats/' || true)
mapfile -t below_verbs < <(select_files '^libtex/src/(rows|kernels|blocks|surface)/')
mapfile -t outside_color < <(printf '%s\n' "${library[@]}" | grep -v '/color[/.]' || true)
mapfile -t outside_formats < <(printf '%s\n' "${library[@]}" | grep -v '/formats/' || true)
mapfile -t outside_reader < <(select_files '^(libtex|tools)/.*\.(cpp|h)$' |
    grep -v '^\(tools/oiio-reader\|libtex/oiio\)/' || true)
ban '#include [<"]hwy/|\bHWY_|\bhwy::' 'only kernels/ knows Highway' "${outside_kernels[@]}"
ban '#include <tex/(check|file|pipeline|preview|tex)\.h>' 'rows/, kernels/, blocks/ and surface/ know no file' \
    "${below_verbs[@]}"
ban '\b(?!is_|take_)[a-z]+_whole\b|\bcan_stream\b' 'files go one way, through streams' "${library[@]}"
ban '\bis_texture\b|case (tex::)?Container::' 'only the table of formats/ tells file types apart' \
    "${outside_formats_and_tools[@]}"
mapfile -t outside_mesh < <(printf '%s\n' "${library[@]}" | grep -v '/mesh/' || true)
ban '#include <nlohmann/' 'only mesh/ knows nlohmann-json' "${outside_mesh[@]}"
ban '#include <OpenColorIO' 'only color knows OpenColorIO' "${outside_color[@]}"
ban '#include <(png\.h|isa-l|OpenEXR/|Imf)' 'only formats/ knows libpng, ISA-L and OpenEXR' "${outside_formats[@]}"
ban '\+ 3\) / 4' 'blocks/extent.h counts blocks' "${library[@]}"
ban '#include <OpenImageIO' 'only the reader and the plug-in know OpenImageIO' "${outside_reader[@]}"
mapfile -t outside_python < <(select_files '^(libtex|tools)/.*\.(cpp|h)$' | grep -v '^libtex/python/' || true)
ban '#include <(pybind11/|Python)' 'only the Python module knows Python' "${outside_python[@]}"
mapfile -t plugin < <(select_files '^libtex/oiio/.*\.(cpp|h)$')
ban '#include "[a-z]+/' 'the plug-in uses the public headers of libtex alone' "${plugin[@]}"
mapfile -t outside_mesh_reader < <(select_files '^(libtex|tools)/.*\.(cpp|h)$' | grep -v '^tools/mesh-reader/' || true)
mapfile -t commands < <(select_files '^tools/([a-z]+-normals\.cpp|(batch|tasks|tree)/.*)$')
ban '\bfor \(.*[.:>_ ](width|height)\b' 'commands leave loops over texels to the library' "${commands[@]}"
ban '#include <assimp' 'only the mesh reader knows Assimp' "${outside_mesh_reader[@]}"
ban '#include ("|<(hwy|png|isa-l|OpenEXR|Imath|Imf|OpenColorIO|OpenImageIO|tbb|fmt))' \
    'a public header shows a private name' "${public[@]}"
ban 'std::(cout|cerr|clog|exit|abort|getenv)|[^a-z_](fprintf|puts|perror|getenv|setlocale) ?\(' \
    'libtex is silent' "${library[@]}"
ban 'MulAdd|NegMulAdd|MulSub|ApproximateReciprocal|std::fma\b|std::thread' \
    'results would depend on the machine' "${library[@]}"

# CMakeLists.txt states the version. What other systems read states it again, and must follow.
version=$(sed -n 's/^project(libtex VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
for file in libtex/debian/changelog samples/ci/action.yml samples/farm/kubernetes.yml tests/consumer/manifest.txt \
    samples/packaging/{homebrew/libtex.rb,nix/default.nix,vcpkg/libtex/vcpkg.json}; do
    grep -qF "$version" "$file" || complain "$file does not state version $version, which CMakeLists.txt has"
done

# -- documents and scripts ------------------------------------------------------------------------------------
[ "$(wc -l <CONTRIBUTING.md)" -le 120 ] || complain "CONTRIBUTING.md is a map: at most 120 lines"
if [ -e README.md ]; then
    [ "$(wc -l <README.md)" -le 150 ] || complain "README.md is a front page: at most 150 lines"
    # shellcheck source=.ci/packages.sh
    . .ci/packages.sh
    for package in "${build_packages[@]}"; do
        grep -qw -- "$package" README.md || complain "README.md does not name the package $package"
    done
fi
manual=$(mktemp -d)
trap 'rm -rf "$manual"' EXIT
for source in $(select_files '^man/[a-z.-]+\.[157]\.in$'); do
    cmake -D IN="$source" -D OUT="$manual/$(basename "$source" .in)" -P man/assemble.cmake ||
        complain "$source cannot be assembled"
done
for section in $(select_files '^man/shared/'); do
    grep -rqx "@include $(basename "$section" .mdoc)@" man || complain "no page includes $section"
done
markdown=$(mktemp -d)
trap 'rm -rf "$manual" "$markdown"' EXIT
tests/manual.sh "$markdown"
for page in "$markdown"/*; do
    name=man/$(basename "$page")
    cmp -s "$page" "$name" || complain "$name is not what its template gives: run tests/manual.sh"
done
# The pages refer to each other and are not installed, so that remark is ignored. Every other remark counts.
# (One page at a time: in a longer output, lines of its two streams get into each other.)
remarks=$(for page in "$manual"/*; do mandoc -T lint -W style "$page" 2>&1; done |
    grep -v 'referenced manual not found\|outdated mandoc.db' || true)
[ -z "$remarks" ] || complain "mandoc complains about a man page"$'\n'"$remarks"
shellcheck -x "${scripts[@]}" || complain "shellcheck complains about a script"

wait
[ ! -s "$form" ] || complain "run clang-format-14 -i on"$'\n'"$(sort "$form")"

[ "$breaches" -eq 0 ] || { echo "lint: $breaches breaches" >&2; exit 1; }
