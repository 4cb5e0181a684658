// SPDX-License-Identifier: Apache-2.0
// npm_gltf.mjs: tests libtex/gltf-transform on a document of glTF-Transform; Khronos' validator and check-normals judge
// the model. Run by tests/npm.sh in the folder in which npm has installed all of them.
//
//     node npm_gltf.mjs COMMANDS SAMPLES

import { Document, Logger, NodeIO } from '@gltf-transform/core';
import { KHRTextureBasisu } from '@gltf-transform/extensions';
import { textureCompress } from '@gltf-transform/functions';
import validator from 'gltf-validator';
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import sharp from 'sharp';

import { bake, compare, encode, mip, pack, readHeights, readTexture, scale, unpack } from 'libtex';
import { checkNormals, normals } from 'libtex/gltf-transform';

const [commands, samples] = process.argv.slice(2);
let passed = 0;
let failed = 0;
async function test(what, body) {
  try {
    await body();
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`npm: FAILED: glTF-Transform: ${what}: ${error.stack}`);
  }
}
const expect = (fact, what) => {
  if (!fact) throw new Error(what);
};

const bricks = bake(readHeights(readFileSync(join(samples, 'bricks.png'))), { bumpiness: 6 });
const png = (map) => encode(pack(map, { encoding: 'rgb8' }), { container: 'png' });
const kColour = readFileSync(join(samples, 'bricks.png'));

/** A triangle with a picture of colours and a map of normals. */
function model(image, type = 'image/png') {
  const document = new Document().setLogger(new Logger(Logger.Verbosity.SILENT));
  const buffer = document.createBuffer();
  const accessor = (kind, values) => document.createAccessor().setType(kind).setArray(new Float32Array(values)).setBuffer(buffer);
  const map = document.createTexture('map').setImage(image).setMimeType(type).setURI(`map.${type === 'image/png' ? 'png' : 'jpg'}`);
  const colour = document.createTexture('colour').setImage(kColour).setMimeType('image/png').setURI('colour.png');
  const material = document.createMaterial().setNormalTexture(map).setBaseColorTexture(colour);
  const triangle = document.createPrimitive().setMaterial(material)
    .setAttribute('POSITION', accessor('VEC3', [0, 0, 0, 1, 0, 0, 0, 1, 0]))
    .setAttribute('NORMAL', accessor('VEC3', [0, 0, 1, 0, 0, 1, 0, 0, 1]))
    .setAttribute('TEXCOORD_0', accessor('VEC2', [0, 1, 1, 1, 0, 0]));
  document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(triangle)));
  return { document, map, colour };
}
/** Writes the model; neither Khronos' validator nor check-normals finds an error. */
async function sound(document, name) {
  const bytes = await new NodeIO().registerExtensions([KHRTextureBasisu]).writeBinary(document);
  writeFileSync(name, bytes);
  const { issues } = await validator.validateBytes(bytes);
  expect(issues.numErrors === 0, JSON.stringify(issues.messages));
  const { status, stderr, stdout } = spawnSync(join(commands, 'check-normals'), [name, '--require', 'y=up'], { encoding: 'utf8' });
  expect(status === 0, `check-normals: ${status} ${stdout} ${stderr}`);
  return bytes.length;
}

await test('uastc of half the size, colours by another function', async () => {
  const { document, map, colour } = model(png(bricks));
  await document.transform(
    textureCompress({ encoder: sharp, targetFormat: 'jpeg', slots: /^baseColor/ }),
    normals({ basisu: KHRTextureBasisu, resize: 64, effort: 'fast', zstd: 3 }));
  expect(map.getMimeType() === 'image/ktx2' && map.getURI() === 'map.ktx2', map.getURI());
  expect(colour.getMimeType() === 'image/jpeg', colour.getMimeType());
  await sound(document, 'uastc.glb');
  const texture = readTexture(map.getImage());
  expect(!texture.srgb, 'the transfer function is linear');
  const made = unpack(texture)[0], wanted = mip(unpack(readTexture(png(bricks)))[0]).find(({ width }) => width === 64);
  const { mean } = compare(made, wanted);
  expect(mean < 2, `${mean} degrees`);
});
await test('rdo makes the file smaller', async () => {
  const sizes = [];
  for (const rdo of [0, 0.5]) {
    const { document } = model(png(bricks));
    await document.transform(normals({ basisu: KHRTextureBasisu, effort: 'fast', rdo }));
    sizes.push(await sound(document, `rdo-${rdo}.glb`));
  }
  expect(sizes[1] < sizes[0], sizes.join());
});
await test('png, from JPEG by a decoder', async () => {
  const { document, map } = model(await sharp(png(bricks)).jpeg({ quality: 95, chromaSubsampling: '4:4:4' }).toBuffer(), 'image/jpeg');
  let refused = '';
  await document.transform(normals({ format: 'png' })).catch(({ message }) => (refused = message));
  expect(refused.includes('needs a decoder'), refused);
  await document.transform(normals({ format: 'png', resize: 128, decoder: sharp }));
  expect(map.getMimeType() === 'image/png', map.getMimeType());
  const made = unpack(readTexture(map.getImage()))[0];
  for (let k = 0; k < made.data.length; k += 3)
    expect(Math.abs(Math.hypot(...made.data.subarray(k, k + 3)) - 1) < 0.01, 'unit vectors');
  await sound(document, 'png.glb');
});
await test('checkNormals', async () => {
  const findings = [];
  const good = model(png(bricks)).document, grey = model(readFileSync(join(samples, 'ramp.png'))).document;
  await good.transform(checkNormals({ onFinding: (_, { id, severity }) => severity === 'error' && findings.push(id), fail: true }));
  expect(findings.length === 0, findings.join());
  let ended = '';
  await grey.transform(checkNormals({ onFinding: (_, { id }) => findings.push(id), fail: true })).catch(({ message }) => (ended = message));
  expect(findings.includes('N210') && ended.includes('N210'), `${findings} ${ended}`);
});
await test('a texture with two uses stays', async () => {
  const { document, map } = model(png(scale(bricks, { scale: 2 })));
  document.getRoot().listMaterials()[0].setOcclusionTexture(map);
  const before = map.getImage();
  await document.transform(normals({ format: 'png', resize: 32 }));
  expect(map.getImage() === before, 'it was touched');
});
await test('wrong options', async () => {
  for (const options of [{}, { format: 'webp' }]) {
    let code = '';
    try {
      normals(options);
    } catch (error) {
      code = error.code;
    }
    expect(code === 'bad-option', code);
  }
});

console.log(`npm: ${passed} passed, ${failed} failed, 0 skipped`);
