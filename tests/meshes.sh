#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# meshes.sh MAKE_MESHES TRANSFER_NORMALS CHECK_NORMALS: the program reproduces the committed meshes byte for byte, and
# the recipe of the README works with them.
set -euo pipefail
samples=$(cd "$(dirname "${BASH_SOURCE[0]}")/../samples" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$1" "$scratch"
for made in crate_low crate_high; do cmp "$scratch/$made.glb" "$samples/$made.glb"; done
"$2" "$samples/crate_low.glb" "$samples/crate_high.glb" -o "$scratch/crate_n.png" --extent 512 --rays straight \
    --max-missed 0
"$3" "$scratch/crate_n.png" --mesh "$samples/crate_low.glb" --report "$scratch/crate.html"
[ -s "$scratch/crate.html" ]
