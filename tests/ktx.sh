#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Asks Khronos' validator about KTX2 files of every encoding, plain and compressed with Zstandard, with y up and down.
# Run it by hand when you change formats/ktx2: Debian 12 has no package of KTX-Software.
#
#     tests/ktx.sh /path/to/ktx [BUILD_FOLDER]
#
# Last result: 2026-11-25, ktx of KTX-Software 5.0.0-rc2: 64 files are valid. On 2026-11-30, its validator without the
# rest of the program said the same of 32 files of BC7 and UASTC, with the rules of KHR_texture_basisu where they hold.
# There are two warnings: the key
# libtex.normal is not one of Khronos' own; and since KTX 2.0.4 (2025) compressed files should state the bytes of a
# plane, where KTX 2.0 demands 0.
set -euo pipefail
ktx=$1
build=${2:-$(dirname "$0")/../build/release}
sample=$(realpath "$(dirname "$0")/../samples/bricks.png")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
files=0
for format in dxt5nm bc5 bc5-snorm rg8 rgb8 rgba8 rg16 rgb16 half float eac-rg11 eac-rg11-snorm \
    astc-4x4 astc-5x5 astc-6x6 astc-8x8 bc7 bc7-rxgb uastc uastc-rrrg; do
    rules=
    [ "$format" != uastc ] || rules=--gltf-basisu
    for compression in "--supercompress none" "--supercompress zstd"; do
        for y in up down; do
            # shellcheck disable=SC2086  # two words or none
            "$build/bake-normals" "$sample" -o "$folder/map.ktx2" --format "$format" --y "$y" $compression \
                --no-sync --quiet
            "$ktx" validate ${rules:+"$rules"} "$folder/map.ktx2" >"$folder/log" 2>&1 ||
                { echo "$format $compression, y $y:"; cat "$folder/log"; exit 1; }
            files=$((files + 1))
        done
    done
done
echo "$files files are valid"
