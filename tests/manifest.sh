#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# manifest.sh COMMANDS: samples/normals.toml builds a copy of the samples with the commands of the folder COMMANDS, and
# builds nothing the second time.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
build=$(cd "$1" && pwd)/build-normals
cp "$root"/samples/*.png "$root/samples/normals.toml" "$scratch"

# builds WHAT: the next run must print this summary and no message.
builds() {
    local said
    said=$("$build" "$scratch/normals.toml" --no-sync 2>&1)
    [ "$said" = "$1" ] || { echo "manifest.sh: expected '$1', got '$said'" >&2; exit 1; }
}

builds '5 made, 0 up to date'
for name in waves_n.ktx2 bricks_n.dds bricks_ue.dds ramp_n.dds hemisphere_n.dds dunes_n.dds; do
    [ -s "$scratch/built/$name" ]
done
builds '0 made, 5 up to date'
cp "$scratch/ramp.png" "$scratch/new.png"
builds '1 made, 5 up to date'
