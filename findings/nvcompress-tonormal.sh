#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# nvcompress-tonormal.sh: nvcompress 2.0.8 (Debian 12, libnvtt-bin) makes a normal map of a height map that is one round
# hill in the middle.
#
# Expected: red is above 128 on the right flank of the hill, green above 128 on the upper or on the lower one, and both
# are 128 on its top.
# Seen (2026-11-30): red is below 128 on the right flank, and green on the lower one: as DirectX reads it, the hill is a
# dent; as OpenGL does, red alone is mirrored, and no way of turning green makes a hill of it. The level texel lies a
# texel to the left of the top and one above it. Heights from 0 to 1 get the slopes of 0 to 28.7 texels, and no
# option sets another strength.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v nvcompress >/dev/null || { echo 'needs libnvtt-bin 2.0.8 of Debian 12' >&2; exit 2; }
dpkg-query -W -f '${Package} ${Version}\n' libnvtt-bin
/usr/bin/python3 -c '
import math
from PIL import Image
picture = Image.new("L", (128, 128))
picture.putdata([round(230 * math.exp(-((k % 128 - 64) ** 2 + (k // 128 - 64) ** 2) / 512)) for k in range(128 * 128)])
picture.convert("RGB").save("hill.png")'
nvcompress -tonormal -rgb -nomips -repeat hill.png hill.dds >/dev/null
/usr/bin/python3 - <<'PYTHON'
texels = open("hill.dds", "rb").read()[128:]
def red_green(column, row):
    blue, green, red, alpha = texels[4 * (128 * row + column):][:4]
    return red, green
places = {"right": (80, 64), "left": (48, 64), "above": (64, 48), "below": (64, 80), "top": (64, 64),
          "off top": (63, 63)}
seen = {name: red_green(*place) for name, place in places.items()}
for name, codes in seen.items():
    print(f"{name}: red {codes[0]}, green {codes[1]}")
assert seen["right"][0] < 60 and seen["left"][0] > 195, "red"
assert seen["below"][1] < 60 and seen["above"][1] > 195, "green"
assert all(abs(code - 127.5) < 2 for code in seen["off top"]), "the level texel"
assert all(abs(code - 127.5) > 3 for code in seen["top"]), "the top"
PYTHON
