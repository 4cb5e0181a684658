#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# headers.sh BUILD [all]: every header of the installation BUILD/stage compiles without another one before it and
# without warnings: those of C++ with both compilers as C++20 and C++23, with and without exceptions and run-time types;
# tex_c.h as C11, C17, C++11 and C++20. tex.h and tex_c.h are tried in every way, each other header in one, by turns;
# with "all", in every way, which takes some minutes. COMPILERS names others than g++ and clang++-14.
set -euo pipefail
build=$1
what=${2:-}
scratch=$build/consumer-headers
rm -rf "$scratch"
mkdir -p "$scratch"

fail() { echo "headers.sh: $*" >&2; exit 1; }

include=$(dirname "$(find "$build/stage/" -path '*/tex/tex.h')")
strict="-fsyntax-only -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Werror -I $(dirname "$include")"
compilers=() c_compilers=()
for name in ${COMPILERS:-g++ clang++-14}; do
    if command -v "$name" >/dev/null; then compilers+=("$name"); fi
    c=${name/clang++/clang}
    c=${c/g++/gcc}
    if command -v "$c" >/dev/null; then c_compilers+=("$c"); fi
done
for list in "${#compilers[@]}" "${#c_compilers[@]}"; do [ "$list" -gt 0 ] || fail "there is no compiler"; done
ways=()
for standard in c++20 c++2b; do
    for exceptions in '' ' -fno-exceptions -fno-rtti'; do
        for cxx in "${compilers[@]}"; do ways+=("$cxx -std=$standard$exceptions"); done
    done
done

# Lines of "COMPILER OPTION... FILE".
turn=0
for path in "$include"/*.h; do
    name=$(basename "$path")
    echo "#include <tex/$name>" | tee "$scratch/$name.c" >"$scratch/$name.cpp"
    if [ "$name" = tex_c.h ]; then
        for cc in "${c_compilers[@]}"; do
            for standard in c11 c17; do echo "$cc -std=$standard $scratch/$name.c"; done
        done
        for cxx in "${compilers[@]}"; do
            for standard in c++11 c++20; do
                echo "$cxx -std=$standard -fno-exceptions -fno-rtti $scratch/$name.cpp"
            done
        done
    elif [ "$name" = tex.h ] || [ "$what" = all ]; then
        for way in "${ways[@]}"; do echo "$way $scratch/$name.cpp"; done
    else
        echo "${ways[turn++ % ${#ways[@]}]} $scratch/$name.cpp"
    fi
done >"$scratch/commands.txt"
[ "$(wc -l <"$scratch/commands.txt")" -ge 20 ] || fail "only these were tried: $(cat "$scratch/commands.txt")"
# shellcheck disable=SC2016  # for the inner shell
xargs -P 2 -d '\n' -n 1 sh -c '$1 $0 || { echo "headers.sh: $1 $0" >&2; exit 255; }' "$strict" \
    <"$scratch/commands.txt" || fail "a header does not compile alone, or warns"
