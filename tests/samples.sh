#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# samples.sh MAKE_SAMPLES [BAKE_NORMALS PREVIEW_NORMALS]: the programs reproduce the committed pictures byte for byte.
set -euo pipefail
samples=$(cd "$(dirname "${BASH_SOURCE[0]}")/../samples" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$1" "$scratch"
for made in hemisphere waves bricks ramp dunes; do cmp "$scratch/$made.png" "$samples/$made.png"; done
if [ $# -gt 1 ]; then
    # The README's picture, made in the same way as in quickstart.sh.
    "$2" "$samples/bricks.png" -o "$scratch/bricks_normals.png" --bumpiness 12
    "$2" "$samples/waves.png" -o "$scratch/waves_normals.png" --bumpiness 6
    "$3" "$scratch/bricks_normals.png" -o "$scratch/strip.png" --height "$samples/bricks.png" \
        --detail "$scratch/waves_normals.png" --detail-tiling 6 \
        --show height,normals,plain,lit --size 220 --light -1,1,0.9 --tint 0.6,0.28,0.18 --specular 0.12 --no-legend
    cmp "$scratch/strip.png" "$samples/strip.png"
    # The README's picture of heights from normals.
    "$3" "$scratch/bricks_normals.png" -o "$scratch/relief.png" --show normals,height,curvature --legend-max 0.15 \
        --size 240 --no-legend
    cmp "$scratch/relief.png" "$samples/relief.png"
    # The README's picture of +Y and -Y, both read as +Y. Its captions are the names of the files.
    "$2" "$samples/hemisphere.png" -o "$scratch/+Y.png" --bumpiness 112 --y up
    "$2" "$samples/hemisphere.png" -o "$scratch/-Y.png" --bumpiness 112 --y down
    "$3" "$scratch/+Y.png" "$scratch/-Y.png" -o "$scratch/y_axis.png" --show normals,lit --columns 4 --size 200 \
        --light -0.3,1,0.8 --specular 0.15 --no-legend --y-in up
    cmp "$scratch/y_axis.png" "$samples/y_axis.png"
    # The README's picture of heights of 8 bits.
    for how in "off:8 bits" "on:8 bits, debanded"; do
        "$2" "$samples/dunes.png" -o "$scratch/${how#*:}.png" --format rgb16 --bumpiness 48 --wrap clamp \
            --deband "${how%%:*}"
    done
    "$3" "$scratch/8 bits.png" "$scratch/8 bits, debanded.png" -o "$scratch/deband.png" --show lit --columns 2 \
        --size 320 --light -1,0.6,0.9 --tint 0.7,0.5,0.3 --specular 0.03 --no-legend
    cmp "$scratch/deband.png" "$samples/deband.png"
fi
