#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# portable_outputs.sh BIN SAMPLES FOLDER: bakes, packs, blends and converts samples with the commands in BIN, into the
# new FOLDER, and prints the SHA-256 of each output. Two builds are the same if they print the same. Needs no more than
# a POSIX shell and sha256sum, so that it runs where nothing is installed.
set -eu
bin=$1 samples=$2 out=$3
mkdir "$out"
cp "$samples"/*.png "$samples"/*.glb "$out"
cd "$out"  # names without spaces from here on
heights="bricks.png dunes.png hemisphere.png waves.png"

# made NAME COMMAND ARGUMENT...: outputs go into the folder NAME, which --out-dir makes.
made() {
    name=$1 command=$2
    shift 2
    "$bin/$command" "$@" --quiet --out-dir "$name"
}

for each in dxt5nm bc5; do
    # shellcheck disable=SC2086
    made "bake-$each" bake-normals $heights --format $each --container dds --bumpiness 6
done
# shellcheck disable=SC2086
{
    made maps bake-normals $heights --format rgb16 --container png --bumpiness 6
    made tif bake-normals $heights --format rgb16 --container tiff --bumpiness 6
    made tga bake-normals $heights --format rgb8 --container tga --bumpiness 6
    made exr bake-normals $heights --format half --container exr --mips all --kernel sobel5
    made astc bake-normals waves.png --format astc-6x6 --container ktx2
    made astc-best bake-normals hemisphere.png --format astc-4x4 --container astc --effort best
    made rdo bake-normals $heights --format bc5 --container ktx2 --rdo-mean 0.5
    made eac bake-normals waves.png --format eac-rg11 --container ktx2
    made rdo-astc bake-normals waves.png --format astc-6x6 --container astc --rdo-mean 0.5
}
maps="maps/bricks.png maps/dunes.png maps/hemisphere.png maps/waves.png"
# shellcheck disable=SC2086
{
    made pack pack-normals $maps --format rg8 --container ktx2 --y down --mips 3
    made jpg pack-normals $maps --format rgb8 --container jpeg
    made scale scale-normals $maps --scale 1.7 --format rgba8
    made blend blend-normals $maps --detail maps/waves.png --tiling 3 --rotate 30
    made convert convert-normals $maps --mesh crate_low.glb --to object --container dds
    made mip mip-normals $maps --format float --container dds --mip-filter lanczos3
    made integrate integrate-normals $maps --container png
}
made from-tif pack-normals tif/*.tif --container dds    # through the reader process
made from-jpg unpack-normals jpg/*.jpg --container png
made from-dds unpack-normals bake-dxt5nm/*.dds --container png
"$bin/transfer-normals" crate_low.glb --high crate_high.glb --extent 128 -o crate.png --quiet
"$bin/preview-normals" maps/waves.png -o preview.png --size 96 --quiet
find . -mindepth 2 -type f -o -name crate.png -o -name preview.png | LC_ALL=C sort | xargs sha256sum
