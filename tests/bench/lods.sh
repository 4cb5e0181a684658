#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Makes LODs of glTF models by gltfpack (npm) and transfer-normals, and measures how far they are from the originals:
#
#     lods.sh BUILD FOLDER MODEL.glb...
#
# BUILD has transfer-normals and lod_bench; FOLDER gets gltfpack and the LODs. For each model and ratio, a row has the
# mean difference of lit codes, and of normals in degrees, for the LOD as gltfpack writes it and for the one with new
# maps, in each extent of --extent; "own" is that of the old map. LODs.md explains the figures.
set -eu

build=$1 folder=$2
shift 2
mkdir -p "$folder"
[ -e "$folder/node_modules/gltfpack" ] || (cd "$folder" && npm install --silent gltfpack >/dev/null)
pack=$folder/node_modules/gltfpack/cli.js
printf 'model\tratio\textent\told: codes\tdegrees\tnew: codes\tdegrees\tratio of codes\n'
for model in "$@"; do
    stem=$(basename "$model" .glb)
    for ratio in ${RATIOS:-0.25 0.1}; do
        low=$folder/${stem}_$ratio.glb
        node "$pack" -si "$ratio" -kn -km -i "$model" -o "$low" >/dev/null
        for extent in ${EXTENTS:-own}; do
            lod=$folder/${stem}_${ratio}_$extent.glb
            options=()
            [ "$extent" = own ] || options=(--extent "$extent")
            "$build/transfer-normals" "$low" "$model" -o "$lod" "${options[@]}" --quiet >/dev/null
            "$build/lod_bench" "$model" "$low" "$lod" | cut -f 2,3 | tr '\n' '\t' |
                awk -v row="$stem\t$ratio\t$extent" \
                    '{ printf "%s\t%s\t%s\t%s\t%s\t%.2f\n", row, $1, $2, $3, $4, $3 / $1 }'
        done
    done
done
