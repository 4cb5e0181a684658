# SPDX-License-Identifier: Apache-2.0
"""Arrays of every layout: right, or a clear TypeError or ValueError; no copies where the layout allows."""

import gc
import os
import subprocess
import sys

import numpy as np
import pytest

import tex

RANDOM = np.random.default_rng(1)
HEIGHTS = RANDOM.random((48, 64), dtype=np.float32)


def bytes_of(array):
    return np.ascontiguousarray(array).tobytes()


EXPECTED = bytes_of(tex.bake(HEIGHTS, bumpiness=5))


def layouts_of(array):
    """The same values in other layouts of memory."""
    padded = np.zeros((50, 67), np.float32)
    padded[1:49, 2:66] = array
    sparse = np.zeros((96, 128), np.float32)
    sparse[::2, ::2] = array
    unaligned = np.zeros(array.nbytes + 1, np.uint8)[1:].view(np.float32).reshape(array.shape)
    unaligned[:] = array
    read_only = array.copy()
    read_only.flags.writeable = False
    return {
        "contiguous": array,
        "fortran": np.asfortranarray(array),
        "window": padded[1:49, 2:66],
        "every second": sparse[::2, ::2],
        "rows from below": np.ascontiguousarray(array[::-1])[::-1],
        "columns from the right": np.ascontiguousarray(array[:, ::-1])[:, ::-1],
        "both": np.ascontiguousarray(array[::-1, ::-1])[::-1, ::-1],
        "transposed": np.ascontiguousarray(array.T).T,
        "unaligned": unaligned,
        "read-only": read_only,
        "big-endian": array.astype(">f4"),
        "float64": array.astype(np.float64),
        "big-endian float64": array.astype(">f8"),
        "list": array.tolist(),
        "memoryview": memoryview(array),
    }


@pytest.mark.parametrize("layout", layouts_of(HEIGHTS))
def test_heights_of_every_layout_give_the_same_normals(layout):
    given = layouts_of(HEIGHTS)[layout]
    before = np.array(given)
    assert bytes_of(tex.bake(given, bumpiness=5)) == EXPECTED
    assert (np.array(given) == before).all()


@pytest.mark.parametrize("width", [1, 2, 15, 16, 17, 33, 63])
def test_heights_of_every_width_end_with_their_memory(width):
    heights = HEIGHTS[:7, :width]
    assert bytes_of(tex.bake(heights)) == bytes_of(tex.bake(heights.copy()))


GUARDED = """
import ctypes, mmap, sys
import numpy as np, tex
width, page = int(sys.argv[1]), mmap.PAGESIZE
memory = mmap.mmap(-1, 2 * page)
address = ctypes.addressof(ctypes.c_char.from_buffer(memory))
assert ctypes.CDLL(None).mprotect(ctypes.c_void_p(address + page), page, 0) == 0
heights = np.frombuffer(memory, np.float32, 3 * width, page - 12 * width).reshape(3, width)
for kernel in ("central", "sobel5", "gaussian"):
    tex.bake(heights, kernel=kernel)
tex.encode_blocks(np.stack([heights, heights, heights + 1], axis=2))
print("end")
"""


@pytest.mark.parametrize("width", [1, 15, 16, 17, 48, 63])
def test_nothing_is_read_behind_an_array(width):
    done = subprocess.run([sys.executable, "-c", GUARDED, str(width)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "end\n"), done.stderr


@pytest.mark.parametrize("wrap", ["repeat", "clamp", "mirror"])
def test_shared_heights_give_the_normals_of_copied_ones(wrap):
    shared, copied = HEIGHTS, np.asfortranarray(HEIGHTS)
    for kernel in ("forward", "central", "sobel5", "gaussian"):
        assert bytes_of(tex.bake(shared, wrap=wrap, kernel=kernel)) == bytes_of(tex.bake(copied, wrap=wrap, kernel=kernel))


def test_integers_are_what_read_image_makes_of_them(tmp_path):
    codes = RANDOM.integers(0, 256, (32, 32), dtype=np.uint8)
    floats = codes.astype(np.float32) / np.float32(255)
    assert bytes_of(tex.bake(codes)) == bytes_of(tex.bake(floats))
    words = RANDOM.integers(0, 65536, (32, 32), dtype=np.uint16)
    assert bytes_of(tex.bake(words.astype(">u2"))) == bytes_of(tex.bake(words.astype(np.float32) / np.float32(65535)))
    signed = RANDOM.integers(-127, 128, (32, 32), dtype=np.int8)
    assert bytes_of(tex.bake(signed)) == bytes_of(tex.bake(signed.astype(np.float32) / np.float32(127)))
    for kind, least in ((np.int8, -128), (np.int16, -32768)):  # the lowest code is -1, too
        lowest = np.array([[least, least + 1, 0, -least - 1]], kind)
        assert np.asarray(tex.HeightField(lowest)).tolist() == [[-1, -1, 0, 1]]
        assert np.asarray(tex.Image(lowest)).tolist() == [[-1, -1, 0, 1]]
    halves = floats.astype(np.float16)
    assert bytes_of(tex.bake(halves)) == bytes_of(tex.bake(halves.astype(np.float32)))


@pytest.mark.parametrize("dtype", [bool, np.int32, np.uint32, np.int64, complex, object, "U3", "datetime64[s]"])
def test_other_types_are_refused(dtype):
    with pytest.raises(TypeError, match="height: cannot use values of the type"):
        tex.bake(np.zeros((4, 4), dtype))


@pytest.mark.parametrize("shape", [(), (4,), (4, 4, 1), (4, 4, 3), (0, 4), (4, 0), (2, 2, 2, 2)])
def test_other_shapes_are_refused(shape):
    with pytest.raises(ValueError, match="height: (expected an array|sides are)"):
        tex.bake(np.zeros(shape, np.float32))


def test_sides_are_limited():
    with pytest.raises(ValueError, match="sides are 1 to 1048576"):
        tex.bake(np.broadcast_to(np.float32(0), (1, (1 << 20) + 1)))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_values_must_be_finite(value):
    heights = HEIGHTS.copy()
    heights[-1, -1] = value
    with pytest.raises(tex.BadDataError, match="some heights are NaN or infinite"):
        tex.bake(heights)
    with pytest.raises(ValueError, match="height: some values are infinite or NaN"):
        tex.deband(heights)
    field = tex.height_field(HEIGHTS)
    field.height[-1, -1] = value
    for call in (tex.deband, lambda field: tex.check(tex.pack(tex.bake(HEIGHTS)), height=field)):
        with pytest.raises(ValueError, match="height: some values are infinite or NaN"):
            call(field)
    normals = tex.bake(HEIGHTS)
    normals[3, 5, 2] = value
    for call in (tex.pack, tex.build_mip_chain, tex.encode_blocks, tex.slope_range, lambda n: tex.compare(n, n)):
        with pytest.raises(ValueError, match="infinite or NaN"):
            call(normals)


def test_what_surfaces_have_may_lack_normals():
    stored = np.array(np.broadcast_to(np.float32([0, 0, 1]), (32, 32, 3)))
    stored[2, 3], stored[5, 6, 0] = np.nan, np.inf
    n = tex.unpack(tex.Image(stored, ["X", "Y", "Z"]), keep_invalid=True, range="signed")
    assert np.isnan(n).all(2).sum() == 2
    for same in (n, np.array(n), stored):
        found = tex.integrate(same)
        assert found["unused_texels"] == 2 and np.allclose(found["height"], 0)
        assert not np.isnan(tex.curvature(same)["values"]).any()
    for refuses in (tex.build_mip_chain, tex.pack, tex.slope_range):
        with pytest.raises(ValueError, match="some values are infinite or NaN"):
            refuses(n)
    colours = (stored + 1) / 2
    for verb in (tex.integrate, tex.curvature):
        with pytest.raises(ValueError, match="look like colours"):
            verb(colours)


@pytest.mark.parametrize("row", [0, 1499, 2000, 2999])
def test_every_row_of_a_large_array_is_examined(row):
    heights = np.zeros((3000, 1600), np.float32)  # large enough for several threads
    heights[row, 1599] = np.nan
    with pytest.raises(ValueError, match="height: some values are infinite or NaN"):
        tex.deband(heights)
    with pytest.raises(tex.BadDataError, match="some heights are NaN or infinite"):
        tex.bake(heights)


@pytest.mark.parametrize("wrong", [None, 3, {}, np.zeros((4, 4), np.float32), np.zeros((4, 4, 4), np.float32)])
def test_maps_must_be_maps(wrong):
    with pytest.raises((TypeError, ValueError), match="^(base|chain|n|a)"):
        tex.build_mip_chain(wrong)


def test_stored_colours_are_no_normals():
    with pytest.raises(TypeError, match=r"unpack\(\) makes normals"):
        tex.pack(np.zeros((4, 4, 3), np.uint8))
    normals = tex.bake(HEIGHTS, bumpiness=8)
    colours = np.asarray(normals) * 0.5 + 0.5
    for call in (tex.pack, tex.encode_blocks, tex.build_mip_chain, lambda n: tex.compare(n, n),
                 lambda n: tex.scale([n], 2)):
        for given in (colours, colours.astype(np.float64), np.full((3, 5, 3), (0.5, 0.5, 1.0))):
            with pytest.raises(ValueError, match=r"look like colours, \(n \+ 1\) / 2; unpack\(\) makes normals"):
                call(given)
    again = tex.unpack(colours, range="unsigned")
    assert tex.compare(again, normals)["max"] < 0.1
    ramp = np.broadcast_to(np.linspace(1, 0, 64, dtype=np.float32), (64, 64))  # x and y are 0 or more everywhere
    slopes = tex.bake(ramp + ramp.T[::-1], bumpiness=20, wrap="clamp")
    for sound in (slopes, np.float32([[[0, 0, 1]]]), slopes * 0.93, np.float32([[[1, 0, 0], [0, 1, 0]]])):
        assert tex.pack(sound).levels


def test_masks_are_not_dropped():
    masked = np.ma.masked_greater(HEIGHTS, 0.5)
    normals = np.ma.masked_greater(tex.bake(HEIGHTS), 0.5)
    for call, given in ((tex.bake, masked), (tex.height_field, masked), (tex.Image, masked), (tex.pack, normals),
                        (tex.MeshPart, normals[0])):
        with pytest.raises(TypeError, match="some values are masked"):
            call(given, [[0, 1, 2]]) if call is tex.MeshPart else call(given)
    field = tex.height_field(masked.filled(np.nan), fill_invalid=True)
    assert np.isfinite(field.height).all()
    assert np.array_equal(tex.bake(np.ma.array(HEIGHTS)), tex.bake(HEIGHTS))


def test_chains_have_the_extents_of_levels():
    chain = tex.build_mip_chain(tex.bake(HEIGHTS))
    with pytest.raises(ValueError, match=r"chain\[1\]: expected 32 x 24 texels, got 16 x 12"):
        tex.pack([chain[0], chain[2]])
    with pytest.raises(ValueError, match="no level"):
        tex.pack([])
    with pytest.raises(ValueError, match="more levels"):
        tex.pack([*chain, chain[-1]])


def test_maps_of_every_layout_give_the_same_bytes():
    n = tex.bake(HEIGHTS, bumpiness=5)
    expected = bytes(tex.pack(n).levels[0])
    interleaved = np.ascontiguousarray(n)
    for given in (interleaved, np.asfortranarray(n), n.astype(np.float64).astype(np.float32), interleaved[::-1][::-1],
                  n.astype(">f4"), np.stack([n[..., k] for k in range(3)], axis=2)):
        assert bytes(tex.pack(given).levels[0]) == expected
    for window in (n[5:29, 3:40], n[5:, 3:]):  # the second one ends with the memory
        assert bytes(tex.pack(window).levels[0]) == bytes(tex.pack(window.copy()).levels[0])
    below, apart = n[::-1], n[::2, 16:48]
    for view in (below, apart, n[:, ::-1], n[..., ::-1]):
        assert bytes(tex.pack(view).levels[0]) == bytes(tex.pack(np.ascontiguousarray(view)).levels[0])


def test_results_are_views_that_keep_their_memory():
    n = tex.bake(HEIGHTS, bumpiness=5)
    assert n.shape == (48, 64, 3) and n.dtype == np.float32 and n.flags.writeable and not n.flags.owndata
    x = n[..., 0]
    del n
    gc.collect()
    tex.bake(HEIGHTS)  # takes the memory, if it was released
    assert bytes_of(x) == np.frombuffer(EXPECTED, np.float32).reshape(48, 64, 3)[..., 0].tobytes()


def test_maps_from_libtex_are_not_copied():
    n = tex.bake(HEIGHTS)
    chain = tex.build_mip_chain(n)
    assert np.shares_memory(chain[0], n)
    del n
    gc.collect()
    assert bytes_of(chain[0]) == bytes_of(tex.bake(HEIGHTS))
    copied = np.ascontiguousarray(chain[0])
    assert not np.shares_memory(tex.build_mip_chain(copied)[0], copied)


def test_verbs_do_not_write_to_their_arguments():
    n = tex.bake(HEIGHTS, bumpiness=5)
    before = n.copy()
    scaled = tex.scale(n, 2)
    tex.blend(n, [{"detail": n}])
    tex.build_mip_chain(n, domain="slope")
    tex.build_roughness_chain(n, np.full((48, 64), 0.5, np.float32))
    assert (n == before).all() and not np.shares_memory(scaled, n)


def test_levels_of_textures_are_read_only_buffers():
    texture = tex.pack(tex.bake(HEIGHTS), "rgb8")
    level = texture.levels[0]
    assert isinstance(level, memoryview) and level.readonly and len(level) == 48 * 64 * 3
    expected = bytes(level)
    del texture
    gc.collect()
    assert bytes(level) == expected


def test_textures_are_made_from_buffers():
    texture = tex.pack(tex.bake(HEIGHTS), "rgb8")
    for data in (bytes(texture.levels[0]), bytearray(texture.levels[0]), np.frombuffer(texture.levels[0], np.uint8)):
        again = tex.Texture("rgb8-unorm", (64, 48), [data], swizzle="rgb", y_axis="up")
        assert tex.encode_file(again, "dds") == tex.encode_file(texture, "dds")
    with pytest.raises(ValueError, match=r"levels\[0\]: expected 9216 bytes, got 9"):
        tex.Texture("rgb8-unorm", (64, 48), [b"123456789"])
    with pytest.raises(ValueError, match=r"levels\[0\]: must be contiguous"):
        tex.Texture("rgb8-unorm", (64, 48), [np.zeros(18432, np.uint8)[::2]])
    with pytest.raises(ValueError, match="extent"):
        tex.Texture("rgb8-unorm", (0, 48), [b""])


def test_pictures_show_their_planes():
    image = tex.decode(tex.pack(tex.bake(HEIGHTS), "rgb8"))
    assert image["R"].shape == (48, 64) and np.shares_memory(image["R"], image.planes[0])
    with pytest.raises(KeyError):
        image["Z"]
    red = image["R"]
    del image
    gc.collect()
    assert np.isfinite(red).all()


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif("libasan" in os.environ.get("LD_PRELOAD", ""), reason="the sanitizer keeps freed memory")
def test_ten_thousand_calls_leak_nothing():
    small = HEIGHTS[:16, :16]

    def call():
        n = tex.bake(small, progress=lambda _: None)
        chain = tex.build_mip_chain(n)
        texture = tex.pack(chain)
        tex.unpack(tex.decode_file(tex.encode_file(texture, "dds")))
        tex.check(texture)
        for wrong in (lambda: tex.bake(small, kernel="x"), lambda: tex.bake(None), lambda: tex.read_image("none.png")):
            with pytest.raises((TypeError, ValueError, OSError)):
                wrong()

    for _ in range(300):
        call()
    gc.collect()
    before, objects = resident(), len(gc.get_objects())
    for _ in range(1000):  # ten calls of libtex each
        call()
    gc.collect()
    assert resident() - before < 4 << 20
    assert len(gc.get_objects()) - objects < 100
