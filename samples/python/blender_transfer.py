# SPDX-License-Identifier: Apache-2.0
"""Makes the normal map of an object from others, as "Selected to Active" does, without Cycles and without a window:

blender -b rock.blend -P blender_transfer.py -- out/rock.dds 2048 rock_low rock_high

The first object gets the map; the others are hit. Without names, these are the active object and the other selected
ones. The image datablock `rock_low normals`, saved in the .blend file, is for Blender's Normal Map node.
"""

import sys

import bpy
import numpy as np
import tex
from mathutils import Matrix


def numbers(collection, name, width, kind=np.float32):
    """An attribute of all elements, as rows of `width`."""
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, values)
    return values.reshape(-1, width)


def part_of(thing, place, with_uvs=False):
    """The triangles of an object with its modifiers, moved by the matrix `place`. Each corner is a vertex."""
    shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    mesh.calc_normals_split()
    mesh.calc_loop_triangles()
    corners = numbers(mesh.loop_triangles, "loops", 3, np.int32)
    if place.determinant() < 0:  # it mirrors
        corners = corners[:, ::-1]
    corners = corners.ravel()
    move = np.array(place, np.float64)
    points = numbers(mesh.vertices, "co", 3)[numbers(mesh.loops, "vertex_index", 1, np.int32)[corners, 0]]
    normals = numbers(mesh.loops, "normal", 3)[corners] @ np.linalg.inv(move[:3, :3])
    uvs = [numbers(mesh.uv_layers.active.data, "uv", 2)[corners]] if with_uvs else []
    shown.to_mesh_clear()
    return tex.MeshPart(
        positions=(points @ move[:3, :3].T + move[:3, 3]).astype(np.float32),
        indices=np.arange(len(corners), dtype=np.uint32).reshape(-1, 3),
        normals=(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-20)).astype(np.float32),
        uvs=uvs,
        name=thing.name,
    )


def transfer(low, high, side, **options):
    """What tex.transfer() makes of objects. Lengths are in the space of `low`."""
    space = tex.select_part(tex.Mesh([part_of(low, Matrix.Identity(4), with_uvs=True)]))
    to_low = low.matrix_world.inverted()
    parts = [part_of(thing, to_low @ thing.matrix_world) for thing in high]
    return tex.transfer((side, side), space, parts, decoder="blender", **options)


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


def main(output, side, *names):
    if names:
        low, *high = (bpy.data.objects[name] for name in names)
    else:
        low = bpy.context.view_layer.objects.active
        high = [thing for thing in bpy.context.selected_objects if thing != low]
    maps = transfer(low, high, int(side))
    print(f"{maps['missed']} of {maps['covered']} texels are missed")
    tex.write_texture(output, tex.pack(tex.build_mip_chain(maps["map"]), "dxt5nm"))
    store(f"{low.name} normals", maps["map"])
    bpy.ops.wm.save_mainfile()


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 :])
