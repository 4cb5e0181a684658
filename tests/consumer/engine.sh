#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# engine.sh BUILD: an engine that has the installation BUILD/stage and its headers, and no more. It bakes heights in
# memory to BC5 on its own threads, without an allocation by the library; decodes a DDS file in memory; and checks the
# map: in C, in C++ without exceptions and run-time types, and in Rust, with the same bytes and findings.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$1
scratch=$build/consumer-engine
rm -rf "$scratch"
mkdir -p "$scratch"

fail() { echo "engine.sh: $*" >&2; exit 1; }

if [ -e "$build/libtex.a" ]; then
    echo "engine.sh: libtex is static here; the languages load the shared one"
    exit 0
fi
libdir=$(dirname "$(find "$build/stage/" -name libtex.so)")
export LD_LIBRARY_PATH=$libdir
strict=(-Wall -Wextra -Wpedantic -Wconversion -Werror -I "$build/stage/include")
gcc -std=c11 "${strict[@]}" -c "$here/c/allocations.c" -o "$scratch/allocations.o"
link=("$scratch/allocations.o" -L "$libdir" -ltex)

# build NAME COMMAND...: in the background.
jobs=()
build() {
    "${@:2}" -o "$scratch/$1" &
    jobs+=($!)
}
for cc in gcc clang-14; do
    if command -v "$cc" >/dev/null; then
        build "c_$cc" "$cc" -std=c11 "${strict[@]}" "$here/engine/engine.c" "${link[@]}"
    fi
done
for cxx in g++ clang++-14; do
    command -v "$cxx" >/dev/null || continue
    for standard in c++20 c++2b; do
        build "${standard}_$cxx" "$cxx" -std=$standard -fno-exceptions -fno-rtti "${strict[@]}" -Wsign-conversion \
            "$here/engine/engine.cpp" "${link[@]}"
    done
done
if command -v rustc >/dev/null; then
    build rust rustc --edition 2021 -D warnings "$here/engine/engine.rs" -L "$libdir" \
        -C link-arg="$scratch/allocations.o"
else
    echo "engine.sh: rustc is not installed: the program in Rust was not tried"
fi
for job in "${jobs[@]}"; do wait "$job" || fail "a program cannot be built"; done

"$scratch/c_gcc" >"$scratch/wanted.txt" || fail "the program in C fails"
grep -q '^N401 error, level 0: either green points up' "$scratch/wanted.txt" ||
    fail "no finding: $(cat "$scratch/wanted.txt")"
[ "$(grep -c '^N' "$scratch/wanted.txt")" = 1 ] || fail "a sound map has findings: $(cat "$scratch/wanted.txt")"
for program in "$scratch"/c_* "$scratch"/c++* "$scratch"/rust; do
    [ -x "$program" ] || continue
    "$program" >"$scratch/out.txt" || fail "$program fails"
    cmp "$scratch/wanted.txt" "$scratch/out.txt" || fail "$program does not do what the program in C does"
done
