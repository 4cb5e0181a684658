// SPDX-License-Identifier: Apache-2.0
// commands.js: runs one command in this thread.

import { readFileSync, writeSync } from 'node:fs';

import { Exit, Wasi, foldersNamed } from './wasi.js';

const kBug = 5, kNoMemory = 3; // exit codes, see exit_code.h

/**
 * Returns the exit code. `signal()` is the number of the signal that has asked the command to stop, or 0; `created` and
 * `removed` are called as Wasi says. With `again`, returns undefined if the stack of this thread was too small and
 * nothing has gone through a standard stream, so that a worker, whose stack is larger, can run the command.
 */
export function run({ args, signal, created, removed, again = false }) {
  const { PWD, ...others } = process.env;
  const wasi = new Wasi({
    args,
    env: [...Object.entries(others).map((pair) => pair.join('=')), `PWD=${process.cwd().replaceAll('\\', '/').replace(/^(?=\w:)/, '/')}`],
    folders: foldersNamed(args.slice(1)),
    created,
    removed,
  });
  let instance;
  try {
    const module = new WebAssembly.Module(readFileSync(new URL('./commands.wasm', import.meta.url)));
    instance = new WebAssembly.Instance(module, {
      wasi_snapshot_preview1: wasi.imports(() => instance.exports.memory),
      libtex: { signal },
    });
    instance.exports._start();
  } catch (error) {
    if (error instanceof Exit) return error.status;
    if (again && !wasi.used && instance !== undefined && error instanceof RangeError) return undefined;
    const noMemory = instance === undefined && error instanceof RangeError;
    writeSync(2, `${args[0]}: error: ${noMemory ? 'out of memory' : `${error.message}; this is a bug: please report it with the command line and, if you can, the file`}\n`);
    return noMemory ? kNoMemory : kBug;
  }
  return 0;
}
