#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every command with extreme values of every option, and with damaged models.

    tests/extremes.py BUILD [SECONDS [SEED]]

First each option alone, as `--help --json` lists it, with all of its words, its limits and values beyond them, empty
text, other programs' notations, folders, devices and the input itself; then random pairs of options, and models whose
JSON or buffers were changed, for SECONDS (60). A run is bad if it ends by a signal or with a status that the manual
does not list, takes longer than 20 seconds, fails without a word, changes an input, or leaves a temporary file. Prints
each bad run as a command line, and how many there were. Best run with the build of the sanitizers, build/asan.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import resource
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import time
import zlib

BUILD = pathlib.Path(sys.argv[1]).resolve()
SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else 60
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else int(time.time())
LONGEST = 20
IS_SANITIZED = b"__asan_init" in (BUILD / "bake-normals").read_bytes()
MOST_BYTES = 4 << 30  # of address space; sanitizers reserve more than any machine has

NUMBERS = ["-inf", "inf", "nan", "1e308", "-1e308", "1e39", "1e-308", "0", "-0", "-1", "0.5", "1", "255", "65536",
           "2147483647", "2147483648", "-2147483649", "9223372036854775808", "18446744073709551616", "0x10", "1e", "1,5",
           "1 ", "", "--", "1x1", "0x0", "1,1", "1e9,1e9", "100000000x100000000", "9" * 400]
TEXTS = ["", " ", "-", "{", "{x", "{stem}{level}", ".", "no-such-file", "a" * 300, "a" * 5000, "\n", "%s%n", "*", "**/[",
         "é\udcff", "1", "x=r,y=g", "rgba:rgba", "auto", "none"]
INPUT = "@input"  # stands for the command's first input

# The inputs of each command, and what its smallest whole command line is.
LINES = {
    "bake": ["heights.png", "-o", "out.dds"],
    "build": ["normals.toml", "--no-sync"],
    "blend": ["normals.png", "normals.png", "-o", "out.png"],
    "check": ["normals.png"],
    "compare": ["normals.png", "normals.dds"],
    "convert": ["normals.png", "--mesh", "model.glb", "--from", "object", "-o", "out.png"],
    "integrate": ["normals.png", "-o", "out.exr"],
    "mip": ["normals.png", "-o", "out.ktx2"],
    "pack": ["normals.png", "-o", "out.dds"],
    "preview": ["normals.png", "-o", "out.png", "--size", "64"],
    "repair": ["normals.png", "-o", "out.png"],
    "scale": ["normals.png", "-o", "out.png", "--scale", "2"],
    "transfer": ["model.glb", "model.glb", "-o", "out.png", "--extent", "32x32"],
    "unpack": ["normals.dds", "-o", "out.png"],
}
# Options that are not tried: the lists of inputs are texts of their own, and a watch ends when somebody ends it.
LEFT_OUT = {"--files-from", "--watch"}
# What each command makes of a model.
MODEL_LINES = [
    ["check-normals", "model.glb"],
    ["preview-normals", "model.glb", "-o", "out.png", "--size", "64"],
    ["pack-normals", "model.glb", "-o", "out.png"],
    ["pack-normals", "model.glb", "-o", "out.glb", "--y", "down"],
    ["repair-normals", "model.glb", "-o", "out.glb", "--likely"],
    ["convert-normals", "model.glb", "--out-dir", "out"],
    ["transfer-normals", "model.glb", "model.glb", "-o", "out.png", "--extent", "32x32", "--occlusion-out", "ao.png"],
]


def png(width, height, channels, depth, texel):
    kind = {1: 0, 3: 2}[channels]
    rows = b"".join(b"\0" + b"".join(texel(x, y) for x in range(width)) for y in range(height))

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def document(picture):
    """A grid of 3x3 vertices with a normal map, as the JSON and the buffer of a GLB."""
    corners = [(x / 2, y / 2) for y in range(3) for x in range(3)]
    quads = [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)]
    parts = [
        b"".join(struct.pack("<3f", x, y, x * y / 2) for x, y in corners),
        b"".join(struct.pack("<3f", 0, 0, 1) for _ in corners),
        b"".join(struct.pack("<2f", x, 1 - y) for x, y in corners),
        b"".join(struct.pack("<6H", a, b, c, a, c, d) for a, b, c, d in quads),
        picture,
    ]
    views, buffer = [], b""
    for part in parts:
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(part)})
        buffer += part + b"\0" * (-len(part) % 4)
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 9, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0.5]},
        {"bufferView": 1, "componentType": 5126, "count": 9, "type": "VEC3"},
        {"bufferView": 2, "componentType": 5126, "count": 9, "type": "VEC2"},
        {"bufferView": 3, "componentType": 5123, "count": 24, "type": "SCALAR"},
    ]
    attributes = {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [1, 1, 1], "children": [1]}, {"mesh": 0, "translation": [0, 0, 1]}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 3, "material": 0}]}],
        "materials": [{"name": "m", "normalTexture": {"index": 0, "texCoord": 0, "scale": 1.0}}],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 10497}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(buffer)}],
    }, buffer


def glb(text, buffer):
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def places(value, at=()):
    """The path of every value in a JSON document."""
    if at:
        yield at
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, (*at, key))


def damaged(chance, whole, buffer):
    """The GLB with one to three changes."""
    tree, data = json.loads(json.dumps(whole)), bytearray(buffer)
    for _ in range(chance.randint(1, 3)):
        what = chance.random()
        if what < 0.75:
            path = chance.choice(list(places(tree)))
            owner = tree
            for key in path[:-1]:
                owner = owner[key]
            old = owner[path[-1]]
            values = [None, True, -1, 0, 1, 2**31, 2**53, -0.5, 1e300, "", "x", [], {}, [old] * 3, [old] * 2000]
            if isinstance(old, (int, float)):
                values += [old + 1, old - 1, old * 2, old * 1000, 5120, 5121, 5123, 5125, 5126] * 2
            if chance.random() < 0.15:
                del owner[path[-1]]
            else:
                owner[path[-1]] = chance.choice(values)
        elif what < 0.95:
            at = chance.randrange(max(1, len(data) // 4)) * 4
            value = chance.choice([0, 0x7F800000, 0xFFC00000, 0x7F7FFFFF, 1, 0xFFFFFFFF, 0x80000000, 0xFFFE0001])
            data[at:at + 4] = struct.pack("<I", value)
        else:
            del data[chance.randrange(len(data) + 1):]
    return glb(json.dumps(tree).encode(), bytes(data))


class Scratch:
    """A folder with inputs, in which one run at a time takes place."""

    def __init__(self, root, inputs):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=root))
        self.inputs = inputs

    def run(self, line, changed=None):
        """What is bad about a run; empty: nothing."""
        inputs = {**self.inputs, **(changed or {})}
        for name, data in inputs.items():
            (self.folder / name).write_bytes(data)
        command = [str(BUILD / line[0]), *line[1:]]
        limits = None if IS_SANITIZED else lambda: resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
        try:
            # surrogateescape: bytes that are not UTF-8 reach the command as they are.
            made = subprocess.run([os.fsencode(word) for word in command], cwd=self.folder, stdin=subprocess.DEVNULL,
                                  capture_output=True, timeout=LONGEST, preexec_fn=limits)
        except subprocess.TimeoutExpired:
            return f"takes more than {LONGEST} seconds"
        bad = []
        if made.returncode not in (0, 1, 2, 3, 4):
            bad.append(f"exit status {made.returncode}: {made.stderr[-300:].decode(errors='replace')}")
        if made.returncode in (2, 3, 4) and not made.stderr and not made.stdout:
            bad.append("fails without a word")
        if made.returncode in (2, 3, 4) and b"normals: error" not in made.stderr and b"error" not in made.stdout:
            bad.append(f"fails without an error: {made.stderr[-200:].decode(errors='replace')}")
        for name, data in inputs.items():
            path = self.folder / name
            if not path.is_file() or path.read_bytes() != data:
                bad.append(f"changes {name}")
        for path in self.folder.iterdir():
            if path.name in inputs:
                continue
            if ".tmp" in path.name or path.name.startswith(".tex"):
                bad.append(f"leaves {path.name}")
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
        return "; ".join(bad)


def values_of(option):
    if option["type"] == "flag":
        return [None]
    values = [row["word"] for row in option.get("words", [])]
    for limit in ("minimum", "maximum", "exclusiveMinimum"):
        if limit in option:
            values += [str(option[limit]), str(option[limit] - 1), str(option[limit] + 1), str(option[limit] * 1.0001)]
    values += NUMBERS + TEXTS + [INPUT] + [word + "x" for word in values[:2]]
    # Nothing may be written outside the scratch folder.
    is_output = option.get("writes") or option["type"] == "folder" or option["names"][-1] == "--name"
    return values if is_output else [*values, "/", "../..", "/dev/null", "/dev/zero", "/proc/self/mem"]


def argument(option, value, line):
    name = option["names"][-1]
    return [name] if value is None else [f"{name}={line[0] if value == INPUT else value}"]


def main():
    root = pathlib.Path(tempfile.mkdtemp(prefix="tex-extremes-"))
    heights = png(17, 9, 1, 16, lambda x, y: struct.pack(">H", (x * x * 97 + y * 3001) % 65536))
    picture = png(16, 8, 3, 8, lambda x, y: bytes([96 + 4 * x, 160 - 8 * y, 240]))
    whole, buffer = document(picture)
    inputs = {"heights.png": heights, "normals.png": picture,
              "normals.toml": b"version = 1\n[[rule]]\nmatch = 'normals.png'\nname = 'out/{stem}.dds'\n"
                              b"steps = [ { pack = {} } ]\n",
              "model.glb": glb(json.dumps(whole).encode(), buffer)}
    (root / "n.png").write_bytes(picture)
    subprocess.run([BUILD / "pack-normals", root / "n.png", "-o", root / "n.dds", "--quiet"], check=True)
    inputs["normals.dds"] = (root / "n.dds").read_bytes()

    tables = {}
    for name in LINES:
        text = subprocess.run([BUILD / f"{name}-normals", "--help", "--json"], capture_output=True, check=True).stdout
        tables[name] = [option for option in json.loads(text)["options"]
                        if option["group"] != "Help" and option["names"][-1] not in LEFT_OUT]

    singles = [[f"{name}-normals", *line, *argument(option, value, line)]
               for name, line in LINES.items() for option in tables[name] for value in values_of(option)]
    local, bad, count = threading.local(), [], 0
    lock = threading.Lock()

    def attempt(line, changed=None):
        nonlocal count
        if not hasattr(local, "scratch"):
            local.scratch = Scratch(root, inputs)
        if any("\0" in word for word in line):
            return
        what = local.scratch.run(line, changed)
        with lock:
            count += 1
            if not what:
                return
            bad.append(line)
            print(f"{shlex.join(line)[:400]}\n    {what}", flush=True)
            if changed:
                kept = root / f"bad{len(bad)}.glb"
                kept.write_bytes(changed["model.glb"])
                print(f"    the model is kept as {kept}", flush=True)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(attempt, singles))
        print(f"extremes: each option alone: {count} runs, {len(bad)} bad", flush=True)
        end = time.monotonic() + SECONDS

        def pairs(k):
            chance = random.Random(SEED * 1000 + k)
            while time.monotonic() < end:
                if chance.random() < 0.5:
                    line = chance.choice(MODEL_LINES)
                    attempt(line, {"model.glb": damaged(chance, whole, buffer)})
                    continue
                name = chance.choice(list(LINES))
                line = [f"{name}-normals", *LINES[name]]
                for option in chance.sample(tables[name], 2):
                    line += argument(option, chance.choice(values_of(option)), LINES[name])
                attempt(line)

        list(pool.map(pairs, range(os.cpu_count())))
    print(f"extremes: seed {SEED}: {count} runs, {len(bad)} bad", flush=True)
    if not bad:
        shutil.rmtree(root)
    return 1 if bad else 0


sys.exit(main())
