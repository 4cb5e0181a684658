# SPDX-License-Identifier: Apache-2.0
"""blender -b -P lit_blender.py -- FOLDER MAP PICTURE SIDE: draws the sphere of FOLDER/sphere.json with a normal map
under a light. Blender makes the tangents itself.

The light is computed by nodes from the normals of the Normal Map node: Blender's own diffuse surfaces darken slopes
that face away from the geometry's light, which a GPU does not.
"""

import json
import sys

import bpy
from mathutils import Vector

folder, normal_map, picture, side = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
with open(f"{folder}/sphere.json") as file:
    arrays = json.load(file)
normals = [(x, -z, y) for x, y, z in zip(*[iter(arrays["normals"])] * 3)]
mesh = bpy.data.meshes.new("sphere")
mesh.from_pydata(normals, [], list(zip(*[iter(arrays["indices"])] * 3)))
uvs = mesh.uv_layers.new()
for loop in mesh.loops:
    u, v = arrays["uvs"][2 * loop.vertex_index:2 * loop.vertex_index + 2]
    uvs.data[loop.index].uv = (u, 1 - v)
mesh.use_auto_smooth = True
mesh.normals_split_custom_set_from_vertices(normals)
sphere = bpy.data.objects.new("sphere", mesh)
bpy.context.scene.collection.objects.link(sphere)

material = bpy.data.materials.new("lit")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
nodes.clear()
texture, bump, cosine, positive, tint, emission, output = (
    nodes.new("ShaderNode" + kind)
    for kind in ("TexImage", "NormalMap", "VectorMath", "Math", "Math", "Emission", "OutputMaterial"))
texture.image = bpy.data.images.load(normal_map)
texture.image.colorspace_settings.name = "Non-Color"
cosine.operation, positive.operation, tint.operation = "DOT_PRODUCT", "MAXIMUM", "MULTIPLY"
light = Vector((-0.8, -1.2, 1.0)).normalized()  # Blender's z points up
cosine.inputs[1].default_value = light
positive.inputs[1].default_value, tint.inputs[1].default_value = 0.0, 0.6
links.new(texture.outputs["Color"], bump.inputs["Color"])
links.new(bump.outputs["Normal"], cosine.inputs[0])
links.new(cosine.outputs["Value"], positive.inputs[0])
links.new(positive.outputs["Value"], tint.inputs[0])
links.new(tint.outputs["Value"], emission.inputs["Strength"])
links.new(emission.outputs["Emission"], output.inputs["Surface"])
sphere.data.materials.clear()
sphere.data.materials.append(material)

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.type, camera.data.ortho_scale = "ORTHO", 2.12
camera.location, camera.rotation_euler = (0.0, -10.0, 0.0), (1.5707963, 0.0, 0.0)
scene = bpy.context.scene
scene.collection.objects.link(camera)
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 64, False, "BOX"
scene.render.resolution_x = scene.render.resolution_y = int(side)
scene.render.image_settings.color_mode, scene.render.dither_intensity = "RGB", 0.0
scene.view_settings.view_transform = "Standard"
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
