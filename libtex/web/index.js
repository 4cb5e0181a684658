// SPDX-License-Identifier: Apache-2.0
// index.js: libtex in JavaScript, over tex.wasm beside it. One ES module for browsers, workers and, through node.js, node.
//
// A call goes to WebAssembly as JSON; typed arrays in it are copied to its memory, those of the answer out of it, and
// both are freed before the verb returns. Nothing of the caller's is kept.

const kTypes = { f32: Float32Array, u16: Uint16Array, u8: Uint8Array };

/** What is wrong, in the words of the commands; `code` is one of 'bad-option', 'bad-data', 'unsupported' ... */
export class TexError extends Error {
  constructor({ code, message }) {
    super(message);
    this.name = 'TexError';
    this.code = code;
  }
}

// WASI as far as a library without files calls it: no file is open, there are no arguments, and no environment.
// Random numbers are for hash tables alone.
function systemCalls(memory) {
  const view = () => new DataView(memory().buffer);
  const kBadDescriptor = 8;
  const calls = {
    clock_time_get(_, __, at) {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    random_get(at, count) {
      new Uint8Array(memory().buffer, at, count).fill(1);
      return 0;
    },
    proc_exit(status) {
      throw new Error(`libtex ended with status ${status}: this is a bug`);
    },
  };
  for (const name of ['environ_sizes_get', 'args_sizes_get']) {
    calls[name] = (count, bytes) => {
      view().setUint32(count, 0, true);
      view().setUint32(bytes, 0, true);
      return 0;
    };
  }
  calls.environ_get = calls.args_get = calls.sched_yield = () => 0;
  return new Proxy(calls, { get: (known, name) => known[name] ?? (() => kBadDescriptor) });
}

let compiled;
let running; // the instance; another one takes its place if it has failed

async function compile(source) {
  if (source !== undefined) return source instanceof WebAssembly.Module ? source : WebAssembly.compile(await source);
  const url = new URL('./tex.wasm', import.meta.url); // written so that bundlers find it
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

/**
 * Loads the WebAssembly; verbs may be called after that. Needed once. `source`: the bytes of tex.wasm, or the module,
 * where it is not beside this file.
 */
export async function ready(source) {
  compiled ??= compile(source);
  try {
    compiled = await compiled;
  } catch (error) {
    compiled = undefined;
    throw error;
  }
}

function start() {
  if (!(compiled instanceof WebAssembly.Module)) throw new Error("libtex: call 'await ready()' first");
  let instance;
  const imports = systemCalls(() => instance.exports.memory);
  const wanted = {};
  for (const { name } of WebAssembly.Module.imports(compiled)) wanted[name] = imports[name];
  instance = new WebAssembly.Instance(compiled, { wasi_snapshot_preview1: wanted });
  instance.exports._initialize();
  return instance.exports;
}

const outOfMemory = () => new TexError({ code: 'out-of-memory', message: 'out of memory' });

function call(verb, request) {
  const tex = (running ??= start());
  const taken = [];
  const take = (bytes) => {
    const at = tex.tex_allocate(bytes);
    if (at === 0 && bytes > 0) throw outOfMemory();
    taken.push(at);
    return at >>> 0;
  };
  function lower(name) {
    const value = this[name]; // node's Buffer turns itself into another object for JSON
    if (typeof value === 'number' && !Number.isFinite(value))
      throw new TexError({ code: 'bad-option', message: `${name}: must be finite` });
    if (!ArrayBuffer.isView(value)) return value;
    const type = value instanceof Uint8ClampedArray ? 'u8' : Object.keys(kTypes).find((key) => value instanceof kTypes[key]);
    const at = take(value.byteLength);
    const bytes = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
    new Uint8Array(tex.memory.buffer, at, bytes.length).set(bytes);
    return { at, count: value.length, type: type ?? 'other' };
  }
  const lift = (_, value) => {
    if (value === null || typeof value !== 'object' || value.at === undefined || value.type === undefined) return value;
    return new kTypes[value.type](tex.memory.buffer, value.at, value.count).slice();
  };
  try {
    const json = new TextEncoder().encode(JSON.stringify({ verb, ...request }, lower) + '\0');
    const at = take(json.length);
    new Uint8Array(tex.memory.buffer, at, json.length).set(json);
    const text = tex.tex_call(at) >>> 0;
    const heap = new Uint8Array(tex.memory.buffer);
    const answer = JSON.parse(new TextDecoder().decode(heap.subarray(text, heap.indexOf(0, text))), lift);
    if (answer.error) throw new TexError(answer.error);
    return answer.value;
  } catch (error) {
    // After a trap nothing is known about the memory: the next call starts anew.
    if (error instanceof WebAssembly.RuntimeError) {
      running = undefined;
      taken.length = 0;
    }
    throw error;
  } finally {
    for (const at of taken) tex.tex_free(at);
    if (running) tex.tex_done();
  }
}

/** Normals from heights: { width, height, data, stride? }, of floats, or of codes with 8 or 16 bits. */
export const bake = (heights, options = {}) => call('bake', { heights, options });
/** Heights from the bytes of a picture, such as a PNG with 16 bits or an EXR. */
export const readHeights = (bytes, options = {}, name = '') => call('readHeights', { bytes, options, name });
/** The levels of a normal map, level 0 first. */
export const mip = (map, options = {}) => call('mip', { map, options });
/** A map, or all levels of one, with its slopes multiplied by options.scale. */
export const scale = (map, options = {}) => call('scale', { map, options });
/** `base` with layers over it: [{ detail, mask?, scale?, tiling? ... }]. */
export const blend = (base, layers, options = {}) => call('blend', { base, layers, options });
/** A texture from a map or its levels. */
export const pack = (map, options = {}) => call('pack', { map, options });
/** The levels of a texture as normals. */
export const unpack = (texture, options = {}) => call('unpack', { texture, options });
/** A texture from the bytes of a file: DDS, KTX, KTX2, ASTC, PNG, EXR, TGA, BMP. */
export const readTexture = (bytes, name = '') => call('readTexture', { bytes, name });
/** The bytes of a file with a texture: options.container is 'dds', 'ktx2', 'png', 'exr' ... */
export const encode = (texture, options = {}) => call('encode', { texture, options });
/** The findings of check-normals about a texture, or about the bytes of a file. */
export const check = (from, options = {}, name = '') =>
  call('check', ArrayBuffer.isView(from) ? { bytes: from, options, name } : { texture: from, options, name });
/** The angles between two maps, in degrees. */
export const compare = (a, b) => call('compare', { a, b });
/** The version of libtex, and the instruction set of its kernels. */
export const version = () => call('version', {});

/** For npm.sh: the options of all verbs as TypeScript. */
export const declarations = () => call('declarations', {});
