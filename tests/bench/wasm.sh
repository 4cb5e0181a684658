#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# wasm.sh: sizes and speeds of the npm package beside build/release. See WASM.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=$(mktemp)
trap 'rm -f "$program"' EXIT
g++ -std=c++20 -O2 -Ilibtex/include tests/bench/wasm_native.cpp -o "$program" -Lbuild/release -ltex \
    -Wl,-rpath,"$PWD/build/release"
wc -c <build/npm/package/tex.wasm
brotli -q 11 -c build/npm/package/tex.wasm | wc -c
for _ in 1 2; do
    node tests/bench/wasm.mjs build/npm/package
    "$program"
done
