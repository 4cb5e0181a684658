# SPDX-License-Identifier: Apache-2.0
"""Bakes an image of a .blend file to a normal map, without a window:

blender -b rock.blend -P blender_bake.py -- Height out/rock.dds

The image datablock `Height` is a height map. The file out/rock.dds is for the engine, and the image `Height normals`,
saved in the .blend file, is for Blender's Normal Map node. Set its colour space to Non-Color if you copy this.
"""

import sys

import bpy
import numpy as np
import tex


def heights_of(image):
    """The red channel, with rows from the top. Blender's rows begin at the bottom."""
    width, height = image.size
    texels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(texels)
    return texels.reshape(height, width, 4)[::-1, :, 0]


def store(name, n):
    """Stores a map as an image datablock: (n + 1) / 2, y up."""
    height, width, _ = n.shape
    image = bpy.data.images.new(name, width, height, float_buffer=True, is_data=True)
    texels = np.ones((height, width, 4), np.float32)
    texels[..., :3] = n[::-1] * 0.5 + 0.5
    image.pixels.foreach_set(texels.ravel())
    image.pack()
    image.use_fake_user = True  # or Blender does not save what no material uses
    return image


def main(name, output):
    n = tex.bake(heights_of(bpy.data.images[name]), bumpiness=8)
    tex.write_texture(output, tex.pack(tex.build_mip_chain(n), "dxt5nm"))
    store(f"{name} normals", n)
    bpy.ops.wm.save_mainfile()


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 :])
