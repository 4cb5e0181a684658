#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# imagemagick-dds-masks.sh: ImageMagick 6.9.11-60 (Debian 12) on two DDS files without compression, the one with blue in
# the lowest byte, the other with red there (D3DFMT_A8B8G8R8, as many exporters write it), as their channel masks say.
#
# Expected: the same picture, because the masks say which byte is which channel.
# Seen (2026-11-29): the masks are not looked at, and blue is taken from the lowest byte of both. In a normal map x and
# z are exchanged: (190, 128, 240) comes out as (240, 128, 190).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v convert-im6.q16 >/dev/null || { echo 'needs imagemagick 6.9.11-60 of Debian 12' >&2; exit 2; }
python3 - <<'PY'
import struct

side, texel = 8, (190, 128, 240, 255)
for name, order, masks in (("bgra.dds", (2, 1, 0, 3), (0xFF0000, 0xFF00, 0xFF, 0xFF000000)),
                           ("rgba.dds", (0, 1, 2, 3), (0xFF, 0xFF00, 0xFF0000, 0xFF000000))):
    # caps, height, width, pitch, pixel format; 0x100F: all of these fields are given
    head = b"DDS " + struct.pack("<7I44x", 124, 0x100F, side, side, 4 * side, 0, 0)
    head += struct.pack("<8I", 32, 0x41, 0, 32, *masks) + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
    with open(name, "wb") as file:
        file.write(head + bytes(texel[k] for k in order) * side * side)
PY
convert-im6.q16 -version | head -n 1
seen=
for name in bgra.dds rgba.dds; do
    codes=$(convert-im6.q16 "$name" -crop 1x1+0+0 -depth 8 rgb:- | od -An -tu1 | tr -s ' ')
    echo "$name:$codes"
    seen+=$codes
done
[ "$seen" = ' 190 128 240 240 128 190' ]
