// SPDX-License-Identifier: Apache-2.0
// commands.js: runs one command in a worker, so that the main thread (cli.js) sees signals meanwhile.

import { readFileSync, writeSync } from 'node:fs';
import { parentPort, workerData } from 'node:worker_threads';

import { Exit, Wasi, foldersNamed } from './wasi.js';

const { args, signal } = workerData;
const kBug = 5, kNoMemory = 3; // exit codes, see exit_code.h

function run() {
  const { PWD, ...others } = process.env;
  const wasi = new Wasi({
    args,
    env: [...Object.entries(others).map((pair) => pair.join('=')), `PWD=${process.cwd().replaceAll('\\', '/').replace(/^(?=\w:)/, '/')}`],
    folders: foldersNamed(args.slice(1)),
    created: (created) => parentPort.postMessage({ created }),
    removed: (removed) => parentPort.postMessage({ removed }),
  });
  let instance;
  try {
    const module = new WebAssembly.Module(readFileSync(new URL('./commands.wasm', import.meta.url)));
    instance = new WebAssembly.Instance(module, {
      wasi_snapshot_preview1: wasi.imports(() => instance.exports.memory),
      libtex: { signal: () => Atomics.load(signal, 0) },
    });
    instance.exports._start();
  } catch (error) {
    if (error instanceof Exit) return error.status;
    const noMemory = instance === undefined && error instanceof RangeError;
    writeSync(2, `${args[0]}: error: ${noMemory ? 'out of memory' : `${error.message}; this is a bug: please report it with the command line and, if you can, the file`}\n`);
    return noMemory ? kNoMemory : kBug;
  }
  return 0;
}

parentPort.postMessage({ ended: run() });
