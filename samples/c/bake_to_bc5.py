#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bake_to_bc5.c in Python, through ctypes: bake_to_bc5.py [libtex.so.1]. (The module `tex` is the comfortable way.)"""

import ctypes
import sys
from ctypes import POINTER, Structure, byref, c_float, c_int32, c_size_t, c_ssize_t, c_uint8, c_uint32

SIDE = 64
BC5_UNORM = 5


class Plane(Structure):
    _fields_ = [("data", POINTER(c_float)), ("stride", c_ssize_t), ("width", c_int32), ("height", c_int32)]


class Map(Structure):
    _fields_ = [("x", POINTER(c_float)), ("y", POINTER(c_float)), ("z", POINTER(c_float)),
                ("stride", c_ssize_t), ("width", c_int32), ("height", c_int32)]


def options(name, *members):
    """A structure of options that begins with its size."""
    kind = type(name, (Structure,), {"_fields_": [("size", c_uint32), *[(key, kind) for key, kind, _ in members]]})
    return kind(ctypes.sizeof(kind), *[value for _, _, value in members])


def main():
    tex = ctypes.CDLL(sys.argv[1] if len(sys.argv) > 1 else "libtex.so.1")
    tex.tex_error_text.restype = ctypes.c_char_p
    for function in (tex.tex_bake_size, tex.tex_mip_size, tex.tex_row_bytes, tex.tex_level_bytes):
        function.restype = c_size_t

    def check(error):
        if error != 0:
            sys.exit("bake_to_bc5: " + tex.tex_error_text(error).decode())

    texels = (c_float * (SIDE * SIDE))(*[(i * 7 + j * j * 3) % 64 / 64 for j in range(SIDE) for i in range(SIDE)])
    heights = Plane(texels, SIDE, SIDE, SIDE)
    maps = []
    for level in range(7):
        side = SIDE >> level
        planes = [(c_float * (side * side))() for _ in range(3)]
        maps.append(Map(*planes, side, side, side))

    bake = options("BakeOptions", ("kernel", c_int32, 1), ("gaussian_sigma", c_float, 1), ("bumpiness_x", c_float, 4),
                   ("bumpiness_y", c_float, 4), ("wrap_x", c_int32, 0), ("wrap_y", c_int32, 0))
    mip = options("MipOptions", *[(name, c_int32, 0) for name in ("filter", "domain", "wrap_x", "wrap_y", "fade_first",
                                                                  "fade_last", "any_z")])
    encode = options("EncodeOptions", ("encoding", c_int32, 1), ("effort", c_int32, 1), ("metric", c_int32, 0),
                     ("y_axis", c_int32, 0))

    size = max(tex.tex_bake_size(SIDE, SIDE, byref(bake)), tex.tex_mip_size(SIDE, SIDE, byref(mip)))
    scratch = ctypes.create_string_buffer(size)
    lent = (scratch, c_size_t(size))
    for first in (0, SIDE // 2):
        check(tex.tex_bake(byref(heights), byref(bake), first, first + SIDE // 2, byref(maps[0]), *lent))
    for level in range(6):
        to = maps[level + 1]
        check(tex.tex_mip_level(byref(maps[level]), level, byref(mip), 0, to.height, byref(to), *lent))
        if level > 0:
            check(tex.tex_mip_finish(byref(maps[level]), level, byref(mip), 0, maps[level].height))
    check(tex.tex_mip_finish(byref(maps[6]), 6, byref(mip), 0, 1))

    total, count = 14695981039346656037, 0
    for level in maps:
        blocks = (c_uint8 * tex.tex_level_bytes(BC5_UNORM, level.width, level.height))()
        pitch = c_size_t(tex.tex_row_bytes(BC5_UNORM, level.width))
        check(tex.tex_encode(byref(level), byref(encode), 0, level.height, blocks, pitch, None, c_size_t(0)))
        for byte in blocks:
            total = (total ^ byte) * 1099511628211 % 2**64
        count += len(blocks)
    print(f"{count} bytes of BC5, sum {total:016x}")


main()
