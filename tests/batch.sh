#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# batch.sh COMMANDS: samples/batch.sh builds a folder of maps with the commands of the folder COMMANDS, and then
# rebuilds only what has changed.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
PATH=$(cd "$1" && pwd):$PATH
export PATH NINJA_STATUS='' LC_ALL=C
cd "$scratch"

# Small maps bake fast. One has a name that is difficult for scripts.
mkdir maps detail
cp "$root/samples/ramp.png" 'maps/a $ b.png'
cp "$root/samples/ramp.png" maps/plain.png
cp "$root/samples/waves.png" maps/rough.png
echo '--bumpiness 4 --effort fast' >maps/rough.bake
echo '--detail ../detail/grain.exr --tiling 2 --effort fast' >maps/rough.blend
bake-normals "$root/samples/ramp.png" -o detail/grain.exr --no-sync

# builds WHAT: the next run must do exactly this ("bake a.png; blend ...", sorted).
builds() {
    local ran
    ran=$("$root/samples/batch.sh" maps out 2>&1 | sed "s|$scratch|.|; /^ninja: no work/d" | sort | paste -sd ';')
    [ "$ran" = "$1" ] || { echo "batch.sh: expected '$1', ran '$ran'" >&2; exit 1; }
}
# Ninja compares modification times. It would miss a change within one tick of the file system's clock.
change() { sleep 0.05 && touch "$1"; }

builds "bake 'a \$ b.png';bake plain.png;bake rough.png;blend ./out/rough.baked.exr"
for name in 'a $ b' plain rough; do [ "$(head -c 4 "out/$name.dds")" = 'DDS ' ]; done
builds ''

change maps/plain.png  # a map
builds 'bake plain.png'
echo '--bumpiness 2' >'maps/a $ b.bake'  # new options
builds "bake 'a \$ b.png'"
change detail/grain.exr  # a file that only the depfile lists
builds 'blend ./out/rough.baked.exr'
change maps/rough.png  # the first of two steps
builds 'bake rough.png;blend ./out/rough.baked.exr'
echo '--bumpiness 5 --effort fast' >maps/rough.bake
builds 'bake rough.png;blend ./out/rough.baked.exr'
builds ''

rm maps/plain.png  # its outputs are removed
builds ''
[ ! -e out/plain.dds ]
echo 'no picture' >maps/broken.png  # one failure does not affect the others
cp "$root/samples/ramp.png" maps/new.png
if "$root/samples/batch.sh" maps out -k 0 >log 2>&1; then echo "batch.sh: a broken map passed" >&2; exit 1; fi
grep -q 'bake-normals: error: broken.png: ' log
[ -e out/new.dds ]
