#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""occlusion_mesh.py BUILD: occlusion from horizons beside that from rays, of the same heights as a mesh.

Writes the heights of three fields, and each as a mesh of two triangles a texel over a plane of two. Prints how far
`bake-normals --occlusion-out` is from `transfer-normals --occlusion-out`, whose rays embree_bench judges.
"""

import array
import math
import os
import subprocess
import sys
import tempfile

SIDE = 128
MARGIN = 16  # texels along the border, where the mesh ends and the heights go on


def noise(i: int, j: int) -> float:
    n = (i * 374761393 + j * 668265263) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    return (n & 0xFFFF) / 65535.0


def bricks(i: int, j: int) -> float:
    x, y = (i + 16 * (j // 16 % 2)) % 32, j % 16
    edge = min(x, 31 - x, y, 15 - y)
    return 5.0 * min(1.0, max(0.0, (edge - 0.5) / 2.0))


FIELDS = {
    "waves": lambda i, j: 4.0 * math.sin(0.21 * i + 0.05 * j) * math.cos(0.17 * j),
    "waves with noise": lambda i, j: 4.0 * math.sin(0.21 * i) * math.cos(0.17 * j) + 0.5 * noise(i, j),
    "bricks": bricks,
}


def write_meshes(heights: list[float]) -> None:
    with open("high.obj", "w") as high:
        for j in range(SIDE):
            for i in range(SIDE):
                high.write(f"v {i + 0.5} {SIDE - j - 0.5} {heights[j * SIDE + i]}\n")
        for j in range(SIDE - 1):
            for i in range(SIDE - 1):
                a = j * SIDE + i + 1
                high.write(f"f {a} {a + SIDE} {a + SIDE + 1}\nf {a} {a + SIDE + 1} {a + 1}\n")
    with open("low.obj", "w") as low:
        for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
            low.write(f"v {x * SIDE} {y * SIDE} 0\nvt {x} {y}\n")
        low.write("vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n")


def run(build: str, *command: str) -> None:
    done = subprocess.run([os.path.join(build, command[0]), *command[1:]], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr)


def floats(name: str) -> array.array:
    with open(name, "rb") as file:
        return array.array("f", file.read())


def both(build: str, height) -> tuple[array.array, array.array]:
    """Occlusion of the field `height` from horizons and from rays; writes files into the current folder."""
    heights = [height(i, j) for j in range(SIDE) for i in range(SIDE)]
    with open("h.r32", "wb") as file:
        array.array("f", heights).tofile(file)
    write_meshes(heights)
    run(build, "bake-normals", "h.r32", "-o", "n.png", "--bumpiness", "1", "--wrap", "clamp",
        "--occlusion-out", "horizons.r32", "--occlusion-directions", "64")
    run(build, "transfer-normals", "low.obj", "high.obj", "-o", "t.png", "--extent", str(SIDE), "--front", "20",
        "--back", "20", "--rays-per-hit", "4096", "--occlusion-out", "rays.r32")
    return floats("horizons.r32"), floats("rays.r32")


def main() -> None:
    build = os.path.abspath(sys.argv[1])
    print("| heights | mean difference | signed | p99 | mean occlusion |\n|---|---|---|---|---|")
    for name, height in FIELDS.items():
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            a, b = both(build, height)
            os.chdir("/")
        inside = range(MARGIN, SIDE - MARGIN)
        gaps = sorted(abs(a[j * SIDE + i] - b[j * SIDE + i]) for j in inside for i in inside)
        signed = sum(a[j * SIDE + i] - b[j * SIDE + i] for j in inside for i in inside) / len(gaps)
        mean = sum(a[j * SIDE + i] for j in inside for i in inside) / len(gaps)
        print(f"| {name} | {sum(gaps) / len(gaps):.4f} | {signed:.4f} | {gaps[len(gaps) * 99 // 100]:.4f} | {mean:.3f} |")


if __name__ == "__main__":
    main()
