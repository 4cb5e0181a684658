#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# gimp-scale-linear.sh: GIMP 2.10.34 (Debian 12) on a normal map of 8 bits whose columns lean to the right and to the
# left by 37 degrees in turn, which is level in the mean.
#
# Expected: scaled to half and blurred, red is 128 in both, the mean of its codes 204 and 51; GIMP may do both in linear
# light or neither.
# Seen (2026-11-30): a Gaussian blur gives 128, scaling 153: codes are taken for sRGB, averaged as light, and encoded
# again. What ought to be level leans by 14 degrees to the right. A precision of 16 bits does not change it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
command -v gimp >/dev/null || { echo 'needs gimp 2.10.34 of Debian 12' >&2; exit 2; }
/usr/bin/python3 -c '
from PIL import Image
picture = Image.new("RGB", (64, 64))
picture.putdata([(204 if k % 2 == 0 else 51, 128, 230) for k in range(64 * 64)])
picture.save("n.png")'
gimp --version
# Loads n.png, runs the steps, writes $1.
edit() {
    gimp -i -d -f -b "(let* ((image (car (gimp-file-load RUN-NONINTERACTIVE \"n.png\" \"n.png\")))
                             (layer (car (gimp-image-get-active-layer image))))
        $2
        (file-png-save RUN-NONINTERACTIVE image (car (gimp-image-get-active-layer image)) \"$1\" \"$1\" 0 9 0 0 0 0 0)
        (gimp-quit 0))" >/dev/null 2>&1
}
edit blurred.png '(plug-in-gauss RUN-NONINTERACTIVE image layer 8 8 0)'
edit scaled.png '(gimp-image-scale image 32 32)'
edit deep.png '(gimp-image-convert-precision image PRECISION-U16-GAMMA) (gimp-image-scale image 32 32)
    (gimp-image-convert-precision image PRECISION-U8-GAMMA)'
seen=
for name in blurred scaled deep; do
    codes=$(/usr/bin/python3 -c "
from PIL import Image
picture = Image.open('$name.png').convert('RGB')
print(*picture.getpixel((picture.width // 2, picture.height // 2)))")
    echo "$name: $codes"
    seen+="$codes;"
done
[ "$seen" = '128 128 230;153 128 230;153 128 230;' ]
