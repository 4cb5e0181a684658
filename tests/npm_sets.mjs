// SPDX-License-Identifier: Apache-2.0
// npm_sets.mjs: random command lines, the same in every run, by the commands of two builds: the same exit code, words
// and bytes. Run by npm_commands.sh.
//
//     node tests/npm_sets.mjs COMMANDS OTHERS SAMPLES SETS
//
// COMMANDS and OTHERS are folders of commands. Prints what differs, and exits 1 if something does.

import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [commands, others, samples, sets] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), 'tex-sets'));

// xorshift
let seed = 61;
function random(count) {
  seed ^= seed << 13;
  seed ^= seed >>> 17;
  seed ^= seed << 5;
  return (seed >>> 0) % count;
}
const one = (list) => list[random(list.length)];
const maybe = (chance, ...words) => (random(chance) === 0 ? words : []);

const formats = ['dxt5nm', 'bc5', 'bc5-snorm', 'eac-rg11', 'astc-4x4', 'astc-6x6', 'rgb8', 'rgba8', 'rgb16', 'ag8', 'rg8',
  'rg16', 'half', 'float', 'rgba16', 'rgba16f', 'rgba32f', 'bc7', 'uastc', 'bc7-rxgb'];
const containers = ['dds', 'ktx2', 'ktx2', 'png', 'exr', 'tga', 'astc'];

function outputs() {
  return [
    ...maybe(2, '--format', one(formats)), ...maybe(2, '--y', one(['up', 'down'])),
    ...maybe(2, '--effort', one(['fast', 'fast', 'normal'])), ...maybe(12, '--rdo-mean', '0.5'),
    ...maybe(8, '--dds-header', one(['legacy', 'dx10'])), ...maybe(8, '--supercompress', one(['zstd', 'zstd:9'])),
    ...maybe(8, '--alpha', one(['0.5', 'keep', 'none'])),
  ];
}
function inputs() {
  return [...maybe(4, '--y-in', one(['up', 'down'])), ...maybe(8, '--snap-flat'), ...maybe(12, '--keep-length'),
    ...maybe(8, '--swizzle', one(['rgb', 'rg', 'gr', 'dxt5nm']))];
}
const filters = ['box', 'triangle', 'kaiser', 'mitchell', 'catmull-rom', 'lanczos3'];
const mips = () => [...maybe(2, '--mips', one(['all', 'none', '3'])), ...maybe(2, '--mip-filter', one(filters)),
  ...maybe(3, '--mip-domain', one(['vector', 'slope']))];
const kernels = ['forward', 'central', 'sobel', 'scharr', 'prewitt', 'sobel5', 'gaussian:1.5'];
const heights = ['bricks.png', 'waves.png', 'dunes.png', 'ramp.png', 'relief.png'];
const maps = ['a.png', 'b.dds', 'c.exr', 'd.ktx2'];

const verbs = {
  'bake-normals': () => [one(heights), ...maybe(2, '--kernel', one(kernels)), ...maybe(2, '--bumpiness', one(['4', '-2', '0.5'])),
    ...maybe(3, '--wrap', one(['repeat', 'clamp', 'mirror,clamp'])), ...maybe(8, '--blur', '0.7'), ...mips()],
  'mip-normals': () => [one(maps), ...inputs(), ...mips()],
  'pack-normals': () => [one(maps), ...inputs(), ...maybe(4, '--mips', one(['all', '2']))],
  'blend-normals': () => [one(maps), '--detail', one(maps), ...maybe(2, '--tiling', one(['2', '3'])), ...maybe(3, '--rotate', '30'),
    ...maybe(3, '--mode', one(['rnm', 'partial-derivative', 'whiteout', 'udn'])), ...mips()],
  'convert-normals': () => [one(maps), '--mesh', 'crate_low.glb', '--to', one(['object', 'tangent']), ...inputs()],
};

// The folders in which the two builds run hold the same files, so that they say the same.
const places = ['a', 'b'].map((name) => join(scratch, name));
for (const place of places) {
  mkdirSync(place);
  for (const name of readdirSync(samples).filter((file) => /\.(png|glb)$/.test(file))) copyFileSync(join(samples, name), join(place, name));
}
const run = (folder, place, words) => {
  const { status, stdout, stderr } = spawnSync(join(folder, words[0]), words.slice(1), { cwd: place, encoding: 'utf8' });
  return { status, stdout, stderr };
};
for (const [k, name] of maps.entries()) {
  run(commands, places[0], ['bake-normals', one(['waves.png', 'dunes.png']), '-o', name, '--bumpiness', `${k + 2}`, '--quiet']);
  copyFileSync(join(places[0], name), join(places[1], name));
}

let differences = 0;
const made = {};
for (let k = 0; k < Number(sets); ++k) {
  const verb = one(Object.keys(verbs));
  const out = `out.${one(containers)}`;
  const words = [verb, ...verbs[verb](), ...outputs(), '-o', out];
  const [a, b] = [run(commands, places[0], words), run(others, places[1], words)];
  const bytes = places.map((place) => {
    try {
      return readFileSync(join(place, out));
    } catch {
      return Buffer.alloc(0);
    }
  });
  const same = JSON.stringify(a) === JSON.stringify(b) && bytes[0].equals(bytes[1]);
  if (!same) {
    ++differences;
    console.log(words.join(' '), JSON.stringify(a), JSON.stringify(b), bytes.map(({ length }) => length).join());
  }
  made[verb] = (made[verb] ?? 0) + (a.status === 0 ? 1 : 0);
  for (const place of places) rmSync(join(place, out), { force: true });
}
rmSync(scratch, { recursive: true });
console.log(`${sets} sets, ${differences} differences; files made: ${JSON.stringify(made)}`);
process.exitCode = differences > 0 ? 1 : 0;
