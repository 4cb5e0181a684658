#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# oiio-sparse-tiff.sh: oiiotool of OpenImageIO 2.4.7.1 (Debian 12) on a TIFF of floats whose only strip is not stored:
# its offset and its byte count are 0, as GDAL writes areas without data with SPARSE_OK=TRUE.
#
# Expected: zeros, or an error. GDAL 3.6.2 reads the file's no-data value.
# Seen (2026-11-28): the first bytes of the file as floats, without an error. The largest "height" here is 1234.5, which
# stands between the header and the directory.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v oiiotool >/dev/null || { echo 'needs openimageio-tools 2.4.7.1 of Debian 12' >&2; exit 2; }
python3 - <<'PY'
import struct

side = 64
# tag, type (3 short, 4 long), value: width, height, bits, no compression, black is 0, strip offset, one sample, rows,
# strip bytes, floats
tags = [(256, 3, side), (257, 3, side), (258, 3, 32), (259, 3, 1), (262, 3, 1), (273, 4, 0), (277, 3, 1),
        (278, 3, side), (279, 4, 0), (339, 3, 3)]
directory = struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", t, kind, 1, v) for t, kind, v in tags)
with open("sparse.tif", "wb") as file:  # 1234.5 lies between the header and the directory, and belongs to nothing
    file.write(b"II*\0" + struct.pack("<If", 12, 1234.5) + directory + struct.pack("<I", 0))
PY
oiiotool --version
greatest=$(oiiotool --stats sparse.tif | sed -n 's/.*Stats Max: \([^ ]*\).*/\1/p')
echo "the largest texel of a file without texels: $greatest"
[ "$(oiiotool --version)" = 2.4.7.1 ] && [ "$greatest" = 1234.500000 ]
