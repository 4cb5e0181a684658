// SPDX-License-Identifier: Apache-2.0
// npm.mjs: tests the JavaScript module against the commands of a native build: the same bytes for seeded sets of
// options, errors, memory, workers. Run by tests/npm.sh.
//
//     node tests/npm.mjs PACKAGE COMMANDS SAMPLES SETS

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { Worker } from 'node:worker_threads';

const [folder, commands, samples, sets] = process.argv.slice(2);
const tex = await import(join(resolve(folder), 'node.js'));
const scratch = mkdtempSync(join(tmpdir(), 'tex-npm'));
let passed = 0;
let failed = 0;

function test(what, body) {
  try {
    body();
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`npm: FAILED: ${what}: ${error.message}`);
  }
}
function same(a, b, what = 'values differ') {
  if (a !== b) throw new Error(`${what}: ${a}, ${b}`);
}
function sameBytes(a, b) {
  same(a.length, b.length, 'lengths');
  if (Buffer.compare(Buffer.from(a.buffer, a.byteOffset, a.byteLength), b) !== 0) throw new Error('bytes differ');
}
function refused(code, text, body) {
  try {
    body();
  } catch (error) {
    if (!(error instanceof tex.TexError)) throw error;
    same(error.code, code);
    if (!error.message.includes(text)) throw new Error(`message: ${error.message}`);
    return;
  }
  throw new Error('was not refused');
}

// xorshift: the same sets in every run.
let seed = 61;
function random(count) {
  seed ^= seed << 13;
  seed ^= seed >>> 17;
  seed ^= seed << 5;
  return (seed >>> 0) % count;
}
const one = (list) => list[random(list.length)];
const run = (command, args) => execFileSync(join(commands, command), [...args, '--quiet'], { stdio: 'pipe' });

const pictures = ['bricks.png', 'waves.png', 'dunes.png', 'ramp.png', 'relief.png'];
const encodings = {
  dds: ['dxt5nm', 'bc5', 'bc5-snorm', 'bc7', 'rgb8', 'rgba8', 'ag8', 'rg16'],
  ktx2: ['bc5', 'eac-rg11', 'eac-rg11-snorm', 'astc-4x4', 'astc-6x6', 'uastc', 'rgb16', 'half', 'float'],
  png: ['rgb8', 'rgb16', 'rgba8'],
  exr: ['half', 'float'],
};

// Heights of 8 and 16 bits to a file of any kind: the bytes of the file are those of bake-normals.
function bakeSet(k) {
  const picture = join(samples, one(pictures));
  const container = one(Object.keys(encodings));
  const encoding = one(encodings[container]);
  const bake = { kernel: one(['forward', 'central', 'sobel', 'scharr', 'prewitt', 'sobel5', 'gaussian']) };
  bake.gaussian_sigma = one([0.5, 1, 2.5]);
  bake.bumpiness = one([1, 4, -2.5, 20]);
  bake.wrap = [one(['repeat', 'clamp', 'mirror']), one(['repeat', 'clamp', 'mirror'])];
  const heights = { invert: one([true, false]), blur_sigma: one([0, 0, 0.75]), deband: one(['off', 'off', 'on']), wrap: bake.wrap };
  const mip = { filter: one(['box', 'triangle', 'kaiser', 'mitchell', 'catmull-rom', 'lanczos3']) };
  mip.domain = one(['vector', 'slope']);
  mip.wrap = bake.wrap;
  mip.levels = container === 'dds' || container === 'ktx2' ? one([0, 1, 3]) : 1;
  const pack = { encoding, y_axis: one(['up', 'down']), effort: one(['fast', 'fast', 'normal']), metric: 'component' };
  if (random(20) === 0) pack.effort = 'best';
  if (pack.effort === 'best' && encoding === 'bc5') pack.metric = 'angle'; // which implies best in the commands
  const write = { container };
  if (container === 'ktx2') write.zstd = encoding === 'uastc' ? 3 : one([0, 0, 3]); // which the commands compress anyway
  if (container === 'dds') write.dds_header = one(['legacy', 'dx10']);
  const out = join(scratch, `${k}.${container}`);
  const args = [picture, '-o', out, '--format', encoding, '--kernel', bake.kernel, '--bumpiness', bake.bumpiness,
    '--wrap', bake.wrap.join(','), '--mip-filter', mip.filter, '--mip-domain', mip.domain,
    '--mips', mip.levels === 0 ? 'all' : mip.levels, '--y', pack.y_axis, '--effort', pack.effort, '--metric', pack.metric];
  if (bake.kernel === 'gaussian') args[args.indexOf('--kernel') + 1] = `gaussian:${bake.gaussian_sigma}`;
  if (heights.invert) args.push('--invert');
  if (heights.blur_sigma > 0) args.push('--blur', heights.blur_sigma);
  if (heights.deband !== 'off') args.push('--deband', heights.deband);
  if (write.zstd) args.push('--supercompress', `zstd:${write.zstd}`);
  if (write.dds_header) args.push('--dds-header', write.dds_header);
  test(args.slice(0, 1).concat(args.slice(3)).join(' '), () => {
    try {
      run('bake-normals', args);
    } catch (error) {
      throw new Error(`bake-normals: ${error.stderr}`);
    }
    const levels = tex.mip(tex.bake(tex.readHeights(readFileSync(picture), heights), bake), mip);
    sameBytes(tex.encode(tex.pack(levels, pack), write), readFileSync(out));
    // And back: the texture that is read is the one that was written.
    const texture = tex.readTexture(readFileSync(out));
    same(texture.levels.length, levels.length);
    if (container !== 'exr') sameBytes(tex.encode(texture, write), readFileSync(out));
  });
  rmSync(out, { force: true });
}
for (let k = 0; k < Number(sets); ++k) bakeSet(k);

const wave = { width: 8, height: 4, data: Float32Array.from({ length: 32 }, (_, k) => Math.sin(k)) };
const map = tex.bake(wave);
test('a stride', () => {
  const wide = { ...wave, stride: 11, data: new Float32Array(11 * 4).fill(NaN) };
  for (let j = 0; j < 4; ++j) wide.data.set(wave.data.subarray(8 * j, 8 * j + 8), 11 * j);
  sameBytes(new Uint8Array(tex.bake(wide).data.buffer), Buffer.from(map.data.buffer));
});
test('codes of 8 and of 16 bits', () => {
  const codes = Uint8Array.from({ length: 32 }, (_, k) => (37 * k) % 256);
  const a = tex.bake({ ...wave, data: codes });
  const b = tex.bake({ ...wave, data: Uint16Array.from(codes, (code) => 257 * code) });
  sameBytes(new Uint8Array(a.data.buffer), Buffer.from(b.data.buffer));
});
test('normals of unit length', () => {
  for (let k = 0; k < map.data.length; k += 3)
    if (Math.abs(Math.hypot(...map.data.subarray(k, k + 3)) - 1) > 1e-6) throw new Error(`texel ${k / 3}`);
});
test('scale by 0 is flat', () => {
  same(Math.max(...tex.scale(map, { scale: 0 }).data.filter((_, k) => k % 3 < 2).map(Math.abs)), 0);
});
test('blend over nothing', () => {
  const flat = tex.scale(map, { scale: 0 });
  const blended = tex.blend(flat, [{ detail: map }], { mode: 'partial-derivative' });
  if (tex.compare(blended, map).max > 0.05) throw new Error(`${tex.compare(blended, map).max} degrees`);
});
test('unpack', () => {
  const unpacked = tex.unpack(tex.pack(map, { encoding: 'rgb16' }))[0];
  if (tex.compare(unpacked, map).max > 0.01) throw new Error('angles');
});
test('check finds what check-normals finds', () => {
  const file = join(samples, 'y_axis.png');
  const found = tex.check(readFileSync(file), { require: ['pow2'] }, file).map(({ id }) => id);
  let report = '';
  try {
    report = execFileSync(join(commands, 'check-normals'), [file, '--require', 'pow2', '--json'], { stdio: 'pipe' });
  } catch (error) {
    report = error.stdout;
  }
  const ids = [...String(report).matchAll(/"(?:id|rule)": *"([A-Z]\d+)"/g)].map((match) => match[1]);
  same([...new Set(found)].sort().join(), [...new Set(ids)].sort().join(), 'findings');
});
test('a word', () => refused('bad-option', "kernel: must be one of 'forward'", () => tex.bake(wave, { kernel: 'x' })));
test('a range', () => refused('bad-option', 'must be above 0 and at most 64', () => tex.bake(wave, { gaussian_sigma: 65 })));
test('NaN', () => refused('bad-option', 'bumpiness: must be finite', () => tex.bake(wave, { bumpiness: NaN })));
test('an unknown option', () => refused('bad-option', "unknown option 'kernle'", () => tex.bake(wave, { kernle: 'x' })));
test('values of the wrong type', () => {
  const texture = { ...tex.pack(tex.bake(wave), { encoding: 'rgba8' }) };
  refused('bad-option', 'gaussian_sigma: expected a number', () => tex.bake(wave, { gaussian_sigma: '1' }));
  refused('bad-option', 'texture.srgb: expected true or false', () => tex.check({ ...texture, srgb: 1 }));
  refused('bad-option', 'texture.levels: expected a list', () => tex.check({ ...texture, levels: {} }));
  refused('bad-option', 'layers: expected a list', () => tex.blend(tex.bake(wave), 'none'));
  refused('bad-option', 'require: expected a string', () => tex.check(texture, { require: [1] }));
  refused('bad-option', 'name: expected a string', () => tex.readTexture(new Uint8Array(4), 5));
});
test('the characters of JSON', () => {
  for (const name of ['"\\/\b\f\n\r\t\u0001', 'ä€𝄞', '\ufffd'])
    refused('bad-option', `unknown option '${name}'`, () => tex.bake(wave, { [name]: 1 }));
  refused('bad-option', "unknown option '\ufffd'", () => tex.bake(wave, { '\ud834': 1 })); // half of a pair
  let deep = 1;
  for (let k = 0; k < 2000; ++k) deep = [deep];
  refused('bad-option', 'options: nested too deeply', () => tex.bake(wave, { kernel: deep }));
});
test('too few samples', () => refused('bad-option', 'fewer samples', () => tex.bake({ ...wave, height: 5 })));
test('heights that are not finite', () => {
  refused('bad-data', 'finite', () => tex.bake({ ...wave, data: new Float32Array(32).fill(Infinity) }));
});
test('a cut PNG', () => {
  const bytes = readFileSync(join(samples, 'bricks.png'));
  refused('bad-data', 'damaged PNG', () => tex.readHeights(bytes.subarray(0, 3000), {}, 'cut.png'));
});
test('a cut EXR', () => {
  const bytes = tex.encode(tex.pack(map, { encoding: 'half' }), { container: 'exr' });
  refused('bad-data', 'cut.exr', () => tex.readTexture(bytes.subarray(0, 300), 'cut.exr'));
});
test('no memory, and the next call', () => {
  const texture = { format: 'rgba32-float', swizzle: 'rgb', levels: [{ width: 1, height: 1, bytes: new Uint8Array(16) }] };
  const file = Buffer.from(tex.encode(texture, { container: 'dds' }));
  file.writeUInt32LE(1 << 14, 12);
  file.writeUInt32LE(1 << 14, 16);
  refused('out-of-memory', 'large.dds', () => tex.readTexture(file, 'large.dds'));
  same(tex.bake(wave).data.length, 96);
});
test('memory is given back', () => {
  const heights = { width: 512, height: 512, data: new Float32Array(512 * 512) };
  const before = process.memoryUsage.rss();
  for (let k = 0; k < 60; ++k) tex.pack(tex.bake(heights), { encoding: 'rgb8' });
  const grown = (process.memoryUsage.rss() - before) >> 20;
  if (grown > 150) throw new Error(`${grown} MB more after 60 calls`);
});
await new Promise((done) => {
  const code = `import(${JSON.stringify(join(resolve(folder), 'node.js'))}).then(({ bake }) =>
    require('node:worker_threads').parentPort.postMessage(bake(${JSON.stringify({ ...wave, data: null })}
      .width ? { width: 2, height: 2, data: new Float32Array(4) } : null).data.length))`;
  const worker = new Worker(code, { eval: true });
  const end = (count) => {
    test('a worker', () => same(count, 12));
    worker.terminate().then(done);
  };
  worker.once('message', end);
  worker.once('error', (error) => end(error.message));
});

rmSync(scratch, { recursive: true });
console.log(`npm: ${passed} passed, ${failed} failed, 0 skipped`);
process.exitCode = failed > 0 ? 1 : 0;
