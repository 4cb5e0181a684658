# SPDX-License-Identifier: Apache-2.0
"""Maps of a low mesh from a high one."""

import json
import subprocess

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
