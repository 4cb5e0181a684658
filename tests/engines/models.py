#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""models.py MAP DETAILS FOLDER: writes a model for each kind of glTF that engines may draw differently.

Each is a square from -1 to 1 that faces +z, with MAP in it, so that the picture of the map fills the view. KINDS says
what each has, and what the specification wants to be seen. Beside them, spheres with and without the map DETAILS.
"""

import dataclasses
import json
import math
import pathlib
import struct
import sys

import sphere


@dataclasses.dataclass
class Kind:
    """A model. `corner` is where the bump of the map's upper left corner is seen; `dent`, whether it is one there."""
    name: str
    tangents: str  # "" for none, else what they are made for
    corner: str = "upper left"
    dent: bool = False
    scale: float = 1
    transform: dict = dataclasses.field(default_factory=dict)
    uv_set: int = 0
    node: dict = dataclasses.field(default_factory=dict)
    double_sided: bool = False
    halves: bool = False  # the UVs of the right half are mirrored
    turn: float = 0  # of the tangents, in degrees
    opposite: bool = False  # w of the tangents
    matte: bool = False  # without highlights

    @property
    def file(self):
        words = "".join(c if c.isalnum() else " " for c in self.name + " " + (self.tangents and "t " + self.tangents))
        return "-".join(words.split()) + ".glb"


def kinds():
    """The rows of the second table: (kind of glTF, with or without TANGENT)."""
    def both(name, **more):
        yield Kind(name, "", **more)
        yield Kind(name, "map", **more)

    yield from both("plain")
    yield Kind("no highlights", "", matte=True)  # KHR_materials_specular: for the comparison of pixels
    yield Kind("w opposite", "map", opposite=True)
    yield from both("normalTexture.scale -1", scale=-1, dent=True)
    yield from both("transform (1,-1)", transform={"scale": [1, -1], "offset": [0, 1]}, corner="lower left")
    yield Kind("transform (1,-1)", "UVs without transform", transform={"scale": [1, -1], "offset": [0, 1]},
               corner="lower left")
    turned = {"rotation": math.pi / 2, "offset": [0, 1]}
    yield from both("transform, 90 degrees", transform=turned, corner="upper right")
    yield Kind("transform, 90 degrees", "UVs without transform", transform=turned, corner="upper right")
    yield from both("texCoord 1", uv_set=1)
    yield Kind("texCoord 1", "set 0, turned by 180 degrees", uv_set=1, turn=180)
    yield from both("node scale (-1,1,1)", node={"scale": [-1, 1, 1]}, corner="upper right")
    # engines.sh has convert-normals write this one again.
    yield Kind("node scale (-1,1,1), converted", "map", node={"scale": [-1, 1, 1]}, corner="upper right")
    yield from both("half of the UVs mirrored", halves=True)
    yield from both("double-sided, from behind", node={"rotation": [0, 1, 0, 0]}, corner="upper right", dent=True,
                    double_sided=True)
    yield from both("mirrored and double-sided, from behind", node={"rotation": [0, 1, 0, 0]}, dent=True, halves=True,
                    double_sided=True)
    # engines.sh has pack-normals replace the picture of this one.
    yield Kind("KHR_texture_basisu", "map")
    for turn in (10, 20, 30, 45, 60, 75, 90, 120):
        yield Kind(f"TANGENT turned by {turn} degrees", "map", turn=turn)


# Spheres, by the file of their normal map. engines.sh has pack-normals replace the picture of the last one.
BARE, PICTURE = "none", "PNG"
SPHERES = {BARE: "sphere-bare.glb", PICTURE: "sphere-png.glb", "uastc": "sphere-uastc.glb"}


def transformed(uv, transform):
    """KHR_texture_transform: T * R * S."""
    (u, v), (su, sv), angle = uv, transform.get("scale", (1, 1)), transform.get("rotation", 0)
    (ou, ov), u, v = transform.get("offset", (0, 0)), u * su, v * sv
    return math.cos(angle) * u + math.sin(angle) * v + ou, -math.sin(angle) * u + math.cos(angle) * v + ov


def tangent(points, uvs):
    """Of one triangle that faces +z: where u grows, with w as MikkTSpace has it for glTF, whose v points down."""
    (x0, y0), (x1, y1), (x2, y2) = points
    (u0, v0), (u1, v1), (u2, v2) = [(u, -v) for u, v in uvs]
    area = (u1 - u0) * (v2 - v0) - (u2 - u0) * (v1 - v0)
    t = [((v2 - v0) * (b1 - b0) - (v1 - v0) * (b2 - b0)) / area for b0, b1, b2 in ((x0, x1, x2), (y0, y1, y2))]
    length = math.hypot(*t)
    return t[0] / length, t[1] / length, 1.0 if area > 0 else -1.0


def square(kind):
    """Positions, normals, UVs, tangents, indices."""
    strips = [(-1, 0), (0, 1)] if kind.halves else [(-1, 1)]
    points = [(x, y) for left, right in strips for x, y in ((left, -1), (right, -1), (right, 1), (left, 1))]
    indices = [4 * k + i for k in range(len(strips)) for i in (0, 1, 2, 0, 2, 3)]
    if kind.halves:  # each half has the whole map, so the second meets the first at u = 1
        uvs = [((x + 1 if k < 4 else 1 - x), (1 - y) / 2) for k, (x, y) in enumerate(points)]
    else:
        uvs = [((x + 1) / 2, (1 - y) / 2) for x, y in points]
    mapped = [transformed(uv, kind.transform) for uv in uvs]
    if kind.tangents == "UVs without transform":
        mapped = uvs
    tangents = []
    for k in range(0, len(points), 4):
        tx, ty, w = tangent(points[k:k + 3], mapped[k:k + 3])
        angle = math.radians(kind.turn)
        tx, ty = math.cos(angle) * tx - math.sin(angle) * ty, math.sin(angle) * tx + math.cos(angle) * ty
        tangents += 4 * [(tx, ty, 0.0, -w if kind.opposite else w)]
    return [(x, y, 0) for x, y in points], len(points) * [(0, 0, 1)], uvs, tangents, indices


def whole_sphere():
    sides, rings = 96, 48
    normals, tangents, uvs = zip(*sphere.vertices(sides, rings))
    return normals, normals, uvs, tangents, list(sphere.triangles(sides, rings))


def model_of(kind, image, geometry=None):
    """Of the square, if it is not of another geometry. Without an image there is no normal map."""
    points, normals, uvs, tangents, indices = geometry or square(kind)
    blob, views, accessors = b"", [], []

    def add(code, component, shape, rows, **bounds):
        nonlocal blob
        values = [value for row in rows for value in row]
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": struct.calcsize(f"<{len(values)}{code}")})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": shape,
                          "count": len(rows), **bounds})
        blob += struct.pack(f"<{len(values)}{code}", *values)
        return len(accessors) - 1

    low, high = ([bound(axis) for axis in zip(*points)] for bound in (min, max))
    attributes = {"POSITION": add("f", 5126, "VEC3", points, min=low, max=high),
                  "NORMAL": add("f", 5126, "VEC3", normals)}
    if kind.uv_set == 1:
        attributes["TEXCOORD_0"] = add("f", 5126, "VEC2", [(1 - u, 1 - v) for u, v in uvs])
    attributes[f"TEXCOORD_{kind.uv_set}"] = add("f", 5126, "VEC2", uvs)
    if kind.tangents:
        attributes["TANGENT"] = add("f", 5126, "VEC4", tangents)
    order = add("I", 5125, "SCALAR", [(i,) for i in indices])
    if image:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(image)})
        blob += image + b"\0" * (-len(image) % 4)
    texture = {"index": 0, "texCoord": kind.uv_set, "scale": kind.scale}
    if kind.transform:
        texture["extensions"] = {"KHR_texture_transform": kind.transform}
    material = {"doubleSided": kind.double_sided,
                "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1,
                                         "baseColorFactor": [0.6, 0.6, 0.6, 1]}}
    if kind.matte:
        material["extensions"] = {"KHR_materials_specular": {"specularFactor": 0}}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, **kind.node}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": order, "material": 0}]}],
        "materials": [material],
        "buffers": [{"byteLength": len(blob)}], "bufferViews": views, "accessors": accessors}
    if image:
        material["normalTexture"] = texture
        document.update(
            textures=[{"source": 0, "sampler": 0}],
            samplers=[{"magFilter": 9729, "minFilter": 9729, "wrapS": 10497, "wrapT": 10497}],
            images=[{"bufferView": len(views) - 1, "mimeType": "image/png"}])
    used = kind.transform and ["KHR_texture_transform"] or kind.matte and ["KHR_materials_specular"]
    if used:
        document["extensionsUsed"] = used
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def main():
    image, details, folder = *(pathlib.Path(path).read_bytes() for path in sys.argv[1:3]), pathlib.Path(sys.argv[3])
    folder.mkdir(exist_ok=True)
    for kind in kinds():
        (folder / kind.file).write_bytes(model_of(kind, image))
    for name, file in SPHERES.items():
        (folder / file).write_bytes(model_of(Kind(name, "map"), None if name == BARE else details, whole_sphere()))


if __name__ == "__main__":
    main()
