#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# windows.sh: tests the archive that samples/packaging/windows.sh has made, under Wine: what it needs, what is inside,
# the unit tests that need nothing of POSIX, names and folders of Windows, and that its outputs have the bytes of
# build/release.
#
#     tests/windows.sh
#
# TEX_UNIT_TESTS is a regular expression for the unit tests to build, by their names, which takes 10 minutes for all; -
# builds none of them.
# The last line is "windows: N passed, M failed, K skipped". Exits 77 without an archive or Wine.
#
# Left out, and counted as skipped: the unit tests that take paths for texts (std::filesystem::path is one on POSIX
# systems alone), or use what these alone have, or judges that Debian does not have for mingw-w64 (libsquish, astcenc).
# They are named below. The command tests are programs for POSIX; what of them concerns Windows is repeated here.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

archive=$(find build/windows -maxdepth 1 -name 'libtex-*-windows-x86_64.zip' 2>/dev/null | head -n 1)
wine=$(command -v wine64 || command -v wine || true)
if [ -z "$archive" ] || [ -z "$wine" ] || ! command -v x86_64-w64-mingw32-objdump >/dev/null; then
    echo 'windows: not run: needs an archive of samples/packaging/windows.sh, mingw-w64 and wine'
    exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export WINEPREFIX=$PWD/build/windows/wine WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml='
python3 -m zipfile -e "$archive" "$scratch"
tree=$scratch/$(basename "$archive" .zip)

passed=0 failed=0 skipped=0
# check WHAT COMMAND...: one test.
check() {
    local what=$1
    shift
    if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "windows: FAILED: $what"; fi
}

# Programs by the names that scripts know.
mkdir "$scratch/bin"
for program in "$tree"/bin/*-normals.exe; do
    printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$wine" "$program" >"$scratch/bin/$(basename "$program" .exe)"
done
chmod +x "$scratch"/bin/*
run() { "$scratch/bin/$1" "${@:2}"; }

# -- the archive ----------------------------------------------------------------------------------------------
needs_only_windows() {
    local allowed='KERNEL32|msvcrt|ADVAPI32|SHELL32|USER32|libtex-commands' extra
    extra=$(x86_64-w64-mingw32-objdump -p "$tree"/bin/* | sed -n 's/^\s*DLL Name: //p' | sort -u |
        grep -viE "^($allowed)\.dll$" || true)
    [ -z "$extra" ] || { echo "needs $extra"; return 1; }
}
has_everything() {
    local command
    for command in tools/*-normals.cpp; do
        command=$(basename "$command" .cpp)
        if [ ! -s "$tree/bin/$command.exe" ] || [ ! -s "$tree/share/doc/libtex/man/$command.1.md" ]; then
            echo "lacks $command"
            return 1
        fi
    done
}
has_licences() {
    python3 - "$tree/share/doc/libtex" <<'PY'
import json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
document = json.loads((folder / "libtex.spdx.json").read_text())
names = [package["name"] for package in document["packages"]]
assert len(names) == len(set(names)) and {"libtex", "mingw-w64", "tiff", "openexr"} <= set(names), names
for package in document["packages"][1:]:
    assert (folder / "licences" / (package["name"] + ".txt")).stat().st_size > 200, package["name"]
PY
}
has_version() { run bake-normals --version | grep -q '^bake-normals [0-9.]*$'; }
check 'needs only libraries of Windows' needs_only_windows
check 'has all commands and pages' has_everything
check 'has licences' has_licences
check 'starts' has_version

# -- outputs --------------------------------------------------------------------------------------------------
same_bytes() {
    sh tests/portable_outputs.sh "$PWD/build/release" "$PWD/samples" "$scratch/native" >"$scratch/native.sums" &&
        sh tests/portable_outputs.sh "$scratch/bin" "$PWD/samples" "$scratch/wine" >"$scratch/wine.sums" &&
        diff "$scratch/native.sums" "$scratch/wine.sums" && [ "$(wc -l <"$scratch/wine.sums")" -ge 70 ]
}
check 'outputs have the bytes of build/release' same_bytes

# -- names and folders ----------------------------------------------------------------------------------------
mkdir "$scratch/work"
cd "$scratch/work"
cp "$OLDPWD"/samples/waves.png "$OLDPWD"/samples/crate_low.glb .
run bake-normals waves.png -o map.png --format rgb8 --quiet
bake() { run bake-normals waves.png "$@" --quiet; }
# refused STATUS TEXT ARGUMENT...: bake-normals ends with this status and names this reason, and leaves no file.
refused() {
    local status=0 wanted=$1 text=$2 before
    shift 2
    before=$(find . -type f | sort)
    run bake-normals "$@" --quiet >/dev/null 2>"$scratch/message" || status=$?
    if [ "$status" -ne "$wanted" ] || ! grep -qF "$text" "$scratch/message" ||
        [ "$before" != "$(find . -type f | sort)" ]; then
        echo "status $status: $(cat "$scratch/message")"
        return 1
    fi
}
writes() { # writes NAME ARGUMENT...: the file is there, with the bytes of map.png
    local name=$1
    shift
    bake "$@" --format rgb8 && cmp -s "$name" map.png
}
check 'a name in UTF-8' writes 'höhe-地図.png' -o 'höhe-地図.png'
check 'backslashes' writes out/deep/a.png --out-dir out --name 'deep\a.png'
long=$(printf 'a%.0s' {1..120})
check 'a path longer than 260 characters' writes "$long/$long/$long/a.png" --out-dir "$long" --name "$long/$long/a.png"
mkdir -p lib
cp map.png lib/Old.png
check 'an output replaces a file' writes lib/Old.png -o lib/Old.png
for name in nul.png CON.png com1.png 'lpt9.dds'; do
    check "the device $name" refused 3 'is the name of a device' waves.png -o "$name"
done
check 'a dot at the end' refused 3 'ends with a dot' waves.png -o 'a.png.' --container png
check 'a stream of a file' refused 3 'holds a character' waves.png -o 'map.png:stream.png'
check 'an output that is an input in other letters' refused 2 'is the input' waves.png -o WAVES.PNG
check 'an output that is an input by a dot' refused 2 'is the input' waves.png -o 'waves.png.' --container png
check 'a missing folder' refused 3 'the directory does not exist' waves.png -o none/a.png
cp map.png fixed.png
chmod a-w fixed.png
check 'a read-only file' refused 3 'permission denied' waves.png -o fixed.png
check 'a missing input' refused 3 'no such file or directory' none.png -o b.png
check 'OpenColorIO' refused 4 'without it (TEX_OCIO=OFF)' waves.png -o b.png --color-space x --ocio-config waves.png
standard_streams() {
    run bake-normals - -o - --format rgb8 --container png <waves.png >piped.png && cmp -s piped.png map.png
}
check 'standard input and output are bytes' standard_streams
no_clobber() { ! run bake-normals waves.png -o map.png --no-clobber --quiet 2>"$scratch/message" &&
    grep -q 'exists' "$scratch/message"; }
check 'no-clobber' no_clobber
leaves_nothing() { [ -z "$(find . -name '*.tex-tmp*')" ]; }
check 'no temporary file is left' leaves_nothing

# -- build-normals --------------------------------------------------------------------------------------------
mkdir tree same
cp "$OLDPWD"/samples/*.png "$OLDPWD"/samples/*.glb "$OLDPWD"/samples/normals.toml tree
cp -r tree/. same
builds() {
    run build-normals tree/normals.toml >"$scratch/first" && "$OLDPWD/build/release/build-normals" same/normals.toml \
        >/dev/null && diff -r tree/built same/built
}
builds_nothing_twice() {
    run build-normals 'tree\normals.toml' >"$scratch/second" &&
        grep -q '^0 made, [1-9][0-9]* up to date' "$scratch/second"
}
refuses_to_watch() {
    ! run build-normals tree/normals.toml --watch 2>"$scratch/message" &&
        grep -q 'which only Linux has' "$scratch/message"
}
# leads_out NAME: a rule with this name of outputs is refused, or its texture is, and nothing is written.
leads_out() {
    local status=0
    printf '%s\n' 'version = 1' '[[rule]]' 'match = "waves.png"' "name = '$1'" 'steps = [ "bake" ]' >tree/out.toml
    run build-normals tree/out.toml >"$scratch/message" 2>&1 || status=$?
    if [ "$status" -lt 2 ] || [ "$(find . -type f | wc -l)" -ne "$2" ]; then
        cat "$scratch/message"
        return 1
    fi
}
check 'builds a tree with the bytes of build/release' builds
check 'builds nothing twice' builds_nothing_twice
check '--watch is refused' refuses_to_watch
files=$(($(find . -type f | wc -l) + 1))
for name in '../{stem}.dds' '{stem}.dds:a.dds' 'nul.dds' 'WAVES.png' '..\{stem}.dds'; do
    check "a manifest with the output $name" leads_out "$name" "$files"
done
cd "$OLDPWD"

# -- unit tests -----------------------------------------------------------------------------------------------
unit_log=build/windows/unit_tests.log
unit_tests() {
    local prefix=$PWD/build/windows/libraries headers left
    export TEX_PREFIX=$prefix
    if [ ! -e "$prefix/lib/libgtest.a" ]; then
        cmake -G Ninja -S /usr/src/googletest -B build/windows/build/googletest -DCMAKE_BUILD_TYPE=Release \
            -DCMAKE_TOOLCHAIN_FILE="$PWD/samples/packaging/windows/toolchain.cmake" -DCMAKE_INSTALL_PREFIX="$prefix" \
            -DCMAKE_INSTALL_LIBDIR=lib >/dev/null && cmake --build build/windows/build/googletest --target install \
            >/dev/null || return 1
    fi
    PKG_CONFIG_LIBDIR=$prefix/lib/pkgconfig cmake -B build/mingw -DBUILD_TESTING=ON \
        -DTEX_UNIT_TESTS="${TEX_UNIT_TESTS:-}" >/dev/null &&
        cmake --build build/mingw --target unit_tests >build/windows/unit_build.log || return 1
    # Its judge is sinl() of mingw-w64, which is x87's fsin: up to two million units in the last place off at 10^6. The
    # sines of libtex have the bits of Linux.
    judged='Math.SinAndCosAreWithinOneAndAHalfUlpAndLargeAnglesWithinTwoAndAHalf'
    (cd build/mingw && "$wine" ./unit_tests.exe --gtest_brief=1 --gtest_filter="-$judged") >"$unit_log" 2>&1 || true
    # As tests/CMakeLists.txt chooses them.
    headers=$(sed -n '/set(left_out/{s/.*(left_out "\(.*\)")$/\1/;s/\\//g;p}' tests/CMakeLists.txt)
    mapfile -t left < <(grep -lE "$headers" tests/unit/*.cpp | grep -v /descriptor_test)
    [ -z "${TEX_UNIT_TESTS:-}" ] || mapfile -t left < <({
        printf '%s\n' "${left[@]}"
        printf '%s\n' tests/unit/*.cpp | grep -vE "/($TEX_UNIT_TESTS)[^/]*$"
    } | sort -u)
    echo "left out: $judged $(for file in "${left[@]}"; do basename "$file" _test.cpp; done | tr '\n' ' ')"
    skipped=$((skipped + 1 + $(cat "${left[@]}" | grep -cE '^(TEST|TEST_F|TEST_P)\(')))
    grep -qE '^\[==========\] [0-9]+ tests from [0-9]+ test suites ran' "$unit_log"
}
count() { sed -n "s/^\[  $1 *\] \([0-9]*\) tests\?[.,].*/\1/p" "$unit_log" | head -n 1; }
if [ "${TEX_UNIT_TESTS:-}" = - ]; then
    echo 'left out: all unit tests'
    skipped=$((skipped + $(cat tests/unit/*_test.cpp | grep -cE '^(TEST|TEST_F|TEST_P)\(')))
elif unit_tests; then
    passed=$((passed + $(count PASSED)))
    skips=$(count SKIPPED)
    skipped=$((skipped + ${skips:-0}))
    failures=$(grep -cE '^\[  FAILED  \] .* \([0-9]+ ms\)$' "$unit_log" || true)
    failed=$((failed + failures))
    grep -E '^\[  FAILED  \] .* ms\)$' "$unit_log" || true
else
    failed=$((failed + 1))
    tail -n 20 "$unit_log" || true
    echo 'windows: FAILED: unit tests'
fi

echo "windows: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
