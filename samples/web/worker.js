// SPDX-License-Identifier: Apache-2.0
// worker.js: runs one command after another, so that the page never stops. To be cancelled, a worker is ended.

import { Exit, Memory } from './memory.js';

const module = WebAssembly.compileStreaming(fetch(new URL('./commands.wasm', import.meta.url)));

async function run({ args, files }) {
  const printed = { 1: [], 2: [] };
  const memory = new Memory(args, files, (stream, bytes) => {
    const text = new TextDecoder().decode(bytes);
    const progress = /\r\x1b\[K\[[#.]*\] *(\d+) %/.exec(text);
    if (progress) postMessage({ progress: Number(progress[1]) / 100 });
    else printed[stream].push(text.replaceAll('\r\x1b[K', ''));
  });
  let code = 0;
  try {
    const instance = await WebAssembly.instantiate(await module, {
      wasi_snapshot_preview1: memory.imports(() => instance.exports.memory),
      libtex: { signal: () => 0 },
    });
    instance.exports._start();
  } catch (error) {
    code = error instanceof Exit ? error.status : -1;
    if (!(error instanceof Exit)) printed[2].push(`${error}\n`);
  }
  return { code, out: printed[1].join(''), err: printed[2].join(''), written: memory.written() };
}

addEventListener('message', async ({ data }) => {
  const ended = await run(data);
  postMessage({ ended }, ended.written.map(([, bytes]) => bytes.buffer));
});
