#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""draco.py: damaged Draco buffers, through tex-mesh-reader as commands start it.

    tests/fuzz/draco.py [SECONDS [BUILD [SEED]]]    default: 60 build/release 1

There is no libFuzzer target: libdraco asks for as much memory as a file claims, and a sanitizer ends the process there.
So this tests what users have: the programs as they are, with the limits and the sandbox of the reader. Models are made
of the buffers in corpus/draco, one after the other damaged in a few places, and go to check-normals, 16 in a run, and
each of some of them to convert-normals. After each run:

* each model has one line of JSON, or one error: a line that names it;
* the exit status is 4 if any model was refused, else 0 or 1, and no signal ended the command;
* the run ended in time (the reader has two seconds for each);
* no file is there that was not there before, but the output of a conversion that succeeded;
* no process of the reader is left.

A finding is printed, and its folder is kept. The last line counts the models, and what became of them. A short run is
in ctest.
"""

import base64
import collections
import ctypes
import json
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

SECONDS = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else ROOT / "build/release").resolve()
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
BATCH = 16
READER_SECONDS = 2  # --reader-timeout
NUMBERS = [0, 1, 2, 3, 127, 128, 129, 254, 255]
WHOLE = [path.read_bytes() for path in sorted((ROOT / "tests/fuzz/corpus/draco").glob("*.drc"))]


class Finding(Exception):
    pass


def flat_png():
    """A flat map of 8x8 texels."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = (b"\0" + b"\x80\x80\xff" * 8) * 8
    head = struct.pack(">IIBBBBB", 8, 8, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


PICTURE = "data:image/png;base64," + base64.b64encode(flat_png()).decode()


def varint(value):
    digits = bytearray()
    while value > 127:
        digits.append(value & 127 | 128)
        value >>= 7
    return bytes(digits) + bytes([value])


def damage(chance):
    """One of the buffers, with a few changes. Most are near the front, where sizes and methods are, after the mark."""
    data = bytearray(chance.choice(WHOLE))
    for _ in range(chance.choice((1, 1, 1, 2, 3, 8))):
        if not data:
            break
        first = 5 if len(data) > 5 and chance.randrange(32) else 0
        at = chance.randrange(first, min(len(data), chance.choice((16, 64, 1 << 20))))
        kind = chance.randrange(8)
        if kind == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif kind == 1:
            data[at] = chance.choice(NUMBERS)
        elif kind == 2:
            data[at] = chance.randrange(256)
        elif kind == 3:
            data[at:at + chance.randrange(1, 5)] = varint(1 << chance.randrange(36) | chance.randrange(3))
        elif kind == 4:
            del data[at:at + chance.randrange(1, 17)]
        elif kind == 5:
            data[at:at] = chance.randbytes(chance.randrange(1, 9))
        elif kind == 6:
            other = chance.choice(WHOLE)
            data[at:] = other[min(at, len(other)):]
        else:
            del data[at:]
    return bytes(data)


def model(chance):
    """A GLB file of a damaged buffer. Its attributes are those of the buffer, now and then others."""
    data = damage(chance)
    ids = [0, 1, 2] if chance.randrange(8) else [chance.randrange(8) for _ in range(3)]
    names = ["POSITION", "NORMAL", "TEXCOORD_0"]
    count = chance.choice((25, 36, 49, 8, 1, 0, 1 << 31))
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_draco_mesh_compression"], "extensionsRequired": ["KHR_draco_mesh_compression"],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
        "accessors": [{"componentType": 5126, "count": count, "type": "VEC2" if k == 2 else "VEC3"} for k in range(3)]
        + [{"componentType": 5125, "count": 96, "type": "SCALAR"}],
        "images": [{"uri": PICTURE}], "textures": [{"source": 0}],
        "materials": [{"name": "m", "normalTexture": {"index": 0}}],
        "meshes": [{"primitives": [{
            "material": 0, "indices": 3, "attributes": {name: k for k, name in enumerate(names)},
            "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": dict(zip(names, ids))}}}]}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    return (struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(data)) + struct.pack("<II", len(text), 0x4E4F534A)
            + text + struct.pack("<II", len(data), 0x004E4942) + data)


def run(folder, command, arguments, models):
    """Runs a command on models. Returns its exit status, its lines of JSON, and the error for each refused model."""
    program = [str(BUILD / command), *arguments, "--json", "--reader-timeout", str(READER_SECONDS)]
    try:
        done = subprocess.run(program, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True,
                              timeout=30 + 2 * READER_SECONDS * len(models))
    except subprocess.TimeoutExpired as late:
        raise Finding(f"{command} did not end: {late}") from late
    errors = {}
    for line in done.stderr.decode(errors="replace").splitlines():
        head = f"{command}: error: "
        name = line[len(head):].split(":")[0] if line.startswith(head) else None
        if line.startswith(f"{command}: warning: "):
            continue
        if name not in models or name in errors:
            raise Finding(f"not one error for a model: {line}")
        errors[name] = line[len(head) + len(name) + 2:]
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    return done.returncode, lines, errors


def kind_of(error):
    """An error without its numbers."""
    return "".join("N" if c.isdigit() else c for c in error).replace("NN", "N").replace("NN", "N").replace("NN", "N")


def one_round(folder, chance, outcomes):
    names = [f"{k}.glb" for k in range(BATCH)]
    for name in names:
        (folder / name).write_bytes(model(chance))
    code, lines, errors = run(folder, "check-normals", names, names)
    for line in lines:  # check-normals finds N101 in a model that it cannot read
        if "error" in line and "findings" in line:
            if [finding["id"] for finding in line["findings"]] != ["N101"] or line["input"] in errors:
                raise Finding(f"not one N101: {line}")
            errors[line["input"]] = line["error"]["reason"]
    read = {line["input"] for line in lines if "findings" in line and "error" not in line}
    if code not in ((4,) if errors else (0, 1)):
        raise Finding(f"check-normals: exit status {code} with {len(errors)} errors")
    for name in names:
        if (name in read) == (name in errors):
            raise Finding(f"{name}: {'an answer and an error' if name in read else 'no answer'}")
        outcomes[kind_of(errors.get(name, "read"))] += 1
    name = chance.choice(names)
    code, _, errors = run(folder, "convert-normals", [name, "-o", "o.png", "--to", "object", "--no-sync"], [name])
    if code not in (0, 4) or (code == 4) != (name in errors):
        raise Finding(f"convert-normals: exit status {code} for {name}")
    if not leaves_no_process():
        raise Finding("a process of the reader is left")
    expected = set(names) | ({"o.png"} if code == 0 else set())
    there = {path.name for path in folder.iterdir()}
    if there != expected:
        raise Finding(f"files: {there ^ expected}")
    (folder / "o.png").unlink(missing_ok=True)


def adopt_orphans():
    """Makes this process the parent of those that its children leave behind."""
    set_child_subreaper = 36  # of <linux/prctl.h>
    ctypes.CDLL(None).prctl(set_child_subreaper, 1, 0, 0, 0)


def leaves_no_process():
    """Whether no process of a command that has ended is left, not even an ended one that nobody waited for."""
    try:
        os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return True
    return False


def main():
    adopt_orphans()
    chance = random.Random(SEED)
    outcomes = collections.Counter()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="draco_"))
    end = time.monotonic() + SECONDS
    rounds = 0
    try:
        while rounds == 0 or time.monotonic() < end:
            one_round(folder, chance, outcomes)
            rounds += 1
    except Finding as finding:
        print(f"draco.py: round {rounds} of seed {SEED}: {finding}\nthe models are in {folder}")
        return 1
    shutil.rmtree(folder)
    for kind, count in outcomes.most_common():
        print(f"{count:8} {kind}")
    print(f"draco.py: {sum(outcomes.values())} models in {rounds} rounds, no finding")
    return 0


sys.exit(main())
