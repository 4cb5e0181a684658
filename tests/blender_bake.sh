#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# blender_bake.sh [BUILD]: Blender's Cycles ("Selected to Active") and samples/python/blender_transfer.py, with the
# module of BUILD (build/release), make the normal map of the crates in samples. Rays leave along the stored normals.
# Both must miss the same texels, and agree on the others. By hand, because Blender takes 600 MB:
# apt-get install --no-install-recommends blender
#
# Last result: 2026-11-26, Blender 3.4.1 of Debian 12, programs and module of 4d26e5d: 885,680 texels, mean 0.003,
# largest 0.095 degrees; of 3,568 missed texels, Blender misses 99.9 %, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source=$PWD
build=$(realpath "${1:-build/release}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
export PYTHONPATH=$build/python:$source/samples/python

# blender_runs ARGUMENT...: a failure of the script is one of this test.
blender_runs() { blender -b --python-exit-code 1 "$@" >log 2>&1 || { cat log; exit 1; }; }

cat >prepare.py <<END_OF_SCRIPT
import bpy
import numpy as np
np.bool = bool  # the importer of 3.4 wants it, and NumPy has none since 1.24
bpy.ops.wm.read_factory_settings(use_empty=True)
for name in ("crate_low", "crate_high"):
    bpy.ops.import_scene.gltf(filepath=f"$source/samples/{name}.glb", merge_vertices=True)
    thing = bpy.context.selected_objects[0]
    thing.name = name
    thing.rotation_euler = (0.3, 0.4, 0.5)
    thing.scale = (1, 2, 3)
high, low = thing, bpy.data.objects["crate_low"]
low.select_set(True)
bpy.context.view_layer.objects.active = low
bpy.ops.wm.save_as_mainfile(filepath="$scratch/crates.blend")
END_OF_SCRIPT
cat >judge.py <<END_OF_SCRIPT
import bpy
import numpy as np
from blender_transfer import transfer
SIDE, REACH = 1024, 0.2
low, high = (bpy.data.objects[name] for name in ("crate_low", "crate_high"))
for thing in (low, high):  # Cycles measures distances in the scene
    thing.rotation_euler, thing.scale = (0, 0, 0), (1, 1, 1)
bpy.context.view_layer.update()
image = bpy.data.images.new("bake", SIDE, SIDE, float_buffer=True, is_data=True)
for thing in (low, high):
    material = bpy.data.materials.new(thing.name)
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    thing.data.materials.clear()
    thing.data.materials.append(material)
bpy.context.scene.render.engine = "CYCLES"
bpy.context.scene.cycles.samples = 1
bpy.context.scene.cycles.use_denoising = False  # or all normals are (0, 0, 0)
bpy.ops.object.bake(type="NORMAL", use_selected_to_active=True, cage_extrusion=REACH, max_ray_distance=2 * REACH,
                    margin=0, use_clear=True)
theirs = np.empty(SIDE * SIDE * 4, np.float32)
image.pixels.foreach_get(theirs)
theirs = theirs.reshape(SIDE, SIDE, 4)[::-1, :, :3] * 2.0 - 1.0
maps = transfer(low, [high], SIDE, rays="vertex", front=REACH, back=REACH)
hit, missed = maps["origin"] == 3, maps["origin"] == 2
turned = np.linalg.norm(np.cross(theirs, maps["map"]), axis=-1)
degrees = np.degrees(np.arctan2(turned, (theirs * maps["map"]).sum(-1)))[hit]
flat = (np.linalg.norm(theirs[missed] - [0, 0, 1], axis=-1) < 0.01).mean()  # but for some at the border
print(f"RESULT {hit.sum()} texels: mean {degrees.mean():.4f}, p99 {np.percentile(degrees, 99):.4f}, largest "
      f"{degrees.max():.4f} degrees; {missed.sum()} missed here, {100 * flat:.1f} % of them there, too")
assert hit.sum() > 800000 and degrees.mean() < 0.01 and degrees.max() < 0.5 and missed.sum() > 0 and flat > 0.98
END_OF_SCRIPT
blender_runs -P prepare.py
blender_runs crates.blend -P "$source/samples/python/blender_transfer.py" -- crate.dds 512
"$build/check-normals" crate.dds --require format=dxt5nm --require mips=full --require y=up
# Scaled and turned alike, they make the same map as where they were stored.
"$build/transfer-normals" "$source"/samples/crate_{low,high}.glb -o stored.dds --extent 512 --decoder blender
"$build/compare-normals" crate.dds stored.dds --max-mean 0.1 --max-p999 3
blender_runs crates.blend -P judge.py
sed -n 's/^RESULT //p' log
echo "blender_bake.sh: passed with $(blender --version | head -n 1)"
