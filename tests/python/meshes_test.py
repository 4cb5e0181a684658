# SPDX-License-Identifier: Apache-2.0
"""Meshes: files, tangents, spaces, and what the commands do with them."""

import json
import subprocess

import numpy as np
import pytest

import tex
from conftest import BINARY, SAMPLES

BROKEN = SAMPLES / "broken"
POSITIONS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
TRIANGLES = [[0, 1, 2], [0, 2, 3]]
NORMALS = [[0, 0, 1]] * 4
UVS = [[0, 0], [1, 0], [1, 1], [0, 1]]


def square(**changes):
    return tex.MeshPart(**{"positions": POSITIONS, "indices": TRIANGLES, "normals": NORMALS, "uvs": UVS, **changes})


def wavy():
    """A square whose normals lean, so that object space is not tangent space."""
    lean = np.float32([[0.3, 0, 1], [-0.2, 0.1, 1], [0.1, 0.4, 1], [0, -0.3, 1]])
    return square(normals=lean / np.linalg.norm(lean, axis=1, keepdims=True))


def test_compare_counts_only_what_a_part_covers():
    a = np.zeros((8, 8, 3), np.float32)
    a[..., 2] = 1
    b = a.copy()
    b[:, 4:] = (1, 0, 0)
    half = [[0, 0], [0.5, 0], [0.5, 1], [0, 1]]
    chart = tex.MeshPart(positions=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], indices=[[0, 1, 2], [0, 2, 3]],
                         uvs=[half])
    assert tex.compare(a, b)["max"] > 89.9
    covered = tex.compare(a, b, part=chart, uv_set=0)
    assert covered["max"] == 0 and covered["texels"] == 32
    with pytest.raises(ValueError):
        tex.compare(a, b, part=chart, uv_set=1)
    with pytest.raises(TypeError, match="a MeshPart"):
        tex.compare(a, b, part=3)


def test_a_part_keeps_its_arrays():
    part = square(name="square", tangents=[[1, 0, 0, 1]] * 4)
    np.testing.assert_array_equal(part.positions, np.float32(POSITIONS))
    np.testing.assert_array_equal(part.indices, TRIANGLES)
    np.testing.assert_array_equal(part.uvs[0], np.float32(UVS))
    np.testing.assert_array_equal(part.normals, np.float32(NORMALS))
    np.testing.assert_array_equal(part.tangents, np.float32([[1, 0, 0, 1]] * 4))
    assert (part.name, part.v_axis, part.material, part.quads) == ("square", "up", -1, [])
    assert repr(part) == "<tex.MeshPart 'square': 2 triangles>"
    assert square(normals=None).normals is None and square(uvs=None).uvs == [] and len(square(uvs=[UVS, UVS]).uvs) == 2
    rows = part.positions
    del part
    np.testing.assert_array_equal(rows, np.float32(POSITIONS))
    with pytest.raises(ValueError, match="read-only"):
        rows[0] = 0


def test_wrong_parts_are_refused():
    for changes, error, text in (
        ({"indices": [[0, 1, 4]]}, tex.BadDataError, "index 2 of triangle 0 is out of range|out of range"),
        ({"indices": np.zeros((0, 3), int)}, tex.BadDataError, "triangle"),
        ({"indices": [[0, 1, -1]]}, ValueError, "indices: must be 0 or more"),
        ({"indices": [[0.0, 1, 2]]}, TypeError, "indices: expected an array of integers"),
        ({"indices": [[0, 1, 2, 3]]}, ValueError, "indices: expected an array of shape"),
        ({"positions": [[0, 0]]}, ValueError, "positions: expected an array of shape"),
        ({"positions": "abc"}, TypeError, "positions: expected an array of numbers"),
        ({"positions": [[np.nan, 0, 0]] * 4}, tex.BadDataError, ""),
        ({"normals": NORMALS[:3]}, tex.BadDataError, ""),
        ({"uvs": [UVS, [[0, 0, 0]]]}, ValueError, r"uvs\[1\]: expected an array of shape"),
        ({"v_axis": "left"}, ValueError, "v_axis: 'left' must be one of"),
    ):
        with pytest.raises(error, match=text):
            square(**changes)
    with pytest.raises(ValueError, match="there must be 6"):
        tex.SelectedPart(square(), [[1, 0, 0, 1]] * 5)
    with pytest.raises(ValueError, match="tangents: some values are infinite"):
        tex.SelectedPart(square(), [[np.inf, 0, 0, 1]] * 6)
    with pytest.raises(TypeError, match="mesh: expected tex.Mesh"):
        tex.select_part(square())
    with pytest.raises(ValueError, match="there is no part"):
        tex.Mesh([])


def test_tangents_of_a_square_point_along_u():
    for method in ("mikktspace", "meshopt"):
        np.testing.assert_allclose(tex.make_tangents(square(), method), [[1, 0, 0, 1]] * 6, atol=1e-6)
    # v down: the bitangent still points up in the picture, so against v.
    np.testing.assert_allclose(tex.make_tangents(square(v_axis="down")), [[1, 0, 0, -1]] * 6, atol=1e-6)
    stored = square(tangents=[[0, 1, 0, -1]] * 4)
    np.testing.assert_array_equal(tex.stored_tangents(stored), [[0, 1, 0, -1]] * 6)
    with pytest.raises(tex.BadOptionError):
        tex.stored_tangents(square())
    with pytest.raises(tex.BadOptionError):
        tex.make_tangents(square(), uv_set=1)
    with pytest.raises(ValueError, match="uv_set: must be 0 or more"):
        tex.make_tangents(square(), uv_set=-1)


def test_a_node_places_a_part():
    turned = np.float64([[0, -2, 0, 5], [2, 0, 0, 0], [0, 0, 2, 0]])
    for node in (turned, {"name": "n", "mesh": 0, "to_scene": turned}):
        part = tex.in_scene(square(), node)
        np.testing.assert_allclose(part.positions, np.float32(POSITIONS) @ turned[:, :3].T + turned[:, 3], atol=1e-6)
    with pytest.raises(ValueError, match="3 rows and 4 columns"):
        tex.in_scene(square(), np.eye(4))
    with pytest.raises(tex.BadDataError):
        tex.in_scene(square(), np.zeros((3, 4)))


def test_spaces_are_inverse(normals):
    space = tex.select_part(tex.Mesh([wavy()]))
    assert space.source == "mikktspace" and not space.has_tangents and space.tangents.shape == (6, 4)
    made = tex.to_object_space(normals, space, decoder="unity-urp")
    assert made["covered"] == 512 * 512 and (made["coverage"] == 3).all() and made["overlaps"] == 0
    assert tex.compare(normals, made["map"])["mean"] > 1  # degrees: another space
    back = tex.to_tangent_space(made["map"], space, decoder="unity-urp")
    assert tex.compare(normals, back["map"])["max"] < 0.1
    # A flat map has the normals of the mesh, here the interpolated ones: T', B' and N' of glTF are not normalised.
    flat = np.zeros((8, 8, 3), np.float32)
    flat[..., 2] = 1
    corner = tex.to_object_space(flat, tex.select_part(tex.Mesh([square()])))["map"]
    np.testing.assert_allclose(corner, flat, atol=1e-6)
    for options, text in (({"padding": -1}, "padding"), ({"subsamples": 9}, "subsamples"), ({"decoder": "x"}, "decoder")):
        with pytest.raises(ValueError, match=text):
            tex.to_object_space(flat, space, **options)
    with pytest.raises(TypeError, match="space: expected tex.SelectedPart"):
        tex.to_object_space(flat, square())


def test_maps_are_those_of_convert_normals(commands, normals):
    mesh = BROKEN / "meshes/N711.glb"
    tex.write_texture(commands.folder / "n.exr", tex.pack(normals, "float"))
    commands("convert-normals", "n.exr", "-o", "o.exr", "--mesh", mesh, "--to", "object", "--format", "float",
             "--decoder", "unreal", "--subsamples", "2")
    space = tex.select_part(tex.read_mesh(mesh))
    n = tex.to_object_space(normals, space, decoder="unreal", subsamples=2)["map"]
    np.testing.assert_allclose(commands.floats("o.exr"), n, rtol=0, atol=3e-7)  # the command normalises what it reads
    commands("convert-normals", "n.exr", "-o", "r.exr", "--mesh", mesh, "--to-mesh", mesh, "--decoder-in", "unreal",
             "--decoder", "godot", "--tangents", "meshopt", "--format", "float")
    other = tex.select_part(tex.read_mesh(mesh), tangents="meshopt")
    fitted = tex.refit(normals, space, other, source_decoder="unreal", target_decoder="godot")
    np.testing.assert_allclose(commands.floats("r.exr"), fitted["map"], rtol=0, atol=3e-7)
    assert fitted["unmatched"] == 0


@pytest.mark.parametrize("show", ["lit", "seams"])
def test_previews_are_those_of_preview_normals(commands, normals, show):
    mesh = BROKEN / "meshes/N711.glb"
    tex.write_texture(commands.folder / "n.dds", tex.pack(tex.build_mip_chain(normals), "rgba8"))
    commands("preview-normals", "n.dds", "-o", "c.png", "--mesh", mesh, "--decoder", "unreal", "--show", show, "--size",
             "160", "--no-legend")
    chain, _ = tex.read_normals(commands.folder / "n.dds", unpack={"keep_length": True})  # as the command samples it
    space = tex.select_part(tex.read_mesh(mesh))
    tex.write_texture(commands.folder / "p.png",
                      tex.preview(chain, mesh=space, decoder="unreal", show=show, size=(160, 0), legend=False))
    assert commands.bytes("p.png") == commands.bytes("c.png")
    with pytest.raises(TypeError, match="mesh: expected tex.SelectedPart"):
        tex.preview(chain, mesh=tex.read_mesh(mesh))


def test_files():
    path = BROKEN / "meshes/N705.glb"
    mesh = tex.read_mesh(path)
    assert tex.mesh_files(path) == [str(path)] and len(mesh.parts) == 1
    assert mesh.materials[0]["has_normal_map"] and mesh.nodes[0]["to_scene"].shape == (3, 4)
    part = mesh.parts[0]
    assert part.tangents.shape == (len(part.positions), 4) and part.v_axis == "down"
    kept = part.positions.copy()
    del mesh  # the part keeps it
    np.testing.assert_array_equal(part.positions, kept)
    with pytest.raises(tex.IoError):
        tex.read_mesh("missing.glb")
    with pytest.raises(tex.UnsupportedError):
        tex.read_mesh(path, max_bytes=100)
    with pytest.raises(tex.BadOptionError):
        tex.select_part(tex.read_mesh(path), material="stone")


@pytest.mark.parametrize("rule", ["N701", "N705", "N711", "N722", "N723"])
def test_check_finds_what_check_normals_finds(rule):
    [file] = BROKEN.glob(f"{rule}-*")
    mesh = BROKEN / f"meshes/{rule}.glb"
    ran = subprocess.run([BINARY / "check-normals", file, "--mesh", mesh, "--json"], capture_output=True, text=True,
                         check=False)
    expected = json.loads(ran.stdout)
    report = tex.check(file, mesh=tex.select_part(tex.read_mesh(mesh)))
    assert [f.id for f in report] == [f["id"] for f in expected["findings"]]
    assert rule in [f.id for f in report]
    if rule == "N711":
        assert report.seams["edges"] > 0 and report.seams["worst"] >= report.seams["mean"]
        assert report.seams["worst_edge"].width > 0


def test_tiles():
    selected = tex.select_part(tex.Mesh([square(uvs=np.float32(UVS) + [1, 0])]))
    assert tex.in_tile(selected, 1002).part.indices.shape == (2, 3)
    assert tex.in_tile(selected, 1002).rest is None
    assert tex.tiles_of(selected) == {"tiles": [1002], "outside": 0, "crossing": 0}
    with pytest.raises(tex.BadOptionError):
        tex.in_tile(selected, 1001)
    with pytest.raises(ValueError, match="tile: must be 1001 or more"):
        tex.in_tile(selected, 3)
    assert tex.decoder_kind("three") == "normalized"


def test_height_field_reports():
    picture = np.float32([[[0.1, 0.2, 0.3], [np.nan] * 3, [0.5, 0.5, 0.5]]])
    found = {}
    tex.height_field(picture, found, fill_invalid=True)
    assert found["luma_texels"] == 1 and found["invalid_texels"] == 1
    assert found["deband"] == {"applied": False, "step": 0.0, "codes": 0, "terrace_texels": 0}
    with pytest.raises(TypeError, match="report: expected a dict"):
        tex.height_field(picture, [], fill_invalid=True)


def test_models_have_their_maps():
    file = str(BROKEN / "N802-used-as-color.glb")
    model = tex.read_model(file)
    assert isinstance(model["mesh"], tex.Mesh)
    (image,), (found,) = model["images"], model["maps"]
    assert image["bytes"].startswith(b"\x89PNG") and image["error"] is None
    assert (0, "baseColorTexture", True) in image["uses"]
    assert found["name"] == "stone: normals" and found["image"] == 0 and found["scale"] == 1.0
    assert found["uv_transform"] == {"offset": (0.0, 0.0), "rotation": 0.0, "scale": (1.0, 1.0)}
    (report,) = tex.check_model(file)
    assert report.map == "stone: normals" and [finding.id for finding in report] == ["N802"]
    assert tex.check_model(file, disable=["N802"], material="stone")[0].findings == []
    with pytest.raises(tex.BadOptionError):
        tex.check_model(file, material="glass")
