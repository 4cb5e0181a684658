#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# consumer.sh STEP BUILD [CXX]: libtex as its users meet it, from the build folder BUILD. Steps, each a test:
#   install       installs into BUILD/stage; the files are those of manifest.txt
#   move          the installation works from another place: a command bakes. No program loads libraries from the
#                 current folder
#   exports       the library exports what its headers declare, and no other function in the namespace tex
#   find_package  a project finds the installed library and builds samples/bake_and_pack.cpp: with both compilers, as
#                 C++20 and C++23, with and without exceptions
#   pkgconfig     the same sample through pkg-config
#   plain         a configuration without options needs no package of the tests
#   library       the library alone, static if BUILD has a shared one and the reverse, needs no package of the commands;
#                 it is installed, and a project finds it
#   subdirectory  a project adds the sources as a folder, once with a shared and once with a static library
#   packages      cpack makes the Debian packages from the objects of BUILD; files and dependencies
#                 are right, and commands run
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source=$(cd "$here/../.." && pwd)
samples=$source/samples
step=$1
build=$2
cxx=${3:-c++}
stage=$build/stage
scratch=$build/consumer-$step
rm -rf "$scratch"
mkdir -p "$scratch"

fail() { echo "consumer.sh $step: $*" >&2; exit 1; }

# A baked DDS begins with its magic and is the same as the one that the installed command makes.
check_bake() {
    [ "$(head -c 3 "$1")" = DDS ] || fail "$1 is not a DDS file"
    [ -e "$scratch/expected.dds" ] ||
        "$stage/bin/bake-normals" "$samples/bricks.png" -o "$scratch/expected.dds" --bumpiness 12
    cmp "$1" "$scratch/expected.dds"
}

# Paths below the prefix $1, sorted, with the library folder written as lib. The name of the file of imported targets
# ends in the build type.
list_files() {
    (cd "$1" && find . ! -type d) | sed -e 's|^\./||' -e 's|^lib/[a-z0-9_]*-linux-gnu/|lib/|' \
        -e 's|\(libtex-targets\)-[a-z]*\.cmake|\1-TYPE.cmake|' -e 's|^lib/python[0-9.]*/|lib/python/|' \
        -e 's|_tex\..*\.so$|_tex.so|' | LC_ALL=C sort
}

# check_files PREFIX [FILTER]: the files below PREFIX are those lines of the manifest that the sed script FILTER leaves.
check_files() {
    list_files "$1" >"$scratch/installed.txt"
    sed -e "${2:-}" "$here/manifest.txt" | LC_ALL=C sort >"$scratch/wanted.txt"
    diff -u "$scratch/wanted.txt" "$scratch/installed.txt" || fail "the files differ from those of $here/manifest.txt"
}
# The Python module and the plug-in of OpenImageIO are installed if the build has them.
no_python='/^lib\/python\//d'
no_oiio='/^lib\/OpenImageIO\//d; /tex-oiio/d'
# shellcheck disable=SC2016  # sed's last line
static_files='/^lib\/libtex\.so/d; $a lib/libtex.a'
library_files=$no_python'; '$no_oiio'; /^bin\//d; /^libexec\//d; /\/samples\//d; /^share\/doc\//!{/^share\//d}'

# Compiles no object of libtex again: BUILD has them. Whether folders are compiled as one source decides their names.
unity=$(sed -n 's/^CMAKE_UNITY_BUILD:[A-Z]*=//p' "$build/CMakeCache.txt")
reuse=(-DCMAKE_CXX_COMPILER_LAUNCHER="$here/reuse_objects.sh" -DCMAKE_UNITY_BUILD="${unity:-OFF}")
export TEX_OBJECTS=$build

# without BUILD WORD...: CMake looked for no package whose name has one of the words.
without() {
    local folder=$1 word
    shift
    for word in "$@"; do
        ! grep -i -- "^[^=/]*$word" "$folder/CMakeCache.txt" || fail "the configuration $folder looked for $word"
    done
}

# quietly WHY COMMAND...: prints what the command prints only if it fails.
quietly() {
    local why=$1
    shift
    "$@" >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "$why"; }
}

# use_library FOLDER VARIANTS OPTION...: builds the stranger's project in FOLDER, a program for each of the VARIANTS;
# each bakes what the command bakes.
all='20_with 20_without 23_with 23_without' extremes='20_with 23_without'
use_library() {
    local folder=$1 variants=$2 name
    shift 2
    quietly "the project cannot be configured: $*" cmake -S "$here/project" -B "$folder" -G Ninja \
        -DCMAKE_CXX_COMPILER="$cxx" -DSAMPLE="$samples/bake_and_pack.cpp" -DVARIANTS="${variants// /;}" "$@"
    quietly "the project cannot be built: $*" cmake --build "$folder"
    for name in $variants; do
        "$folder/bake_${name}_exceptions" "$samples/bricks.png" "$scratch/bricks.dds"
        check_bake "$scratch/bricks.dds"
    done
}

# package NAME DEPENDENCY...: the package NAME is there and depends on these. Unpacks it into $root.
package() {
    local file wanted document
    file=$(find "$scratch" -maxdepth 1 -name "$1_*.deb")
    [ -e "$file" ] || fail "there is no package $1"
    dpkg-deb --field "$file" Package Version Depends
    depends=$(dpkg-deb --field "$file" Depends)
    for wanted in "${@:2}"; do
        case $depends in *"$wanted"*) ;; *) fail "$1 does not depend on $wanted: $depends" ;; esac
    done
    dpkg-deb --extract "$file" "$root"
    for document in copyright changelog.Debian.gz; do
        [ -s "$root/usr/share/doc/$1/$document" ] || fail "$1 has no $document"
        debian_files+=$'\n'"\$a share/doc/$1/$document"
    done
    debian_files+=$'\n'"\$a share/lintian/overrides/$1"
}
# What is in Debian's own places; package() adds the documents of each package.
debian_files='s|/zsh/site-functions/|/zsh/vendor-completions/|; s|^share/man/.*|&.gz|; /doc\/libtex\/LICENSE/d
s|doc/libtex/CHANGELOG.md|doc/libtex-dev/changelog.gz|; s|doc/libtex/samples|doc/libtex-tools/samples|
s|doc/libtex/|doc/libtex-dev/|'

# Hardened as by Debian's hardening=+all: position-independent, read-only relocations, bound at start, no code on the
# stack, with stack protector and fortified calls. And no search path for libraries.
check_hardening() {
    readelf --dyn-syms -W "$1" >"$scratch/symbols.txt"
    readelf -hW "$1" | grep -q 'Type: *DYN' || fail "$1 is not position-independent"
    readelf -dW "$1" | grep -q BIND_NOW || fail "$1 binds lazily"
    readelf -lW "$1" | grep -q GNU_RELRO || fail "$1 has writable relocations"
    readelf -lW "$1" | grep -q 'GNU_STACK.* RW  *0x' || fail "$1 may run code on its stack"
    grep -q ' __stack_chk_fail@' "$scratch/symbols.txt" || fail "$1 has no stack protector"
    case $1 in
    *.imageio.so) ;; # calls nothing that could be fortified
    *) grep -q ' __[a-z]*_chk@' "$scratch/symbols.txt" || fail "$1 has no fortified calls" ;;
    esac
    ! readelf -dW "$1" | grep -q 'R\(UN\)\?PATH' || fail "$1 has a search path for libraries"
}

case $step in
install)
    rm -rf "$stage"
    cmake --install "$build" --prefix "$stage" >/dev/null
    files=''
    if [ ! -e "$build/python" ]; then files=$no_python; fi
    if [ ! -e "$build/oiio" ]; then files+=$'\n'$no_oiio; fi
    if [ -e "$build/libtex.a" ]; then files+=$'\n'$static_files; fi
    check_files "$stage" "$files"
    while read -r link; do
        [ -e "$stage/share/doc/libtex/$link" ] || fail "README.md points to $link, which is not installed"
    done < <(grep -o ']([^)]*)' "$stage/share/doc/libtex/README.md" | tr -d '])(' | grep -v '^http')
    ;;
move)
    cp -a "$stage" "$scratch/elsewhere"
    for command in "$scratch"/elsewhere/bin/*; do "$command" --version; done
    "$scratch/elsewhere/bin/bake-normals" "$samples/bricks.png" -o "$scratch/bricks.dds" --bumpiness 12
    check_bake "$scratch/bricks.dds"
    # TIFF goes through the reader program, which must be found too.
    "$scratch/elsewhere/bin/bake-normals" "$samples/bricks.png" -o "$scratch/bricks.tif" --bumpiness 12
    # An empty or relative entry in the search path would load libraries from there.
    for program in "$stage"/bin/* "$build"/*-normals; do
        path=$(readelf -dW "$program" | sed -n 's/.*(R\(UN\)\?PATH).*\[\(.*\)\]$/\2/p')
        [ -n "$path" ] || continue
        while read -r -d : entry; do
            case $entry in \$ORIGIN* | /*) ;; *) fail "$program searches '$entry' for libraries: $path" ;; esac
        done <<<"$path:"
    done
    ;;
exports)
    library=$build/libtex.so
    if [ -e "$build/libtex.a" ]; then  # the same objects as a shared library
        library=$scratch/libtex.so
        "$cxx" -shared -o "$library" -Wl,--whole-archive "$build/libtex.a" -Wl,--no-whole-archive
    fi
    # Functions of the namespace itself: "tex::v1::bake(". What the headers define inline may be there or not.
    nm -DC --defined-only "$library" |
        sed -n 's/^[0-9a-f]* [TW] tex::v1::\([a-z][a-z0-9_]*\)\((\|\[abi\).*/\1/p' | sort -u >"$scratch/exported.txt"
    while read -r name; do
        grep -rqw -- "$name" "$source/libtex/include/tex" || fail "the library exports $name, which no header declares"
    done <"$scratch/exported.txt"
    # The functions that sources define: TEX_API stands before their types.
    sed -n 's/^\(\[\[nodiscard\]\] \|\)TEX_API [^(]*[ *]\([a-z][a-z0-9_]*\)(.*/\2/p' "$source"/libtex/include/tex/*.h |
        sort -u >"$scratch/declared.txt"
    count=$(wc -l <"$scratch/declared.txt")
    [ "$count" -ge 30 ] || fail "only $count functions were found in the headers"
    missing=$(comm -23 "$scratch/declared.txt" "$scratch/exported.txt")
    [ -z "$missing" ] || fail "the library does not export: $missing"
    ;;
find_package)
    use_library "$scratch/build" "$all" -DCMAKE_PREFIX_PATH="$stage"
    other=$([[ $cxx == *clang* ]] && echo g++ || echo clang++-14)
    if cxx=$(command -v "$other"); then
        use_library "$scratch/other" "$all" -DCMAKE_PREFIX_PATH="$stage"
    else
        echo "consumer.sh: $other is not installed: one compiler was tried"
    fi
    ;;
pkgconfig)
    PKG_CONFIG_PATH=$(dirname "$(find "$stage" -name libtex.pc)")
    export PKG_CONFIG_PATH
    static=()
    if [ -e "$build/libtex.a" ]; then static=(--static); fi
    libdir=$(pkg-config --variable=libdir libtex)
    # shellcheck disable=SC2046  # flags are words
    "$cxx" -std=c++20 -o "$scratch/bake_and_pack" "$samples/bake_and_pack.cpp" \
        $(pkg-config --cflags --libs "${static[@]}" libtex) -Wl,-rpath,"$libdir"
    "$scratch/bake_and_pack" "$samples/bricks.png" "$scratch/bricks.dds"
    check_bake "$scratch/bricks.dds"
    ;;
plain)
    quietly 'libtex cannot be configured' cmake -S "$source" -B "$scratch/build" -DCMAKE_CXX_COMPILER="$cxx"
    without "$scratch/build" GTest squish osmesa
    ;;
library)
    shared=ON files=$library_files
    if [ ! -e "$build/libtex.a" ]; then shared=OFF files=$static_files$'\n'$library_files; fi
    quietly 'the library cannot be configured' cmake -S "$source" -B "$scratch/build" -G Ninja \
        "${reuse[@]}" -DCMAKE_CXX_COMPILER="$cxx" -DTEX_COMMANDS=OFF -DBUILD_SHARED_LIBS=$shared \
        -DCMAKE_INSTALL_PREFIX="$scratch/stage" -DCMAKE_INSTALL_LIBDIR="$scratch/stage/lib" \
        -DCMAKE_INSTALL_INCLUDEDIR="$scratch/stage/include"  # absolute, as Nix sets them
    without "$scratch/build" CLI11 fmt_DIR OpenImageIO seccomp GTest squish osmesa
    quietly 'the library cannot be built' cmake --build "$scratch/build" --target install
    check_files "$scratch/stage" "$files"
    for folder in libdir includedir; do
        path=$(PKG_CONFIG_PATH=$scratch/stage/lib/pkgconfig pkg-config --variable=$folder libtex)
        [ -d "$path" ] || fail "libtex.pc says that $folder is $path, which does not exist"
    done
    use_library "$scratch/program" "$extremes" -DCMAKE_PREFIX_PATH="$scratch/stage"
    ;;
subdirectory)
    for shared in ON OFF; do
        folder=$scratch/shared-$shared
        use_library "$folder" "$extremes" "${reuse[@]}" -DLIBTEX_SOURCE="$source" -DBUILD_SHARED_LIBS=$shared
        without "$folder" CLI11 fmt_DIR OpenImageIO seccomp GTest squish osmesa
        cmake --install "$folder" --prefix "$folder/stage" >/dev/null
        [ ! -e "$folder/stage" ] || fail "a project that adds libtex installs $(list_files "$folder/stage")"
    done
    ;;
packages)
    # The preset `debian` differs from `release` in what links see, not in objects.
    export TEX_OBJECTS_OF=all
    quietly 'the packages cannot be configured' cmake -S "$source" --preset debian -B "$scratch/build" "${reuse[@]}" \
        -DCMAKE_CXX_COMPILER="$cxx"
    quietly 'the packages cannot be built' cmake --build "$scratch/build"
    # The length of this path stays when the installation removes it, and bytes must not depend on the folder.
    readelf -dW "$scratch/build/bake-normals" | grep -q 'RUNPATH.*\[.ORIGIN' ||
        fail 'the search path for libraries names the folder of the build'
    quietly 'cpack failed' cpack --config "$scratch/build/CPackConfig.cmake" -B "$scratch"
    root=$scratch/root
    package libtex1 libc6 libpng16-16 libdeflate0 libisal2 libzstd1 libopenexr libtbb12 libhwy \
        libopencolorio
    case $depends in *openimageio* | *assimp* | *draco*) fail "the library needs the readers: $depends" ;; esac
    package libtex-dev 'libtex1 (= '
    package libtex-tools 'libtex1 (= ' libtiff6 libjpeg62-turbo libwebp7 libassimp libdraco libseccomp2
    case $depends in *openimageio*) fail "the commands need OpenImageIO: $depends" ;; esac
    package libtex-reader-oiio libopenimageio libseccomp2
    python=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    package python3-libtex 'libtex1 (= ' "python3 (>= $python)" python3-numpy
    package libtex-oiio 'libtex1 (= ' libopenimageio
    check_files "$root/usr" "$debian_files"
    LD_LIBRARY_PATH=$(dirname "$(find "$root" -name libtex.so.1)")
    export LD_LIBRARY_PATH
    "$root/usr/bin/bake-normals" "$samples/bricks.png" -o "$scratch/bricks.dds" --bumpiness 12
    check_bake "$scratch/bricks.dds"
    # TIFF goes through the reader program, which must be found too.
    "$root/usr/bin/bake-normals" "$samples/bricks.png" -o "$scratch/bricks.tif" --bumpiness 12
    while read -r program; do check_hardening "$program"; done \
        < <(find "$root/usr/bin" "$root/usr/libexec" "$root/usr/lib" -type f \( -perm -u+x -o -name '*.so*' \))
    ;;
*) fail "no such step" ;;
esac
