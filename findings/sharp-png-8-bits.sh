#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# sharp-png-8-bits.sh: sharp 0.35.5 reads a PNG of 16 bits and writes a PNG.
#
# Expected: 16 bits, as the input has and PNG can hold.
# Seen (2026-11-28): 8 bits, without a word, with resize() and without. Slopes finer than half a degree are gone.
# toColourspace('rgb16') before png() keeps them.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund sharp@0.35.5
cat >look.mjs <<'JS'
import sharp from 'sharp';
const side = 8, map = new Uint16Array(side * side * 3);
for (let k = 0; k < map.length; k += 3) map.set([33068, 32691, 65500], k);
const raw = { width: side, height: side, channels: 3, depth: 'ushort' };
const bits = (png) => png[24];  // of IHDR
const input = await sharp(map, { raw }).toColourspace('rgb16').png().toBuffer();
const usual = bits(await sharp(input).png().toBuffer());
const asked = bits(await sharp(input).toColourspace('rgb16').png().toBuffer());
console.log(`sharp ${sharp.versions.sharp}: a PNG of ${bits(input)} bits is written with ${usual}; ` +
            `after toColourspace('rgb16'), with ${asked}`);
process.exit(bits(input) === 16 && usual === 8 && asked === 16 ? 0 : 1);
JS
node look.mjs
