#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# web.sh: uses the page of samples/web in Chromium: drops files, checks, bakes, packs, flips, repairs, cancels. What it
# saves has the bytes of the commands.
#
#     tests/browser/web.sh [BUILD]    default: build/release
#
# The last line is "web: N passed, M failed". Exits 77 without commands.wasm (samples/packaging/npm.sh) or Chromium.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if [ ! -e build/npm/package/commands.wasm ] || ! command -v chromium >/dev/null; then
    echo 'web: not run: needs a package of samples/packaging/npm.sh and chromium'
    exit 77
fi
build=$(cd "${1:-build/release}" && pwd)
server=$PWD/tests/browser/serve.py port=8621
scratch=$(mktemp -d)
browser=
trap '[ -z "$browser" ] || kill "$browser" 2>/dev/null || true; wait; rm -rf "$scratch"' EXIT
cp samples/web/*.{html,css,js} build/npm/package/commands.wasm tests/browser/web/* samples/{waves.png,crate_low.glb} \
    samples/broken/N301-srgb-decoded.png "$scratch"
cd "$scratch"
/usr/bin/convert -size 2048x2048 plasma:fractal -colorspace gray large.png
mkdir native
export PATH=$build:$PATH
bake-normals waves.png -o native/baked.dds --format bc5 --y up --bumpiness 6 --quiet
pack-normals native/baked.dds -o native/packed.ktx2 --format astc-6x6 --y down --quiet
pack-normals native/baked.dds -o native/flipped.png --format rgb16 --y down --quiet
repair-normals N301-srgb-decoded.png -o native/repaired.png --quiet
(
    until (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do sleep 0.1; done
    exec chromium --headless --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" \
        "http://127.0.0.1:$port/test.html" 2>log
) &
browser=$!
passed=0 failed=0
if timeout 300 python3 "$server" "$port"; then passed=1; else failed=1; tail -n 5 log; fi
for file in native/*; do
    if cmp "$file" "$(basename "$file")"; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
done
echo "web: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
