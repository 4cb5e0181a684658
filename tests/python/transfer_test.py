# SPDX-License-Identifier: Apache-2.0
"""Maps of a low mesh from a high one."""

import json
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

import tex
from conftest import BINARY, SAMPLES

EXTENT = (48, 32)


def plane(height=0.0, **changes):
    """A square of the size 2, whose map lies on it."""
    corners = [[0, 0, height], [2, 0, height], [2, 2, height], [0, 2, height]]
    return tex.MeshPart(**{"positions": corners, "indices": [[0, 1, 2], [0, 2, 3]], "normals": [[0, 0, 1]] * 4,
                           "uvs": [[0, 0], [1, 0], [1, 1], [0, 1]], **changes})


def low():
    return tex.select_part(tex.Mesh([plane()]))


def test_heights_are_distances():
    maps = tex.transfer(EXTENT, low(), plane(0.25), front=1, back="5%", heights=True, positions=True, object=True)
    np.testing.assert_allclose(maps["heights"], 0.25)
    np.testing.assert_allclose(maps["map"], np.broadcast_to([0, 0, 1], (32, 48, 3)), atol=1e-7)
    np.testing.assert_allclose(maps["position"][0, 0], [1 / 48, 2 - 1 / 32, 0.25], rtol=1e-6)
    assert maps["origin"].min() == maps["origin"].max() == 3
    assert (maps["covered"], maps["missed"], maps["front"]) == (48 * 32, 0, 1.0)
    assert maps["back"] == pytest.approx(0.05 * np.sqrt(8))
    assert maps["occlusion"] is maps["ids"] is maps["color"] is None
    assert maps["rays"] == 48 * 32


def test_colors_of_vertices(tmp_path):
    high = plane(0.25, colors=[[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    maps = tex.transfer(EXTENT, low(), high, front=1, back=1, vertex_colors=True)
    across, down = np.meshgrid((np.arange(48) + 0.5) / 48, 1 - (np.arange(32) + 0.5) / 32)
    colors = np.stack([np.asarray(maps["vertex_color"].planes[k]) for k in range(3)], axis=-1)
    np.testing.assert_allclose(colors, np.stack([across, down, np.ones_like(down)], axis=-1), atol=1e-6)
    assert plane().colors is None and high.colors.shape == (4, 3)
    file = tmp_path / "c.obj"
    file.write_text("v 0 0 0 1 0 0.5\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n")
    assert tex.read_mesh(str(file)).parts[0].colors is None
    np.testing.assert_array_equal(tex.read_mesh(str(file), colors=True).parts[0].colors[0], [1, 0, 0.5])


def test_second_rays():
    wall = tex.MeshPart([[0, -4000, 0], [0, 4000, 0], [0, 4000, 4000], [0, -4000, 4000]], [[0, 1, 2], [0, 2, 3]])
    maps = tex.transfer(EXTENT, low(), [plane(), wall], front=0.01, back=0.01, occlusion=True, bent=True,
                        thickness=True, rays_per_hit=256, occlusion_distance=1000)
    assert abs(float(maps["occlusion"].mean()) - 0.5) < 0.002  # half of the sky
    assert maps["bent"][..., 0].min() > 0.3  # away from the wall
    np.testing.assert_allclose(maps["thickness"], 1000)  # nothing is below
    assert maps["rays"] == 48 * 32 * (1 + 2 * 256)


def test_inputs():
    high = [plane(0.25), plane(0.5)]
    near = {"front": 1, "back": 1, "heights": True}
    maps = tex.transfer(EXTENT, low(), high, low_groups=[0, 1], high_groups=[1, 0], high_ids=[4, 7], **near)
    assert set(np.unique(maps["heights"])) == {np.float32(0.25), np.float32(0.5)}
    assert ((maps["ids"] == 7) == (maps["heights"] == 0.5)).all()
    with pytest.raises(TypeError, match="around: expected tex.MeshPart"):
        tex.transfer(EXTENT, low(), high, around=low())
    assert tex.transfer(EXTENT, low(), high, around=plane(3.0))["diagonal"] == pytest.approx(np.sqrt(17))
    caged = tex.transfer(EXTENT, low(), high[:1], cage=plane(0.5), heights=True)
    assert caged["front"] == 0.5 and caged["missed"] == 0
    offset = tex.transfer(EXTENT, low(), high, offset=[[0.3]], **near)
    np.testing.assert_allclose(offset["heights"], 0.25)
    skewed = tex.transfer(EXTENT, low(), high, rays="straight", skew=np.ones((2, 2)), **near)
    np.testing.assert_allclose(skewed["heights"], 0.5)
    color = np.random.default_rng(1).random((32, 48, 3), dtype=np.float32)
    lean = np.zeros((32, 48, 3), np.float32)
    lean[...] = [0.6, 0, 0.8]
    part = plane()
    details = [{"normals": lean, "tangents": tex.make_tangents(part), "decoder": "unreal", "color": color}]
    shown = tex.transfer(EXTENT, low(), part, high_details=details)
    np.testing.assert_allclose(shown["map"], lean, atol=1e-6)
    np.testing.assert_allclose(np.asarray(shown["color"]), color, atol=1e-6)


def test_what_is_wrong_is_said():
    space = low()
    for options, error, text in (
        ({"front": "near"}, ValueError, "front: must be a number, a text such as '5%', or 'auto'"),
        ({"front": "x%"}, ValueError, "front: must be"),
        ({"front": -1}, tex.BadOptionError, "front: must be 0 or more"),
        ({"rays": "straigt"}, ValueError, "rays: 'straigt' must be one of 'smooth', 'straight', 'vertex'"),
        ({"cage": space}, TypeError, "cage: expected tex.MeshPart"),
        ({"low_groups": [1]}, tex.BadOptionError, "low_groups"),
        ({"low_groups": 1}, TypeError, "low_groups: expected a sequence"),
        ({"high_details": [{"colour": 1}]}, ValueError, "high_details: 'colour' must be one of"),
        ({"skew": [[0.5]]}, tex.BadOptionError, "skew: needs"),
    ):
        with pytest.raises(error, match=text):
            tex.transfer(EXTENT, space, plane(), **options)
    with pytest.raises(TypeError, match="high: expected"):
        tex.transfer(EXTENT, space, "high.glb")
    with pytest.raises(tex.BadOptionError, match="no ray hits the high mesh"):
        tex.transfer(EXTENT, space, plane(100))


def test_names():
    matched = tex.match_names(["rock_low", "lid_low"], ["rock_high", "rock_high.001", "bolt"])
    assert matched == {"low": [0, 1], "high": [0, 0, 2], "lone_low": ["lid_low"], "lone_high": ["bolt"]}


def test_the_command_makes_the_same_maps(tmp_path):
    out = tmp_path / "n.exr"
    done = subprocess.run([BINARY / "transfer-normals", SAMPLES / "crate_low.glb", SAMPLES / "crate_high.glb", "-o", out,
                           "--extent", "64", "--format", "float", "--mips", "none", "--occlusion-out", tmp_path / "ao.exr",
                           "--rays-per-hit", "8", "--json"], check=True, capture_output=True)
    report = json.loads(done.stdout)
    space = tex.select_part(tex.read_mesh(SAMPLES / "crate_low.glb"), in_scene=True)
    assert [piece["triangle"] for piece in space.pieces] == [0]
    high = tex.parts_in_scene(tex.read_mesh(SAMPLES / "crate_high.glb"), most=100)
    maps = tex.transfer((64, 64), space, high, occlusion=True, rays_per_hit=8)
    assert maps["rays"] == report["rays"]
    np.testing.assert_allclose(np.asarray(tex.read_image(out))[..., :3], maps["map"], atol=1e-6)
    np.testing.assert_array_equal(np.asarray(tex.read_image(tmp_path / "ao.exr")).squeeze(), maps["occlusion"])


def with_material(mesh, name):
    """A copy of a GLB file whose triangles have a material."""
    data = mesh.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    model, rest = json.loads(data[20:20 + size]), data[20 + size:]
    model["materials"] = [{"name": "crate"}]
    for primitive in (p for m in model["meshes"] for p in m["primitives"]):
        primitive["material"] = 0
    text = json.dumps(model).encode()
    text += b" " * (-len(text) % 4)
    Path(name).write_bytes(struct.pack("<4s4I", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest)


def test_run_writes_models(commands):
    for name in ("crate_low.glb", "crate_high.glb"):
        with_material(SAMPLES / name, name)
    ran = tex.run("transfer-normals", ["crate_low.glb", "crate_high.glb", "-o", "lod.glb", "--extent", "64"])
    assert (ran.code, ran.results[0]["output"]) == (0, "lod.glb"), ran.err
    commands("transfer-normals", "crate_low.glb", "crate_high.glb", "-o", "program.glb", "--extent", "64")
    assert commands.bytes("lod.glb") == commands.bytes("program.glb")
    assert [(each["image"], each["scale"]) for each in tex.read_model("lod.glb")["maps"]] == [(0, 1.0)]
    # A rule of a manifest says so by the name of its output.
    Path("normals.toml").write_text(
        'version = 1\n[[rule]]\nmatch = "crate_low.glb"\nname = "out/{stem:-_low}_lod.glb"\n'
        'steps = [ { transfer = { extent = "64", high = "{dir}/{stem:-_low}_high.glb" } } ]\n')
    ran = tex.run("build-normals", [])
    assert ran.code == 0, ran.err
    assert commands.bytes("out/crate_lod.glb") == commands.bytes("lod.glb")


def test_places_are_copies_that_are_not_made():
    near = {"front": 1, "back": 1, "heights": True, "high_ids": [4, 7]}
    right = plane(positions=[[1, 0, 0.5], [2, 0, 0.5], [2, 2, 0.5], [1, 2, 0.5]])
    copies = tex.transfer(EXTENT, low(), [plane(0.25), right], **near)
    places = [{"part": 0, "name": "left"}, {"part": 0, "to_scene": [0.5, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0.25]}]
    placed = tex.transfer(EXTENT, low(), plane(0.25), high_places=places, **near)
    np.testing.assert_allclose(placed["heights"], copies["heights"], atol=1e-6)
    np.testing.assert_array_equal(placed["ids"], copies["ids"])
    assert set(np.unique(placed["ids"])) == {4, 7}
    for wrong, error, words in [([{"part": -1}], ValueError, "part: must be 0 or more"),
                                ([{"part": 1}], tex.BadOptionError, "high_places"),
                                ([{"to_scene": [1.0] * 11}], ValueError, "12 numbers"),
                                ([{"place": 0}], ValueError, "must be one of 'part', 'name', 'to_scene'"),
                                ([0], TypeError, "high_places: expected a dict for each place")]:
        with pytest.raises(error, match=words):
            tex.transfer(EXTENT, low(), plane(0.25), high_places=wrong, **near)


def forest(path, side, moves):
    """A glTF of a square of side x side cells that nodes show, each moved."""
    at = np.linspace(0, 1, side + 1, dtype=np.float32)
    u, v = np.meshgrid(at, at)
    positions = np.stack([2 * u, 2 * v, 0.25 + 0.1 * u * v], axis=-1).reshape(-1, 3)
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).reshape(-1, 1)
    indices = (corner + [0, 1, side + 2, 0, side + 2, side + 1]).astype(np.uint32)
    path.with_suffix(".bin").write_bytes(positions.tobytes() + indices.tobytes())
    accessors = [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
                  "min": positions.min(0).tolist(), "max": positions.max(0).tolist()},
                 {"bufferView": 1, "componentType": 5125, "count": indices.size, "type": "SCALAR"}]
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(moves)))}],
        "nodes": [{"mesh": 0, "name": f"tree{k}", "translation": move} for k, move in enumerate(moves)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": accessors, "buffers": [{"uri": path.with_suffix(".bin").name,
                                             "byteLength": positions.nbytes + indices.nbytes}],
        "bufferViews": [{"buffer": 0, "byteLength": positions.nbytes},
                        {"buffer": 0, "byteOffset": positions.nbytes, "byteLength": indices.nbytes}]}))
    return tex.read_mesh(str(path))


def test_places_in_a_scene(tmp_path):
    moves = [[0, 0, 0], [0.5, 0, 0.125]]
    parts, places = tex.places_in_scene(forest(tmp_path / "few.gltf", 8, moves))
    assert len(parts) == 2 and places == []  # copies of few triangles are made
    mesh = forest(tmp_path / "many.gltf", 300, moves)
    parts, places = tex.places_in_scene(mesh)
    assert [place["name"] for place in places] == ["tree0", "tree1"] and {place["part"] for place in places} == {0}
    assert places[1]["to_scene"] == [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0.125]
    near = {"front": 1, "back": 1, "heights": True}
    placed = tex.transfer(EXTENT, low(), parts, high_places=places, **near)
    copied = tex.transfer(EXTENT, low(), tex.parts_in_scene(mesh), **near)
    np.testing.assert_allclose(placed["heights"], copied["heights"], atol=1e-6)
    with pytest.raises(tex.UnsupportedError, match="too many copies"):
        tex.places_in_scene(mesh, most=20)
