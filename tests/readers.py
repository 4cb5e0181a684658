#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# readers.py BUILD: what GDAL, OpenImageIO, ImageMagick, Pillow and libtex read in files that leave open what they mean.
#
# Each function makes a file, lets the programs read it, and holds what it says of them in normal-maps(7), "HOW OTHER
# PROGRAMS READ THESE FILES". A row that fails is one that the manual tells wrong, in our reader or in another version of
# theirs. The last line counts: "readers: N passed, M failed".
import os
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy
from osgeo import gdal, osr
from PIL import Image

BUILD = os.path.abspath(sys.argv[1])
sys.path.insert(0, os.path.join(BUILD, "python"))
import tex  # noqa: E402  (the module of this build)

gdal.UseExceptions()
SIDE = 32


def ours(file):
    """The first channel, with NaN where there is no data."""
    image = tex.read_image(file, values="stored")
    heights = numpy.array(image.planes[0])
    if image.no_data is not None:
        heights[heights == numpy.float32(image.no_data)] = numpy.nan
    return heights


def normals(file):
    return numpy.asarray(tex.read_normals(file)[0][0])


def by_gdal(file):
    return gdal.Open(file).ReadAsArray()


def printed(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False)


def by_oiio(file):
    """The codes of each texel: a line is "Pixel (0, 0): 200 60 (0.784 0.235)"."""
    lines = printed("oiiotool", "--native", "--dumpdata", file).stdout.splitlines()
    return [tuple(map(int, line.split("):")[1].split("(")[0].split())) for line in lines if "Pixel (" in line]


def geotiff(name, heights, epsg=None, cell=30.0, options=(), no_data=None):
    rows, columns = heights.shape
    kind = gdal.GDT_UInt16 if heights.dtype == numpy.uint16 else gdal.GDT_Float32
    made = gdal.GetDriverByName("GTiff").Create(name, columns, rows, 1, kind, list(options))
    made.SetGeoTransform((0, cell, 0, rows * cell / 2, 0, -cell))
    if epsg:
        system = osr.SpatialReference()
        system.ImportFromEPSG(epsg)
        made.SetProjection(system.ExportToWkt())
    if no_data is not None:
        made.GetRasterBand(1).SetNoDataValue(no_data)
    made.GetRasterBand(1).WriteArray(heights)
    return made


def slope(file, *options):
    gdal.DEMProcessing("slope.tif", file, "slope", computeEdges=True, options=list(options))
    return by_gdal("slope.tif")


def strips_never_written():
    made = gdal.GetDriverByName("GTiff").Create("sparse.tif", SIDE, SIDE, 1, gdal.GDT_UInt16, ["SPARSE_OK=TRUE"])
    made.GetRasterBand(1).SetNoDataValue(7)
    made.GetRasterBand(1).WriteArray(numpy.full((1, SIDE), 9, numpy.uint16), 0, SIDE - 1)
    del made
    assert set(by_gdal("sparse.tif").ravel()) == {7, 9}
    assert numpy.isnan(ours("sparse.tif")).sum() == (SIDE - 1) * SIDE, "no data"
    assert set(by_oiio("sparse.tif")) > {(9,)}, "bytes of the file itself"
    damage = printed("convert-im6.q16", "sparse.tif", "-depth", "16", "gray:sparse.raw")
    assert damage.returncode or set(open("sparse.raw", "rb").read()) != {7, 0}


def mask_in_a_tiff():
    heights = numpy.full((SIDE, SIDE), 1000, numpy.float32)
    gdal.SetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES")
    made = geotiff("mask.tif", heights, 32632)
    heights[:, :8] = 0
    made.GetRasterBand(1).WriteArray(heights)
    made.CreateMaskBand(gdal.GMF_PER_DATASET)
    band = made.GetRasterBand(1).GetMaskBand()
    mask = numpy.full((SIDE, SIDE), 255, numpy.uint8)
    mask[:, :8] = 0
    band.WriteArray(mask)
    del band, made
    made = gdal.Open("mask.tif")
    band = made.GetRasterBand(1).GetMaskBand()
    assert (band.ReadAsArray() == mask).all()
    assert (numpy.isnan(ours("mask.tif")) == (mask == 0)).all()
    assert slope("mask.tif")[8:-8, 7:9].min() > 80, "gdaldem makes a cliff"
    assert printed("identify", "mask.tif").stdout.count("\n") == 2, "ImageMagick has a second page"


def white_is_zero():
    codes = numpy.arange(SIDE * SIDE, dtype=numpy.uint16).reshape(SIDE, SIDE)
    made = geotiff("white.tif", codes, options=["PHOTOMETRIC=MINISWHITE"], no_data=5)
    del made
    assert (by_gdal("white.tif") == codes).all(), "GDAL does not invert"
    read = ours("white.tif")
    assert numpy.isnan(read[0, 5]) and numpy.isnan(read).sum() == 1, "the value is a code"
    assert read[0, 1] > read[0, 2], "ours are inverted"


def bil(name, header, codes):
    codes.tofile(name)
    with open(os.path.splitext(name)[0] + ".hdr", "w", encoding="ascii") as file:
        file.write(f"NROWS {SIDE}\nNCOLS {SIDE}\nNBANDS 1\nNBITS 16\nLAYOUT BIL\n" + header)


def bil_without_byteorder():
    codes = numpy.arange(SIDE * SIDE, dtype=">i2").reshape(SIDE, SIDE)
    bil("order.bil", "", codes)
    assert (by_gdal("order.bil") == codes).all() and (ours("order.bil") == codes).all()


def bil_without_pixeltype():
    codes = numpy.full((SIDE, SIDE), -5, "<i2")
    bil("sign.bil", "BYTEORDER I\nNODATA -9999\n", codes)
    assert (by_gdal("sign.bil") == -5).all() and (ours("sign.bil") == -5).all()
    bil("plain.bil", "BYTEORDER I\n", codes)
    assert (by_gdal("plain.bil") == 65531).all() and (ours("plain.bil") == 65531).all()


def bil_without_nbits():
    for kind, codes in (("UInt16", numpy.arange(SIDE * SIDE, dtype="<u2")), ("Float32", numpy.arange(SIDE * SIDE, dtype="<f4"))):
        codes = codes.reshape(SIDE, SIDE)
        codes.tofile("bits.bil")
        with open("bits.hdr", "w", encoding="ascii") as file:
            file.write(f"NROWS {SIDE}\nNCOLS {SIDE}\nBYTEORDER I\n")
        assert gdal.GetDataTypeName(gdal.Open("bits.bil").GetRasterBand(1).DataType) == kind
        assert (by_gdal("bits.bil") == codes).all() and (ours("bits.bil") == codes).all()


def bil_with_long_rows():
    codes = numpy.arange(SIDE * SIDE, dtype="<u2").reshape(SIDE, SIDE)
    numpy.pad(codes, ((0, 0), (0, 2))).tofile("rows.bil")
    with open("rows.hdr", "w", encoding="ascii") as file:
        file.write(f"NROWS {SIDE}\nNCOLS {SIDE}\nNBITS 16\nBYTEORDER I\nTOTALROWBYTES {2 * SIDE + 4}\n")
    assert (ours("rows.bil") == codes).all()
    assert (by_gdal("rows.bil") != codes).any(), "GDAL ignores the word"


def grid_without_nodata():
    with open("grid.asc", "w", encoding="ascii") as file:
        file.write("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30\n1 2 3\n4 -9999 6\n")
    assert by_gdal("grid.asc")[1, 1] == -9999 and "NoData" not in printed("gdalinfo", "grid.asc").stdout
    read = ours("grid.asc")
    assert numpy.isnan(read[1, 1]) and read[1, 2] == 6


def grid_with_dx_and_dy():
    heights = numpy.arange(SIDE * SIDE, dtype=numpy.float32).reshape(SIDE, SIDE)
    made = geotiff("cells.tif", heights)
    made.SetGeoTransform((0, 30, 0, 0, 0, -20))
    gdal.GetDriverByName("AAIGrid").CreateCopy("cells.asc", made)
    words = open("cells.asc", encoding="ascii").read().lower()
    assert "dx " in words and "dy " in words and "cellsize" not in words
    assert (ours("cells.asc") == heights).all()
    gdal.GetDriverByName("AAIGrid").CreateCopy("forced.asc", made, options=["FORCE_CELLSIZE=TRUE"])
    words = open("forced.asc", encoding="ascii").read().lower()
    assert "cellsize     30" in words and "dx " not in words


def mean_slope(file):
    """Degrees of the normals that bake-normals makes, without an option."""
    subprocess.run([os.path.join(BUILD, "bake-normals"), file, "-o", "n.exr", "--format", "float", "--quiet"], check=True)
    z = normals("n.exr")[2:-2, 2:-2, 2]
    return numpy.degrees(numpy.arccos(numpy.clip(z, -1, 1))).mean()


def elevation_in_degrees():
    # A plane that rises by 1 m a cell of an arc second at the equator, 30.9 m: 1.85 degrees.
    heights = numpy.tile(numpy.arange(SIDE, dtype=numpy.float32), (SIDE, 1))
    made = geotiff("degrees.tif", heights, 4326, 1 / 3600)
    del made
    flat = gdal.VersionInfo() < "3100000"
    assert (slope("degrees.tif").mean() > 89) == flat, "degrees are the unit of heights"
    assert abs(mean_slope("degrees.tif") - 1.85) < 0.02, mean_slope("degrees.tif")


def elevation_in_web_mercator():
    heights = numpy.tile(numpy.arange(SIDE, dtype=numpy.float32) * 30, (SIDE, 1))
    made = geotiff("mercator.tif", heights, 3857)
    made.SetGeoTransform((0, 30, 0, 8399737.0, 0, -30))  # 60 degrees north, where a metre of the map is half a metre
    del made
    assert abs(slope("mercator.tif").mean() - 45) < 0.1, "GDAL takes the metres as they are"
    assert abs(mean_slope("mercator.tif") - 63.4) < 0.2, mean_slope("mercator.tif")


def heights_in_red_and_green():
    values = numpy.arange(SIDE * SIDE).reshape(SIDE, SIDE) * 37
    picture = numpy.zeros((SIDE, SIDE, 3), numpy.uint8)
    picture[..., 0], picture[..., 1], picture[..., 2] = values >> 8, values & 255, 99
    Image.fromarray(picture).save("rg.png")
    Image.fromarray(picture[..., [1, 0, 2]]).save("gr.png")
    for name, channel in (("rg.png", "rg16"), ("gr.png", "gr16")):
        read = numpy.asarray(tex.read_heights(name, channel=channel))
        assert abs(read * 65535 - values).max() < 0.5, name


def exr_of_a_crop():
    Image.fromarray(numpy.full((SIDE, SIDE, 3), 128, numpy.uint8)).save("grey.png")
    printed("oiiotool", "grey.png", "--fullsize", f"{2 * SIDE}x{2 * SIDE}+0+0", "-o", "crop.exr")
    assert len(printed("oiiotool", "--native", "--dumpdata", "crop.exr").stdout.split("Pixel (")) == SIDE * SIDE + 1
    facts = tex.read_normals("crop.exr")[1]
    assert normals("crop.exr").shape[:2] == (SIDE, SIDE) and "of a picture of 64x64" in facts["remarks"][0], facts


def png_with_a_gamma():
    Image.fromarray(numpy.full((SIDE, SIDE, 3), 128, numpy.uint8)).save("gamma.png")
    data = open("gamma.png", "rb").read()
    chunk = b"gAMA" + struct.pack(">I", 100000)
    with open("gamma.png", "wb") as file:
        file.write(data[:33] + struct.pack(">I", 4) + chunk + struct.pack(">I", zlib.crc32(chunk)) + data[33:])
    assert (by_gdal("gamma.png") == 128).all() and set(by_oiio("gamma.png")) == {(128, 128, 128)}
    assert Image.open("gamma.png").getpixel((0, 0)) == (128, 128, 128)
    assert (ours("gamma.png") == 128).all()
    printed("convert-im6.q16", "gamma.png", "-define", "dds:compression=none", "gamma.dds")
    assert open("gamma.dds", "rb").read()[-1] == 188, "ImageMagick encodes"


def tga_of_grey_words():
    head = struct.pack("<3B5x4H2B", 0, 0, 3, 0, 0, SIDE, SIDE, 16, 0x20)
    with open("words.tga", "wb") as file:
        file.write(head + bytes([33, 200]) * SIDE * SIDE)
    assert set(by_oiio("words.tga")) == {(33,)} and Image.open("words.tga").getpixel((0, 0)) == (33, 200)
    try:
        tex.read_image("words.tga")
    except tex.UnsupportedError as error:
        assert "counts no bits of alpha" in str(error), error
    else:
        raise AssertionError("read")


def dds_with_masks():
    texel = (190, 128, 240, 255)
    masks = {"rgba.dds": (0xFF, 0xFF00, 0xFF0000, 0xFF000000), "bgrx.dds": (0xFF0000, 0xFF00, 0xFF, 0)}
    for name, order in (("rgba.dds", (0, 1, 2, 3)), ("bgrx.dds", (2, 1, 0, 3))):
        head = b"DDS " + struct.pack("<7I44x", 124, 0x100F, SIDE, SIDE, 4 * SIDE, 0, 0)
        head += struct.pack("<8I", 32, 0x41 if name == "rgba.dds" else 0x40, 0, 32, *masks[name])
        with open(name, "wb") as file:
            file.write(head + struct.pack("<5I", 0x1000, 0, 0, 0, 0) + bytes(texel[k] for k in order) * SIDE * SIDE)
        planes = tex.read_image(name, values="stored").planes
        assert [numpy.array(plane)[3, 3] for plane in planes][:3] == list(texel[:3]), name
        assert by_oiio(name)[5][:3] == texel[:3], name
    turned = subprocess.run(["convert-im6.q16", "rgba.dds", "-depth", "8", "rgb:-"], capture_output=True, check=True)
    assert tuple(turned.stdout[:3]) == (240, 128, 190), "ImageMagick exchanges red and blue"
    assert Image.open("bgrx.dds").getpixel((1, 0)) != texel[:3], "Pillow reads three bytes a texel"


def turned_tiff():
    codes = numpy.arange(SIDE * SIDE, dtype=numpy.uint8).reshape(SIDE, SIDE)
    Image.fromarray(codes).save("turned.tif", tiffinfo={274: 3})
    assert (ours("turned.tif") == codes[::-1, ::-1]).all()
    assert (numpy.asarray(Image.open("turned.tif")) == codes[::-1, ::-1]).all(), "Pillow turns"
    assert (by_gdal("turned.tif") == codes).all(), "GDAL does not"
    assert by_oiio("turned.tif")[0] == (int(codes[0, 0]),), "oiiotool does not"


def bc5_with_ati2():
    # x is 200 and y is 60 everywhere: two blocks of one value each.
    def block(value):
        return bytes([value, value]) + bytes(6)

    def dds(name, first, second, reserved=b""):
        head = struct.pack("<4s7I", b"DDS ", 124, 0x81007, 8, 8, 64, 0, 1) + reserved.ljust(44, b"\0")
        head += struct.pack("<2I4s5I", 32, 4, b"ATI2", 0, 0, 0, 0, 0) + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
        with open(name, "wb") as file:
            file.write(head + (block(first) + block(second)) * 4)

    dds("bare.dds", 200, 60)
    assert Image.open("bare.dds").getpixel((0, 0))[:2] == (200, 60), "Pillow: red first"
    assert set(by_oiio("bare.dds")) == {(200, 60)}, "OpenImageIO: red first"
    x = normals("bare.dds")[0, 0, 0]
    assert abs(x - (2 * 200 / 255 - 1)) < 0.01, "ours: red first, where nothing tells"


ROWS = [
    strips_never_written,
    mask_in_a_tiff,
    white_is_zero,
    bil_without_byteorder,
    bil_without_pixeltype,
    grid_without_nodata,
    grid_with_dx_and_dy,
    elevation_in_degrees,
    elevation_in_web_mercator,
    heights_in_red_and_green,
    bil_without_nbits,
    bil_with_long_rows,
    exr_of_a_crop,
    png_with_a_gamma,
    tga_of_grey_words,
    dds_with_masks,
    turned_tiff,
    bc5_with_ati2,
]


def main():
    print(f"GDAL {gdal.__version__}, Pillow {Image.__version__}, {printed('oiiotool', '--version').stdout.strip()}")
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for row in ROWS:
            try:
                row()
                print(f"ok      {row.__name__}")
            except Exception as error:  # pylint: disable=broad-except
                failed += 1
                print(f"FAILED  {row.__name__}: {type(error).__name__}: {error}")
        os.chdir("/")
    print(f"readers: {len(ROWS) - failed} passed, {failed} failed")
    return int(failed > 0)


sys.exit(main())
