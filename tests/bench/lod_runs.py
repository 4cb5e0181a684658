#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Several LODs in one run of transfer-normals beside one alone.

    lod_runs.py BUILD FOLDER [EXTENT...]        default: 256 512 1024

FOLDER gets a wavy sphere of a million triangles with a normal map of 1024x1024, four simplified ones, and the outputs.
For each extent, a row has the seconds of processor time, with one thread, of one LOD (the mean of the finest and the
coarsest), of two and of four in one run, and the ratio of the last to the first. The least of two runs counts. Needs
numpy and PIL. LODS.md has the last figures.
"""

import io
import json
import pathlib
import resource
import struct
import subprocess
import sys

import numpy
from PIL import Image

TAU = 2 * numpy.pi


def surface(u, v):
    radius = 1 + 0.01 * numpy.sin(40 * TAU * u) * numpy.sin(numpy.pi * v) * numpy.sin(30 * numpy.pi * v)
    around, down = TAU * u, numpy.pi * v
    return numpy.stack([radius * numpy.sin(down) * numpy.cos(around), radius * numpy.cos(down),
                        radius * numpy.sin(down) * numpy.sin(around)], -1)


def waves(side=1024):
    y, x = numpy.mgrid[0:side, 0:side] / side
    normals = numpy.stack([0.2 * numpy.sin(200 * TAU * x), 0.2 * numpy.sin(180 * TAU * y), numpy.zeros_like(x)], -1)
    normals[..., 2] = numpy.sqrt(1 - (normals ** 2).sum(-1))
    file = io.BytesIO()
    Image.fromarray(numpy.uint8(numpy.round((normals * 0.5 + 0.5) * 255))).save(file, "png")
    return file.getvalue()


def write_sphere(path, columns, picture):
    """Of columns * columns triangles, nearly."""
    rows = columns // 2
    v, u = numpy.meshgrid(numpy.linspace(0, 1, rows + 1), numpy.linspace(0, 1, columns + 1), indexing="ij")
    step = 1e-5
    positions = surface(u, v).reshape(-1, 3)
    normals = numpy.cross(surface(u, v + step) - surface(u, v - step), surface(u + step, v) - surface(u - step, v))
    normals = normals.reshape(-1, 3)
    lengths = numpy.linalg.norm(normals, axis=1, keepdims=True)
    normals = numpy.where(lengths > 1e-14, normals / numpy.maximum(lengths, 1e-30), positions)  # the poles
    normals *= numpy.where((normals * positions).sum(1, keepdims=True) < 0, -1, 1)
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    at = numpy.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    a, b, c, d = at[:-1, :-1], at[:-1, 1:], at[1:, :-1], at[1:, 1:]
    triangles = numpy.concatenate([numpy.stack(each, -1).reshape(-1, 3) for each in ((a, b, c), (b, d, c))])
    faces = numpy.cross(positions[triangles[:, 1]] - positions[triangles[:, 0]],
                        positions[triangles[:, 2]] - positions[triangles[:, 0]])
    triangles = triangles[numpy.linalg.norm(faces, axis=1) > 1e-14]
    content, views = b"", []
    for each in (positions.astype("<f4").tobytes(), normals.astype("<f4").tobytes(),
                 numpy.stack([u, v], -1).astype("<f4").tobytes(), triangles.astype("<u4").tobytes(), picture):
        views.append({"buffer": 0, "byteOffset": len(content), "byteLength": len(each)})
        content += each + bytes(-len(each) % 4)
    bounds = positions.astype("f4")
    many = {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3"}
    model = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3,
                                    "material": 0}]}],
        "materials": [{"name": "M", "normalTexture": {"index": 0}}], "textures": [{"source": 0}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [{**many, "min": bounds.min(0).tolist(), "max": bounds.max(0).tolist()},
                      {**many, "bufferView": 1}, {**many, "bufferView": 2, "type": "VEC2"},
                      {"bufferView": 3, "componentType": 5125, "count": int(triangles.size), "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": len(content)}]}
    text = json.dumps(model).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(content)) +
                     struct.pack("<I4s", len(text), b"JSON") + text +
                     struct.pack("<I4s", len(content), b"BIN\0") + content)


def seconds(command):
    """Of processor time, the least of two runs."""
    times = []
    for _ in range(2):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(times)


def main():
    build, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    (folder / "out").mkdir(parents=True, exist_ok=True)
    picture = waves()
    lows = [folder / f"low_{columns}.glb" for columns in (316, 224, 158, 112)]
    for path, columns in [(folder / "high.glb", 1000), *((low, int(low.stem[4:])) for low in lows)]:
        if not path.exists():
            write_sphere(path, columns, picture)
    print("extent\tone\ttwo\tfour\tfour / one")
    for extent in sys.argv[3:] or ["256", "512", "1024"]:
        def run(*some):
            return seconds([build / "transfer-normals", *some, "--high", folder / "high.glb", "--out-dir",
                            folder / "out", "--name", "{stem}.glb", "--extent", extent, "--threads", "1", "--quiet",
                            "--no-sync"])
        one, two, four = (run(lows[0]) + run(lows[3])) / 2, run(lows[0], lows[3]), run(*lows)
        print(f"{extent}\t{one:.2f}\t{two:.2f}\t{four:.2f}\t{four / one:.2f}", flush=True)


main()
