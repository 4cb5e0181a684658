#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""cases.py [--gate] ENGINE: writes cases.json, what the page of an engine is to draw, in the current folder.

The rows of the first table are FILES; PLACES says where each engine shows them. Those of the others are in models.py.
cases.py --commands prints the commands that make the files.
"""

import json
import sys

import models

SIDE = 128  # of pictures

# Towards the light. The steepest slope of the bump is 45 degrees, so no texel of it is in its own shadow.
LIGHTS = {"above": (0, 0.6, 0.8), "left": (-0.6, 0, 0.8)}

# The first table's rows: what makes each file from bump.png, a height map.
FILES = {
    "PNG, +Y": "bake-normals bump.png -o map.png $bake",
    "PNG, -Y": "bake-normals bump.png -o map-down.png $bake --y down",
    "PNG, +Y, alpha 0": "pack-normals map.png -o map-clear.png --format rgba8 --alpha 0 --no-sync --quiet",
    "EXR of n": "bake-normals bump.png -o map.exr $bake",
    "DDS, dxt5nm": "bake-normals bump.png -o dxt5nm.dds --format dxt5nm $bake $all",
    "DDS, bc5": "bake-normals bump.png -o bc5.dds --format bc5 $bake $all",
    "DDS, rg8": "bake-normals bump.png -o rg8.dds --format rg8 $bake $all",
    "DDS, rgba8": "bake-normals bump.png -o rgba8.dds --format rgba8 $bake $all",
    "KTX2, bc5": "bake-normals bump.png -o bc5.ktx2 --format bc5 $bake $all",
    "KTX2, eac-rg11": "bake-normals bump.png -o eac-rg11.ktx2 --format eac-rg11 $bake $all",
    "KTX2, rg8": "bake-normals bump.png -o rg8.ktx2 --format rg8 $bake $all",
    "KTX2, rgba8": "bake-normals bump.png -o rgba8.ktx2 --format rgba8 $bake $all",
    "KTX2, astc-4x4": "bake-normals bump.png -o astc-4x4.ktx2 --format astc-4x4 $bake $all",
    "KTX2, uastc": "bake-normals bump.png -o uastc.ktx2 --format uastc $bake $all",
}

# The surfaces on which each engine draws a file: its own geometry, or a glTF model with or without TANGENT. The settings
# of a recipe are named as in the engine.
OWN, PLAIN, TANGENT = "", "models/plain.glb", "models/plain-t-map.glb"
PLACES = {
    "three": [("own geometry", OWN), ("own geometry, repeat.y = -1, normalScale.y = -1", OWN),
              ("material of GLTFLoader", PLAIN), ("material of GLTFLoader, TANGENT", TANGENT),
              ("new material", PLAIN), ("new material, normalScale.y = -1", PLAIN), ("new material, TANGENT", TANGENT)],
    "babylon": [("own geometry", OWN), ("own geometry, invertNormalMapX, invertNormalMapY", OWN),
                ("own geometry, PBR", OWN), ("own geometry, PBR, invertNormalMapX, invertNormalMapY", OWN),
                ("own geometry, right-handed", OWN), ("glTF", PLAIN), ("glTF, TANGENT", TANGENT),
                ("glTF, right-handed", PLAIN)],
    "playcanvas": [("own geometry", OWN), ("glTF", PLAIN), ("glTF, TANGENT", TANGENT)],
    "phaser": [("image", OWN), ("image, flipX", OWN), ("image, flipY", OWN), ("image, rotated by 90 degrees", OWN)],
    "cesium": [], "filament": [], "model-viewer": [("createTexture", PLAIN), ("createTexture, TANGENT", TANGENT)],
    "godot": [("own geometry", OWN), ("own geometry, Image, Lambert", OWN), ("glTF", PLAIN), ("glTF, TANGENT", TANGENT)],
    "blender": [("own geometry", OWN), ("own geometry, Convention DirectX", OWN), ("glTF", PLAIN),
                ("glTF, TANGENT", TANGENT)],
}
# What the gate draws, in the first two places of an engine, and what must be seen there.
GATE = {
    "three": {"PNG, +Y": ("bump", "y wrong in the lower left corner"),
              "KTX2, bc5": ("y wrong in the lower left corner", "bump")},
    "babylon": {"PNG, +Y": ("dent", "bump"), "PNG, -Y": ("x wrong", "y wrong")},
}
# Where the picture is mirrored, turned over or turned on purpose, or by the engine's own geometry.
CORNERS = {"own geometry, right-handed": "upper right", "image, flipX": "upper right", "image, flipY": "lower left",
           "image, rotated by 90 degrees": "upper right"}
# The file types that an engine is given, if not all. (npm does not have Babylon.js' decoder of KTX2: see babylon.js.)
TYPES = {"phaser": ("png",), "playcanvas": ("png", "dds", "ktx2"), "model-viewer": ("png", "ktx2"),
         "godot": ("png", "exr", "dds", "ktx2"), "blender": ("png", "exr", "dds")}
DRAWS_MODELS = ("three", "babylon", "playcanvas", "cesium", "filament", "model-viewer", "godot", "blender")
# The sphere with UASTC is as that with the PNG.
AS_PICTURE = "as with the PNG"
DRAWS_SPHERES = ("three", "babylon", "playcanvas", "cesium", "filament")


def file_of(name):
    words = FILES[name].split()
    return words[words.index("-o") + 1]


def cases_of(engine, gate=False):
    cases = []
    for name in GATE[engine] if gate else FILES:
        if file_of(name).split(".")[-1] not in TYPES.get(engine, ("png", "exr", "dds", "ktx2")):
            continue
        for k, (place, model) in enumerate(PLACES[engine][:2] if gate else PLACES[engine]):
            cases.append({"table": "files", "name": name, "place": place, "map": file_of(name), "model": model,
                          "wanted": GATE[engine][name][k] if gate else "",
                          "corner": CORNERS.get(place, "upper left"), "dent": False, "halves": False})
    if not gate and engine in DRAWS_MODELS:
        for kind in models.kinds():
            cases.append({"table": "models", "name": kind.name, "place": kind.tangents, "map": "",
                          "model": f"models/{kind.file}", "corner": kind.corner, "dent": kind.dent,
                          "halves": kind.halves})
    if engine in DRAWS_SPHERES and not gate:
        for name, file in models.SPHERES.items():
            wanted = "" if name in (models.BARE, models.PICTURE) else AS_PICTURE
            cases.append({"table": "spheres", "name": name, "place": "", "map": "", "model": f"models/{file}",
                          "wanted": wanted})
    for k, case in enumerate(cases):
        case["id"] = f"{k:03}"
    return cases


def main():
    if sys.argv[1] == "--commands":
        print("\n".join(FILES.values()))
        return
    engine, gate = sys.argv[-1], sys.argv[1] == "--gate"
    with open("cases.json", "w", encoding="utf-8") as file:
        json.dump({"engine": engine, "side": SIDE, "lights": LIGHTS, "cases": cases_of(engine, gate)}, file, indent=1)


if __name__ == "__main__":
    main()
