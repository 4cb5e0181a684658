#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""command_threads.py: how long each command takes on 1, 2, 4 ... threads.

    tests/bench/command_threads.py [BUILD [SIDE [ROUNDS]]]    default: build/release 4096 5

Each command reads a map of SIDE x SIDE texels and runs in turn on 1, 2, 4 ... and all processors. Prints the medians of
the wall-clock times, and the median of the ratio of one thread to all within a round. Needs numpy.
"""

import os
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile
import time
import zlib

import numpy as np


def hills(side):
    """Heights from 0 to 1 with detail of every size, which repeat."""
    y, x = np.mgrid[0:side, 0:side].astype(np.float32) * np.float32(2 * np.pi / side)
    heights = np.zeros((side, side), np.float32)
    for octave in range(9):
        waves = 2**octave
        heights += np.sin(waves * x + 3 * np.sin(y) + octave) * np.cos(waves * y - octave) / waves
    heights += np.random.default_rng(1).normal(0, 0.002, heights.shape).astype(np.float32)
    return (heights - heights.min()) / np.ptp(heights)


def write_png(path, heights):
    """A grey PNG of 16 bits, each row filtered by Sub."""
    side = heights.shape[0]
    rows = np.round(heights * 65535).astype(">u2").view(np.uint8).reshape(side, 2 * side)
    rows = np.hstack([rows[:, :2], rows[:, 2:] - rows[:, :-2]])
    data = zlib.compress(np.hstack([np.ones((side, 1), np.uint8), rows]).tobytes(), 6)

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", side, side, 16, 0, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


COMMANDS = [
    "bake-normals h.png -o o.dds",
    "bake-normals h.png -o o.dds --effort fast",
    "bake-normals h.png -o o.png",
    "bake-normals h.exr -o o.dds",
    "bake-normals h.r16 -o o.dds",
    "bake-normals h.r16 -o o.ktx2 --format astc-6x6",
    "bake-normals h.r16 -o o.dds --effort best",
    "bake-normals h.r16 -o o.dds --blur 2",
    "bake-normals h.png -o o.exr",
    "bake-normals h.png -o o.ktx2 --format bc5 --supercompress zstd",
    "bake-normals h.png -o o.ktx2 --format eac-rg11",
    "mip-normals n.png -o o.dds",
    "mip-normals n.dds -o o.dds",
    "mip-normals n.dds -o o.dds --mip-filter kaiser",
    "pack-normals n.exr -o o.dds",
    "unpack-normals n.dds -o o.png",
    "unpack-normals n.dds -o o.exr",
    "scale-normals n.png --scale 2 -o o.png",
    "blend-normals n.png n2.png -o o.dds",
    "blend-normals n.dds n.dds -o o.dds",
    "check-normals n.dds",
    "check-normals n.png",
    "compare-normals n.dds n.png",
    "preview-normals n.dds -o o.png --size SIDE",
    "integrate-normals n.png -o o.png",
    "integrate-normals n.png -o o.exr --wrap clamp",
    "transfer-normals low.glb high.glb -o o.dds --extent SIDE",
    "transfer-normals low.glb high.glb -o o.dds --extent SIDE --height-out t.exr",
]


def seconds(command, threads):
    begin = time.perf_counter()
    run = subprocess.run([*command.split(), "--threads", str(threads)], capture_output=True, text=True)
    taken = time.perf_counter() - begin
    if run.returncode not in (0, 1):
        sys.exit(f"{command}: {run.stderr}")
    return taken


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/release").resolve()
    side, rounds = (int(sys.argv[k]) if len(sys.argv) > k else default for k, default in ((2, 4096), (3, 5)))
    processors = len(os.sched_getaffinity(0))
    counts = sorted({2**k for k in range(10) if 2**k < processors} | {processors})
    os.environ["PATH"] = f"{build}:{os.environ['PATH']}"
    models = pathlib.Path(__file__).resolve().parents[2] / "samples"
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        heights = hills(side)
        write_png(pathlib.Path("h.png"), heights)
        pathlib.Path("h.r16").write_bytes(np.round(heights * 65535).astype("<u2").tobytes())
        for mesh in ("low", "high"):
            os.symlink(models / f"crate_{mesh}.glb", f"{mesh}.glb")
        for made in ("n.png", "n.exr", "n.dds"):
            subprocess.run(["bake-normals", "h.png", "--bumpiness", "16", "-o", made, "--no-sync"], check=True)
        subprocess.run(["scale-normals", "n.png", "--scale", "0.5", "-o", "n2.png", "--no-sync"], check=True)
        subprocess.run(["integrate-normals", "n.png", "-o", "h.exr", "--format", "half", "--no-sync"], check=True)
        print(f"| {side}x{side} | " + " | ".join(f"{n}" for n in counts) + " | times |")
        print("|---" * (len(counts) + 2) + "|")
        for command in COMMANDS:
            command = command.replace("SIDE", str(side))
            if " -o " in command:
                command += " --no-sync"
            runs = [[seconds(command, n) for n in counts] for _ in range(rounds)]
            medians = " | ".join(f"{statistics.median(times):.2f}" for times in zip(*runs))
            times = statistics.median(run[0] / run[-1] for run in runs)
            print(f"| `{command.removesuffix(' --no-sync')}` | {medians} | {times:.1f} |", flush=True)


if __name__ == "__main__":
    main()
