#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bake_folder.py FOLDER OUT: bakes every height map of a folder to DXT5nm, and prints how steep each one is."""

import sys
from pathlib import Path

import tex


def main(folder, out):
    out.mkdir(parents=True, exist_ok=True)
    failed = 0
    for path in sorted(folder.glob("*.png")):
        try:
            field = tex.height_field(tex.read_image(path))
            n = tex.bake(field, bumpiness=8, kernel="scharr")
            texture = tex.pack(tex.build_mip_chain(n), "dxt5nm")
            tex.write_texture(out / f"{path.stem}.dds", texture)
        except tex.Error as error:
            print(f"bake_folder: error: {error}", file=sys.stderr)
            failed += 1
            continue
        (x0, x1), (y0, y1) = tex.slope_range(n).values()
        print(f"{path.name}: slopes from {min(x0, y0):.1f} to {max(x1, y1):.1f}")
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
