#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# babylon-left-handed-bumps.sh: a StandardMaterial of Babylon.js 9.35.0 with a normal map that leans to the right, and
# with one that leans up (green up), on a plane of MeshBuilder in a scene with default settings. Chromium of Debian 12
# draws it, with SwiftShader.
#
# Expected: light from the right makes the first brighter than light from the left, and light from above the second, or
# one of the two is the other way: engines differ in where green points.
# Seen (2026-11-29): both are the other way, so that neither maps with green up nor maps with green down are right.
# With invertNormalMapX and invertNormalMapY both are right.
# For a normal map: a bump is lit as a dent, and a map with green down looks right as long as light comes from above.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund @babylonjs/core@9.35.0 esbuild@0.28.2
cat >look.js <<'JS'
import * as BABYLON from "@babylonjs/core";
const canvas = document.createElement("canvas");
canvas.width = canvas.height = 16;
const engine = new BABYLON.Engine(canvas, false, {preserveDrawingBuffer: true});
// How light a plane is under light from a side, with a map of one normal.
async function code(normal, light, inverted) {
  const scene = new BABYLON.Scene(engine);
  const camera = new BABYLON.FreeCamera("camera", new BABYLON.Vector3(0, 0, -10), scene);
  camera.setTarget(BABYLON.Vector3.Zero());
  camera.mode = BABYLON.Camera.ORTHOGRAPHIC_CAMERA;
  [camera.orthoLeft, camera.orthoRight, camera.orthoBottom, camera.orthoTop] = [-1, 1, -1, 1];
  const [x, y, z] = light;  // towards it: x to the right on the screen, z to the viewer
  new BABYLON.DirectionalLight("light", new BABYLON.Vector3(-x, -y, z), scene);
  const material = new BABYLON.StandardMaterial("lit", scene);
  material.specularColor = BABYLON.Color3.Black();
  material.diffuseColor = new BABYLON.Color3(0.6, 0.6, 0.6);
  const texels = Uint8Array.from({length: 4 * 16}, (_, k) => k % 4 < 3 ? Math.round(127.5 * (normal[k % 4] + 1)) : 255);
  material.bumpTexture = BABYLON.RawTexture.CreateRGBATexture(texels, 4, 4, scene, false);
  material.invertNormalMapX = material.invertNormalMapY = inverted;
  BABYLON.MeshBuilder.CreatePlane("plane", {size: 2}, scene).material = material;
  await scene.whenReadyAsync();
  scene.render();
  const copy = new OffscreenCanvas(16, 16).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  scene.dispose();
  return copy.getImageData(8, 8, 1, 1).data[0];
}
const lines = [];
for (const [name, inverted] of [["default", false], ["inverted", true]]) {
  const right = await code([0.6, 0, 0.8], [0.6, 0, 0.8], inverted);
  const left = await code([0.6, 0, 0.8], [-0.6, 0, 0.8], inverted);
  const above = await code([0, 0.6, 0.8], [0, 0.6, 0.8], inverted);
  const below = await code([0, 0.6, 0.8], [0, -0.6, 0.8], inverted);
  lines.push(`${name}: leans right, lit from the right ${right}, from the left ${left};` +
             ` leans up, lit from above ${above}, from below ${below}`);
}
document.body.textContent = lines.join("|") + "|end";
JS
npx esbuild look.js --bundle --format=esm --outfile=page.js --log-level=error
{
    echo '<!DOCTYPE html><meta charset="utf-8"><body></body><script type="module">'
    cat page.js
    echo '</script>'
} >page.html
chromium --headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
    --user-data-dir="$work/profile" --virtual-time-budget=60000 --dump-dom "file://$work/page.html" 2>log |
    sed -n 's/.*<body>\(.*\)|end.*/\1/p' | tr '|' '\n' >seen
echo "Babylon.js 9.35.0, $(chromium --version 2>/dev/null)"
cat seen
python3 - <<'PY'
import re
numbers = [[int(n) for n in re.findall(r" (\d+)", line)] for line in open("seen")]
(right, left, above, below), inverted = numbers
raise SystemExit(not (right < left and above < below and inverted[0] > inverted[1] and inverted[2] > inverted[3]))
PY
