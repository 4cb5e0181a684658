# SPDX-License-Identifier: Apache-2.0
"""The classes: made by hand, copied, pickled, shown; what verbs accept in place of arrays."""

import copy
import io
import pickle

import numpy as np
import pytest
from PIL import Image as Pillow

import tex
from conftest import SAMPLES

CLASSES = [tex.CheckReport, tex.Finding, tex.HeightField, tex.Image, tex.Mesh, tex.MeshPart, tex.Region,
           tex.SelectedPart, tex.Texture]


def part():
    return tex.MeshPart([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], normals=[[0, 0, 1]] * 3,
                        uvs=[[0, 0], [1, 0], [0, 1]], v_axis="down", name="p\udcff")


def objects(heights, normals):
    mesh = tex.Mesh([part()])
    texture = tex.pack(normals[:64, :64])
    report = tex.check(tex.pack(-normals), "n\udcff.dds", require={"y": "down", "mips": "full"})
    return [
        tex.read_image(SAMPLES / "bricks.png"),
        tex.HeightField(heights, (3, 4), ("clamp", "mirror")),
        tex.height_field(tex.read_image(SAMPLES.parent / "tests/unit/geotiff/utm.tif")),
        texture,
        tex.encode_picture(tex.preview(normals[:8, :8])) and tex.preview(normals[:8, :8]),
        report,
        report.findings[0],
        mesh.parts[0],
        mesh,
        tex.SelectedPart(part(), [[1, 0, 0, 1]] * 3),
    ]


def attributes(value):
    names = [name for name in dir(value) if not name.startswith("_")]
    return {name: getattr(value, name) for name in names if not callable(getattr(value, name))}


def same(a, b):
    if isinstance(a, np.ndarray):
        return np.array_equal(a, b)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if type(a) in CLASSES:
        return type(a) is type(b) and same(attributes(a), attributes(b))
    return a == b


@pytest.mark.parametrize("again", [lambda o: pickle.loads(pickle.dumps(o)), copy.copy, copy.deepcopy],
                         ids=["pickle", "copy", "deepcopy"])
def test_objects_can_be_pickled_and_copied(heights, normals, again):
    for value in objects(heights, normals):
        twin = again(value)
        assert twin is not value and same(value, twin), value
    assert tex.unpack(again(tex.pack(normals)))[0].shape == normals.shape


def test_a_damaged_pickle_is_an_error(normals):
    restore, (name, parts) = tex.pack(normals[:4, :4]).__reduce__()
    for wrong in ((), parts[:3], (b"",) * len(parts), None, ("x",) * len(parts)):
        with pytest.raises((ValueError, IndexError, TypeError)):
            restore(name, wrong)


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_no_object_is_without_a_value(kind):
    with pytest.raises(TypeError):
        kind.__new__(kind)
    with pytest.raises(TypeError, match=f"{kind.__name__}"):
        kind()
    with pytest.raises(TypeError):
        type("Mine", (kind,), {})


def test_pictures_are_arrays():
    colours = np.random.default_rng(3).integers(0, 256, (5, 7, 3), np.uint8)
    image = tex.Image(colours)
    assert (image.shape, image.names, image.bits, image.extent) == ((5, 7, 3), ["R", "G", "B"], 8, (7, 5))
    assert np.array_equal(np.rint(np.asarray(image) * 255), colours)
    assert np.asarray(image, dtype=np.float64).dtype == np.float64
    grey = tex.read_image(SAMPLES / "bricks.png")
    with Pillow.open(SAMPLES / "bricks.png") as other:
        assert np.array_equal(np.rint(np.asarray(grey) * (2**grey.bits - 1)), np.asarray(other, dtype=np.float32))
    assert grey.shape == np.asarray(grey).shape == (512, 512)
    many = tex.Image(np.zeros((2, 3, 6), np.float32), [f"layer.{k}" for k in range(6)])
    assert many.names[5] == "layer.5" and many["layer.5"].shape == (2, 3)
    with pytest.raises(ValueError, match="names: there must be 3"):
        tex.Image(colours, ["R"])
    field = tex.HeightField([[0.0, 0.5]], 3, "clamp")
    assert (field.shape, field.bumpiness, field.wrap) == ((1, 2), (3, 3), ("clamp", "clamp"))
    assert np.array_equal(np.asarray(field), [[0.0, 0.5]])


def test_a_missing_channel_names_those_that_exist():
    image = tex.Image(np.zeros((2, 2, 3), np.uint8))
    with pytest.raises(KeyError, match="no channel 'Y'; there are 'R', 'G', 'B'.*read_heights"):
        image["Y"]
    with pytest.raises(TypeError, match="channels have names: 'R', 'G', 'B'"):
        image[0]


@pytest.fixture
def files(tmp_path, normals):
    tex.write_texture(tmp_path / "n.png", tex.pack(normals, "rgb16"))
    tex.write_texture(tmp_path / "n.dds", tex.pack(tex.build_mip_chain(normals), "bc5"))
    return tmp_path


def test_heights_come_from_files_and_pictures(heights, tmp_path):
    expected = tex.bake(heights, bumpiness=5)
    path = SAMPLES / "bricks.png"
    for source in (path, str(path), tex.read_image(path), tex.read_heights(path), tex.HeightField(heights)):
        assert np.array_equal(tex.bake(source, bumpiness=5), expected)
    colours = tmp_path / "rgb.png"
    Pillow.fromarray(np.uint8([[[9, 9, 9], [200, 200, 200]]])).save(colours)
    assert np.allclose(tex.read_heights(colours).height, [[9 / 255, 200 / 255]])
    assert np.allclose(tex.read_heights(colours, channel="g", invert=True).height, [[246 / 255, 55 / 255]])
    with pytest.raises(tex.BadOptionError) as caught:
        tex.read_heights(colours, channel="a")
    assert caught.value.file == str(colours)
    with pytest.raises(tex.IoError):
        tex.read_heights("none.png")


def test_normals_come_from_files_pictures_and_textures(files, normals):
    picture = tex.read_image(files / "n.png")
    texture = tex.read_texture(files / "n.dds")
    direct = tex.unpack(picture)
    assert tex.encode_file(tex.pack(files / "n.png"), "dds") == tex.encode_file(tex.pack(direct), "dds")
    assert tex.encode_file(tex.pack(picture), "dds") == tex.encode_file(tex.pack(direct), "dds")
    assert len(tex.pack(str(files / "n.dds")).levels) == len(texture.levels) == 10
    for other in (files / "n.png", picture):
        assert tex.compare(other, normals)["max"] < 0.01
    assert 0.01 < tex.compare(texture, files / "n.dds")["mean"] + tex.compare(texture, normals)["mean"] < 2
    assert tex.slope_range(picture) == tex.slope_range(direct)


def test_arrays_and_pictures_can_be_checked(files, normals):
    expected = [f.id for f in tex.check(files / "n.png")]
    assert [f.id for f in tex.check(tex.read_image(files / "n.png"))] == expected
    codes = np.uint8(np.rint((normals * 0.5 + 0.5) * 255))
    [found] = [f for f in tex.check(codes[:, :, [1, 0, 2]], require={"y": "down"}) if f.severity == "error"][:1]
    assert found.id.startswith("N")
    assert not [f for f in tex.check(np.asarray(normals)) if f.severity == "error"]
    assert [f.id for f in tex.check(normals * 0.5)] == ["N201"] or tex.check(normals * 0.5).findings
    with pytest.raises(ValueError, match="what: a normal map has 2 to 4 channels"):
        tex.check(normals[:, :, 0])


def test_a_check_that_cannot_be_made_raises(tmp_path, normals):
    with pytest.raises(tex.IoError) as caught:
        tex.check(tmp_path / "none\udcff.dds")
    assert caught.value.file == str(tmp_path / "none\udcff.dds")
    (tmp_path / "bad.dds").write_bytes(b"DDS nonsense")
    for check in (tex.check, tex.check_file):
        with pytest.raises(tex.BadDataError):
            check(tmp_path / "bad.dds")
    tex.write_texture(tmp_path / "n.dds", tex.pack(normals))
    for what in (tmp_path / "n.dds", tex.pack(normals)):
        with pytest.raises(tex.CancelledError):
            tex.check(what, progress=lambda fraction: False)


def test_names_need_not_be_utf8(tmp_path, normals):
    path = tmp_path / "n\udcff.dds"
    tex.write_texture(path, tex.pack(normals))
    report = tex.check(path)
    assert report.file == str(path) and "n\udcff.dds" in repr(report)
    assert tex.check(tex.pack(normals), "n\udcff.dds").file == "n\udcff.dds"


def shown(png):
    with Pillow.open(io.BytesIO(png)) as picture:
        return np.asarray(picture.convert("RGB"), dtype=np.float32)


def test_notebooks_show_textures_and_pictures(normals):
    colours = np.rint((normals * 0.5 + 0.5) * 255)
    for encoding in ("rgb8", "dxt5nm", "bc5", "float"):
        assert np.abs(shown(tex.pack(normals, encoding)._repr_png_()) - colours).mean() < 3, encoding
    picture = tex.preview(normals, size=(40, 30))
    assert picture._repr_png_() == tex.encode_picture(picture)
    large = tex.pack(tex.build_mip_chain(np.tile(normals, (4, 1, 1))))
    assert shown(large._repr_png_()).shape == (1024, 256, 3)
    heights = tex.Image(np.uint8([[0, 128, 255]]))
    assert np.array_equal(shown(heights._repr_png_())[0, :, 0], [0, 128, 255])
    assert shown(tex.Texture("r8-unorm", (3, 1), [bytes([0, 128, 255])])._repr_png_()).tolist()[0][1] == [128] * 3
