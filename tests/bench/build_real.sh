#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_real.sh: measures build-normals on many real height maps of all input formats, beside the same work by Ninja.
#
#     tests/bench/build_real.sh [COUNT [ROUNDS [BUILD]]]    default: 2000 3 build/release
#
# Cuts COUNT pieces of 128 to 512 texels a side from the real height maps beside this repository, in nine kinds of
# files, with oiiotool. Then makes all of them with 1 thread, with 2 threads and with Ninja (one bake-normals for each
# file, two at a time), ROUNDS times in turn, and prints medians. Last, the time from the start to the first output.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
count=${1:-2000}
rounds=${2:-3}
build=$(cd "${3:-build/release}" && pwd)
height=$(cd ../shared/data/height && pwd)
export PATH=$build:$PATH
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
RANDOM=1

# -- the tree ---------------------------------------------------------------------------------------------------------
mkdir -p art
sources=("$height"/{dem_puget_sound_1025x1025_u16.png,metal_plate_disp_1k_1024x1024_u16.png} \
    "$height"/{urho_heightmap_1025x1025_u8.png,terrain_1024x1024_rgba_float.exr})
kinds=("png uint8" "png uint16" "exr half" "exr float" "tif uint8" "tif uint16" "tga uint8" "jpg uint8" "bmp uint8")
sides=(128 256 512)
for ((s = 0; s < ${#sources[@]}; ++s)); do
    arguments=(--threads 2 "${sources[s]}")
    case ${sources[s]} in *exr) arguments+=(--ch R) ;; esac
    arguments+=(--label whole)
    for ((k = s; k < count; k += ${#sources[@]})); do
        read -r extension depth <<<"${kinds[k / ${#sources[@]} % ${#kinds[@]}]}"
        side=${sides[RANDOM % 3]}
        cut=${side}x$side+$((RANDOM % (1024 - side)))+$((RANDOM % (1024 - side)))
        arguments+=(whole --cut "$cut" -d "$depth" -o "art/t$k.$extension")
    done
    oiiotool "${arguments[@]}"
done
cat >normals.toml <<'MANIFEST'
version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "art/*"
name = "{stem}_n.dds"
steps = [ { bake = { bumpiness = 4 } } ]
MANIFEST
{
    echo "rule bake"
    echo "  command = bake-normals --quiet --threads 1 --no-sync --bumpiness 4 -o \$out \$in"
    for file in art/*; do
        name=${file##*/}
        echo "build ninja-out/${name%.*}_n.dds: bake $file"
    done
} >build.ninja

# -- the measurements -------------------------------------------------------------------------------------------------
seconds() { # of a command; what it says is discarded
    local begin
    begin=$(date +%s%N)
    "$@" >/dev/null
    echo "scale=3; ($(date +%s%N) - $begin) / 1000000000" | bc
}
manifest() { rm -rf out .normals.toml.state && seconds build-normals --quiet --no-sync --threads "$1"; }
by_ninja() { rm -rf ninja-out .ninja_log && seconds ninja -j2; }
median() { sort -n "$1" | sed -n "$(((rounds + 1) / 2))p"; }
for ((k = 0; k < rounds; ++k)); do
    manifest 1 >>one
    manifest 2 >>two
    by_ninja >>ninja
done
diff -r out ninja-out >/dev/null || { echo "build_real: Ninja's outputs differ" >&2; exit 1; }
one=$(median one) two=$(median two) ninja=$(median ninja)
echo "| $count files | seconds | against 2 threads |"
echo "|---|---|---|"
echo "| 1 thread | $one | $(echo "scale=2; $one / $two" | bc) |"
echo "| 2 threads | $two | 1 |"
echo "| Ninja, 2 at a time | $ninja | $(echo "scale=2; $ninja / $two" | bc) |"

# The first output of all of them: seen by inotify as it gets its name.
rm -rf out .normals.toml.state && mkdir out
coproc inotifywait -q -e moved_to,create out 2>&1
sleep 0.5
begin=$(date +%s%N)
build-normals --quiet --no-sync >/dev/null &
read -r _ <&"${COPROC[0]}"
echo "Start to first output: $((($(date +%s%N) - begin) / 1000000)) ms"
wait
