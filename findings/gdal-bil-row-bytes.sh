#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# gdal-bil-row-bytes.sh: GDAL 3.6.2 (Debian 12) on a BIL file of heights whose rows are longer than their cells, as the
# words BANDROWBYTES and TOTALROWBYTES of its header say (Esri, "BIL, BIP, and BSQ raster files").
#
# Expected: the heights, without the bytes between the rows.
# Seen (2026-11-29): neither word is obeyed. Rows are read one after the other as if nothing lay between them, so that
# each begins some cells too early and the terrain is sheared; the padding becomes heights. No warning, and the exit
# status is 0.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v gdallocationinfo >/dev/null || { echo 'needs gdal-bin 3.6.2 of Debian 12' >&2; exit 2; }
python3 - <<'PY'
import struct

side, padding = 8, 4
with open("padded.bil", "wb") as file:
    for row in range(side):
        file.write(struct.pack("<8H", *(1000 + 10 * row + column for column in range(side))) + b"\xff" * padding)
with open("padded.hdr", "w", encoding="ascii") as file:
    file.write("NROWS 8\nNCOLS 8\nNBANDS 1\nNBITS 16\nLAYOUT BIL\nBYTEORDER I\n"
               "BANDROWBYTES 20\nTOTALROWBYTES 20\n")
PY
gdalinfo --version
first=$(gdallocationinfo -valonly padded.bil 0 0)
second=$(gdallocationinfo -valonly padded.bil 0 1)
last=$(gdallocationinfo -valonly padded.bil 0 7)
echo "the first heights of rows 0, 1 and 7: $first, $second, $last; the file has 1000, 1010, 1070"
[ "$(gdalinfo --version | cut -d, -f1)" = 'GDAL 3.6.2' ] && [ "$first $second $last" = '1000 65535 1056' ]
