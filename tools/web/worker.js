// SPDX-License-Identifier: Apache-2.0
// worker.js: runs one command in a worker, so that the main thread (cli.js) sees signals meanwhile.

import { parentPort, workerData } from 'node:worker_threads';

import { run } from './commands.js';

const { args, signal } = workerData;
const ended = run({
  args,
  signal: () => Atomics.load(signal, 0),
  created: (created) => parentPort.postMessage({ created }),
  removed: (removed) => parentPort.postMessage({ removed }),
});
parentPort.postMessage({ ended });
