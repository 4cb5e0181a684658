#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# pillow-dds-x8.sh: Pillow 9.4.0 (Debian 12) on a DDS file without compression whose texels have 32 bits and no alpha
# (D3DFMT_X8R8G8B8, which exporters write for opaque maps).
#
# Expected: R, G and B of each texel, and the fourth byte skipped.
# Seen (2026-11-29): three bytes are taken for each texel, whatever the header says of its size. From the second texel
# on channels are shifted, and the last quarter of the picture is missing without an error. A flat normal map, 128 128
# 255, becomes stripes.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
/usr/bin/python3 -c 'import PIL' 2>/dev/null || { echo 'needs python3-pil 9.4.0 of Debian 12' >&2; exit 2; }
/usr/bin/python3 - <<'PY'
import struct

import PIL
from PIL import Image

side = 8
head = b"DDS " + struct.pack("<7I44x", 124, 0x100F, side, side, 4 * side, 0, 0)
head += struct.pack("<8I", 32, 0x40, 0, 32, 0xFF0000, 0xFF00, 0xFF, 0) + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
with open("flat.dds", "wb") as file:
    file.write(head + bytes([255, 128, 128, 0]) * side * side)
print("Pillow", PIL.__version__)
picture = Image.open("flat.dds")
texels = [picture.getpixel((k, 0)) for k in range(4)]
print(picture.mode, *texels)
assert PIL.__version__ == "9.4.0"
assert texels == [(128, 128, 255), (128, 255, 0), (255, 0, 128), (0, 128, 128)], texels
PY
