// SPDX-License-Identifier: Apache-2.0
import { make } from './make.js';

addEventListener('message', async ({ data }) => postMessage(await make(data).catch((error) => String(error))));
