#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""occlusion_picture.py BUILD OUT.png: the README's picture of occlusion.

Three maps in ambient light and a weak light from the upper left: above without their occlusion, below with it. The
bricks are those of the samples; cobbles and a weave are made here from formulas. ImageMagick joins the pictures.
"""

import array
import math
import os
import subprocess
import sys
import tempfile

SIDE = 256
SAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "samples")


def noise(i: int, j: int) -> float:
    n = (i * 374761393 + j * 668265263) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((n ^ (n >> 16)) & 0xFFFF) / 65535.0


def cobbles(i: int, j: int) -> float:
    """Rounded stones around jittered points of a grid that repeats: high in the middle, steep at the joint."""
    cells, best, second = 7, 1e9, 1e9
    x, y = i * cells / SIDE, j * cells / SIDE
    for row in range(int(y) - 1, int(y) + 2):
        for column in range(int(x) - 1, int(x) + 2):
            a, b = column % cells, row % cells
            way = math.hypot(column + 0.2 + 0.6 * noise(a, b) - x, row + 0.2 + 0.6 * noise(b + 31, a) - y)
            best, second = min(best, way), max(best, min(second, way))
    edge = min(1.0, (second - best) / 0.55)
    return 13.0 * math.sqrt(1.0 - (1.0 - edge) ** 2) - 3.0 * best * best


def weave(i: int, j: int) -> float:
    """Bands that go over and under each other."""
    count = 6
    x, y = i * count / SIDE, j * count / SIDE
    column, row = int(x), int(y)
    round_x, round_y = (math.sqrt(max(0.0, 1.0 - (2.3 * (v % 1.0 - 0.5)) ** 2)) for v in (x, y))
    sign = 1.0 if (column + row) % 2 == 0 else -1.0
    lift_down, lift_across = math.cos(math.pi * (y % 1.0 - 0.5)) * sign, -math.cos(math.pi * (x % 1.0 - 0.5)) * sign
    down = 9.0 * round_x + 8.0 * lift_down if round_x > 0.0 else -16.0
    across = 9.0 * round_y + 8.0 * lift_across if round_y > 0.0 else -16.0
    return max(down, across, -14.0)


def main() -> None:
    build, out = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        def run(*command: str) -> None:
            subprocess.run([os.path.join(build, command[0]), *command[1:]], cwd=folder, check=True, stderr=subprocess.DEVNULL)

        for name, height in (("cobbles", cobbles), ("weave", weave)):
            with open(os.path.join(folder, name + ".r32"), "wb") as file:
                array.array("f", [height(i, j) for j in range(SIDE) for i in range(SIDE)]).tofile(file)
        maps = ((os.path.join(SAMPLES, "bricks.png"), "26", "0.5,0.2,0.12"), ("cobbles.r32", "1", "0.42,0.4,0.37"),
                ("weave.r32", "1", "0.6,0.42,0.22"))
        pictures: list[list[str]] = [[], []]
        for k, (heights, bumpiness, tint) in enumerate(maps):
            run("bake-normals", heights, "-o", f"{k}.png", "--bumpiness", bumpiness, "--occlusion-out", f"{k}_ao.png")
            for with_it in (0, 1):
                picture = f"{k}_{with_it}.png"
                run("preview-normals", f"{k}.png", "-o", picture, "--size", str(SIDE), "--ambient", "0.75", "--tint", tint,
                    "--light", "-1,1,1.1", "--light-color", "0.35", "--specular", "0.05", "--no-legend",
                    *(["--occlusion", f"{k}_ao.png"] if with_it else []))
                pictures[with_it].append(picture)
        subprocess.run(["convert", "-background", "white", "(", *pictures[0], "+smush", "6", ")", "(", *pictures[1],
                        "+smush", "6", ")", "-smush", "6", "+dither", "-colors", "128", "-strip", out],
                       cwd=folder, check=True, stderr=subprocess.DEVNULL)


main()
