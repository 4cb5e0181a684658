#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# page.sh PLACE PAGE: bundles PAGE.js of PLACE, beside whose node_modules it lies, and has it draw the cases.json of the
# current folder in Chromium. ENGINES_PATIENCE is how many seconds it may take (900).
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
place=$1 page=$2 status=0
echo '<!DOCTYPE html><meta charset="utf-8"><body><script src="start.js"></script>' \
    '<script type="module" src="page.js"></script>' >page.html
cp "$tests/start.js" .
"$place/node_modules/.bin/esbuild" "$place/$page.js" --bundle --format=esm --outfile=page.js --log-level=error \
    --external:fs --external:path --allow-overwrite
# What engines fetch while they run: a transcoder of Basis Universal, workers.
for pair in basis=three/examples/jsm/libs/basis cesium=cesium/Build/Cesium filament=filament; do
    [ ! -d "$place/node_modules/${pair#*=}" ] || ln -sfn "$place/node_modules/${pair#*=}" "${pair%=*}"
done
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
(
    until (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do sleep 0.1; done
    exec chromium --headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader \
        --enable-unsafe-swiftshader --no-first-run --disable-background-networking --disable-component-update \
        --disable-sync --disable-dev-shm-usage --force-color-profile=srgb --user-data-dir="$PWD/profile" \
        "http://127.0.0.1:$port/page.html" 2>log
) &
browser=$!
trap 'kill "$browser" 2>/dev/null || true; wait "$browser" 2>/dev/null || true' EXIT
timeout "${ENGINES_PATIENCE:-900}" python3 "$tests/../browser/serve.py" "$port" || status=1
[ "$status" -eq 0 ] || tail -n 3 log
exit "$status"
