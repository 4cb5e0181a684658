// SPDX-License-Identifier: Apache-2.0
// Makes a texture in the page and in a worker, and posts both. See npm.sh.

import { make } from './make.js';

const post = (name, body) => fetch(`/${name}`, { method: 'POST', body });
try {
  const picture = new Uint8Array(await (await fetch('/bricks.png')).arrayBuffer());
  await post('page.dds', await make(picture));
  const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
  const made = await new Promise((done, failed) => {
    worker.addEventListener('message', ({ data }) => done(data));
    worker.addEventListener('error', ({ message }) => failed(new Error(`worker: ${message}`)));
    worker.postMessage(picture);
  });
  if (typeof made === 'string') throw new Error(made);
  await post('worker.dds', made);
  await post('done', '');
} catch (error) {
  await post('failed', `${error}\n`);
}
