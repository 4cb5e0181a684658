#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# imagemagick-png-gamma.sh: ImageMagick 6.9.11-60 (Debian 12) on a flat normal map, a PNG whose chunk gAMA says 1.0, as
# programs write that mark their maps as linear.
#
# Expected: the same codes, 128 128 255, in every file type, since no conversion was asked for.
# Seen (2026-11-29): PNG, TIFF and BMP keep them. DDS and TGA get 188 188 255, as if colours had been encoded as
# sRGB, and nothing is printed: a flat surface leans by 34 degrees in those. Without the chunk all keep 128 128 255.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v convert-im6.q16 >/dev/null || { echo 'needs imagemagick 6.9.11-60 of Debian 12' >&2; exit 2; }
python3 - <<'PY'
import struct
import zlib

side = 8


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


head = chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0))
# One texel differs a little, so that no file type takes a palette of one colour.
rows = b"".join(b"\0" + bytes([128, 128, 255] * (side - 1) + [128, 129 + j, 254]) for j in range(side))
for name, gamma in (("linear.png", chunk(b"gAMA", struct.pack(">I", 100000))), ("plain.png", b"")):
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + head + gamma + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
PY
convert-im6.q16 -version | head -n 1
seen=
for name in plain linear; do
    for type in png tif bmp tga dds; do
        convert-im6.q16 "$name.png" -define dds:compression=none "$name.$type"
        # The first texel as the file has it: TGA and DDS without compression hold blue first.
        codes=$(python3 - "$name.$type" <<'PY'
import subprocess
import sys

file = sys.argv[1]
data = open(file, "rb").read()
start = {"dds": 128, "tga": 18 + data[0]}.get(file[-3:])
if start is not None:
    print(*data[start : start + 3][::-1])
else:
    read = ["convert-im6.q16", file, "-set", "colorspace", "sRGB", "-crop", "1x1+0+0", "-depth", "8", "rgb:-"]
    print(*subprocess.run(read, capture_output=True, check=True).stdout[:3])
PY
        )
        echo "$name.$type: $codes"
        seen+="$codes;"
    done
done
same='128 128 255;' turned='188 188 255;'
[ "$seen" = "$same$same$same$same$same$same$same$same$turned$turned" ]
