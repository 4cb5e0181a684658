#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# spheres.sh: foreign programs draw a lit sphere with the files that --for makes for them. Run by hand.
#
#     tests/engines/spheres.sh [BUILD]    default: build/release
#
# Each picture must agree with that of preview-normals for the same file: within 3 codes of 8 bits on 99 % of the
# sphere's pixels. Blender and Godot draw their own files; three.js in Chromium draws those for three, gltf, bevy,
# android and ios, which its GPU API decodes. For unity, unreal and o3de nothing runs here. Needs blender, chromium,
# godot3, npm and xvfb (apt-get install --no-install-recommends), and a BUILD with the Python module.
#
# Last result, 2026-11-24, three 0.187.0 in Chromium 156 with SwiftShader, Blender 3.4.1, Godot 3.2.3 with llvmpipe: all
# agree on 99.3 to 99.7 % of the pixels.
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$tests/../.."
build=$(realpath "${1:-build/release}")
export PATH=$build:$PATH PYTHONPATH=$build/python
samples=$PWD/samples side=768 port=8618
scratch=$(mktemp -d)
browser=
trap '[ -z "$browser" ] || kill "$browser" || true; wait; rm -rf "$scratch"' EXIT
cd "$scratch"

python3 "$tests/sphere.py" .
bake-normals "$samples/bricks.png" --out-dir . --for blender,godot,three,gltf,bevy,android,ios --bumpiness 2 --no-sync
cp gltf/bricks.png normal.png # as sphere.glb names it

blender -b --python-exit-code 1 -P "$tests/lit_blender.py" -- . blender/bricks.png "$PWD/blender.png" "$side" \
    >log 2>&1 || { cat log; exit 1; }
xvfb-run -a godot3 --video-driver GLES3 --resolution 64x64 -s "$tests/lit_godot.gd" \
    "$PWD" "$PWD/godot/bricks.png" "$PWD/godot.png" "$side" >log 2>&1 || { cat log; exit 1; }

npm install --silent --prefix modules three@0.187.0
cp "$tests/lit_three.html" .
cat >maps.json <<END
{"side": $side, "maps": [["normal.png", "gltf.png"], ["three/bricks.png", "three.png"],
                        ["bevy/bricks.ktx2", "bevy.png"], ["android/bricks.ktx2", "android.png"],
                        ["ios/bricks.ktx2", "ios.png"]]}
END
(
    until (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do sleep 0.1; done
    exec chromium --headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader \
        --enable-unsafe-swiftshader --user-data-dir="$scratch/profile" "http://127.0.0.1:$port/lit_three.html" 2>log
) &
browser=$!
timeout 120 python3 "$tests/../browser/serve.py" "$port" || { cat log; exit 1; }

failed=0
for file in */bricks.*; do
    engine=${file%%/*}
    preview-normals "$file" -o ours.png --mesh sphere.glb --camera 0,0,0 --size "$side" --tint 0.6 --specular 0 \
        --ambient 0 --no-legend --no-sync --quiet
    python3 "$tests/compare.py" ours.png "$engine.png" || failed=1
done
exit "$failed"
