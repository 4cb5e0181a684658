#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""sphere.py FOLDER: writes a sphere with normals, tangents and UVs that go twice around it.

FOLDER/sphere.glb is for programs that read glTF, with normal.png beside it as its normal map; FOLDER/sphere.json holds
the same arrays for scripts.
"""

import json
import math
import pathlib
import struct
import sys

SIDES, RINGS = 256, 128


def vertices(sides=SIDES, rings=RINGS):
    for ring in range(rings + 1):
        theta = math.pi * ring / rings  # from the north pole
        for side in range(sides + 1):
            phi = 2 * math.pi * side / sides
            normal = (math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi))
            yield normal, (math.cos(phi), 0.0, -math.sin(phi), 1.0), (2 * side / sides, ring / rings)


def triangles(sides=SIDES, rings=RINGS):
    for ring in range(rings):
        for side in range(sides):
            a = ring * (sides + 1) + side
            b = a + sides + 1
            if ring > 0:
                yield from (a, b, a + 1)
            if ring < rings - 1:
                yield from (a + 1, b, b + 1)


def main():
    folder = pathlib.Path(sys.argv[1])
    normals, tangents, uvs = zip(*vertices())
    indices = list(triangles())
    arrays = {"normals": [c for n in normals for c in n], "tangents": [c for t in tangents for c in t],
              "uvs": [c for uv in uvs for c in uv], "indices": indices}
    (folder / "sphere.json").write_text(json.dumps(arrays))

    blob, views, accessors = b"", [], []

    def add(code, component, kind, width, values, **bounds):
        nonlocal blob
        data = struct.pack(f"<{len(values)}{code}", *values)
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind,
                          "count": len(values) // width, **bounds})
        blob += data
        return len(accessors) - 1

    position = add("f", 5126, "VEC3", 3, arrays["normals"], min=[-1, -1, -1], max=[1, 1, 1])
    attributes = {"POSITION": position, "NORMAL": position, "TANGENT": add("f", 5126, "VEC4", 4, arrays["tangents"]),
                  "TEXCOORD_0": add("f", 5126, "VEC2", 2, arrays["uvs"])}
    primitive = {"attributes": attributes, "indices": add("I", 5125, "SCALAR", 1, indices), "material": 0}
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}], "materials": [{"normalTexture": {"index": 0}}],
        "textures": [{"source": 0}], "images": [{"uri": "normal.png"}],
        "buffers": [{"byteLength": len(blob)}], "bufferViews": views, "accessors": accessors}).encode()
    text += b" " * (-len(text) % 4)
    blob += b"\0" * (-len(blob) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
    (folder / "sphere.glb").write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


if __name__ == "__main__":
    main()
