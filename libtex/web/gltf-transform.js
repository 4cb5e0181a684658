// SPDX-License-Identifier: Apache-2.0
// gltf-transform.js: functions for documents of glTF-Transform. They touch textures of normals alone.

import { TexError, check, encode, mip, pack, readTexture, unpack } from 'libtex';

const kSlots = ['normalTexture', 'clearcoatNormalTexture'];
const kOthers = ['image/jpeg', 'image/webp', 'image/avif']; // what libtex does not decode
const kTypes = { uastc: 'image/ktx2', png: 'image/png' };

/** The names of the slots in which materials use the texture. */
function slotsOf(document, texture) {
  const edges = document.getGraph().listParentEdges(texture);
  return edges.filter((edge) => edge.getParent() !== document.getRoot()).map((edge) => edge.getName());
}

/** The textures that are used as normals and as nothing else. */
function normalTextures(document) {
  return document.getRoot().listTextures().filter((texture) => {
    const slots = slotsOf(document, texture);
    const normal = slots.filter((slot) => kSlots.includes(slot)).length;
    if (normal > 0 && normal < slots.length)
      document.getLogger().warn(`${nameOf(texture)}: is used as ${slots.join(', ')}, and left as it is`);
    return normal > 0 && normal === slots.length && texture.getImage() !== null;
  });
}

const nameOf = (texture) => texture.getURI() || texture.getName() || 'a texture without a name';

async function read(texture, decoder) {
  const image = texture.getImage(), type = texture.getMimeType();
  if (!kOthers.includes(type)) return readTexture(image, nameOf(texture));
  if (decoder === undefined) {
    const message = `${nameOf(texture)}: ${type} needs a decoder: normals({ decoder: sharp })`;
    throw new TexError({ code: 'unsupported', message });
  }
  const { data, info } = await decoder(image).ensureAlpha().raw().toBuffer({ resolveWithObject: true });
  const level = { width: info.width, height: info.height, bytes: new Uint8Array(data.buffer, data.byteOffset, data.length) };
  return { format: 'rgba8-unorm', swizzle: 'rgb', levels: [level] };
}

/**
 * Checks textures of normals. Findings go to the document's logger, and to `onFinding(texture, finding)`. With `fail`,
 * an error ends the transformation. Other options are those of check().
 */
export function checkNormals({ decoder, onFinding, fail = false, ...options } = {}) {
  return async function checkNormals(document) {
    const errors = [];
    for (const texture of normalTextures(document)) {
      for (const finding of check(await read(texture, decoder), options, nameOf(texture))) {
        const line = `${nameOf(texture)}: ${finding.severity} ${finding.id} ${finding.name}: ${finding.message}`;
        document.getLogger()[{ error: 'error', warning: 'warn', note: 'info' }[finding.severity]](line);
        onFinding?.(texture, finding);
        if (finding.severity === 'error') errors.push(line);
      }
    }
    if (fail && errors.length > 0) throw new TexError({ code: 'bad-data', message: errors.join('\n') });
  };
}

/**
 * Makes textures of normals smaller. `format`: 'uastc' (KTX2 with all levels and KHR_texture_basisu) or 'png'.
 * `resize`: halves a map until no side has more texels; its normals are unit again. `rdo`: the mean angle in degrees
 * that UASTC may add to compress better. `effort`: of UASTC. `zstd`: 1 to 22. `decoder`: sharp, for JPEG, WebP and AVIF.
 * `basisu`: KHRTextureBasisu of @gltf-transform/extensions, which 'uastc' needs.
 */
export function normals({ format = 'uastc', resize = Infinity, rdo, effort = 'normal', zstd = 18, decoder, basisu } = {}) {
  if (kTypes[format] === undefined)
    throw new TexError({ code: 'bad-option', message: `format: must be one of '${Object.keys(kTypes).join("', '")}'` });
  if (format === 'uastc' && basisu === undefined)
    throw new TexError({ code: 'bad-option', message: 'basisu: uastc needs KHRTextureBasisu of @gltf-transform/extensions' });
  return async function normals(document) {
    const touched = normalTextures(document);
    for (const texture of touched) {
      const all = mip(unpack(await read(texture, decoder))[0]);
      const first = all.findIndex(({ width, height }) => Math.max(width, height) <= resize);
      const levels = all.slice(first === -1 ? all.length - 1 : first);
      const image = format === 'png'
        ? encode(pack(levels[0], { encoding: 'rgb8' }), { container: 'png' })
        : encode(pack(levels, { encoding: 'uastc', effort, ...(rdo > 0 && { rdo_mean: rdo }) }), { container: 'ktx2', zstd });
      texture.setImage(image).setMimeType(kTypes[format]);
      const uri = texture.getURI();
      if (uri) texture.setURI(uri.replace(/[^./]+$/, format === 'png' ? 'png' : 'ktx2'));
    }
    if (format === 'uastc' && touched.length > 0) document.createExtension(basisu).setRequired(true);
  };
}
