// SPDX-License-Identifier: Apache-2.0
// Makes tests/golden/tangents.txt with two libraries that others wrote: mikktspace (the reference implementation of
// MikkTSpace, as WebAssembly) and meshoptimizer. Run it by hand, if meshes are added to tests/unit/tangents_test.cpp:
//
//     mkdir dump modules && npm install --prefix modules mikktspace@1.1.1 meshoptimizer@1.3.0
//     TEX_TANGENTS_DUMP=dump build/release/unit_tests --gtest_filter='TangentsGolden.*'
//     cp tests/peers/tangents.mjs modules && node modules/tangents.mjs dump >tests/golden/tangents.txt
//
// The test writes the corners of its meshes into `dump`. With a second folder, the script writes the tangents there, as
// floats, to look for a difference.

import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { MeshoptTangents } from 'meshoptimizer';

const { generateTangents } = createRequire(import.meta.url)('mikktspace');
await MeshoptTangents.ready;
const [dump, out] = process.argv.slice(2);

// FNV-1a of the bits, -0 as 0.
function digest(values) {
    const plain = new Float32Array(values.length);
    for (let k = 0; k < values.length; ++k) plain[k] = values[k] === 0 ? 0 : values[k];
    let hash = 0xcbf29ce484222325n;
    for (const byte of new Uint8Array(plain.buffer)) {
        hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
    }
    return hash.toString(16).padStart(16, '0');
}

console.log('# mesh, corners, digests of the tangents of mikktspace 1.1.1 and meshoptimizer 1.3.0');
console.log('# made by tests/peers/tangents.mjs');
const order = new Intl.Collator('en', { numeric: true });
for (const file of readdirSync(dump).filter((name) => name.endsWith('.corners')).sort(order.compare)) {
    const bytes = readFileSync(`${dump}/${file}`);
    const all = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
    const corners = all.length / 8;
    const positions = new Float32Array(corners * 3);
    const normals = new Float32Array(corners * 3);
    const uvs = new Float32Array(corners * 2);
    for (let c = 0; c < corners; ++c) {
        positions.set(all.subarray(c * 8, c * 8 + 3), c * 3);
        normals.set(all.subarray(c * 8 + 3, c * 8 + 6), c * 3);
        uvs.set(all.subarray(c * 8 + 6, c * 8 + 8), c * 2);
    }
    const mikktspace = generateTangents(positions, normals, uvs);
    const meshopt = MeshoptTangents.generateTangents(null, positions, 3, normals, 3, uvs, 2, []);
    const name = file.replace(/\.corners$/, '');
    if (out) {
        writeFileSync(`${out}/${name}.mikktspace`, new Uint8Array(mikktspace.buffer));
        writeFileSync(`${out}/${name}.meshopt`, new Uint8Array(meshopt.buffer));
    }
    console.log(`${name} ${corners} ${digest(mikktspace)} ${digest(meshopt)}`);
}
