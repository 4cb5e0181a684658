#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# abi.sh: the binary interface of libtex.so, by abigail-tools.
#
#     tests/abi.sh [REVISION]        compares HEAD with a revision, by default the last tag (v1.0.0): what a program
#                                    that was linked to that one uses must be there, and as it was
#     tests/abi.sh --write FILE      writes the interface of HEAD, for abidiff
#
# abidw finds types in debug information, so libtex is built with it, in build/abi. The last line is "abi: N passed, M
# failed". Exits 77 if there is no tag.
set -euo pipefail
if [ "${1:-}" = --write ]; then written=$(realpath "${2:?}"); fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scratch=build/abi

# describe REVISION FILE: writes the interface of libtex.so at a revision. Instruction sets are no part of it.
describe() {
    local tree=$scratch/tree
    rm -rf "$tree" "$scratch/build"
    mkdir -p "$tree"
    git archive "$1" | tar -x -C "$tree"
    cmake -S "$tree" -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_UNITY_BUILD=ON -DBUILD_TESTING=OFF \
        -DCMAKE_CXX_FLAGS="-O1 -g -ffile-prefix-map=$PWD/= -DHWY_COMPILE_ONLY_STATIC" >"$scratch/configure.log"
    cmake --build "$scratch/build" --target tex >"$scratch/build.log" || { tail -n 20 "$scratch/build.log"; return 1; }
    abidw --no-corpus-path --no-comp-dir-path --no-show-locs --exported-interfaces-only --drop-private-types \
        --headers-dir "$tree/libtex/include" --out-file "$2" "$scratch/build/libtex.so"
}

mkdir -p "$scratch"
if [ "${1:-}" = --write ]; then
    describe HEAD "$written"
    exit
fi
before=${1:-$(git describe --tags --abbrev=0 --match 'v[0-9]*' 2>/dev/null || true)}
if [ -z "$before" ]; then
    echo 'abi: not run: there is no tag to compare with'
    exit 77
fi
describe "$before" "$scratch/before.abi"
describe HEAD "$scratch/now.abi"
if abidiff --leaf-changes-only --no-added-syms "$scratch/before.abi" "$scratch/now.abi"; then
    echo 'abi: 1 passed, 0 failed'
else
    echo "abi: programs that were linked to the libtex of $before do not work with this one"
    echo 'abi: 0 passed, 1 failed'
    exit 1
fi
