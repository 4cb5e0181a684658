#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# jpeg-quality-chroma.sh: what the quality of a JPEG costs a normal map with fine bumps, by Pillow 9.4.0 and ImageMagick
# 6.9.11-60 (Debian 12). Mean angles to the map, in degrees.
#
# Expected: quality 100 costs next to nothing in both, and less the higher it is.
# Seen (2026-11-30): Pillow halves the resolution of chroma at every quality, unless subsampling=0 is given: 12.6 at
# quality 75, and still 11.4 at 100, in a file of twice the size of quality 75 with whole chroma, which costs 7.5.
# ImageMagick keeps chroma whole from quality 90 on: 11.7 at 89, 3.8 at 90, 0.4 at 100. The difference of x and y is in
# chroma alone, so that one step of quality decides.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
/usr/bin/python3 -c 'import PIL, numpy' 2>/dev/null || { echo 'needs python3-pil 9.4.0 and python3-numpy' >&2; exit 2; }
command -v convert >/dev/null || { echo 'needs imagemagick 6.9.11-60 of Debian 12' >&2; exit 2; }
convert -version | head -1
/usr/bin/python3 - <<'PY'
import os
import subprocess

import numpy as np
import PIL
from PIL import Image

print("Pillow", PIL.__version__)
i, j = np.meshgrid(np.arange(256), np.arange(256))
p = 0.5 * np.cos(2.1 * i + 1.4 * j)  # slopes of bumps of three texels
q = 0.33 * np.cos(2.1 * i + 1.4 * j) + 0.4 * np.sin(0.9 * i - 1.7 * j)
normals = np.dstack([-p, -q, np.ones_like(p)])
normals /= np.linalg.norm(normals, axis=2, keepdims=True)
picture = Image.fromarray(np.round((0.5 * normals + 0.5) * 255).astype(np.uint8))
picture.save("map.png")


def angle(file):
    vectors = np.asarray(Image.open(file)).astype(float) / 127.5 - 1
    vectors /= np.linalg.norm(vectors, axis=2, keepdims=True)
    return np.degrees(np.arccos(np.clip((vectors * normals).sum(axis=2), -1, 1))).mean()


def by_pillow(**options):
    picture.save("map.jpg", "JPEG", **options)
    print("Pillow", options, f"{angle('map.jpg'):.1f} degrees, {os.path.getsize('map.jpg')} bytes")
    return angle("map.jpg")


def by_imagemagick(quality):
    subprocess.run(["convert", "map.png", "-quality", str(quality), "map.jpg"], check=True)
    print("ImageMagick", quality, f"{angle('map.jpg'):.1f} degrees, {os.path.getsize('map.jpg')} bytes")
    return angle("map.jpg")


assert PIL.__version__ == "9.4.0"
assert by_pillow(quality=75) > 12 and by_pillow(quality=100) > 11
assert by_pillow(quality=75, subsampling=0) < 8
assert by_imagemagick(89) > 11
assert by_imagemagick(90) < 4 and by_imagemagick(100) < 0.5
PY
