#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# gltf-transform-webp-normals.sh: textureCompress() of @gltf-transform/functions 4.5.1, with sharp 0.35.5 and without
# other options, on a document whose only texture is a normal map of 256x256: to WebP, AVIF and JPEG.
#
# Expected: the slot of a normal map is left out, or kept without loss; else WebP loses about as much as JPEG, because
# both are lossy and halve the resolution of colour, and AVIF less.
# Seen (2026-11-29): the slot is not looked at. WebP turns the vectors by 7.3 degrees in the mean, JPEG by 3.2, and
# AVIF, for which sharp keeps the full resolution of colour, by 4.1 in a sixth of the bytes.
# For a normal map: textureCompress({slots: /^(?!normal)/}) for the others, and WebP without loss for this one, which
# has two thirds of the bytes of the PNG.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1 \
    @gltf-transform/extensions@4.5.1 sharp@0.35.5
cat >look.mjs <<'JS'
import { Document } from '@gltf-transform/core';
import { textureCompress } from '@gltf-transform/functions';
import sharp from 'sharp';
const side = 256, map = new Uint8Array(3 * side * side);
for (let j = 0; j < side; j++) {
    for (let i = 0; i < side; i++) {
        const p = 0.9 * Math.cos(0.7 * i) * Math.cos(0.23 * j), q = -0.9 * Math.sin(0.9 * j) * Math.cos(0.31 * i);
        [p, q, 1].forEach((n, c) => {
            map[3 * (side * j + i) + c] = Math.round(127.5 * (n / Math.hypot(p, q, 1) + 1));
        });
    }
}
const png = await sharp(map, { raw: { width: side, height: side, channels: 3 } }).png().toBuffer();
function meanDegrees(codes) {
    let sum = 0;
    for (let k = 0; k < map.length; k += 3) {
        const vector = (from) => [0, 1, 2].map((c) => from[k + c] / 127.5 - 1);
        const a = vector(map), b = vector(codes);
        const cosine = a.reduce((dot, n, c) => dot + n * b[c], 0) / Math.hypot(...a) / Math.hypot(...b);
        sum += Math.acos(Math.min(1, cosine)) * 180 / Math.PI;
    }
    return sum * 3 / map.length;
}
const degrees = {};
for (const targetFormat of ['webp', 'avif', 'jpeg']) {
    const document = new Document();
    document.createBuffer();
    const texture = document.createTexture('n').setImage(png).setMimeType('image/png');
    document.createMaterial('m').setNormalTexture(texture);
    await document.transform(textureCompress({ encoder: sharp, targetFormat }));
    const [made] = document.getRoot().listTextures();
    const bytes = Buffer.from(made.getImage());
    degrees[targetFormat] = meanDegrees(await sharp(bytes).removeAlpha().raw().toBuffer());
    console.log(`${made.getMimeType()}: ${bytes.length} of ${png.length} bytes, ` +
                `${degrees[targetFormat].toFixed(2)} degrees in the mean`);
}
console.log(`sharp ${sharp.versions.sharp}, libwebp ${sharp.versions.webp}`);
const { webp, avif, jpeg } = degrees;
process.exit(webp > 6 && webp < 9 && jpeg > 2 && jpeg < 4 && avif > 3 && avif < 5 ? 0 : 1);
JS
node look.mjs
