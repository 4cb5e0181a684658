#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The same bytes on arm64: cross-builds libtex and the commands, and runs the kernels' tests and the matrix of bytes
# (tests/cli/matrix_test.cpp, against tests/golden/commands.txt) under QEMU. The reader process is left out, because
# OpenImageIO would bring 240 more packages. Needs g++-aarch64-linux-gnu and qemu-user-static, and a release build,
# whose cli_tests start the commands. The last line is "arm64: N passed, M failed". Exits 77 if the packages for arm64
# cannot be downloaded.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=samples/packaging/portable/arm64_root.sh
. samples/packaging/portable/arm64_root.sh

root=$PWD/build/arm64-root
packages=(
    libc6-dev libstdc++-12-dev libpng-dev libopenexr-dev libopencolorio-dev libdeflate-dev libisal-dev libzstd-dev
    libastcenc-dev
    libtbb-dev libhwy-dev libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libgtest-dev libgmock-dev libsquish-dev
)

# The commands under QEMU, with their names, for a test program of this machine that runs them.
make_wrappers() {
    local command
    rm -rf build/arm64/emulated
    mkdir -p build/arm64/emulated
    for command in tools/*-normals.cpp; do
        command=$(basename "$command" .cpp)
        printf '#!/bin/sh\nexec qemu-aarch64-static -L %q %q "$@"\n' "$root" "$PWD/build/arm64/$command" \
            >"build/arm64/emulated/$command"
        chmod +x "build/arm64/emulated/$command"
    done
}

passed=0
failed=0
# Runs a test program of GoogleTest and adds up its counts.
tests() {
    local log=build/arm64/tests.log count
    "$@" 2>&1 | tee "$log" | grep -v '^\[ RUN\|^\[       OK\|^\[---' || true
    count=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$log")
    passed=$((passed + ${count:-0}))
    count=$(sed -n 's/^\[  FAILED  \] \([0-9]*\) test.*/\1/p' "$log")
    failed=$((failed + ${count:-0}))
    [ "$(grep -c '^\[  PASSED  \]' "$log")" -eq 1 ] || failed=$((failed + 1))  # it ended before the end
}

mkdir -p build
if ! arm64_root "$root" "${packages[@]}" >build/arm64-root.log 2>&1; then
    tail -n 5 build/arm64-root.log
    echo "arm64: not run: the mirror does not have the packages"
    exit 77
fi
cmake --preset arm64 >/dev/null
cmake --build --preset arm64
make_wrappers
# Without the longest searches and judgements, which take minutes here: the bytes of what they judge are compared. And
# without the tests of files that only the reader reads.
left_out='EacSearch.FindsTheOptimum*:Convert.MakesUnitVectorsOfTriangles*:Convert.ShowsFlat*:AstcEncode.IsCloser*'
left_out+=':AstcEncode.MoreEffort*:AstcEncode.Best*:AstcEncode.BlocksOfEveryPlan*:SecondRays.BelowASphere*'
left_out+=':GivenExtrasTest.HeightsOf16Bits*:GivenExtrasTest.FilesGive*'
tests qemu-aarch64-static -L "$root" build/arm64/unit_tests --gtest_filter="-$left_out"
TEX_PROGRAMS=$PWD/build/arm64/emulated tests build/release/cli_tests --gtest_filter='*Matrix.*Golden*'
echo "arm64: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
