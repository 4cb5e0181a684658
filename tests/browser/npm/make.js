// SPDX-License-Identifier: Apache-2.0
// What a page and its worker do with the npm package: a texture from a picture.

import { bake, encode, mip, pack, readHeights, ready } from 'libtex';

export async function make(picture) {
  await ready();
  const levels = mip(bake(readHeights(picture), { bumpiness: 6 }));
  return encode(pack(levels, { encoding: 'bc5' }), { container: 'dds' });
}
