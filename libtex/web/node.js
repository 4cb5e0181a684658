// SPDX-License-Identifier: Apache-2.0
// node.js: what node imports: index.js, ready. Bundlers for browsers never see it.

import { readFile } from 'node:fs/promises';

import { ready } from './index.js';

await ready(readFile(new URL('./tex.wasm', import.meta.url)));

export * from './index.js';
