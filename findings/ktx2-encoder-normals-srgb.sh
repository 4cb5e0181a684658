#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ktx2-encoder-normals-srgb.sh: ktx2() of ktx2-encoder 0.6.0, a transform for glTF documents, on a document whose one
# texture is in the slot normalTexture.
#
# Expected: a KTX2 file with a linear transfer function, because the slot says that the texture holds no colours.
# Seen (2026-11-28): transfer function 2, sRGB. A GPU then decodes 0.5 as 0.21: flat normals lean by 60 degrees.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1 \
    @gltf-transform/extensions@4.5.1 ktx2-encoder@0.6.0 sharp@0.35.5
cat >look.mjs <<'JS'
import { Document } from '@gltf-transform/core';
import { ktx2 } from 'ktx2-encoder/gltf-transform';
import sharp from 'sharp';
const side = 64, flat = Buffer.alloc(side * side * 3);
for (let k = 0; k < flat.length; k += 3) flat.set([128, 128, 255], k);
const png = await sharp(flat, { raw: { width: side, height: side, channels: 3 } }).png().toBuffer();
const imageDecoder = async (bytes) => {
    const { data, info } = await sharp(bytes).ensureAlpha().raw().toBuffer({ resolveWithObject: true });
    return { data: new Uint8Array(data), width: info.width, height: info.height };
};
const document = new Document();
const texture = document.createTexture('normals').setImage(new Uint8Array(png)).setMimeType('image/png');
document.createMaterial().setNormalTexture(texture);
await document.transform(ktx2({ isUASTC: true, generateMipmap: false, imageDecoder }));
const file = texture.getImage(), view = new DataView(file.buffer, file.byteOffset);
const transfer = view.getUint8(view.getUint32(48, true) + 14);  // of the basic data format descriptor
console.log(`ktx2-encoder 0.6.0: ${texture.getMimeType()} with transfer function ${transfer} (1 linear, 2 sRGB)`);
process.exit(transfer === 2 ? 0 : 1);
JS
node look.mjs | tail -n 1
exit "${PIPESTATUS[0]}"
