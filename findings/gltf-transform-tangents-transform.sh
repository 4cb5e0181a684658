#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# gltf-transform-tangents-transform.sh: tangents() of @gltf-transform/functions 4.5.1 on a quad whose normal texture is
# turned by 90 degrees (KHR_texture_transform).
#
# Expected: tangents that run along the u of the turned texture, because the normal map is read with these UVs.
# Seen (2026-11-28): the same tangents as without the extension. Bumps are lit from a side, by 90 degrees off.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund mikktspace@1.1.1 \
    @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1 @gltf-transform/extensions@4.5.1
cat >look.mjs <<'JS'
import { Document } from '@gltf-transform/core';
import { KHRTextureTransform } from '@gltf-transform/extensions';
import { tangents, unweld } from '@gltf-transform/functions';
import * as mikktspace from 'mikktspace';
async function tangentOf(rotation) {
    const document = new Document(), buffer = document.createBuffer();
    const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
    const quad = document.createPrimitive()
        .setAttribute('POSITION', accessor('VEC3', new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0])))
        .setAttribute('NORMAL', accessor('VEC3', new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1])))
        .setAttribute('TEXCOORD_0', accessor('VEC2', new Float32Array([0, 1, 1, 1, 1, 0, 0, 0])))
        .setIndices(accessor('SCALAR', new Uint16Array([0, 1, 2, 0, 2, 3])));
    const picture = document.createTexture().setImage(new Uint8Array([137, 80, 78, 71])).setMimeType('image/png');
    const material = document.createMaterial().setNormalTexture(picture);
    const transform = document.createExtension(KHRTextureTransform).createTransform().setRotation(rotation);
    material.getNormalTextureInfo().setExtension('KHR_texture_transform', transform);
    document.createMesh().addPrimitive(quad.setMaterial(material));
    const { generateTangents } = mikktspace.default ?? mikktspace;
    await document.transform(unweld(), tangents({ generateTangents }));
    return [...document.getRoot().listMeshes()[0].listPrimitives()[0].getAttribute('TANGENT').getArray()].slice(0, 4);
}
const plain = await tangentOf(0), turned = await tangentOf(Math.PI / 2);
console.log('@gltf-transform/functions 4.5.1: tangent', plain.join(' '), 'and, turned by 90 degrees,',
            turned.join(' '));
process.exit(plain.join() === turned.join() && Math.abs(plain[0]) === 1 ? 0 : 1);
JS
node look.mjs
