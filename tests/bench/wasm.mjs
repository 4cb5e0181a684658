// SPDX-License-Identifier: Apache-2.0
// wasm.mjs: how long the JavaScript module takes beside the C interface of the native library, one thread each, turn by
// turn; and how much of it is spent in WebAssembly, not in copies from and to JavaScript. Run by wasm.sh.
//
//     node tests/bench/wasm.mjs PACKAGE

import { join, resolve } from 'node:path';

const [folder] = process.argv.slice(2);
let inside = 0; // microseconds in WebAssembly since it was last set to 0
const spent = (before) => {
  const { user, system } = process.cpuUsage(before);
  return user + system;
};
const { Instance } = WebAssembly;
WebAssembly.Instance = function (module, imports) {
  const { exports } = new Instance(module, imports);
  const tex_call = (at) => {
    const before = process.cpuUsage();
    const answer = exports.tex_call(at);
    inside += spent(before);
    return answer;
  };
  return { exports: { ...exports, tex_call } };
};
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

// The least processor time of five, in Mtexel/s: in all, and in WebAssembly alone.
function speeds(body, count = 5) {
  let [all, within] = [Infinity, Infinity];
  for (let k = 0; k < count; ++k) {
    inside = 0;
    const before = process.cpuUsage();
    body();
    all = Math.min(all, spent(before));
    within = Math.min(within, inside);
  }
  return [texels / all, texels / within];
}
const cases = [['bake', null, null]];
for (const encoding of ['bc5', 'astc-4x4', 'uastc']) for (const effort of ['fast', 'normal']) cases.push([encoding, encoding, effort]);
for (const [name, encoding, effort] of cases) {
  const call = encoding ? () => tex.pack(map, { encoding, effort }) : () => tex.bake(heights);
  call();
  const [all, within] = speeds(call);
  console.log(`${name} ${effort ?? ''}: ${all.toFixed(2)} Mtexel/s, in WebAssembly ${within.toFixed(2)}`);
}
