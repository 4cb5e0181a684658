#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# phaser-flipped-normals.sh: a lit image of Phaser 4.2.1 whose normal map leans to the right, as it is, turned by 180
# degrees, and with flipX. Chromium of Debian 12 draws it, with SwiftShader.
#
# Expected: turned or flipped, it leans to the left: light from the left makes it brighter than light from the right.
# Seen (2026-11-29): turned, it does. With flipX it still leans to the right: the picture of the map is mirrored, its
# normals are not.
# For a normal map: one sprite for both directions of a character is lit from the wrong side in one of them.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund phaser@4.2.1 esbuild@0.28.2
cat >look.js <<'JS'
import * as Phaser from "phaser";
const side = 32, far = 40 * side;
const filled = color => {
  const context = Object.assign(document.createElement("canvas"), {width: side, height: side}).getContext("2d");
  context.fillStyle = color;
  context.fillRect(0, 0, side, side);
  return context.canvas;
};
const game = new Phaser.Game({
  type: Phaser.WEBGL, width: side, height: side, banner: false, audio: {noAudio: true}, parent: document.body,
  render: {preserveDrawingBuffer: true}, callbacks: {postBoot: () => game.loop.stop()},
  scene: {create() {
    this.lights.enable().setAmbientColor(0);
    const light = this.lights.addLight(0, 0, 4 * far, 0xffffff, 1);
    light.z = 0.8 * far;
    this.textures.addImage("lit", filled("#999"), filled("rgb(204, 128, 230)"));  // (0.6, 0, 0.8)
    const image = this.add.image(side / 2, side / 2, "lit").setLighting(true);
    const code = x => {
      light.setPosition(side / 2 + 0.6 * far * x, side / 2);
      game.step(performance.now(), 16);
      const copy = new OffscreenCanvas(side, side).getContext("2d");
      copy.drawImage(game.canvas, 0, 0);
      return copy.getImageData(side / 2, side / 2, 1, 1).data[0];
    };
    const line = name => `${name}: lit from the right ${code(1)}, from the left ${code(-1)}`;
    code(1);
    const lines = [line("as it is")];
    image.setAngle(180);
    lines.push(line("turned by 180 degrees"));
    image.setAngle(0).setFlipX(true);
    lines.push(line("flipX"));
    document.body.textContent = lines.join("|") + "|end";
  }}});
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
echo "Phaser 4.2.1, $(chromium --version 2>/dev/null)"
cat seen
python3 - <<'PY'
import re
numbers = [[int(n) for n in re.findall(r" (\d+)", line)[-2:]] for line in open("seen")]
plain, turned, flipped = numbers
raise SystemExit(not (plain[0] > plain[1] and turned[0] < turned[1] and flipped[0] > flipped[1]))
PY
