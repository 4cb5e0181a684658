// SPDX-License-Identifier: Apache-2.0
// wasm.mjs: how long the JavaScript module takes beside the C interface of the native library, one thread each, turn by
// turn. Run by wasm.sh.
//
//     node tests/bench/wasm.mjs PACKAGE

import { join, resolve } from 'node:path';

const [folder] = process.argv.slice(2);
const start = process.hrtime.bigint();
const tex = await import(join(resolve(folder), 'node.js'));
console.log(`import and compile: ${Number(process.hrtime.bigint() - start) / 1e6} ms`);

const side = 1024;
const data = new Float32Array(side * side);
for (let j = 0; j < side; ++j)
  for (let i = 0; i < side; ++i) data[j * side + i] = Math.sin(i / 7) * Math.cos(j / 11) + 0.3 * Math.sin((i + 2 * j) / 3);
const heights = { width: side, height: side, data };
const map = tex.bake(heights, { bumpiness: 4 });
const texels = side * side;

// The least processor time of five, in Mtexel/s.
function speed(body, count = 5) {
  let least = Infinity;
  for (let k = 0; k < count; ++k) {
    const before = process.cpuUsage();
    body();
    const { user, system } = process.cpuUsage(before);
    least = Math.min(least, user + system);
  }
  return texels / least;
}
const cases = [['bake', null, null]];
for (const encoding of ['bc5', 'astc-4x4', 'uastc']) for (const effort of ['fast', 'normal']) cases.push([encoding, encoding, effort]);
for (const [name, encoding, effort] of cases) {
  const call = encoding ? () => tex.pack(map, { encoding, effort }) : () => tex.bake(heights);
  call();
  console.log(`${name} ${effort ?? ''}: ${speed(call).toFixed(2)} Mtexel/s`);
}
