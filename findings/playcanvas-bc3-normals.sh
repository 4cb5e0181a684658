#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# playcanvas-bc3-normals.sh: a StandardMaterial of PlayCanvas 2.23.3 with a normal map of BC3 (DXT5). Its R, G and B
# hold a normal that leans to the left; its alpha, as x, and G hold one that leans to the right, as DXT5nm does. The
# texture does not say which of the two it is. Chromium of Debian 12 draws it, with SwiftShader.
#
# Expected: R, G and B are read, as from RGBA8 with the same values, unless the texture's type says swizzleGGGR.
# Seen (2026-11-29): x is read from alpha. RGBA8 leans to the left.
# For a normal map: DXT5nm needs no setting. BC3 with x, y and z in R, G and B, and 255 or a mask in alpha, leans to the
# right by up to 90 degrees everywhere, and B is not used.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund playcanvas@2.23.3 esbuild@0.28.2
cat >look.js <<'JS'
import * as pc from "playcanvas";
const canvas = document.createElement("canvas");
const app = new pc.Application(canvas, {graphicsDeviceOptions: {preserveDrawingBuffer: true, antialias: false}});
app.setCanvasFillMode(pc.FILLMODE_NONE, 16, 16);
app.setCanvasResolution(pc.RESOLUTION_FIXED, 16, 16);
app.autoRender = false;
app.scene.ambientLight = new pc.Color(0, 0, 0);
app.start();
const camera = new pc.Entity(), light = new pc.Entity(), plane = new pc.Entity();
camera.addComponent("camera", {projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: 1, nearClip: 1, farClip: 20});
camera.setPosition(0, 0, 10);
light.addComponent("light", {type: "directional"});
plane.addComponent("render", {type: "plane"});
plane.setLocalScale(2, 2, 2);
plane.setLocalEulerAngles(90, 0, 0);
for (const entity of [camera, light, plane]) app.root.addChild(entity);
function code(texture, x) {
  const material = new pc.StandardMaterial();
  material.diffuse = new pc.Color(0.6, 0.6, 0.6);
  material.gloss = 0;
  material.normalMap = texture;
  material.update();
  plane.render.material = material;
  light.setRotation(new pc.Quat().setFromDirections(new pc.Vec3(0, -1, 0), new pc.Vec3(-0.6 * x, 0, -0.8)));
  app.render();
  const copy = new OffscreenCanvas(16, 16).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  return copy.getImageData(8, 8, 1, 1).data[0];
}
const made = (format, bytes) => new pc.Texture(app.graphicsDevice, {width: 4, height: 4, format, mipmaps: false,
  levels: [Uint8Array.from(bytes)]});
const rgb565 = 6 << 11 | 32 << 5 | 28;  // 49 130 231
const textures = {
  RGBA8: made(pc.PIXELFORMAT_RGBA8, Array.from({length: 16}, () => [49, 130, 231, 204]).flat()),
  BC3: made(pc.PIXELFORMAT_DXT5, [204, 204, 0, 0, 0, 0, 0, 0, rgb565 & 255, rgb565 >> 8, rgb565 & 255, rgb565 >> 8,
                                  0, 0, 0, 0]),
};
const lines = Object.entries(textures).map(([name, texture]) =>
  `${name}: lit from the right ${code(texture, 1)}, from the left ${code(texture, -1)}`);
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
echo "PlayCanvas 2.23.3, $(chromium --version 2>/dev/null)"
cat seen
python3 - <<'PY'
import re
numbers = [[int(n) for n in re.findall(r" (\d+)", line)] for line in open("seen")]
plain, compressed = numbers
raise SystemExit(not (plain[0] < plain[1] and compressed[0] > compressed[1]))
PY
