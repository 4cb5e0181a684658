#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# godot-runtime-tangents.sh: Godot 4.6.3 (Debian sid) loads a glTF triangle without TANGENT, whose material has a normal
# texture, by GLTFDocument.append_from_file(path, state), as games do with models of their players.
#
# Expected: the mesh gets tangents by MikkTSpace, as the specification asks for, and as the editor's import makes them.
# Seen (2026-11-30): it has none, and no word is said. With the flag 8 as third argument it has.
# For a normal map: its vectors are turned by 90 degrees where they are drawn, so that light from above comes from a
# side; it is the same model that looks right when the editor has imported it.
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
arrays = [[0, 0, 0, 1, 0, 0, 1, 1, 0], [0, 0, 1] * 3, [0, 1, 1, 1, 1, 0]]
data = b"".join(struct.pack(f"<{len(a)}f", *a) for a in arrays)
uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
views, at = [], 0
for array in arrays:
    views.append({"buffer": 0, "byteOffset": at, "byteLength": 4 * len(array)})
    at += 4 * len(array)
accessors = [{"bufferView": k, "componentType": 5126, "count": 3, "type": "VEC3" if k < 2 else "VEC2"}
             for k in range(3)]
accessors[0].update(min=[0, 0, 0], max=[1, 1, 0])
with open("plain.gltf", "w", encoding="utf-8") as file:
    json.dump({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "materials": [{"normalTexture": {"index": 0}}], "textures": [{"source": 0}],
        "meshes": [{"primitives": [{"material": 0, "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}],
        "images": [{"uri": "data:image/png;base64," + base64.b64encode(png).decode()}],
        "buffers": [{"byteLength": len(data), "uri": uri}], "bufferViews": views, "accessors": accessors}, file)
PY
cat >look.gd <<'GD'
extends SceneTree
func _initialize():
    for flags in [0, 8]:
        var document := GLTFDocument.new()
        var state := GLTFState.new()
        document.append_from_file("plain.gltf", state, flags)
        var arrays = state.get_meshes()[0].mesh.get_surface_arrays(0)
        print("seen flags ", flags, ": tangents ", arrays[Mesh.ARRAY_TANGENT])
    quit()
GD
version=$(godot --version | tail -n 1)
echo "godot $version"
seen=$(HOME=$work timeout 60 godot --headless --script look.gd 2>log | sed -n 's/^seen //p')
echo "$seen"
grep -i tangent log || echo "no warning"
[ "${version#4.6.3}" != "$version" ] && ! grep -q -i tangent log &&
    [ "$(head -n 1 <<<"$seen")" = 'flags 0: tangents <null>' ] && grep -q '^flags 8: tangents \[' <<<"$seen"
