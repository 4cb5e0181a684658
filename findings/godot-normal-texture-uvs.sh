#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# godot-normal-texture-uvs.sh: Godot 4.6.3 (Debian sid) reads a glTF triangle whose normal texture has texCoord 1 and
# KHR_texture_transform with a scale of 2, and one whose base colour has them.
#
# Expected: material and mesh say so in both: the second set of UVs, and uv1_scale or uv2_scale of 2; or a warning.
# Seen (2026-11-30): of the base colour the scale is taken, as uv1_scale. Of the normal texture neither is: uv1_scale
# and uv2_scale stay 1, the map is read with set 0, and no word is said.
# For a normal map: it lies elsewhere than its author put it, and where set 0 is turned, bumps are lit as dents. Only
# the base colour's transform counts, for all maps of a material.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v godot >/dev/null || { echo 'needs godot 4.6.3 of Debian sid' >&2; exit 2; }
python3 - <<'PY'
import base64
import json
import struct
import zlib


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)) +
       chunk(b"IDAT", zlib.compress(b"\0\x80\x80\xff")) + chunk(b"IEND", b""))
arrays = [[0, 0, 0, 1, 0, 0, 1, 1, 0], [0, 0, 1] * 3, [0, 1, 1, 1, 1, 0], [1, 0, 0, 0, 0, 1]]
data = b"".join(struct.pack(f"<{len(a)}f", *a) for a in arrays)
uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
views, at = [], 0
for array in arrays:
    views.append({"buffer": 0, "byteOffset": at, "byteLength": 4 * len(array)})
    at += 4 * len(array)
accessors = [{"bufferView": k, "componentType": 5126, "count": 3, "type": "VEC3" if k < 2 else "VEC2"}
             for k in range(4)]
accessors[0].update(min=[0, 0, 0], max=[1, 1, 0])
texture = {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}
for name, material in (("normal", {"normalTexture": texture}),
                       ("colour", {"pbrMetallicRoughness": {"baseColorTexture": texture}})):
    with open(f"{name}.gltf", "w", encoding="utf-8") as file:
        json.dump({
            "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_texture_transform"], "scene": 0,
            "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "materials": [material],
            "meshes": [{"primitives": [{"material": 0, "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2,
                                                                      "TEXCOORD_1": 3}}]}],
            "textures": [{"source": 0}],
            "images": [{"uri": "data:image/png;base64," + base64.b64encode(png).decode()}],
            "buffers": [{"byteLength": len(data), "uri": uri}], "bufferViews": views, "accessors": accessors}, file)
PY
cat >look.gd <<'GD'
extends SceneTree
func _initialize():
    for name in ["normal", "colour"]:
        var document := GLTFDocument.new()
        var state := GLTFState.new()
        document.append_from_file(name + ".gltf", state)
        var material = state.get_materials()[0]
        print("seen ", name, ": uv1_scale ", material.uv1_scale, ", uv2_scale ", material.uv2_scale)
    quit()
GD
version=$(godot --version | tail -n 1)
echo "godot $version"
seen=$(HOME=$work timeout 60 godot --headless --script look.gd 2>log | sed -n 's/^seen //p')
echo "$seen"
grep -i -E 'texcoord|transform' log || echo "no warning"
[ "${version#4.6.3}" != "$version" ] && ! grep -q -i -E 'texcoord|transform' log &&
    [ "$seen" = 'normal: uv1_scale (1.0, 1.0, 1.0), uv2_scale (1.0, 1.0, 1.0)
colour: uv1_scale (2.0, 2.0, 1.0), uv2_scale (1.0, 1.0, 1.0)' ]
