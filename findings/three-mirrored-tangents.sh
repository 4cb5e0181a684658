#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three-mirrored-tangents.sh: a normal map that leans up (green up) on a plane of three.js 0.187.0 with an attribute
# `tangent`, whose object is as it is, or mirrored by scale.x = -1, lit from above and from below. The same plane
# without that attribute beside it. Chromium of Debian 12 draws them, with SwiftShader.
#
# Expected: light from above stays the brighter one, with the attribute and without: w of tangents says on which side
# the bitangent lies, and the mirroring of the object turns that round once more.
# Seen (2026-11-29): on the mirrored object with the attribute, light from below is the brighter one. Without it, where
# the shader derives tangents from the picture, nothing changes.
# For a normal map: on mirrored copies of a model (arms, wheels) that was exported with tangents, bumps are lit as dents
# in y; exporting without tangents, or applying the scale to the mesh, mends it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund three@0.187.0 esbuild@0.28.2
cat >look.js <<'JS'
import * as THREE from "three";
const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
renderer.setSize(16, 16);
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
const texels = Uint8Array.from({length: 4 * 16}, (_, k) => [128, 204, 230, 255][k % 4]);  // leans up by 37 degrees
const map = new THREE.DataTexture(texels, 4, 4);
map.needsUpdate = true;
function code(hasTangents, scale, y) {
  const geometry = new THREE.PlaneGeometry(2, 2);
  if (hasTangents)
    geometry.setAttribute("tangent", new THREE.Float32BufferAttribute(Array(4).fill([1, 0, 0, 1]).flat(), 4));
  const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({color: 0x999999, normalMap: map}));
  mesh.scale.x = scale;
  const light = new THREE.DirectionalLight(0xffffff, 3);
  light.position.set(0, y, 0.8);
  const scene = new THREE.Scene();
  scene.add(mesh, light);
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
  camera.position.z = 5;
  renderer.render(scene, camera);
  const copy = new OffscreenCanvas(16, 16).getContext("2d");
  copy.drawImage(renderer.domElement, 0, 0);
  return copy.getImageData(8, 8, 1, 1).data[0];
}
const lines = [];
for (const hasTangents of [false, true]) {
  for (const scale of [1, -1])
    lines.push(`${hasTangents ? "tangents" : "none"}, scale ${scale}: above ${code(hasTangents, scale, 0.6)},` +
               ` below ${code(hasTangents, scale, -0.6)}`);
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
echo "three.js 0.187.0, $(chromium --version 2>/dev/null)"
cat seen
python3 - <<'PY'
import re
numbers = [[int(n) for n in re.findall(r"(?:above|below) (\d+)", line)] for line in open("seen")]
plain, mirrored, tangents, both = numbers
raise SystemExit(not (all(a > b for a, b in (plain, mirrored, tangents)) and both[0] < both[1]))
PY
