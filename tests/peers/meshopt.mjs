// SPDX-License-Identifier: Apache-2.0
// Makes tests/golden/meshopt.txt with meshoptimizer's encoder and decoder (as WebAssembly). Run it by hand, if buffers
// are added:
//
//     mkdir modules && npm install --prefix modules meshoptimizer@1.2.0
//     cp tests/peers/meshopt.mjs modules && node modules/meshopt.mjs >tests/golden/meshopt.txt
//
// A line is: name, mode, filter, count, stride, the compressed bytes, the digest (FNV-1a) of those that meshoptimizer
// decodes.

import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';

await MeshoptEncoder.ready;
await MeshoptDecoder.ready;

const hex = (bytes) => Buffer.from(bytes).toString('hex');
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

function digest(bytes) {
    let hash = 0xcbf29ce484222325n;
    for (const byte of bytes) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
    return hash.toString(16).padStart(16, '0');
}

function line(name, mode, filter, count, stride, packed) {
    const plain = new Uint8Array(count * stride);
    MeshoptDecoder.decodeGltfBuffer(plain, count, stride, packed, mode, filter);
    console.log([name, mode, filter, count, stride, hex(packed), digest(plain)].join(' '));
}

console.log('# made by tests/peers/meshopt.mjs with meshoptimizer 1.2.0');

// A grid of 20 by 15 squares, and triangles that share no edge and no vertex with those before.
const grid = [];
for (let j = 0; j < 15; ++j) {
    for (let i = 0; i < 20; ++i) {
        const a = j * 21 + i;
        grid.push(a, a + 1, a + 21, a + 21, a + 1, a + 22);
    }
}
for (let k = 0; k < 30; ++k) grid.push((k * 631) % 336, (k * 997 + 5) % 336, (k * 1409 + 11) % 336);
for (const size of [2, 4]) {
    const indices = size === 2 ? new Uint16Array(grid) : new Uint32Array(grid);
    const packed = MeshoptEncoder.encodeGltfBuffer(bytesOf(indices), grid.length, size, 'TRIANGLES');
    line(`grid${size}`, 'TRIANGLES', 'NONE', grid.length, size, packed);
}
const sequence = new Uint32Array(300).map((_, k) => (k % 3 === 2 ? 70000 + k : k * k) % 100000);
line('sequence', 'INDICES', 'NONE', 300, 4, MeshoptEncoder.encodeGltfBuffer(bytesOf(sequence), 300, 4, 'INDICES'));

// More vertices than one block has: smooth, rough and constant numbers of 8, 16 and 32 bits.
for (const [count, stride] of [[1, 4], [40, 12], [300, 16], [140, 64], [33, 252]]) {
    const view = new DataView(new ArrayBuffer(count * stride));
    for (let k = 0; k < count; ++k) {
        for (let at = 0; at < stride; at += 4) {
            const kind = (at / 4) % 4;
            if (kind === 0) view.setUint32(k * stride + at, (((k * k * 37) & 0xffff) << 16) | ((5 * k) & 0xffff), true);
            if (kind === 1) view.setFloat32(k * stride + at, 0.25 * k - 3 + 0.001 * ((k * 7) % 5), true);
            if (kind === 2) view.setUint32(k * stride + at, ((k * 97) & 255) << 16 | 200 << 8 | k % 3, true);
        }
    }
    const bytes = new Uint8Array(view.buffer);
    for (const [version, level] of [[0, 2], [1, 0], [1, 1], [1, 2], [1, 3]]) {
        const packed = MeshoptEncoder.encodeVertexBufferLevel(bytes, count, stride, level, version);
        line(`v${version}level${level}stride${stride}`, 'ATTRIBUTES', 'NONE', count, stride, packed);
    }
}

// Unit vectors on a spiral, and quaternions.
const vectors = new Float32Array(4 * 200);
for (let k = 0; k < 200; ++k) {
    const z = 1 - (2 * k) / 199, r = Math.sqrt(Math.max(0, 1 - z * z));
    vectors.set([r * Math.cos(2.4 * k), r * Math.sin(2.4 * k), z, k % 2 ? 1 : -1], 4 * k);
}
const turns = vectors.map((v, k) => v / Math.SQRT2);
for (const [stride, bits] of [[4, 8], [8, 12], [8, 16]]) {
    const filtered = MeshoptEncoder.encodeFilterOct(vectors, 200, stride, bits);
    line(`octahedral${bits}`, 'ATTRIBUTES', 'OCTAHEDRAL', 200, stride,
         MeshoptEncoder.encodeGltfBuffer(filtered, 200, stride, 'ATTRIBUTES'));
}
line('quaternions', 'ATTRIBUTES', 'QUATERNION', 200, 8,
     MeshoptEncoder.encodeGltfBuffer(MeshoptEncoder.encodeFilterQuat(turns, 200, 8, 12), 200, 8, 'ATTRIBUTES'));
const numbers = new Float32Array(300).map((_, k) => (k - 150) * Math.pow(1.1, k % 60));
line('exponential', 'ATTRIBUTES', 'EXPONENTIAL', 100, 12,
     MeshoptEncoder.encodeGltfBuffer(MeshoptEncoder.encodeFilterExp(numbers, 100, 12, 15), 100, 12, 'ATTRIBUTES'));
