#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bump.py: writes bump.png, a height map of 128x128 texels: a bump in the upper left corner of a plane.

A bump of BUMPINESS texels is 45 degrees steep at its steepest.
"""

import math
import struct
import zlib

SIDE, CENTRE, RADIUS = 128, (34, 36), 26
BUMPINESS = RADIUS * 3 * math.sqrt(3) / 8  # h = (1 - r^2)^2 is steepest at r^2 = 1/3


def height(x, y):
    r2 = ((x + 0.5 - CENTRE[0]) ** 2 + (y + 0.5 - CENTRE[1]) ** 2) / RADIUS ** 2
    return (1 - r2) ** 2 if r2 < 1 else 0


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def main():
    rows = b"".join(b"\0" + struct.pack(f">{SIDE}H", *(round(65535 * height(x, y)) for x in range(SIDE)))
                    for y in range(SIDE))
    with open("bump.png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 16, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    print(f"{BUMPINESS:.2f}")


if __name__ == "__main__":
    main()
