#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# filter_figures.py: whether filters bring damaged maps nearer to what they were, in mean degrees, for VERDICTS.md.
#
# JPEG of quality 50, 75 and 90 (4:2:0): the map after its JPEG; with the blocks of luma smoothed, and of chroma, too,
# by applying the same quantiser to shifted copies and taking their mean (Nosratinia 2001); and as the nearest surface
# (Frankot, Chellappa 1988), each channel weighted by the frequencies that it holds. Heights of 8 bits: the bake, and
# the bake after a blur of its normals by 1 texel. Needs PIL and numpy. "tune" are the maps of wild4 with an even first
# byte of the SHA-256 of their names; nothing was tuned on either half.
import hashlib
import io
import os

import numpy as np
from PIL import Image

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "shared", "data", "wild4")
LUMA = np.array([16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69, 56, 14, 17,
                 22, 29, 51, 87, 80, 62, 18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81, 104, 113, 92, 49, 64, 78,
                 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99.0]).reshape(8, 8)
CHROMA = np.full((8, 8), 99.0)
CHROMA[:4, :4] = [[17, 18, 24, 47], [18, 21, 26, 66], [24, 26, 56, 99], [47, 66, 99, 99]]
COSINES = np.array([[(np.sqrt(0.125) if u == 0 else 0.5) * np.cos((2 * x + 1) * u * np.pi / 16) for x in range(8)]
                    for u in range(8)])
YCC = np.array([[0.299, 0.587, 0.114], [-0.168736, -0.331264, 0.5], [0.5, -0.418688, -0.081312]])


def maps(count=60):
    with open(os.path.join(DATA, "labels.tsv"), encoding="utf-8") as file:
        rows = [line.rstrip("\n").split("\t") for line in file][1:]
    names = sorted(row[0] for row in rows if row[1] == "normal" and not row[2] and row[0].endswith(".png"))
    for k in range(count):
        name = names[k * len(names) // count]
        codes = np.asarray(Image.open(os.path.join(DATA, name)).convert("RGB"))
        height, width = codes.shape[:2]
        side = min(height, width, 512) // 16 * 16
        if side < 64:
            continue
        y, x = (height - side) // 16 * 8, (width - side) // 16 * 8
        tune = hashlib.sha256(os.path.basename(name).encode()).digest()[0] % 2 == 0
        yield tune, codes[y:y + side, x:x + side]


def vectors(codes):
    v = codes / 127.5 - 1
    return v / np.maximum(np.linalg.norm(v, axis=2, keepdims=True), 1e-6)


def codes_of(v):
    return np.clip(np.round((v + 1) * 127.5), 0, 255).astype(np.uint8)


def degrees(a, b):
    u, v = vectors(a), vectors(b)
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(u, v), axis=2), (u * v).sum(2))).mean()


def quantised(plane, steps):
    height, width = plane.shape
    blocks = plane.reshape(height // 8, 8, width // 8, 8).transpose(0, 2, 1, 3)
    kept = np.round(COSINES @ blocks @ COSINES.T / steps) * steps
    return (COSINES.T @ kept @ COSINES).transpose(0, 2, 1, 3).reshape(height, width)


def smoothed(plane, steps):
    height, width = plane.shape
    wide = np.pad(plane, 8, mode="edge")
    total = np.zeros_like(plane)
    for dy in range(0, 8, 2):
        for dx in range(0, 8, 2):
            one = quantised(wide[dy:dy + height + 8, dx:dx + width + 8], steps)
            total += one[8 - dy:8 - dy + height, 8 - dx:8 - dx + width]
    return total / 16


def deblocked(codes, quality, chroma):
    scale = 50 / quality if quality < 50 else 2 - quality / 50
    ycc = codes.astype(float) @ YCC.T
    ycc[..., 0] = smoothed(ycc[..., 0] - 128, np.maximum(1, np.floor(LUMA * scale + 0.5))) + 128
    for c in (1, 2) if chroma else ():
        plane = ycc[..., c]
        half = plane.reshape(plane.shape[0] // 2, 2, -1, 2).mean((1, 3))
        more = smoothed(half, np.maximum(1, np.floor(CHROMA * scale + 0.5))) - half
        ycc[..., c] = plane + np.repeat(np.repeat(more, 2, 0), 2, 1)
    return np.clip(np.round(ycc @ np.linalg.inv(YCC).T), 0, 255).astype(np.uint8)


def as_surface(codes):
    v = vectors(codes)
    z = np.maximum(v[..., 2], 0.1)
    p, q = -v[..., 0] / z, -v[..., 1] / z
    height, width = p.shape
    p, q = (np.pad(s, ((0, height), (0, width)), mode="symmetric") for s in (p, q))
    p[:, width:] *= -1
    q[height:, :] *= -1
    fy, fx = np.fft.fftfreq(2 * height)[:, None], np.fft.fftfreq(2 * width)[None, :]
    length = np.sqrt(fx ** 2 + fy ** 2)
    length[0, 0] = 1
    ux, uy = fx / length, -fy / length
    chroma = (np.cos(np.pi * fx) * np.cos(np.pi * fy)) ** 2 * (abs(fx) < 0.25) * (abs(fy) < 0.25)
    of_p, of_q = np.fft.fft2(p), np.fft.fft2(q)
    total, weights = 0, 0.02
    for a, b, held in ((0.299, 0.587, 1.0), (0.5, -0.419, chroma), (-0.169, -0.331, chroma)):
        along = held * (a * ux + b * uy)
        total = total + along * held * (a * of_p + b * of_q)
        weights = weights + along ** 2
    surface = total / weights
    p, q = (np.fft.ifft2(u * surface).real[:height, :width] for u in (ux, uy))
    return codes_of(np.stack([-p, -q, np.ones_like(p)], 2) / np.sqrt(1 + p * p + q * q)[..., None])


def bumps(rng, side=256):
    noise = np.fft.fft2(rng.standard_normal((side, side)))
    f = np.sqrt(np.fft.fftfreq(side)[:, None] ** 2 + np.fft.fftfreq(side)[None, :] ** 2)
    heights = np.fft.ifft2(noise * np.exp(-(f * 30) ** 2)).real
    return (heights - heights.min()) / np.ptp(heights)


def baked(heights, strength):
    p = strength * (np.roll(heights, -1, 1) - np.roll(heights, 1, 1)) / 2
    q = strength * (np.roll(heights, 1, 0) - np.roll(heights, -1, 0)) / 2
    return codes_of(np.stack([-p, -q, np.ones_like(p)], 2) / np.sqrt(1 + p * p + q * q)[..., None])


def blurred(codes, sigma=1.0):
    kernel = np.exp(-np.arange(-3, 4) ** 2 / (2 * sigma ** 2))
    kernel /= kernel.sum()
    v = vectors(codes)
    for axis in (0, 1):
        v = sum(k * np.roll(v, s, axis) for s, k in zip(range(-3, 4), kernel))
    return codes_of(v / np.linalg.norm(v, axis=2, keepdims=True))


def main():
    rows = {}
    for tune, codes in maps():
        for quality in (50, 75, 90):
            stream = io.BytesIO()
            Image.fromarray(codes).save(stream, "JPEG", quality=quality, subsampling=2)
            jpeg = np.asarray(Image.open(stream))
            results = [jpeg, deblocked(jpeg, quality, False), deblocked(jpeg, quality, True)]
            flipped = jpeg.copy()
            flipped[..., 1] = 255 - flipped[..., 1]
            down = as_surface(flipped)
            down[..., 1] = 255 - down[..., 1]
            angles = [degrees(codes, result) for result in results]
            angles.append(min(degrees(codes, as_surface(jpeg)), degrees(codes, down)))
            rows.setdefault((quality, tune), []).append(angles)
    for (quality, tune), angles in sorted(rows.items()):
        all_of = np.array(angles)
        better = (all_of[:, 1:] < all_of[:, :1]).sum(0)
        print(f"JPEG {quality}, {'tune' if tune else 'held out'}, {len(all_of)} maps: mean", all_of.mean(0).round(3),
              "nearer", better)
    rng = np.random.default_rng(1)
    for strength in (10.0, 40.0):
        heights = bumps(rng)
        true, rounded = baked(heights, strength), baked(np.round(heights * 255) / 255, strength)
        print(f"heights of 8 bits, strength {strength}: {degrees(true, rounded):.2f}, blurred "
              f"{degrees(true, blurred(rounded)):.2f}")


if __name__ == "__main__":
    main()
