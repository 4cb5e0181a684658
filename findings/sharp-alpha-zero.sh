#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# sharp-alpha-zero.sh: resize() of sharp 0.35.5 on a normal map whose alpha, say a height or a gloss, is 0 everywhere.
#
# Expected: the same vector in the smaller map, or at worst a vector that alpha has weighted.
# Seen (2026-11-28): black texels. Colours are multiplied by alpha for the filter and cannot be divided by it again, so
# the normals are lost wherever the other channel is 0. removeAlpha() before resize() changes nothing: it acts after it,
# whatever the order of the calls. In a pipeline of its own it keeps them.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund sharp@0.35.5
cat >look.mjs <<'JS'
import sharp from 'sharp';
const side = 4, map = Buffer.alloc(side * side * 4);
for (let k = 0; k < map.length; k += 4) map.set([200, 90, 220, 0], k);
const input = () => sharp(map, { raw: { width: side, height: side, channels: 4 } });
const first = async (picture, channels) => [...await picture.raw().toBuffer()].slice(0, channels).join(' ');
const usual = await first(input().resize(2, 2), 4), called = await first(input().removeAlpha().resize(2, 2), 3);
const { data } = await input().removeAlpha().raw().toBuffer({ resolveWithObject: true });
const apart = await first(sharp(data, { raw: { width: side, height: side, channels: 3 } }).resize(2, 2), 3);
console.log(`sharp ${sharp.versions.sharp}: 200 90 220 0 becomes ${usual}; after removeAlpha(), ${called}; ` +
            `in a second pipeline, ${apart}`);
process.exit(usual === '0 0 0 0' && called === '0 0 0' && apart === '200 90 220' ? 0 : 1);
JS
node look.mjs
