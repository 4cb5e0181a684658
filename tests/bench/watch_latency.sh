#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# watch_latency.sh: measures how long build-normals --watch takes from a save to the finished output.
#
#     tests/bench/watch_latency.sh [COUNT [BUILD]]    default: 20 build/release
#
# Saves a 512x512 height map COUNT times in place, and COUNT times under another name that then replaces it, as editors
# do. Prints the median and the longest time. Needs inotifywait (inotify-tools).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
count=${1:-20}
build=$(cd "${2:-build/release}" && pwd)
export PATH=$build:$PATH
samples=$PWD/samples
scratch=$(mktemp -d)
trap 'kill -INT "$watch" "$COPROC_PID" 2>/dev/null || true; rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir art out
cat >normals.toml <<'MANIFEST'
version = 1
[[rule]]
match = "art/*.png"
name = "out/{stem}.dds"
steps = [ { bake = { bumpiness = 4 } } ]
MANIFEST
pictures=("$samples/bricks.png" "$samples/waves.png")
cp "${pictures[0]}" art/wall.png
set -m # so that the watch takes SIGINT
build-normals --watch --no-sync >log 2>&1 &
watch=$!
coproc inotifywait -q -m -e moved_to,create --format %f out 2>&1
until [ -e out/wall.dds ]; do sleep 0.1; done
sleep 1
while read -r -t 0.3 _ <&"${COPROC[0]}"; do :; done

measure() { # MEANS: prints milliseconds
    local begin
    begin=$(date +%s%N)
    case $1 in
        place) cat "${pictures[k % 2]}" >art/wall.png ;;
        rename) cp "${pictures[k % 2]}" art/wall.tmp && begin=$(date +%s%N) && mv art/wall.tmp art/wall.png ;;
    esac
    read -r -t 10 _ <&"${COPROC[0]}"
    echo $((($(date +%s%N) - begin) / 1000000))
    sleep 0.2
    while read -r -t 0.1 _ <&"${COPROC[0]}"; do :; done
}
echo "| how it is saved | median | longest |"
echo "|---|---|---|"
for means in place rename; do
    for ((k = 1; k <= count; ++k)); do measure "$means"; done >took
    echo "| $means | $(sort -n took | sed -n "$(((count + 1) / 2))p") ms | $(sort -n took | tail -1) ms |"
done
begin=$(date +%s%N)
kill -INT "$watch"
status=0
wait "$watch" || status=$?
echo "SIGINT ends it after $((($(date +%s%N) - begin) / 1000000)) ms with status $status"
