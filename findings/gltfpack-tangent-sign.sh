#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# gltfpack-tangent-sign.sh: gltfpack 1.3.0 with -gt, "generate tangent frames", on a quad without tangents.
#
# Expected: w = 1, as @gltf-transform/functions 4.5.1 writes. The quad faces +z, u runs to the right and v down, so the
# green of a glTF map points up, which is w cross(normal, tangent) = w cross((0, 0, 1), (1, 0, 0)) for w = 1.
# Seen (2026-11-28): w = -1 at all four corners. A map with green up is lit from the wrong side, top for bottom.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund gltfpack@1.3.0 @gltf-transform/core@4.5.1
cat >make.mjs <<'JS'
import { Document, NodeIO } from '@gltf-transform/core';
const document = new Document(), buffer = document.createBuffer();
const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
const quad = document.createPrimitive()
    .setAttribute('POSITION', accessor('VEC3', new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0])))
    .setAttribute('NORMAL', accessor('VEC3', new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1])))
    .setAttribute('TEXCOORD_0', accessor('VEC2', new Float32Array([0, 1, 1, 1, 1, 0, 0, 0])))
    .setIndices(accessor('SCALAR', new Uint16Array([0, 1, 2, 0, 2, 3])));
const picture = document.createTexture().setImage(new Uint8Array([137, 80, 78, 71])).setMimeType('image/png');
quad.setMaterial(document.createMaterial().setNormalTexture(picture));
document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(quad)));
await new NodeIO().write('quad.glb', document);
JS
cat >look.mjs <<'JS'
import { NodeIO } from '@gltf-transform/core';
const document = await new NodeIO().read('packed.glb');
const tangents = document.getRoot().listMeshes()[0].listPrimitives()[0].getAttribute('TANGENT').getArray();
const signs = [...new Set([...tangents].filter((_, k) => k % 4 === 3))];
console.log('gltfpack 1.3.0: w =', signs.join(' '), '(green points up with w = 1)');
process.exit(signs.length === 1 && signs[0] === -1 ? 0 : 1);
JS
node make.mjs
npx gltfpack -i quad.glb -o packed.glb -noq -gt >packed.txt
node look.mjs
