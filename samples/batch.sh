#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# batch.sh HEIGHTS OUT [NINJA_OPTION...]: builds a folder of textures from a folder of height maps, and rebuilds only
# what changed.
#
#     HEIGHTS/NAME.png     a height map (or .exr, .tif), which becomes OUT/NAME.dds
#     HEIGHTS/NAME.bake    its options for bake-normals, on one line:   --bumpiness 12 --wrap clamp
#     HEIGHTS/NAME.blend   its options for blend-normals, if it gets detail:
#                          --detail ../grain.png --tiling 8 --mask rust.png:a
#
# Paths in options are relative to HEIGHTS. Ninja rebuilds a texture if its map, its options, the commands or a file
# that an option names have changed; --depfile lists those files for Ninja. Textures without a map are removed. The
# commands come from PATH.
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: batch.sh HEIGHTS OUT [NINJA_OPTION...]" >&2; exit 2; }
mkdir -p "$2"
heights=$(cd "$1" && pwd)
out=$(cd "$2" && pwd)
shift 2
bake=$(command -v bake-normals)
blend=$(command -v blend-normals)

# Prints a path in Ninja's syntax.
escape() {
    local path=${1//\$/\$\$}
    path=${path// /\$ }
    printf '%s' "${path//:/\$:}"
}
# Prints the options in a file, or nothing if there is none. A $ is an ordinary character.
options_in() { if [ -e "$1" ]; then sed 's/\$/$$/g' "$1"; fi; }

cd "$heights"
shopt -s nullglob
{
    # One thread for each map, because Ninja processes as many maps in parallel as there are processors.
    cat <<END
builddir = $(escape "$out")
rule bake
  command = bake-normals \$in -o \$out --threads 1 --quiet --depfile \$out.d \$options
  depfile = \$out.d
  deps = gcc
  description = bake \$in
rule blend
  command = blend-normals \$in -o \$out --threads 1 --quiet --depfile \$out.d \$options
  depfile = \$out.d
  deps = gcc
  description = blend \$in
END
    for map in *.png *.exr *.tif; do
        name=${map%.*}
        texture=$out/$name.dds
        baked=$texture format=
        if [ -e "$name.blend" ]; then baked=$out/$name.baked.exr format='--format float'; fi
        echo "build $(escape "$baked"): bake $(escape "$map") | $(escape "$bake")"
        echo "  options = $format $(options_in "$name.bake")"
        if [ -e "$name.blend" ]; then
            echo "build $(escape "$texture"): blend $(escape "$baked") | $(escape "$blend")"
            echo "  options = $(options_in "$name.blend")"
        fi
    done
} >"$out/build.ninja"
ninja -f "$out/build.ninja" -t cleandead >"$out/cleandead.log"
exec ninja -f "$out/build.ninja" "$@"
