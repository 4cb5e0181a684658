// SPDX-License-Identifier: Apache-2.0
// Decodes texel blocks (BC1, BC2, BC3 and BC5) to RGBA with 8 bits, for GPUs that do not support them and for extents
// that WebGL does not accept.

// The values of a BC4 block at `at`, as 16 numbers from 0 to 255. The range of a signed block, -127 to 127, is shifted
// to these numbers.
function bc4Values(bytes, at, signed) {
  const end = (k) => (signed ? (Math.max((bytes[at + k] << 24) >> 24, -127) + 127) * (255 / 254) : bytes[at + k]);
  const a = end(0), b = end(1);
  const many = signed ? (bytes[at] << 24) >> 24 > (bytes[at + 1] << 24) >> 24 : bytes[at] > bytes[at + 1];
  const palette = [a, b];
  for (let k = 1; k < 7; ++k) palette.push(many ? ((7 - k) * a + k * b) / 7 : k < 5 ? ((5 - k) * a + k * b) / 5 : k === 5 ? 0 : 255);
  const values = [];
  for (let k = 0; k < 16; ++k) {
    const bit = 3 * k, byte = at + 2 + (bit >> 3);
    values.push(palette[((bytes[byte] | (bytes[byte + 1] || 0) << 8) >> (bit & 7)) & 7]);
  }
  return values;
}

// The colours of a BC1 block at `at`, as 16 triples. BC2 and BC3 always have four colours.
function bc1Colors(bytes, at, always4) {
  const c0 = bytes[at] | bytes[at + 1] << 8, c1 = bytes[at + 2] | bytes[at + 3] << 8;
  const wide = (c) => {
    const r = c >> 11, g = (c >> 5) & 63, b = c & 31;
    return [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2];
  };
  const p = wide(c0), q = wide(c1);
  const mix = (m, n) => p.map((v, k) => (m * v + n * q[k]) / (m + n));
  const palette = always4 || c0 > c1 ? [p, q, mix(2, 1), mix(1, 2)] : [p, q, mix(1, 1), [0, 0, 0]];
  const colors = [];
  for (let k = 0; k < 16; ++k) colors.push(palette[(bytes[at + 4 + (k >> 2)] >> 2 * (k & 3)) & 3]);
  return colors;
}

// Decodes one level in `format` ("bc3-unorm") to RGBA.
function decodeBlocks(format, width, height, bytes) {
  const rgba = new Uint8ClampedArray(4 * width * height).fill(255);
  const size = format === "bc1-unorm" ? 8 : 16;
  const across = Math.ceil(width / 4);
  for (let at = 0, n = 0; at + size <= bytes.length; at += size, ++n) {
    const left = 4 * (n % across), top = 4 * Math.floor(n / across);
    const signed = format === "bc5-snorm";
    const two = signed || format === "bc5-unorm";
    const first = two || format === "bc3-unorm" ? bc4Values(bytes, at, signed) : null;
    const second = two ? bc4Values(bytes, at + 8, signed) : null;
    const colors = two ? null : bc1Colors(bytes, at + size - 8, size === 16);
    for (let k = 0; k < 16; ++k) {
      const x = left + (k & 3), y = top + (k >> 2);
      if (x >= width || y >= height) continue;
      const texel = two ? [first[k], second[k], 0, 255] : [...colors[k], first ? first[k] : 255];
      if (format === "bc2-unorm") texel[3] = 17 * ((bytes[at + (k >> 1)] >> 4 * (k & 1)) & 15);
      rgba.set(texel, 4 * (y * width + x));
    }
  }
  return new Uint8Array(rgba.buffer);
}
