#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""odd_models.py FOLDER: writes models that are odd or hostile, for gltf_validator_test.cpp.

Each is a grid of 4x4 squares with a normal map, in which one thing is changed. The name says what.
"""

import base64
import copy
import json
import math
import os
import struct
import sys
import zlib

OUT = sys.argv[1]
CODES = {5120: "b", 5121: "B", 5123: "H", 5125: "I", 5126: "f"}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def picture(size=16):
    """A normal map with waves, as PNG."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = b""
    for j in range(size):
        rows += b"\0"
        for i in range(size):
            x, y = 0.4 * math.sin(6.3 * i / size), 0.3 * math.cos(6.3 * j / size)
            rows += bytes(round(127.5 + 127.5 * c) for c in (x, y, math.sqrt(1 - x * x - y * y)))
    head = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


PNG = picture()
SIDE = 4
POINTS = [(i / SIDE, j / SIDE) for j in range(SIDE + 1) for i in range(SIDE + 1)]
POSITIONS = [c for u, v in POINTS for c in (u, 1 - v, 0.1 * math.sin(4 * u))]
NORMALS = [0, 0, 1] * len(POINTS)
UVS = [c for point in POINTS for c in point]
TANGENTS = [1, 0, 0, 1] * len(POINTS)
INDICES = [k for j in range(SIDE) for i in range(SIDE) for a in [j * (SIDE + 1) + i]
           for k in (a, a + SIDE + 1, a + 1, a + 1, a + SIDE + 1, a + SIDE + 2)]


class Model:
    """A model in memory: `document`, and short names for its parts that are changed most."""

    def __init__(self, index_type=5123):
        self.binary, self.views, self.accessors = b"", [], []
        self.attributes = {"POSITION": self.add(POSITIONS, "VEC3", bounds=True), "NORMAL": self.add(NORMALS, "VEC3"),
                           "TEXCOORD_0": self.add(UVS, "VEC2"), "TANGENT": self.add(TANGENTS, "VEC4")}
        self.primitive = {"attributes": self.attributes, "indices": self.add(INDICES, "SCALAR", index_type),
                          "material": 0}
        self.node, self.image, self.texture = {"mesh": 0}, {"uri": "n.png"}, {"index": 0}
        self.material = {"name": "m", "normalTexture": self.texture}
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [self.node],
                         "meshes": [{"primitives": [self.primitive]}], "materials": [self.material],
                         "textures": [{"source": 0}], "images": [self.image]}

    def view(self, data, **more):
        self.binary += bytes(-len(self.binary) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **more})
        self.binary += data
        return len(self.views) - 1

    def add(self, values, kind, component=5126, bounds=False, **more):
        data = struct.pack(f"<{len(values)}{CODES[component]}", *values)
        size = COMPONENTS[kind]
        accessor = {"bufferView": self.view(data), "componentType": component, "count": len(values) // size,
                    "type": kind, **more}
        if bounds:
            stored = struct.unpack(f"<{len(values)}f", data)
            accessor["min"] = [min(stored[k::size]) for k in range(size)]
            accessor["max"] = [max(stored[k::size]) for k in range(size)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def use(self, *names, required=False):
        for key in ("extensionsUsed", "extensionsRequired")[:2 if required else 1]:
            self.document.setdefault(key, []).extend(names)
        return self

    def text(self, **buffer):
        self.document.update({"buffers": [{"byteLength": len(self.binary), **buffer}], "bufferViews": self.views,
                              "accessors": self.accessors})
        return json.dumps(self.document)

    def glb(self, name, change=lambda text: text):
        text = change(self.text()).encode()
        text += b" " * (-len(text) % 4)
        data = self.binary + bytes(-len(self.binary) % 4)
        write(name + ".glb", struct.pack("<IIIII", 0x46546C67, 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
              + text + struct.pack("<II", len(data), 0x004E4942) + data)

    def gltf(self, name, change=lambda text: text, encode=lambda text: text.encode()):
        data = "data:application/octet-stream;base64," + base64.b64encode(self.binary).decode()
        write(name + ".gltf", encode(change(self.text(uri=data))))


def write(name, data):
    path = os.path.join(OUT, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)


def made(name, change, write_it=Model.glb, **more):
    model = Model(**more)
    change(model)
    write_it(model, name)


def each(prefix, at, values):
    """A model for each value of a member: `at` gives its object and key."""
    for name, value in values.items():
        model = Model()
        owner, key = at(model)
        if value is None:
            del owner[key]
        else:
            owner[key] = value
        model.glb(prefix + name)


def moved(**transform):
    return {"KHR_texture_transform": transform}


def uvs():
    def override(m):
        m.attributes["TEXCOORD_1"] = m.add([c / 2 for c in UVS], "VEC2")
        m.use("KHR_texture_transform").texture.update(texCoord=0, extensions=moved(texCoord=1, scale=[2, 2]))
    made("transform_overrides_texcoord", override)
    made("transform_of_colour_alone", lambda m: m.use("KHR_texture_transform").material.update(
        pbrMetallicRoughness={"baseColorTexture": {"index": 0, "extensions": moved(scale=[3, 3])}}))
    transforms = {"negative": {"scale": [-1, 1], "offset": [1, 0], "rotation": 0.7}, "zero": {"scale": [0, 0]},
                  "huge": {"scale": [1e30, 1e30]}, "short": {"offset": [0.5]}, "text": {"rotation": "x"},
                  "minus": {"texCoord": -1}}
    for name, transform in transforms.items():
        made("transform_" + name, lambda m, t=transform: m.use("KHR_texture_transform", required=True).texture.update(
            extensions=moved(**t)))
    made("transform_of_clearcoat", lambda m: m.use("KHR_texture_transform", "KHR_materials_clearcoat").material.update(
        extensions={"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0, "scale": 0.5, "extensions":
                                                                            moved(scale=[2, 2], rotation=0.3)}}}))
    each("texcoord_", lambda m: (m.texture, "texCoord"), {"3": 3, "1e20": 1e20})
    each("uvs_", lambda m: (m.attributes, "TEXCOORD_0"), {"none": None})
    made("uvs_with_a_gap", lambda m: m.attributes.update(TEXCOORD_2=m.attributes["TEXCOORD_0"]))
    made("uvs_eight", lambda m: m.attributes.update({f"TEXCOORD_{k}": m.attributes["TEXCOORD_0"] for k in range(8)}))
    made("uvs_twelve", lambda m: m.attributes.update({f"TEXCOORD_{k}": m.attributes["TEXCOORD_0"] for k in range(12)}))
    made("uvs_of_16_bits", lambda m: m.attributes.update(
        TEXCOORD_0=m.add([round(c * 65535) for c in UVS], "VEC2", 5123, normalized=True)))


def nodes():
    made("nodes_mirrored", lambda m: (m.node.update(scale=[-1, 1, 1]), m.document["nodes"].append({"mesh": 0}),
                                      m.document["scenes"][0]["nodes"].append(1)))
    each("node_", lambda m: (m.node, "matrix"), {"mirrored": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]})
    each("rotation_", lambda m: (m.node, "rotation"), {"of_length_2": [0, 0, 0, 2]})
    made("scene_second", lambda m: m.document.update(scene=1, scenes=[{}, {"nodes": [0]}]))
    made("scene_none", lambda m: (m.document.pop("scene"), m.document.update(scenes=[{}, {"nodes": [0]}])))
    each("scenes_", lambda m: (m.document, "scenes"), {"empty": []})
    each("scene_", lambda m: (m.document, "scene"), {"7": 7})
    each("nodes_", lambda m: (m.document, "nodes"), {"empty": [],
                                                     "in_a_circle": [{"children": [1]}, {"children": [0]}]})
    made("nodes_none", lambda m: [m.document.pop(key) for key in ("scene", "scenes", "nodes")])
    made("nodes_5000_deep", lambda m: m.document.update(
        nodes=[{"mesh": 0, "children": [1]}] + [{"children": [k + 2]} for k in range(5000)] + [{}]))
    made("instances", lambda m: m.use("EXT_mesh_gpu_instancing").node.update(
        extensions={"EXT_mesh_gpu_instancing": {"attributes": {"SCALE": m.add([-1, 1, 1, 1, 1, 1], "VEC3")}}}))


def images():
    for name in ("n.png", "sub/dir/n.png", "ü n%1.png"):
        write(name, PNG)
    encoded = base64.b64encode(PNG).decode()
    each("image_", lambda m: (m.image, "uri"), {
        "missing": "nothing.png", "parent": "../n.png", "absolute": "/n.png", "encoded_parent": "%2e%2e/n.png",
        "encoded_slash": "sub%2Fdir/n.png", "utf8": "ü n%251.png", "utf8_encoded": "%C3%BC%20n%251.png",
        "backslashes": "sub\\dir\\n.png", "scheme": "file:///etc/passwd", "https": "https://example.com/n.png",
        "query": "n.png?v=1", "dot": "./n.png", "empty": "", "number": 5, "folder": "sub",
        "data": "data:image/png;base64," + encoded, "data_without_type": "data:;base64," + encoded,
        "data_percent": "data:image/png," + "".join(f"%{b:02x}" for b in PNG), "data_upper": "DATA:image/png;base64,"
        + encoded, "data_empty": "data:", "data_damaged": "data:image/png;base64,A"})
    made("image_of_another_type", lambda m: m.document.update(images=[{"bufferView": m.view(PNG),
                                                                        "mimeType": "image/jpeg"}]))
    made("image_without_type", lambda m: m.document.update(images=[{"bufferView": m.view(PNG)}]))
    made("image_without_view", lambda m: m.document.update(images=[{"bufferView": 99, "mimeType": "image/png"}]))
    made("image_of_two_bytes", lambda m: m.document.update(images=[{"bufferView": m.view(b"xx"),
                                                                     "mimeType": "image/png"}]))
    each("texture_", lambda m: (m.texture, "index"), {"5": 5})
    each("textures_", lambda m: (m.document, "textures"), {"without_source": [{}], "of_source_9": [{"source": 9}]})


def buffers():
    made("views_overlap", lambda m: m.views[1].update(m.views[0]))
    made("view_leaves_its_buffer", lambda m: setattr(m, "binary", m.binary[:-4]))
    each("stride_", lambda m: (m.views[0], "byteStride"), {"8": 8, "256": 256})
    each("count_", lambda m: (m.accessors[0], "count"), {"2_53": 2 ** 53, "25.0": 25.0, "25.5": 25.5, "minus": -1})
    each("offset_", lambda m: (m.accessors[0], "byteOffset"), {"2_62": 2 ** 62, "1": 1})
    each("tangents_", lambda m: (m.accessors[3], "bufferView"), {"without_view": None})

    def sparse(m, indices, values):
        accessor = m.accessors[2]
        accessor["sparse"] = {"count": len(indices),
                              "indices": {"bufferView": m.view(struct.pack(f"<{len(indices)}H", *indices)),
                                          "componentType": 5123},
                              "values": {"bufferView": m.view(struct.pack(f"<{len(values)}f", *values))}}
        return accessor
    made("sparse_without_base", lambda m: sparse(m, range(25), UVS).pop("bufferView"))
    made("sparse_twice_the_same", lambda m: sparse(m, [3, 3], [0, 0, 1, 1]))
    for name, key, values, kind in (
            ("position_nan", "POSITION", POSITIONS[:4] + [math.nan] + POSITIONS[5:], "VEC3"),
            ("tangent_infinite", "TANGENT", [1, 0, math.inf, 1] + TANGENTS[4:], "VEC4"),
            ("tangent_w_0", "TANGENT", [1, 0, 0, 0] + TANGENTS[4:], "VEC4"),
            ("tangents_0", "TANGENT", [0] * 100, "VEC4"), ("normals_0", "NORMAL", [0] * 75, "VEC3"),
            ("normals_of_four", "NORMAL", [0, 0, 1, 0] * 25, "VEC4")):
        made(name, lambda m, k=key, v=values, t=kind: m.attributes.update({k: m.add(v, t)}))
    each("normals_", lambda m: (m.attributes, "NORMAL"), {"none": None})
    each("positions_", lambda m: (m.attributes, "POSITION"), {"none": None, "77": 77})
    each("attributes_", lambda m: (m.primitive, "attributes"), {"none": None, "empty": {}})


def primitives():
    strip = []
    for j in range(SIDE):
        row = [k for i in range(SIDE + 1) for k in (j * (SIDE + 1) + i, (j + 1) * (SIDE + 1) + i)]
        strip += ([strip[-1], row[0]] if strip else []) + row
    made("strip_with_empty_triangles", lambda m: m.primitive.update(mode=5, indices=m.add(strip, "SCALAR", 5123)))
    made("fan", lambda m: m.primitive.update(mode=6, indices=m.add([12, 0, 1, 2, 3, 4, 9, 14, 19, 24], "SCALAR", 5123)))
    made("indices_of_8_bits", lambda m: None, index_type=5121)
    made("indices_of_32_bits", lambda m: None, index_type=5125)
    each("indices_", lambda m: (m.primitive, "indices"), {"none": None, "99": 99})
    made("indices_restart", lambda m: m.primitive.update(indices=m.add(INDICES[:-1] + [0xFFFFFFFF], "SCALAR", 5125)))
    each("indices_count_", lambda m: (m.accessors[4], "count"), {"95": 95})
    each("mode_", lambda m: (m.primitive, "mode"), {"points": 0, "7": 7, "text": "x"})
    made("lines_beside", lambda m: m.document["meshes"][0]["primitives"].append({**m.primitive, "mode": 1}))
    made("morph_target", lambda m: m.primitive.update(targets=[{"POSITION": m.add([0.1] * 75, "VEC3", bounds=True)}]))

    def skinned(m):
        m.attributes.update(JOINTS_0=m.add([0] * 100, "VEC4", 5121), WEIGHTS_0=m.add([1, 0, 0, 0] * 25, "VEC4"))
        m.document.update(skins=[{"joints": [0]}], nodes=[{"name": "j"}, {"mesh": 0, "skin": 0}])
        m.document["scenes"][0]["nodes"] = [0, 1]
    made("skin", skinned)
    made("primitives_500", lambda m: m.document["meshes"][0].update(primitives=[m.primitive] * 500))


def materials():
    def variants(m, *numbers):
        m.use("KHR_materials_variants").document.update(
            extensions={"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]}})
        m.document["materials"].append({"name": "blue", "normalTexture": {"index": 0}})
        m.primitive["extensions"] = {"KHR_materials_variants": {
            "mappings": [{"material": number, "variants": [k]} for k, number in enumerate(numbers)]}}
    made("variants", lambda m: variants(m, 1, 0))
    made("variants_of_no_material", lambda m: variants(m, 1, 7))
    each("materials_", lambda m: (m.document, "materials"), {"empty": [], "object": {"a": 1}, "number": [5]})
    made("materials_none", lambda m: (m.document.pop("materials"), m.primitive.pop("material")))
    each("material_", lambda m: (m.primitive, "material"), {"4": 4})
    each("scale_", lambda m: (m.texture, "scale"), {"0": 0, "text": "big"})
    each("name_", lambda m: (m.material, "name"), {"control": "a\0b\n\"\x1b[31m", "long": "x" * 5000,
                                                   "path": "../../x"})
    made("required_unknown", lambda m: m.use("ACME_nonsense", required=True))
    each("required_", lambda m: (m.document, "extensionsRequired"), {"text": "KHR_texture_transform", "number": [5]})
    for owner in ("texture", "material"):
        made("unknown_in_" + owner, lambda m, o=owner: getattr(m.use("ACME_nonsense"), o).update(
            extensions={"ACME_nonsense": {}}))


def texts():
    made("json_with_mark", lambda m: None, lambda m, name: m.gltf(name, encode=lambda t: t.encode("utf-8-sig")))
    made("json_utf16", lambda m: None, lambda m, name: m.gltf(name, encode=lambda t: t.encode("utf-16")))
    made("json_not_utf8", lambda m: None, lambda m, name: m.gltf(
        name, encode=lambda t: t.encode().replace(b'"name": "m"', b'"name": "\xff\xfe"')))
    made("json_of_4_mb", lambda m: m.document.update(extras="x" * (4 << 20)), Model.gltf)
    for name, end in {"deep": ',"extras":' + "[" * 100 + "]" * 100 + "}", "deep_1000": ',"extras":' + "[" * 1000
                      + "]" * 1000 + "}", "asset_twice": ',"asset":{"version":"1.0"}}', "trailing": "} x",
                      "cut": ""}.items():
        made("json_" + name, lambda m: None, lambda m, name, e=end: m.gltf(name, lambda t: t[:-1] + e))
    made("json_nan", lambda m: None, lambda m, name: m.gltf(name, lambda t: t.replace('"scene": 0', '"scene": NaN')))
    made("json_comment", lambda m: None, lambda m, name: m.gltf(name, lambda t: "/* a comment */" + t))
    made("json_infinite", lambda m: m.node.update(translation=[math.inf, 0, 0]),
         lambda m, name: m.gltf(name, lambda t: t.replace("Infinity", "1e999")))
    each("asset_", lambda m: (m.document, "asset"), {"minimum": {"version": "2.0", "minVersion": "2.1"},
                                                      "minimum_2_1": {"version": "2.1", "minVersion": "2.1"},
                                                      "version_1": {"version": "1.0"}, "none": None})

    def with_extras(value):
        if isinstance(value, dict):
            return {**{key: with_extras(part) for key, part in value.items()}, "extras": {"uri": "../x", "mesh": 9}}
        return [with_extras(part) for part in value] if isinstance(value, list) else value

    def add_extras(m):
        for key in ("asset", "nodes", "materials", "textures", "images"):
            m.document[key] = with_extras(copy.deepcopy(m.document[key]))
    made("extras_everywhere", add_extras)


def chunks():
    Model().glb("chunk")
    with open(os.path.join(OUT, "chunk.glb"), "rb") as file:
        glb = file.read()
    more = struct.pack("<II", 4, 0x12345678) + b"abcd"
    for name, data in {"third": glb[:8] + struct.pack("<I", len(glb) + 12) + glb[12:] + more, "junk": glb + b"junk",
                       "short_length": glb[:8] + struct.pack("<I", len(glb) - 8) + glb[12:], "cut": glb[:-8],
                       "version_1": glb[:4] + struct.pack("<I", 1) + glb[8:], "head_alone": glb[:12]}.items():
        write(f"chunk_{name}.glb", data)


for family in (uvs, nodes, images, buffers, primitives, materials, texts, chunks):
    family()
