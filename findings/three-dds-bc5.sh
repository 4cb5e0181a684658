#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three-dds-bc5.sh: DDSLoader of three.js 0.187.0 on DDS files of 4x4 texels with BC5 and BC7, as engines store normal
# maps. Its KTX2Loader takes both formats.
#
# Expected: a texture, or an exception.
# Seen (2026-11-28): parse() returns a texture without levels and without a format, and prints an error to the console.
# BC1, BC2, BC3 and BC6H alone are read.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund three@0.187.0
cat >look.mjs <<'JS'
import { DDSLoader } from 'three/examples/jsm/loaders/DDSLoader.js';
function dds(fourCC, dxgiFormat, blockBytes) {
    const words = new Uint32Array(32 + 5 + blockBytes / 4);
    words.set([0x20534444, 124, 0x81007, 4, 4, blockBytes, 0, 1]);  // "DDS ", size, flags, height, width, bytes, levels
    words.set([32, 4, [...fourCC].reduce((sum, c, k) => sum | c.charCodeAt(0) << 8 * k, 0)], 19);
    words[27] = 0x1000;  // a texture
    words.set([dxgiFormat, 3, 0, 1, 0], 32);
    return words.buffer;
}
const log = [];
console.error = (...words) => log.push(words.join(' '));
let expected = true;
for (const [name, dxgiFormat] of [['BC5', 83], ['BC7', 98]]) {
    const texture = new DDSLoader().parse(dds('DX10', dxgiFormat, 16), true);
    console.log(`three.js 0.187.0, ${name} in DDS: format ${texture.format}, ${texture.mipmaps.length} levels`);
    expected &&= texture.format === null && texture.mipmaps.length === 0;
}
console.log(log.join('\n'));
process.exit(expected ? 0 : 1);
JS
node look.mjs
