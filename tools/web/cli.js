#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// cli.js: `npx libtex COMMAND`. A command that only reads runs in the main thread, which starts sooner; a signal ends it
// at once. A command that writes files runs in a worker. The first signal asks it to stop; a second one, or a second of
// waiting, ends the process and removes the unfinished files. Then the process ends by the signal, as the native
// commands do.

import { readFileSync, unlinkSync } from 'node:fs';
import { constants } from 'node:os';
import { setFlagsFromString } from 'node:v8';

const { commands, version } = JSON.parse(readFileSync(new URL('./package.json', import.meta.url)));
const [name, ...rest] = process.argv.slice(2);
const usage = `usage: libtex COMMAND [OPTION]... [FILE]...
The commands, each with --help: ${commands.join(', ')}.
`;
const kUsage = 2;
const kLastKnown = 24; // the newest version of node that was tried
const kPatience = 1000; // milliseconds
const kReaders = ['check-normals', 'compare-normals'];
// Their options that write files, and lists of arguments, which may hold such options.
const kWrites = /^(@|--(report|sarif|junit|baseline-write|depfile|heatmap|plot)(=|$))/;

if (name === '--help' || name === '--version') {
  process.stdout.write(name === '--help' ? usage : `libtex ${version}\n`);
} else if (!commands.includes(name)) {
  process.stderr.write(name === undefined ? usage : `libtex: error: unknown command '${name}'\n${usage}`);
  process.exitCode = kUsage;
} else {
  // Each function is validated when it is first called, not 10 MB at the start. Later versions may not know the flag,
  // and would say so.
  if (parseInt(process.versions.node) <= kLastKnown) setFlagsFromString('--wasm-lazy-validation');
  if (kReaders.includes(name) && !rest.some((word) => kWrites.test(word))) await runHere();
  await runInWorker();
}

async function runHere() {
  const { run } = await import('./commands.js');
  const ended = run({ args: [name, ...rest], signal: () => 0, created: () => {}, removed: () => {}, again: true });
  if (ended !== undefined) process.exit(ended);
}

async function runInWorker() {
  const { Worker } = await import('node:worker_threads');
  const unfinished = new Set();
  const signal = new Int32Array(new SharedArrayBuffer(4));
  const worker = new Worker(new URL('./worker.js', import.meta.url), { workerData: { args: [name, ...rest], signal } });

  function endBySignal() {
    for (const file of unfinished) {
      try {
        unlinkSync(Buffer.from(file, 'latin1'));
      } catch {
        // It is gone.
      }
    }
    const number = Atomics.load(signal, 0);
    for (const [word, value] of Object.entries(constants.signals)) {
      if (value === number && signals.includes(word)) {
        process.removeAllListeners(word);
        process.kill(process.pid, word);
      }
    }
  }
  const signals = ['SIGINT', 'SIGTERM', 'SIGHUP'];
  for (const word of signals) {
    process.on(word, () => {
      if (Atomics.exchange(signal, 0, constants.signals[word]) !== 0) endBySignal();
      setTimeout(endBySignal, kPatience);
    });
  }
  worker.on('message', ({ created, removed, ended }) => {
    if (created !== undefined) unfinished.add(created);
    if (removed !== undefined) unfinished.delete(removed);
    if (ended === undefined) return;
    const number = Atomics.load(signal, 0);
    if (number !== 0 && ended === 128 + number) endBySignal();
    else process.exit(ended);
  });
  worker.on('error', (error) => {
    process.stderr.write(`${name}: error: ${error.message}\n`);
    process.exit(5);
  });
}
