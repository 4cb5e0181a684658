# SPDX-License-Identifier: Apache-2.0
"""Data beside normals: kept, taken and given, with the bytes of the commands."""

import copy
import gc
import pickle
import subprocess

import numpy as np
import pytest

import tex

RANDOM = np.random.default_rng(3)
HEIGHT, WIDTH = 24, 40  # rows are no multiple of 16 texels
CODES = RANDOM.integers(0, 256, (HEIGHT, WIDTH), np.uint8)
OTHER = RANDOM.integers(0, 256, (HEIGHT, WIDTH), np.uint8)
NORMALS = tex.bake(RANDOM.random((HEIGHT, WIDTH), dtype=np.float32), bumpiness=3)


def write_picture(name, codes, kind):
    """A file that ImageMagick writes."""
    height, width = codes.shape[:2]
    command = ["convert", "-size", f"{width}x{height}", "-depth", "8", f"{kind}:-", name]
    subprocess.run(command, input=codes.tobytes(), check=True)


def colours(alpha):
    rgb = np.rint((np.asarray(NORMALS) + 1) / 2 * 255).astype(np.uint8)
    return np.dstack([rgb, alpha])


@pytest.fixture
def picture(commands):
    """A picture with heights in alpha."""
    write_picture("n.png", colours(CODES), "rgba")
    write_picture("o.png", OTHER, "gray")
    return "n.png"


def halved(codes):
    return codes.reshape(HEIGHT // 2, 2, WIDTH // 2, 2).astype(np.float64).mean((1, 3)) / 255


def test_files_give_what_imagemagick_has_put_into_alpha(picture):
    chain, info = tex.read_normals(picture, inspect=True)
    assert isinstance(chain[0], tex.NormalMap) and chain[0].shape == (HEIGHT, WIDTH, 3)
    assert (np.rint(chain[0].alpha * 255) == CODES).all() and list(chain[0].others) == ["alpha"]
    assert [other["name"] for other in info["others"]] == ["A"]
    assert type(tex.read_normals(picture, drop_others=True)[0][0]) is np.ndarray
    assert type(tex.read_normals(picture, unpack={"others": ()})[0][0]) is np.ndarray
    assert (tex.unpack(tex.read_image(picture)).alpha == chain[0].alpha).all()
    assert (tex.unpack(colours(CODES)).alpha == chain[0].alpha).all()
    assert (tex.unpack(tex.read_texture(picture))[0].alpha == chain[0].alpha).all()


def test_pack_and_levels_have_the_bytes_of_the_commands(commands, picture):
    commands("pack-normals", picture, "-o", "pack.png", "--format", "rgba8", "--normalize")
    assert tex.encode_file(tex.pack(picture, "rgba8", y_known=False), "png") == commands.bytes("pack.png")
    commands("mip-normals", picture, "-o", "mip.ktx2", "--format", "rgba16", "--kind", "roughness")
    base = tex.read_normals(picture)[0][0]
    chain = tex.build_mip_chain(base, alpha="roughness")
    assert tex.encode_file(tex.pack(chain, "rgba16", y_known=False), "ktx2") == commands.bytes("mip.ktx2")
    means = tex.build_mip_chain(base)
    np.testing.assert_allclose(means[1].alpha, halved(CODES), atol=1e-6)
    assert (chain[1].alpha >= means[1].alpha - 1e-6).all()  # roughness only grows


def test_data_that_are_given_have_the_bytes_of_the_commands(commands, picture):
    commands("mip-normals", picture, "-o", "o.ktx2", "--format", "rgba8", "--blue", "o.png", "--alpha", "0.5",
             "--kind", "occlusion,mask")
    n = tex.NormalMap(tex.read_normals(picture)[0][0], blue=OTHER / np.float32(255), alpha=np.full_like(CODES, 0.5, np.float32))
    chain = tex.build_mip_chain(n, blue="occlusion")
    assert tex.encode_file(tex.pack(chain, "rgba8", y_known=False), "ktx2") == commands.bytes("o.ktx2")
    tex.pack_file(picture, "p.ktx2", mip={}, pack={"encoding": "rgba8"}, others={"blue": OTHER, "alpha": 0.5})
    assert commands.bytes("p.ktx2") == commands.bytes("o.ktx2")
    commands("mip-normals", picture, "-o", "l.exr", "--format", "float", "--length", "o.png", "--mips", "none")
    lengths = tex.NormalMap(tex.read_normals(picture)[0][0], alpha=None, length=OTHER / np.float32(255))
    assert tex.encode_file(tex.pack(lengths, "float", y_known=False), "exr") == commands.bytes("l.exr")
    unpack = {"others": ["length"]}
    found = tex.read_normals("l.exr", unpack=unpack)[0][0]
    np.testing.assert_allclose(found.length, OTHER / 255, atol=2e-6)
    kinds = [finding.id for finding in tex.check("l.exr", any_length=True)]
    assert "N201" in [finding.id for finding in tex.check("l.exr")] and "N201" not in kinds


def test_findings_say_which_texels_spoke():
    rows, columns = np.indices((64, 64))
    colors = np.stack([128 + 40 * np.sin(columns / 5), 128 + 40 * np.cos(rows / 7), np.full((64, 64), 247)], axis=2)
    colors = colors.astype(np.uint8)
    colors[8:18, 40:48] = (190, 128, 20)
    found = {finding.id: finding for finding in tex.check(colors, marks=64, disable=["N304"])}
    marks = found["N202"].marks
    spoke = marks["squares"] == marks["names"].index("spoke")
    assert marks["side"] == 1 and marks["texels"]["spoke"] == 80 and spoke.sum() == 80 and spoke[8:18, 40:48].all()
    assert found["N202"].fix_harms == ""
    assert all(finding.marks is None for finding in tex.check(colors))


def test_heights_that_are_baked_go_into_alpha(commands):
    write_picture("h.png", CODES, "gray")
    commands("bake-normals", "h.png", "-o", "n.dds", "--format", "rgba8", "--alpha", "height", "--kind", "height")
    tex.bake_file("h.png", "p.dds", pack={"encoding": "rgba8"}, others={"alpha": "heights"}, mip={"alpha": "height"})
    assert commands.bytes("n.dds") == commands.bytes("p.dds")
    field = tex.read_heights("h.png")
    n = tex.NormalMap(tex.bake(field), alpha=field.height)
    tex.write_texture("m.dds", tex.pack(tex.build_mip_chain(n), "rgba8"))
    assert commands.bytes("n.dds") == commands.bytes("m.dds")


def test_scale_blend_and_conversions_keep_them(commands, picture):
    base = tex.read_normals(picture)[0][0]
    assert (tex.scale(base, 2).alpha == base.alpha).all()
    assert (tex.scale([base], 2)[0].alpha == base.alpha).all()
    commands("blend-normals", picture, "n.png", "-o", "b.ktx2", "--format", "rgba8", "--mips", "none")
    blended = tex.blend(base, [{"detail": np.asarray(base)}])
    assert (blended.alpha == base.alpha).all()
    assert tex.encode_file(tex.pack(blended, "rgba8", y_known=False), "ktx2") == commands.bytes("b.ktx2")
    assert not hasattr(tex.blend(np.asarray(base), [{"detail": base}]), "alpha")  # the detail's are not taken
    part = tex.MeshPart(positions=[[0, 0, 0], [1, 0, 0], [0, 1, 0]], normals=[[0, 0, 1]] * 3,
                        uvs=[[[0, 0], [2, 0], [0, 2]]], indices=[0, 1, 2])
    space = tex.select_part(tex.Mesh([part]))
    converted = tex.to_object_space(base, space)["map"]
    assert (converted.alpha == base.alpha).all()
    assert (tex.to_tangent_space(converted, space)["map"].alpha == base.alpha).all()


def test_maps_are_arrays():
    alpha = CODES / np.float32(255)
    n = tex.NormalMap(NORMALS, alpha=alpha)
    assert isinstance(n, np.ndarray) and np.shares_memory(n, NORMALS) and n.alpha is alpha
    for same in (n.copy(), copy.copy(n), copy.deepcopy(n), pickle.loads(pickle.dumps(n)), tex.NormalMap(n)):
        assert (same.alpha == alpha).all() and (same == n).all() and same.blue is None
    assert tex.NormalMap(n, alpha=None).alpha is None and tex.NormalMap(n, blue=alpha).others.keys() == {"blue", "alpha"}
    for other in (n[::-1], n[:2], -n, n.T):
        assert other.alpha is None
    assert type(np.asarray(n)) is np.ndarray


def test_layouts_of_planes():
    plain = tex.pack(tex.NormalMap(NORMALS, alpha=CODES), "rgba8").levels[0].tobytes()  # 255 is 1
    alpha = CODES / np.float32(255)
    for same in (alpha.astype(np.float64), np.asfortranarray(alpha), np.repeat(alpha, 2, axis=1)[:, ::2]):
        assert tex.pack(tex.NormalMap(NORMALS, alpha=same), "rgba8").levels[0].tobytes() == plain


@pytest.mark.parametrize("width", [40, 64])
def test_results_outlive_what_they_share(width):
    normals = tex.bake(np.zeros((32, width), np.float32))
    chain = tex.build_mip_chain(tex.NormalMap(normals, alpha=np.full((32, width), 0.25, np.float32)))
    again = tex.build_mip_chain(chain[0])
    scaled = tex.scale(chain[0], 2)
    scaled.alpha[:] = 0.75
    assert (chain[0].alpha == 0.25).all()
    del normals, chain
    gc.collect()
    [tex.bake(np.ones((32, width), np.float32)) for _ in range(8)]
    assert (again[0].alpha == 0.25).all() and (again[1].alpha == 0.25).all()


def test_what_files_hold_beside_normals_may_be_left_out(picture):
    n = tex.read_normals(picture)[0][0]
    assert n.alpha is not None
    alone = tex.encode_file(tex.pack(tex.NormalMap(n, alpha=None), "bc5"), "dds")
    for source in (picture, tex.read_image(picture), tex.read_texture(picture)):
        assert bytes(tex.pack(source, "bc5").levels[0]) == alone[-len(tex.pack(source, "bc5").levels[0]):]


def test_mistakes_are_named():
    for call, error, text in (
        (lambda: tex.NormalMap(NORMALS, aplha=CODES), TypeError, "unexpected argument 'aplha'"),
        (lambda: tex.NormalMap(NORMALS[..., 0]), ValueError, "n: expected an array of shape (height, width, 3)"),
        (lambda: tex.NormalMap(NORMALS, alpha=CODES.T), ValueError, "alpha: expected an array of shape (24, 40)"),
        (lambda: tex.pack(tex.NormalMap(NORMALS, alpha=np.full(CODES.shape, np.nan))), ValueError, "chain.alpha: some values"),
        (lambda: tex.pack(tex.NormalMap(NORMALS, blue=CODES, length=CODES), "rgba8"), tex.BadOptionError, "blue and length"),
        (lambda: tex.pack(tex.NormalMap(NORMALS, alpha=CODES), "bc5"), ValueError,
         "chain: bc5 has no room for alpha; NormalMap(n, alpha=None) leaves it out"),
        (lambda: tex.pack([tex.NormalMap(NORMALS, blue=CODES)], "rg8"), ValueError, "rg8 has no room for blue"),
        (lambda: tex.encode_blocks(tex.NormalMap(NORMALS, length=CODES), "bc5"), ValueError, "n: bc5 has no room for length"),
        (lambda: tex.unpack(colours(CODES), others="alpha"), TypeError, "others: expected a sequence"),
        (lambda: tex.unpack(colours(CODES), others=["aplha"]), ValueError, "must be one of 'blue', 'alpha', 'length'"),
        (lambda: tex.pack_file("a", "b.png", others={"aplha": 1}), ValueError, "others: 'aplha' must be one of"),
        (lambda: tex.pack_file("a", "b.png", others={"alpha": "heights"}), ValueError, "must be a number or an array"),
        (lambda: tex.build_mip_chain(NORMALS, alpha="rust"), ValueError, "alpha: 'rust' must be one of"),
    ):
        with pytest.raises(error) as caught:
            call()
        assert text in str(caught.value)
