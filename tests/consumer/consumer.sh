#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# consumer.sh STEP BUILD [CXX]: what somebody meets who installs libtex, from the build folder BUILD. Steps, each a test:
#   install    installs into BUILD/stage; the files are those of manifest.txt
#   move       the installation works from another place, too: a command bakes; and nothing is loaded from the folder that one stands in
#   exports    the library exports what its headers declare, and nothing else of its own
#   cmake      a project finds the library with find_package, builds samples/bake_and_pack.cpp, bakes
#   pkgconfig  the same through pkg-config
#   package    cpack makes a Debian package whose dependencies are named and whose commands run
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
samples=$here/../../samples
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
    "$stage/bin/bake-normals" "$samples/bricks.png" -o "$scratch/expected.dds" --bumpiness 12
    cmp "$1" "$scratch/expected.dds"
}

# Paths below the prefix $1, sorted, with the library folder written as lib.
list_files() {
    (cd "$1" && find . ! -type d | sed -e 's|^\./||' -e 's|^lib/[a-z0-9_]*-linux-gnu/|lib/|' | LC_ALL=C sort)
}

case $step in
install)
    rm -rf "$stage"
    cmake --install "$build" --prefix "$stage" >/dev/null
    list_files "$stage" >"$scratch/installed.txt"
    wanted=$here/manifest.txt
    if [ -e "$build/libtex.a" ]; then  # a static build has one library file
        sed -e '/^lib\/libtex\.so/d' -e '$a lib/libtex.a' "$wanted" | LC_ALL=C sort >"$scratch/wanted.txt"
        wanted=$scratch/wanted.txt
    fi
    # The name of the file of imported targets ends in the build type.
    sed -i 's|\(libtex-targets\)-[a-z]*\.cmake|\1-TYPE.cmake|' "$scratch/installed.txt"
    diff -u "$wanted" "$scratch/installed.txt" || fail "the installation differs from $here/manifest.txt"
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
    # Functions of the namespace tex itself: "tex::bake(". What the headers define inline may be there or not.
    nm -DC --defined-only "$library" | sed -n 's/^[0-9a-f]* [TW] tex::\([a-z][a-z0-9_]*\)\((\|\[abi\).*/\1/p' | sort -u >"$scratch/exported.txt"
    while read -r name; do
        grep -rqw -- "$name" "$here/../../libtex/include/tex" || fail "the library exports $name, which no header declares"
    done <"$scratch/exported.txt"
    # The functions that sources define: they begin a line, after [[nodiscard]].
    grep -h '^\[\[nodiscard\]\]' "$here"/../../libtex/include/tex/*.h | grep -v 'constexpr\|inline' |
        sed -n 's/^\[\[nodiscard\]\] [^(]*[ *]\([a-z][a-z0-9_]*\)(.*/\1/p' | sort -u >"$scratch/declared.txt"
    [ "$(wc -l <"$scratch/declared.txt")" -ge 30 ] || fail "only $(wc -l <"$scratch/declared.txt") functions were found in the headers"
    missing=$(comm -23 "$scratch/declared.txt" "$scratch/exported.txt")
    [ -z "$missing" ] || fail "the library does not export: $missing"
    ;;
cmake)
    cmake -S "$here/project" -B "$scratch/build" -G Ninja -DCMAKE_PREFIX_PATH="$stage" -DCMAKE_CXX_COMPILER="$cxx" \
        -DSAMPLE="$samples/bake_and_pack.cpp"
    cmake --build "$scratch/build"
    "$scratch/build/bake_and_pack" "$samples/bricks.png" "$scratch/bricks.dds"
    check_bake "$scratch/bricks.dds"
    ;;
pkgconfig)
    PKG_CONFIG_PATH=$(dirname "$(find "$stage" -name libtex.pc)")
    export PKG_CONFIG_PATH
    static=()
    if [ -e "$build/libtex.a" ]; then static=(--static); fi
    libdir=$(pkg-config --variable=libdir libtex)
    # shellcheck disable=SC2046  # flags are words
    "$cxx" -std=c++20 -o "$scratch/bake_and_pack" "$samples/bake_and_pack.cpp" $(pkg-config --cflags --libs "${static[@]}" libtex) \
        -Wl,-rpath,"$libdir"
    "$scratch/bake_and_pack" "$samples/bricks.png" "$scratch/bricks.dds"
    check_bake "$scratch/bricks.dds"
    ;;
package)
    (cd "$build" && cpack -G DEB -B "$scratch" >"$scratch/cpack.log") || { cat "$scratch/cpack.log"; fail "cpack failed"; }
    package=$(find "$scratch" -maxdepth 1 -name '*.deb')
    dpkg-deb --info "$package"
    depends=$(dpkg-deb --field "$package" Depends)
    for wanted in libc6 libpng16-16 libdeflate0 libopenexr libtbb12 libhwy libopencolorio libopenimageio libseccomp2; do
        case $depends in *"$wanted"*) ;; *) fail "the package does not depend on $wanted: $depends" ;; esac
    done
    dpkg-deb --extract "$package" "$scratch/root"
    list_files "$scratch/root/usr" | sed 's|\(libtex-targets\)-[a-z]*\.cmake|\1-TYPE.cmake|' >"$scratch/packaged.txt"
    diff -u "$here/manifest.txt" "$scratch/packaged.txt" || fail "the package differs from $here/manifest.txt"
    "$scratch/root/usr/bin/bake-normals" "$samples/bricks.png" -o "$scratch/bricks.dds" --bumpiness 12
    check_bake "$scratch/bricks.dds"
    # Hardened as by Debian's hardening=+all: position-independent, read-only relocations, bound at start, no code on the stack, with stack protector and fortified calls.
    for program in "$scratch"/root/usr/bin/* "$scratch/root/usr/libexec/libtex/tex-reader" "$(find "$scratch/root" -name 'libtex.so.0')"; do
        readelf --dyn-syms -W "$program" >"$scratch/symbols.txt"
        readelf -hW "$program" | grep -q 'Type: *DYN' || fail "$program is not position-independent"
        readelf -dW "$program" | grep -q BIND_NOW || fail "$program binds lazily"
        readelf -lW "$program" | grep -q GNU_RELRO || fail "$program has writable relocations"
        readelf -lW "$program" | grep -q 'GNU_STACK.* RW  *0x' || fail "$program may run code on its stack"
        grep -q ' __stack_chk_fail@' "$scratch/symbols.txt" || fail "$program has no stack protector"
        grep -q ' __[a-z]*_chk@' "$scratch/symbols.txt" || fail "$program has no fortified calls"
    done
    ;;
*) fail "no such step" ;;
esac
