#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.sh: reads our KTX2 files in Chromium by three.js' KTX2Loader. Run by hand.
#
#     tests/browser/three.sh [BUILD]    default: build/release
#
# Every encoding that KTX2Loader knows, with and without Zstandard. Every texel of every level must be what
# unpack-normals writes, within one code of 8 bits (two for signed formats). Needs npm, python3 and chromium.
#
# Last result, 2026-11-23, three 0.187.0, Chromium 156 with SwiftShader: all 18 files agree.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=$(cd "${1:-build/release}" && pwd)
export PATH=$build:$PATH
samples=$PWD/samples page=$PWD/tests/browser/three.html server=$PWD/tests/browser/serve.py
scratch=$(mktemp -d)
browser=
trap '[ -z "$browser" ] || kill "$browser" || true; wait; rm -rf "$scratch"' EXIT
cd "$scratch"
npm install --silent --prefix modules three@0.187.0
cp "$page" three.html
bake-normals "$samples/bricks.png" -o square.png --bumpiness 6 --no-sync
entries=()
for encoding in dxt5nm bc5 bc5-snorm eac-rg11 eac-rg11-snorm astc-4x4 astc-6x6 rg8 rgba8; do
    for zstd in "" zstd; do
        file=$encoding${zstd:+-$zstd}
        pack-normals square.png -o "$file.ktx2" --format "$encoding" --mips all ${zstd:+--supercompress zstd} --no-sync
        unpack-normals "$file.ktx2" --level all --out-dir . --name "$file.{level}.png" --no-sync --quiet
        levels=$(find . -maxdepth 1 -name "$file.*.png" | wc -l)
        entries+=("{\"file\": \"$file\", \"encoding\": \"$encoding\", \"levels\": $levels}")
    done
done
(IFS=,; echo "[${entries[*]}]") >files.json
(
    until (exec 3<>/dev/tcp/127.0.0.1/8617) 2>/dev/null; do sleep 0.1; done
    exec chromium --headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader \
        --enable-unsafe-swiftshader --user-data-dir="$scratch/profile" http://127.0.0.1:8617/three.html 2>log
) &
browser=$!
timeout 120 python3 "$server" 8617 || { cat log; exit 1; }
cat result
grep -q "all agree" result
