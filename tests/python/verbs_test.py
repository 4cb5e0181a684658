# SPDX-License-Identifier: Apache-2.0
"""Every verb gives what the commands give, byte for byte."""

import json
import warnings

import numpy as np
import pytest

import tex
from conftest import SAMPLES


def test_bake_gives_the_normals_of_the_command(commands, bricks, heights):
    commands("bake-normals", bricks, "-o", "n.exr", "--format", "float", "--mips", "none", "--bumpiness", "12",
             "--kernel", "gaussian:1.5", "--wrap", "clamp,mirror")
    n = tex.bake(heights, bumpiness=12, kernel="gaussian", gaussian_sigma=1.5, wrap=("clamp", "mirror"))
    assert n.tobytes() == commands.floats("n.exr").tobytes()


def test_elevation_models_have_the_slopes_of_the_ground(commands):
    source = SAMPLES.parent / "tests/unit/geotiff/degrees.tif"
    commands("bake-normals", source, "-o", "n.exr", "--format", "float", "--mips", "none")
    report = {}
    field = tex.height_field(tex.read_image(source), report=report)
    assert field.ground == report["ground"] and report["ground_remark"] == ""
    assert (field.ground["unit"], field.ground["height_metres"]) == ("degree", 1)
    for heights in (source, field):
        assert tex.bake(heights).tobytes() == commands.floats("n.exr").tobytes()
        assert tex.bake(heights, bumpiness=1).tobytes() == tex.bake(field.height, bumpiness=1).tobytes()
    facts = tex.bake_file(source, "p.exr", pack={"encoding": "float"}, mip={"levels": 1})
    assert facts["on_ground"] and commands.floats("p.exr").tobytes() == commands.floats("n.exr").tobytes()
    assert not tex.bake_file(source, "p.exr", bumpiness=1)["on_ground"]
    assert tex.HeightField(field, 2).ground is None and tex.HeightField([[0.0]]).ground is None


def test_deband_keeps_the_codes_and_the_input():
    j, i = np.mgrid[0:96, 0:128]
    codes = np.round(60 + 40 * np.sin(i * 0.03) * np.cos(j * 0.02)).astype(np.float32)
    heights = codes / np.float32(255)
    before = heights.copy()
    found = tex.deband(heights, wrap="clamp", threads=2)
    assert (heights == before).all()
    assert found["applied"] and abs(found["step"] * 255 - 1) < 1e-4 and found["terrace_texels"] > 0
    assert (np.round(found["field"].height * 255) == codes).all()
    assert (found["field"].height != before).any()
    assert (tex.height_field(heights, deband="on", wrap="clamp").height == found["field"].height).all()
    assert not tex.deband(heights, when="off")["applied"]


def test_height_field_picks_inverts_and_blurs_as_the_command(commands):
    source = SAMPLES / "y_axis.png"
    commands("bake-normals", source, "-o", "n.exr", "--format", "float", "--mips", "none", "--bumpiness", "2",
             "--channel", "g", "--invert", "--blur", "1.5")
    field = tex.height_field(tex.read_image(source), channel="g", invert=True, blur_sigma=1.5)
    assert tex.bake(field, bumpiness=2).tobytes() == commands.floats("n.exr").tobytes()


def test_height_field_fills_invalid_texels():
    heights = np.full((8, 8), 0.5, np.float32)
    heights[2, 3] = np.nan
    with pytest.raises(tex.BadDataError, match="column 3, row 2") as caught:
        tex.height_field(heights)
    assert caught.value.code == "bad-data"
    assert (tex.height_field(heights, fill_invalid=True).height == 0.5).all()


def test_to_linear_takes_the_srgb_curve_away():
    image = tex.to_linear(np.array([[0, 128, 255]], np.uint8), space="sRGB")
    np.testing.assert_allclose(image["Y"], [[0, 0.21586, 1]], atol=1e-5)


def test_strengths_are_those_of_the_command(commands, bricks, heights):
    commands("bake-normals", bricks, "-o", "n.exr", "--format", "float", "--mips", "none", "--height-range", "0.25",
             "--world-size", "2")
    strength = tex.strength_from_world((512, 512), 0.25, 2)
    assert strength == (64.0, 64.0)
    assert tex.bake(heights, bumpiness=strength).tobytes() == commands.floats("n.exr").tobytes()
    assert tex.strength_from_uv((512, 512), 0.125) == (64.0, 64.0)


def test_slope_range_is_that_of_the_command(commands, bricks, normals):
    report = json.loads(commands("bake-normals", bricks, "-o", "n.exr", "--bumpiness", "12", "--json"))
    slopes = tex.slope_range(normals)
    for axis in "xy":
        np.testing.assert_allclose(slopes[axis], report["slopes"][axis], rtol=1e-6)


@pytest.mark.parametrize("name", ["a.dds", "a.ktx2", "a.png", "a.exr", "a.tif", "a.tga"])
def test_every_container_has_the_bytes_of_the_command(commands, bricks, normals, name):
    commands("bake-normals", bricks, "-o", "of_command-" + name, "--bumpiness", "12")
    container = tex.container_of(name)
    levels = 0 if tex.can_hold_blocks(container) else 1
    texture = tex.pack(tex.build_mip_chain(normals, levels=levels), tex.default_encoding(container))
    assert tex.encode_file(texture, container) == commands.bytes("of_command-" + name)
    tex.write_texture(name, texture)
    assert commands.bytes(name) == commands.bytes("of_command-" + name)


@pytest.mark.parametrize("effort", ["fast", "normal", "best"])
@pytest.mark.parametrize("encoding", ["dxt5nm", "bc5", "bc5-snorm", "rgb8", "half"])
def test_pack_gives_the_bytes_of_the_command(commands, bricks, normals, encoding, effort):
    commands("bake-normals", bricks, "-o", "c.dds", "--bumpiness", "12", "--format", encoding, "--effort", effort,
             "--y", "down", "--mip-filter", "kaiser", "--wrap", "clamp", "--mips", "4", "--fade", "1,3")
    n = tex.bake(tex.height_field(tex.read_image(bricks)), bumpiness=12, wrap="clamp")
    chain = tex.build_mip_chain(n, levels=4, filter="kaiser", wrap="clamp", fade=(1, 3))
    tex.write_texture("p.dds", tex.pack(chain, encoding, effort=effort, y_axis="down"))
    assert commands.bytes("p.dds") == commands.bytes("c.dds")


@pytest.mark.parametrize("encoding", ["dxt5nm", "bc5", "bc5-snorm", "eac-rg11", "eac-rg11-snorm"])
def test_encode_blocks_gives_the_blocks_of_pack(normals, encoding):
    odd = normals[:61, :39]
    packed = tex.pack(odd, encoding, y_axis="down")
    blocks = tex.encode_blocks(odd, encoding, y_axis="down")
    assert len(blocks) == tex.level_bytes(tex.encoding_info(encoding)[0], (39, 61))
    if encoding != "dxt5nm":
        assert blocks == bytes(packed.levels[0])
    texture = tex.Texture(packed.format, (39, 61), [blocks], swizzle=packed.swizzle, y_axis="down")
    assert tex.unpack(texture)[0].tobytes() == tex.unpack(packed)[0].tobytes()


def test_unpack_and_decode_read_what_the_command_reads(commands, bricks, normals):
    tex.write_texture("n.dds", tex.pack(normals, "bc5"))
    commands("unpack-normals", "n.dds", "-o", "n.exr", "--format", "float")
    texture = tex.read_texture("n.dds")
    assert (texture.encoding, texture.y_axis, texture.swizzle) == ("bc5", "up", "rg")
    assert tex.unpack(texture)[0].tobytes() == commands.floats("n.exr").tobytes()
    stored = tex.decode(texture)
    assert stored.names == ["R", "G"] and stored.extent == (512, 512)
    chain, info = tex.read_normals("n.dds")
    assert chain[0].tobytes() == commands.floats("n.exr").tobytes()
    assert (info["format"], info["y_known"]) == ("bc5-unorm", True)
    assert tex.guess_swizzle(texture) == "rg"
    assert tex.decode_file(commands.bytes("n.dds"), "x").levels[0] == texture.levels[0]
    assert tex.decode_file(bytearray(commands.bytes("n.dds"))).extent == tex.probe("n.dds") == (512, 512)


def test_read_normals_warns_of_green_that_points_down(commands, normals):
    tex.write_texture("down.png", tex.pack(normals, "rgb8", y_axis="down", y_known=False))
    with pytest.warns(UserWarning, match="down.png: y is taken to point up"):
        _, info = tex.read_normals("down.png")
    assert info["y_doubtful"] and not info["y_known"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        right = tex.read_normals("down.png", unpack={"y_axis": "down"})[0][0]
        tex.read_normals("down.png", doubt_y=False)
        tex.write_texture("up.png", tex.pack(normals, "rgb8", y_known=False))
        assert tex.compare(right, tex.read_normals("up.png")[0][0])["mean"] < 0.3  # the middle of 255 codes is none


def test_transcode_is_what_gpus_show(normals):
    texture = tex.pack(normals, "uastc")
    means = {}
    for format, shown in {"astc": "rgba16-unorm", "bc7": "bc7-unorm", "etc1": "rgb8-unorm", "bc1": "bc1-unorm"}.items():
        made = tex.transcode(texture, format)
        assert (made.format, made.swizzle) == (shown, texture.swizzle)
        means[format] = tex.compare(tex.unpack(texture)[0], tex.unpack(made)[0])["mean"]
    assert means["astc"] < means["bc7"] < means["bc1"] and means["bc7"] < means["etc1"]
    with pytest.raises(ValueError, match="neither"):
        tex.transcode(tex.pack(normals, "bc7"), "bc1")


def test_unpack_reads_stored_colours(normals):
    stored = tex.pack(normals, "rgb8")
    colours = np.frombuffer(stored.levels[0], np.uint8).reshape(512, 512, 3)
    assert tex.unpack(colours).tobytes() == tex.unpack(stored)[0].tobytes()


def test_scale_gives_the_normals_of_the_command(commands, normals):
    tex.write_texture("n.exr", tex.pack(normals, "float"))
    commands("scale-normals", "n.exr", "-o", "s.exr", "--scale", "0.5", "--format", "float")
    before = normals.copy()
    assert tex.scale(normals, 0.5).tobytes() == commands.floats("s.exr").tobytes()
    assert (normals == before).all(), "the argument has changed"
    halves = tex.scale(tex.build_mip_chain(normals), 0.5, "xy")
    assert halves[2].shape == (128, 128, 3)


def test_blend_gives_the_normals_of_the_command(commands, normals):
    detail = np.ascontiguousarray(normals[::-1])
    tex.write_texture("base.exr", tex.pack(normals, "float"))
    tex.write_texture("detail.exr", tex.pack(detail, "float"))
    commands("blend-normals", "base.exr", "--detail", "detail.exr", "-o", "b.exr", "--format", "float", "--mips", "none", "--mode", "rnm",
             "--tiling", "3,2", "--rotate", "30", "--detail-scale", "0.5")
    layers = [{"detail": detail, "tiling": (3, 2), "rotation": 30, "scale": 0.5}]
    assert tex.blend(normals, layers, mode="rnm").tobytes() == commands.floats("b.exr").tobytes()
    report = tex.blend_file("base.exr", [{"input": "detail.exr", "tiling": (3, 2), "rotation": 30, "scale": 0.5}],
                            "f.exr", blend={"mode": "rnm"}, mip={"levels": 1}, pack={"encoding": "float"})
    assert commands.bytes("f.exr") == commands.bytes("b.exr") and report["levels"] == 1


def test_compare_measures_what_the_command_measures(commands, normals):
    other = tex.bake(tex.read_image(SAMPLES / "bricks.png")["Y"], bumpiness=10)
    tex.write_texture("a.exr", tex.pack(normals, "float"))
    tex.write_texture("b.exr", tex.pack(other, "float"))
    report = json.loads(commands("compare-normals", "a.exr", "b.exr", "--json"))
    result = tex.compare(normals, other)
    text = json.dumps(report)
    for key in ("mean", "max", "p99"):
        assert f"{result[key]:.4f}"[:5] in text, (key, result[key], text)
    assert result["degrees"].shape == (512, 512) and result["degrees"].max() == pytest.approx(result["max"])
    picture = tex.heat_map(result["degrees"], 10)
    assert picture.names == ["R", "G", "B"] and picture.extent == (512, 548)
    assert tex.largest_of_cells(result["degrees"], 64).max() == result["degrees"].max()
    assert tex.encode_picture(tex.picture_of(picture))[:4] == b"\x89PNG"


def test_roughness_has_the_bytes_of_the_command(commands, normals):
    tex.write_texture("n.exr", tex.pack(normals, "float"))
    commands("mip-normals", "n.exr", "-o", "m.dds", "--roughness-out", "r.dds", "--roughness-format", "bc4")
    chain = tex.build_roughness_chain(normals, 0.0)
    tex.write_texture("p.dds", tex.pack_roughness(chain, "bc4-unorm"))
    assert commands.bytes("p.dds") == commands.bytes("r.dds")


def test_check_finds_what_the_command_finds(commands, normals):
    flipped = normals * np.float32([1, -1, 1])
    texture = tex.pack(flipped, "rgb8")
    tex.write_texture("n.png", texture)
    report = tex.run("check-normals", ["n.png", "--require", "y=up"]).results[0]
    found = tex.check("n.png", require={"y": "up"})
    assert [f.id for f in found] == [f["id"] for f in report["findings"]] and "N401" in [f.id for f in found]
    assert [f.message for f in found] == [f["message"] for f in report["findings"]]
    assert found.y["y"] == "down" and found.extent == (512, 512)
    assert [f.id for f in tex.check(texture, require={"y": "up"}, severity={"N401": "note"})] == [f.id for f in found]
    assert not list(tex.check(texture, disable=["N401", "N404"], require={"y": "up", "pow2": True, "extent": (512, 512)}))
    assert tex.check(texture, height=tex.read_image(SAMPLES / "bricks.png")["Y"]).pair["y"] == "down"
    assert tex.find_rule("N401") in tex.rules() and tex.find_rule("nonsense") is None
    with pytest.raises(tex.BadOptionError):
        tex.check(texture, require={"z": "up"})
    with pytest.raises(tex.BadOptionError):
        tex.check(texture, enable=["N999"])


def test_preview_has_the_bytes_of_the_command(commands, normals):
    tex.write_texture("n.dds", tex.pack(tex.build_mip_chain(normals), "rgba8"))
    commands("preview-normals", "n.dds", "-o", "c.png", "--size", "128")
    chain, _ = tex.read_normals("n.dds")
    picture = tex.preview(chain, size=(128, 0))
    tex.write_texture("p.png", picture)
    assert commands.bytes("p.png") == commands.bytes("c.png")
    assert tex.encode_picture(picture)[:4] == b"\x89PNG"
    sheet = tex.contact_sheet([(picture, "one"), (picture, "two")], 2)
    assert sheet.extent[0] > 256
    assert tex.split_view((picture, "a"), (picture, "b")).format == "rgb8-unorm"
    assert b"acTL" in tex.encode_animation([picture, tex.preview(chain, size=(128, 0), light={"x": 1})], 10)


def test_files_have_the_bytes_of_the_commands(commands, bricks):
    commands("bake-normals", bricks, "-o", "c.dds", "--bumpiness", "12", "--y", "down", "--mip-filter", "kaiser")
    report = tex.bake_file(bricks, "p.dds", bumpiness=12, pack={"y_axis": "down"}, mip={"filter": "kaiser"})
    assert commands.bytes("p.dds") == commands.bytes("c.dds")
    assert report["extent"] == (512, 512) and report["levels"] == 10 and report["bytes"] == len(commands.bytes("p.dds"))
    commands("pack-normals", "c.dds", "-o", "c.ktx2", "--format", "bc5")
    assert tex.pack_file("p.dds", "p.ktx2", pack={"encoding": "bc5"})["source"]["y_axis"] == "down"
    assert commands.bytes("p.ktx2") == commands.bytes("c.ktx2")
    tex.write_file("x.bin", memoryview(b"12"))
    assert commands.bytes("x.bin") == b"12"
    with pytest.raises(tex.IoError):
        tex.write_file("x.bin", b"34", no_clobber=True)


def test_facts():
    assert tex.format_info("bc3-unorm") == {"sample": "unorm", "channels": 4, "bits": 8, "block": (4, 4), "block_bytes": 16}
    assert tex.format_of("unorm", 8, 3) == "rgb8-unorm" and tex.format_of("snorm", 8, 3) is None
    assert tex.encoding_info("dxt5nm") == ("bc3-unorm", "1y1x")
    assert tex.layout_name("1y1x") == "dxt5nm"
    assert tex.level_extent((7, 3), 1) == (3, 1) and tex.level_count((4096, 1)) == 13
    assert tex.steepest_slope("dxt5nm") == pytest.approx(11.3, abs=0.05)
    assert tex.container_of("a.TIFF") == "tiff" and tex.container_of("a.xyz") is None
    assert tex.can_hold("png", "rgb8") and not tex.can_hold("png", "bc5") and tex.can_hold("dds", "bc5-unorm")
    assert tex.can_hold_blocks("dds") and tex.can_compress("ktx2") and not tex.can_hold_levels("png")
    assert tex.version() == tex.__version__
    assert tex.runtime()["dependencies"]["libpng"] and tex.opencolorio_version().startswith("2.")
    assert tex.reader_info()["program"].endswith("tex-reader")
    assert tex.color_files() == []


def test_integrate_gives_heights_back_and_the_pictures_of_the_command(commands, bricks, heights):
    n = tex.bake(heights, bumpiness=12, wrap="mirror")
    found = tex.integrate(n, bumpiness=12, wrap="mirror")
    np.testing.assert_allclose(found["height"], heights - np.asarray(heights).min(), atol=1e-4)
    assert found["curl"]["max"] < 0.1 and found["degrees"].shape == found["height"].shape
    commands("bake-normals", bricks, "-o", "n.exr", "--format", "float", "--mips", "none", "--bumpiness", "12",
             "--wrap", "mirror")
    commands("integrate-normals", "n.exr", "-o", "h.exr", "--format", "float", "--bumpiness", "12", "--wrap", "mirror",
             "--heights", "raw")
    assert found["height"].tobytes() == tex.read_image("h.exr")["Y"].tobytes()
    with pytest.raises(ValueError, match="bumpiness"):
        tex.integrate(n, bumpiness=0)


def test_curvature_of_a_dome_is_the_inverse_of_its_radius():
    j, i = np.mgrid[-16:17, -16:17]
    n = np.stack([i, -j, np.sqrt(100.0**2 - i**2 - j**2)], axis=-1) / 100
    bend = tex.curvature(n.astype(np.float32), wrap="clamp")
    np.testing.assert_allclose(bend["values"][2:-2, 2:-2], 0.01, rtol=0.01)
    assert bend["least"] <= bend["rms"] <= bend["greatest"]


def test_occlusion_of_a_valley_follows_its_formula():
    heights = np.abs(np.arange(129) - 64.0)[np.newaxis].repeat(129, axis=0).astype(np.float32)
    maps = tex.occlusion(heights, wrap="clamp", directions=64, bent=True)
    assert set(maps) == {"occlusion", "bent"} and maps["bent"].shape == (129, 129, 3)
    assert abs(maps["occlusion"][64, 64] - 2**-0.5) < 0.005
    alone = tex.occlusion(heights, wrap="clamp", occlusion=False, horizons=4)
    assert set(alone) == {"horizons"} and alone["horizons"].shape == (4, 129, 129)
    np.testing.assert_allclose(alone["horizons"][:, 64, 64], [2**-0.5, 0, 2**-0.5, 0], atol=0.005)
    with pytest.raises(ValueError, match="directions"):
        tex.occlusion(heights, directions=2)


def test_large_levels_are_left_out(bricks, heights):
    chain = tex.build_mip_chain(tex.bake(heights), max_side=100)
    assert [level.shape[0] for level in chain] == [64, 32, 16, 8, 4, 2, 1]
    with pytest.raises(ValueError, match="max_side"):
        tex.build_mip_chain(tex.bake(heights), max_side=-1)
