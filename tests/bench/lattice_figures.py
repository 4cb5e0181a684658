#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# lattice_figures.py: what repair-normals --likely makes of slopes on a lattice (N305), for VERDICTS.md.
#
#     lattice_figures.py BUILD
#
# Heights that have more than 8 bits, made here and from ../shared/data, are baked by numpy with central differences,
# once as they are and once rounded to 256 values, and stored with 8 bits. The command gets the coarse map alone; the
# judge is the mean angle to the fine one. "tune" are the heights that thresholds were set on. Needs PIL, numpy, GDAL.
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal
from PIL import Image

HEIGHTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "shared", "data", "height")
gdal.UseExceptions()


def stretched(heights):
    return (heights - heights.min()) / np.ptp(heights)


def noise(seed, smooth=None, power=None, side=256):
    spectrum = np.fft.fft2(np.random.default_rng(seed).standard_normal((side, side)))
    f = np.hypot(np.fft.fftfreq(side)[:, None], np.fft.fftfreq(side)[None, :])
    if power is None:
        weights = np.exp(-(f * smooth) ** 2)
    else:
        weights = 1 / np.maximum(f, 1 / side) ** power
        weights[0, 0] = 0
    return stretched(np.fft.ifft2(spectrum * weights).real)


def domes(seed, count, side=256):
    rng = np.random.default_rng(seed)
    heights = np.zeros((side, side))
    y, x = np.mgrid[:side, :side]
    for _ in range(count):
        cx, cy = rng.random(2) * side
        radius = rng.uniform(0.05, 0.2) * side
        dx, dy = np.abs(x - cx), np.abs(y - cy)
        dx, dy = np.minimum(dx, side - dx), np.minimum(dy, side - dy)
        heights = np.maximum(heights, np.sqrt(np.maximum(0, radius * radius - dx * dx - dy * dy)))
    return stretched(heights)


def real(name, x=0, y=0, side=512):
    plane = gdal.Open(os.path.join(HEIGHTS, name)).ReadAsArray().astype(float)
    plane = plane[0] if plane.ndim == 3 else plane
    return stretched(plane[y:y + side, x:x + side])


def slopes(heights, bumpiness, repeats):
    wide = np.pad(heights, 1, mode="wrap" if repeats else "edge")
    return bumpiness * (wide[1:-1, 2:] - wide[1:-1, :-2]) / 2, bumpiness * (wide[:-2, 1:-1] - wide[2:, 1:-1]) / 2


def normals(p, q, y_sign):
    return np.stack([-p, -q * y_sign, np.ones_like(p)], 2) / np.sqrt(1 + p * p + q * q)[..., None]


def degrees(u, v):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(u, v), axis=2), (u * v).sum(2))).mean()


def stored(n):
    return np.clip(np.round((n + 1) * 127.5), 0, 255).astype(np.uint8)


def read(path):
    v = np.asarray(Image.open(path)) / 127.5 - 1
    return v / np.maximum(np.linalg.norm(v, axis=2, keepdims=True), 1e-6)


def judge(build, heights, bumpiness, repeats, folder):
    coarse, fine = os.path.join(folder, "coarse.png"), os.path.join(folder, "fine.png")
    y_sign = 1 if repeats else -1
    true = normals(*slopes(heights, bumpiness, repeats), y_sign)
    Image.fromarray(stored(normals(*slopes(np.round(heights * 255) / 255, bumpiness, repeats), y_sign))).save(coarse)
    ran = subprocess.run([os.path.join(build, "repair-normals"), coarse, "-o", fine, "--likely", "--only", "N305",
                          "--json", "--no-sync"], capture_output=True, text=True, check=False)
    line = json.loads(ran.stdout.splitlines()[0])
    found = bool(line["repairs"]) or any(one["id"] == "N305" for one in line["left"])
    return found, bool(line["repairs"]), degrees(read(coarse), true), degrees(read(fine), true)


def main():
    sets = {
        "tune": [noise(1, 30), noise(2, 60), noise(3, 15), noise(4, power=2.2), noise(5, power=3), domes(1, 12),
                 real("dem_mt_fuji_smart_512x512_u16.png"), real("metal_plate_disp_1k_1024x1024_u16.png"),
                 real("dem_puget_sound_1025x1025_u16.png")],
        "held out": [noise(11, 25), noise(12, 80), noise(13, 18), noise(14, power=2.5), noise(15, power=2), domes(7, 30),
                     real("dem_landscape_200x125_f32_metres.tif"), real("elevation_map_250x195_rgb16_equal.png"),
                     real("dem_puget_sound_1025x1025_u16.png", 0, 512)]}
    with tempfile.TemporaryDirectory() as folder:
        for half, all_heights in sets.items():
            rows = [judge(sys.argv[1], heights, bumpiness, repeats, folder) for heights in all_heights
                    for bumpiness in (14, 24, 40) for repeats in (True, False)]
            found = [row for row in rows if row[0]]
            mended = np.array([row[2:] for row in found if row[1]])
            ratios = mended[:, 1] / mended[:, 0]
            print(f"{half}: {len(rows)} maps, {len(found)} found, {len(mended)} smoothed; {mended[:, 0].mean():.2f} to "
                  f"{mended[:, 1].mean():.2f} degrees; ratio {np.median(ratios):.2f} in the median, {ratios.min():.2f} "
                  f"to {ratios.max():.2f}")


if __name__ == "__main__":
    main()
