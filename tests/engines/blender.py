# SPDX-License-Identifier: Apache-2.0
"""blender -b -P blender.py: Blender draws each case of cases.json in the current folder, as page.js has engines of the
web do it. Cycles draws; models come through the importer of glTF that Blender has.
"""

import json
import pathlib

import bpy
from mathutils import Vector


def add(kind, data):
    thing = bpy.data.objects.new(kind, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def image_node(material, name):
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(str(pathlib.Path(name).resolve()))
    node.image.colorspace_settings.name = "Non-Color"
    return node


def own_square(case):
    """Blender's own plane, which stands up to face the camera."""
    bpy.ops.mesh.primitive_plane_add(size=2, rotation=(1.5707963, 0, 0))
    material = bpy.data.materials.new("lit")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    normal, diffuse, output = (nodes.new("ShaderNode" + kind) for kind in ("NormalMap", "BsdfDiffuse", "OutputMaterial"))
    if "DirectX" in case["place"]:
        normal.convention = "DIRECTX"
    diffuse.inputs["Color"].default_value = (0.6, 0.6, 0.6, 1)
    links.new(image_node(material, case["map"]).outputs["Color"], normal.inputs["Color"])
    links.new(normal.outputs["Normal"], diffuse.inputs["Normal"])
    links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    bpy.context.object.data.materials.append(material)


def model(case):
    bpy.ops.import_scene.gltf(filepath=str(pathlib.Path(case["model"]).resolve()))
    if case["map"]:
        material = next(m for m in bpy.data.materials if m.node_tree and
                        any(n.type == "NORMAL_MAP" for n in m.node_tree.nodes))
        normal = next(n for n in material.node_tree.nodes if n.type == "NORMAL_MAP")
        material.node_tree.links.new(image_node(material, case["map"]).outputs["Color"], normal.inputs["Color"])


def grey(path, side):
    picture = bpy.data.images.load(str(path.resolve()))
    picture.colorspace_settings.name = "Non-Color"
    values = list(picture.pixels)  # from the bottom row up
    rows = [bytes(round(255 * values[4 * (y * side + x)]) for x in range(side)) for y in range(side)]
    return b"".join(reversed(rows))


def draw(case, job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    (model if case["model"] else own_square)(case)
    camera = add("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2
    camera.location, camera.rotation_euler = (0, -10, 0), (1.5707963, 0, 0)
    scene, side = bpy.context.scene, job["side"]
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 8, False, "BOX"
    scene.cycles.max_bounces = 0
    scene.render.resolution_x = scene.render.resolution_y = side
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGB"
    scene.view_settings.view_transform = "Standard"
    sun = add("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = 3, 0
    for name, (x, y, z) in job["lights"].items():
        sun.rotation_euler = Vector((x, -z, y)).to_track_quat("Z", "Y").to_euler()  # it shines along its -z
        path = pathlib.Path(f"{case['id']}.{name}.png")
        scene.render.filepath = str(path.resolve())
        bpy.ops.render.render(write_still=True)
        pathlib.Path(f"{case['id']}.{name}.grey").write_bytes(grey(path, side))


def main():
    job = json.loads(pathlib.Path("cases.json").read_text(encoding="utf-8"))
    for case in job["cases"]:
        try:
            draw(case, job)
        except (RuntimeError, StopIteration, OSError, ImportError) as error:
            pathlib.Path(f"{case['id']}.txt").write_text(str(error), encoding="utf-8")


main()
