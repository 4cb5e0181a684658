#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tidy.sh: runs clang-tidy's checks for mistakes, safety and speed (listed in .clang-tidy) on libtex and the commands. A
# finding is an error.
#
#     tests/tidy.sh [FILE...]    all sources of libtex and tools, or the named ones
#
# Needs clang-tidy-14. The compile commands come from the preset `fuzz`, which uses clang and compiles each kernel only
# once. The last line prints the counts.
#
# clang-tidy spends nine tenths of its time in the headers of other projects. So many sources are checked together, as
# one source that includes them. Programs, and sources whose names clash with those of others, are checked separately.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
together=64
out=$PWD/build/tidy
database=$out/compile_commands.json

# The preset's compile flags for a source, quoted for a shell.
flags() { sed -n "s|.*\"command\": \"[^ ]* \(.*\) -o [^ ]* -c $PWD/$1\",\?\$|\1|p" "$database" | sed 's|\\\(.\)|\1|g'; }

# clashing FILE FLAG...: the lines of those includes (except the first) that have errors.
clashing() {
    clang++-14 "${@:2}" -w -ferror-limit=0 -fsyntax-only "$1" 2>&1 |
        sed -n "s|^In file included from $1:\([0-9]*\):.*|\1|p" | sort -un | sed '/^1$/d'
}

# look_at FLAGS SOURCE...: checks the sources together; findings go to files in $out.
look_at() {
    local flags=$1 arguments all number clashing apart=()
    eval "arguments=($flags)"
    shift
    all=$(mktemp "$out/XXXXXX.cpp")
    printf "#include \"$PWD/%s\"  // NOLINT(bugprone-suspicious-include)\n" "$@" >"$all"
    # Each line of $all with errors is a source that clashes with an earlier one. After its removal, others may still
    # clash.
    while mapfile -t clashing < <(clashing "$all" "${arguments[@]}") && [ "${#clashing[@]}" -gt 0 ]; do
        for number in "${clashing[@]}"; do apart+=("${!number}"); done
        sed -i "$(printf '%ds|.*||;' "${clashing[@]}")" "$all"
    done
    if ! clang-tidy-14 --quiet "$all" -- "${arguments[@]}" -Wno-error >"$all.found" 2>"$all.log" &&
        [ ! -s "$all.found" ]; then
        { echo "$*: error: clang-tidy failed"; cat "$all.log"; } >"$all.found"
    fi
    [ "${#apart[@]}" -eq 0 ] || look_at "$flags" "${apart[@]}"
}

# Runs as many checks in parallel as there are processors.
start() {
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n || true; done
    look_at "$@" &
}

sources=("$@")
if [ "${#sources[@]}" -eq 0 ]; then
    mapfile -t sources < <(find libtex/src libtex/python libtex/oiio tools -name '*.cpp' | sort)
fi
rm -rf "$out"
mkdir -p "$out"
cmake --preset fuzz -B "$out" -DCMAKE_UNITY_BUILD=OFF -DTEX_PYTHON=ON -DTEX_OIIO=ON >"$out/configure.log" ||
    { cat "$out/configure.log"; exit 1; }
declare -A batches=()  # the sources, by their compile flags
for source in "${sources[@]}"; do
    key=$(flags "$source")
    [ -n "$key" ] || { echo "tidy: the preset fuzz does not compile $source" >&2; exit 2; }
    if grep -q '^int main' "$source"; then
        start "$key" "$source"
        continue
    fi
    batches[$key]+=" $source"
    # shellcheck disable=SC2086  # names without spaces
    if [ "$(wc -w <<<"${batches[$key]}")" -eq "$together" ]; then
        start "$key" ${batches[$key]}
        batches[$key]=
    fi
done
for key in "${!batches[@]}"; do
    [ -n "${batches[$key]}" ] || continue
    # shellcheck disable=SC2086
    start "$key" ${batches[$key]}
done
wait
find "$out" -name '*.found' -exec cat {} + | sed "s|$PWD/||" | tee "$out/findings"
count=$(sed -n '/: error: /p' "$out/findings" | sort -u | wc -l)
echo "tidy: ${#sources[@]} sources, $count findings"
[ "$count" -eq 0 ]
