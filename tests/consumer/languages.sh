#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# languages.sh BUILD: tex_c.h as its users meet it, in the installation BUILD/stage: the samples in C, C++ without
# exceptions, Rust, Python and C# are built as strangers build them, and print the same sum; and nothing allocates.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
samples=$here/../../samples/c
build=$1
scratch=$build/consumer-languages
rm -rf "$scratch"
mkdir -p "$scratch"

fail() { echo "languages.sh: $*" >&2; exit 1; }

if [ -e "$build/libtex.a" ]; then
    echo "languages.sh: libtex is static here; the languages load the shared one"
    exit 0
fi
libdir=$(dirname "$(find "$build/stage" -name libtex.so)")
export LD_LIBRARY_PATH=$libdir
strict=(-Wall -Wextra -pedantic -Wconversion -Wsign-conversion -Werror -I "$build/stage/include")
wanted='5488 bytes of BC5, sum '

# same NAME COMMAND...: prints what the sample in C prints.
same() {
    local name=$1
    shift
    "$@" >"$scratch/$name.txt" || fail "the sample in $name fails"
    [ -e "$scratch/wanted.txt" ] || cp "$scratch/$name.txt" "$scratch/wanted.txt"
    cmp "$scratch/wanted.txt" "$scratch/$name.txt" || fail "the sample in $name does not do what that in C does"
}

for cc in gcc clang-14; do
    command -v "$cc" >/dev/null || continue
    "$cc" -std=c11 "${strict[@]}" "$samples/bake_to_bc5.c" -L "$libdir" -ltex -o "$scratch/bake_$cc"
    same "C-$cc" "$scratch/bake_$cc"
    "$cc" -std=c11 "${strict[@]}" "$samples/valley_occlusion.c" -L "$libdir" -ltex -o "$scratch/valley_$cc"
    [ "$("$scratch/valley_$cc")" = 'occlusion at the bottom: 0.71' ] || fail 'not the occlusion of a valley'
done
[ -e "$scratch/wanted.txt" ] || fail "there is no C compiler"
grep -q "^$wanted" "$scratch/wanted.txt" || fail "not the bytes of a chain: $(cat "$scratch/wanted.txt")"

gcc -std=gnu11 -O1 -fno-builtin "${strict[@]}" "$here/c/no_allocation.c" "$here/c/allocations.c" \
    -L "$libdir" -ltex -lm -o "$scratch/no_allocation"
"$scratch/no_allocation" || fail "a function allocates memory, or fails"

same Python python3 "$samples/bake_to_bc5.py" "$libdir/libtex.so"
if command -v rustc >/dev/null; then
    rustc --edition 2021 -D warnings "$samples/bake_to_bc5.rs" -L "$libdir" -o "$scratch/bake_rust"
    same Rust "$scratch/bake_rust"
else
    echo "languages.sh: rustc is not installed: the sample in Rust was not tried"
fi
if command -v mcs >/dev/null; then
    mcs -unsafe -out:"$scratch/bake.exe" "$samples/BakeToBc5.cs"
    same 'C#' mono "$scratch/bake.exe"
else
    echo "languages.sh: mono is not installed: the sample in C# was not tried"
fi

# The version script, the header and the library name the same symbols, and each has its version.
grep -o '\btex_[a-z0-9_]*(' "$build/stage/include/tex/tex_c.h" | tr -d '(' | sort -u >"$scratch/named.txt"
nm -D --defined-only "$libdir/libtex.so" | sed -n 's/.* T \(tex_[a-z0-9_]*\)@@TEX_1\.0$/\1/p' |
    sort >"$scratch/exported.txt"
missing=$(comm -13 "$scratch/named.txt" "$scratch/exported.txt")
[ -z "$missing" ] || fail "exported, but not in tex_c.h: $missing"
sed -n 's/^TEX_C_API .*[ *]\(tex_[a-z0-9_]*\)(.*/\1/p' "$build/stage/include/tex/tex_c.h" | sort |
    diff - "$scratch/exported.txt" || fail "tex_c.h and libtex.map do not name the same functions"
