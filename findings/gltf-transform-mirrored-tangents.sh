#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# gltf-transform-mirrored-tangents.sh: clearNodeTransform() of @gltf-transform/functions 4.5.1 on a node with scale
# (-1, 1, 1), whose mesh has tangents (1, 0, 0) with w = 1.
#
# Expected: tangents (-1, 0, 0) with w = -1. The bitangent w cross(normal, tangent) was (0, 1, 0), which mirroring in x
# does not change; the order of the indices is reversed for the same reason.
# Seen (2026-11-28): (-1, 0, 0) with w = 1, so the bitangent is (0, -1, 0). Green acts upside down on baked geometry.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1
cat >look.mjs <<'JS'
import { Document } from '@gltf-transform/core';
import { clearNodeTransform } from '@gltf-transform/functions';
const document = new Document(), buffer = document.createBuffer();
const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
const triangle = document.createPrimitive()
    .setAttribute('POSITION', accessor('VEC3', new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0])))
    .setAttribute('NORMAL', accessor('VEC3', new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1])))
    .setAttribute('TEXCOORD_0', accessor('VEC2', new Float32Array([0, 1, 1, 1, 1, 0])))
    .setAttribute('TANGENT', accessor('VEC4', new Float32Array([1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1])))
    .setIndices(accessor('SCALAR', new Uint16Array([0, 1, 2])));
const node = document.createNode().setMesh(document.createMesh().addPrimitive(triangle)).setScale([-1, 1, 1]);
document.createScene().addChild(node);
clearNodeTransform(node);
const mesh = node.getMesh().listPrimitives()[0];
const tangent = [...mesh.getAttribute('TANGENT').getArray()].slice(0, 4);
console.log('@gltf-transform/functions 4.5.1: indices', [...mesh.getIndices().getArray()].join(' '), '(were 0 1 2),',
            'tangent', tangent.join(' '), '(was 1 0 0 1)');
process.exit(tangent.join(' ') === '-1 0 0 1' ? 0 : 1);
JS
node look.mjs
