#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ffmpeg-dds-z.sh: ffmpeg 5.1 (Debian 12) on normal maps in DDS: BC5, and DXT5 that its header marks as a normal map.
#
# Expected: x and y as they are stored, and z of a unit vector: 255 for a flat normal, 128 128.
# Seen (2026-12-01): z is sqrt((255^2 - r^2 - g^2) / 2) of the codes themselves, as if they were not centred on 128. A
# flat normal gets 127, which is no z at all, and slopes to one side point into the surface. In BC5 with the mark that
# NVIDIA's tools set on normal maps, red is 255 everywhere: x is lost.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v ffmpeg >/dev/null || { echo 'needs ffmpeg 5.1 of Debian 12' >&2; exit 2; }
ffmpeg -version | head -n 1
/usr/bin/python3 - <<'PY'
import struct
import subprocess

NORMALS = [(128, 128), (192, 128), (64, 128)]  # flat, and leaning to the right and to the left by 30 degrees
MARK = 0x80000000  # DDPF_NORMAL of NVIDIA's tools


def write(name, fourcc, flags, block):
    blocks = b"".join(block(x, y) for x, y in NORMALS)
    head = b"DDS " + struct.pack("<7I44x", 124, 0x81007, 4, 4 * len(NORMALS), len(blocks), 0, 0)
    head += struct.pack("<2I4s5I", 32, 4 | flags, fourcc, 0, 0, 0, 0, 0) + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
    with open(name, "wb") as file:
        file.write(head + blocks)


def half(value):
    return bytes([value, value]) + bytes(6)


def bc5(x, y):
    return half(x) + half(y)


def dxt5nm(x, y):  # x in alpha, y in green
    return half(x) + struct.pack("<2H", y >> 2 << 5, y >> 2 << 5) + bytes(4)


def read(name):
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", name, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         check=True, capture_output=True).stdout
    return [tuple(raw[12 * k:12 * k + 3]) for k in range(len(NORMALS))]


write("bc5.dds", b"ATI2", 0, lambda x, y: bc5(y, x))  # y comes first
write("bc5u.dds", b"BC5U", 0, bc5)
write("marked.dds", b"BC5U", MARK, bc5)
write("dxt5nm.dds", b"DXT5", MARK, dxt5nm)
seen = {name: read(name) for name in ("bc5.dds", "bc5u.dds", "marked.dds", "dxt5nm.dds")}
for name, texels in seen.items():
    print(name, *texels)
assert seen["bc5u.dds"] == [(128, 128, 127), (192, 128, 77), (64, 128, 149)], seen
assert seen["bc5.dds"] == seen["bc5u.dds"], seen
assert all(red == 255 for red, _, _ in seen["marked.dds"]), seen
assert [t[2] for t in seen["dxt5nm.dds"]] == [126, 75, 148], seen
PY
