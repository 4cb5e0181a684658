// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader.h"

#include <gtest/gtest.h>

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>

#include "formats/reader/reader_process.h"
#include "formats/reader/reader_rows.h"
#include "scratch.h"
#include "unit/tiff_maker.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

void expect_row(const Result<Image>& image, std::size_t plane, const std::vector<float>& values) {
    ASSERT_TRUE(image) << image.error().message();
    ASSERT_LT(plane, image->planes.size());
    ASSERT_EQ(static_cast<std::size_t>(image->extent().width), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(image->planes[plane].at(static_cast<int>(i), 0), values[i]) << i;
}

TEST(Reader, ReadsEverySampleTypeOfTiffRaw) {
    TiffMaker tiff{4, 1};
    tiff.data = raw<std::uint8_t>({0, 1, 128, 255});
    expect_row(read(tiff.make()), 0, {0.0f, 1 / 255.0f, 128 / 255.0f, 1.0f});
    tiff.bits = 16;
    tiff.data = raw<std::uint16_t>({0, 1, 32768, 65535});
    expect_row(read(tiff.make()), 0, {0.0f, 1 / 65535.0f, 32768 / 65535.0f, 1.0f});
    tiff.bits = 32;
    tiff.data = raw<std::uint32_t>({0, 1, 2147483648u, 4294967295u});
    expect_row(read(tiff.make()), 0,
               {0.0f, static_cast<float>(1 / 4294967295.0), static_cast<float>(2147483648.0 / 4294967295.0), 1.0f});
    tiff.sample_format = 2;
    tiff.bits = 16;
    tiff.data = raw<std::int16_t>({-32768, -32767, 0, 32767});
    const Result<Image> sixteen = read(tiff.make());
    expect_row(sixteen, 0, {-1.0f, -1.0f, 0.0f, 1.0f});
    EXPECT_EQ(sixteen->sample, SampleKind::snorm);
    tiff.sample_format = 3;
    tiff.bits = 32;
    tiff.data = raw<float>({-5.25f, 0.1f, 8848.86f, 1e30f});
    const Result<Image> floats = read(tiff.make());
    expect_row(floats, 0, {-5.25f, 0.1f, 8848.86f, 1e30f});
    EXPECT_EQ(floats->sample, SampleKind::floating);
    EXPECT_EQ(floats->bits, 32);
}

TEST(Reader, FewBitsAreTheirCodesOverTheLargest) {
    TiffMaker tiff{4, 1};
    tiff.bits = 4;
    tiff.data = raw<std::uint8_t>({0x01, 0x7f});
    const Result<Image> four = read(tiff.make());
    expect_row(four, 0, {0.0f, 1 / 15.0f, 7 / 15.0f, 1.0f});
    EXPECT_EQ(four->bits, 4);
    tiff.bits = 1;
    tiff.data = raw<std::uint8_t>({0x50});
    expect_row(read(tiff.make()), 0, {0.0f, 1.0f, 0.0f, 1.0f});
}

TEST(Reader, PaletteColoursKeepAllTheirBits) {
    TiffMaker tiff{4, 1};
    tiff.bits = 4;
    tiff.photometric = 3;
    for (int c = 0; c < 3; ++c) {
        for (std::uint32_t v = 0; v < 16; ++v) put(tiff.palette, (v * 13 + static_cast<std::uint32_t>(c)) * 257, 2);
    }
    tiff.data = raw<std::uint8_t>({0x01, 0x7f});
    const Result<Image> image = read(tiff.make());
    expect_row(image, 0, {0.0f, 13 / 255.0f, 91 / 255.0f, 195 / 255.0f});
    expect_row(image, 2, {2 / 255.0f, 15 / 255.0f, 93 / 255.0f, 197 / 255.0f});
    EXPECT_EQ(image->bits, 8);
}

TEST(Reader, UnassociatedAlphaTouchesNoColour) {
    TiffMaker tiff{1, 1};
    tiff.samples = 4;
    tiff.photometric = 2;
    tiff.extra = 2;
    tiff.data = raw<std::uint8_t>({200, 100, 50, 10});
    const Result<Image> image = read(tiff.make());
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->names, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(image->planes[0].at(0, 0), 200 / 255.0f);
    EXPECT_EQ(image->planes[3].at(0, 0), 10 / 255.0f);
    EXPECT_EQ(image->remark, "");
}

// Dividing would lose bits, and files that state it by mistake their values. So it is said.
TEST(Reader, AssociatedAlphaIsSaid) {
    TiffMaker tiff{1, 1};
    tiff.samples = 4;
    tiff.photometric = 2;
    tiff.extra = 1;
    tiff.data = raw<std::uint8_t>({10, 5, 2, 10});
    const Result<Image> image = read(tiff.make());
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->planes[0].at(0, 0), 10 / 255.0f);
    EXPECT_EQ(image->remark, kMultipliedText);
}

// What TIFF and EXIF call 6: the first row of the file is the right column of the picture.
TEST(Reader, OrientationTurnsThePicture) {
    const std::vector<std::vector<int>> turned = {
        {10, 20, 30, 40, 50, 60}, {30, 20, 10, 60, 50, 40}, {60, 50, 40, 30, 20, 10}, {40, 50, 60, 10, 20, 30},
        {10, 40, 20, 50, 30, 60}, {40, 10, 50, 20, 60, 30}, {60, 30, 50, 20, 40, 10}, {30, 60, 20, 50, 10, 40}};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        SCOPED_TRACE(orientation);
        TiffMaker tiff{3, 2};
        tiff.data = raw<std::uint8_t>({10, 20, 30, 40, 50, 60});
        tiff.orientation = orientation;
        const Result<Image> image = read(tiff.make());
        ASSERT_TRUE(image) << image.error().message();
        const int width = orientation < 5 ? 3 : 2;
        ASSERT_EQ(image->extent(), (Extent{width, 6 / width}));
        for (int k = 0; k < 6; ++k) {
            EXPECT_EQ(
                image->planes[0].at(k % width, k / width),
                static_cast<float>(turned[static_cast<std::size_t>(orientation - 1)][static_cast<std::size_t>(k)]) /
                    255.0f);
        }
    }
}

// Radiance files state the order of rows and columns: "+Y" is from the bottom.
TEST(Reader, RadiancePicturesFromTheBottomAreTurned) {
    const auto picture = [](const std::string& order) {
        std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + order + " 2 +X 3\n";
        for (int k = 0; k < 6; ++k)
            text += {static_cast<char>(128), static_cast<char>(16 * k), 0, static_cast<char>(129)};
        const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
        return read({bytes, bytes + text.size()});
    };
    const Result<Image> plain = picture("-Y");
    const Result<Image> turned = picture("+Y");
    ASSERT_TRUE(plain && turned);
    EXPECT_EQ(plain->remark, "");
    EXPECT_EQ(turned->remark, "the picture was turned or mirrored, as its orientation (4) says");
    for (int k = 0; k < 6; ++k) {
        EXPECT_EQ(plain->planes[1].at(k % 3, k / 3), static_cast<float>(k) / 8.0f);
        EXPECT_EQ(turned->planes[1].at(k % 3, 1 - k / 3), static_cast<float>(k) / 8.0f);
    }
}

TEST(Reader, OddKindsOfSamplesKeepTheirValues) {
    TiffMaker tiff{2, 1};
    tiff.bits = 12;
    tiff.data = raw<std::uint8_t>({0x80, 0x0f, 0xff});  // a stream of bits
    const Result<Image> twelve = read(tiff.make());
    expect_row(twelve, 0, {static_cast<float>(2048 / 4095.0), 1.0f});
    EXPECT_EQ(twelve->bits, 12);
    tiff.bits = 64;
    tiff.data = raw<std::uint64_t>({0, ~std::uint64_t{0}});
    expect_row(read(tiff.make()), 0, {0.0f, 1.0f});
    tiff.sample_format = 2;
    tiff.data = raw<std::int64_t>({std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()});
    expect_row(read(tiff.make()), 0, {-1.0f, 1.0f});
    tiff.sample_format = 3;
    tiff.data = raw<double>({-8848.86, 0.1});
    expect_row(read(tiff.make()), 0, {-8848.86f, 0.1f});
    tiff.bits = 24;
    tiff.data = raw<std::uint8_t>({0, 0x80, 0x3f, 0, 0, 0xc0});  // 1.5 and -2 with 16 bits of fraction
    expect_row(read(tiff.make()), 0, {1.5f, -2.0f});
    tiff = TiffMaker{2, 1};
    tiff.photometric = 0;  // 0 is white
    tiff.data = raw<std::uint8_t>({0, 200});
    expect_row(read(tiff.make()), 0, {1.0f, 55 / 255.0f});
}

TEST(Reader, TellsWhatATiffSaysAboutItsSamples) {
    TiffMaker tiff{2, 1};
    tiff.bits = 16;
    tiff.sample_format = 2;
    tiff.data = raw<std::int16_t>({-10, 20});
    Result<InputFile> file = InputFile::from_memory("test", tiff.make());
    ASSERT_TRUE(file);
    const Result<std::unique_ptr<RowSource>> rows = open_reader_rows(*file, quick());
    ASSERT_TRUE(rows) << rows.error().message();
    EXPECT_EQ((*rows)->head().samples.kind, 2u);
    EXPECT_EQ((*rows)->head().samples.bits, 16u);
    EXPECT_EQ((*rows)->head().samples.has_place, 0u);
    EXPECT_EQ((*rows)->head().samples.has_scale, 0u);
    const std::string data = TEX_SOURCE_DIR "/../shared/data/wild/";
    if (!fs::exists(data)) GTEST_SKIP() << "../shared/data is not there";
    Result<InputFile> geo = InputFile::open(data + "gtif_scale_offset.tif");
    ASSERT_TRUE(geo);
    const Result<std::unique_ptr<RowSource>> geo_rows = open_reader_rows(*geo, quick());
    ASSERT_TRUE(geo_rows) << geo_rows.error().message();
    EXPECT_EQ((*geo_rows)->head().samples.has_scale, 1u);
    EXPECT_NE((*geo_rows)->head().samples.scale, 1.0);
}

TEST(Reader, RefusesCmyk) {
    TiffMaker tiff{1, 1};
    tiff.samples = 4;
    tiff.photometric = 5;
    tiff.data = raw<std::uint8_t>({1, 2, 3, 4});
    const Result<Image> image = read(tiff.make());
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::unsupported);
    EXPECT_EQ(image.error().reason,
              "a CMYK picture, which is not read; ImageMagick makes it RGB: convert FILE -colorspace sRGB RGB.png");
}

TEST(Reader, RefusesForeignLogLuvWithoutCallingItDamaged) {
    TiffMaker log{1, 1};
    log.samples = 3;
    log.photometric = 32845;
    log.data = raw<std::uint8_t>({1, 2, 3});
    const Result<Image> luv = read(log.make());
    ASSERT_FALSE(luv);
    EXPECT_EQ(luv.error().code, ErrorCode::unsupported);
    EXPECT_EQ(luv.error().reason, "LogLuv colours that are not compressed as such are not supported");
}

TEST(Reader, RefusesMoreTexelsThanTheLimit) {
    TiffMaker tiff{4, 1};
    tiff.data = raw<std::uint8_t>({0, 1, 128, 255});
    ReadOptions options = quick();
    options.max_texels = 3;
    EXPECT_EQ(read(tiff.make(), options).error().code, ErrorCode::unsupported);
    tiff.width = 1'000'000;  // with four bytes of data
    tiff.height = 1'000'000;
    EXPECT_FALSE(read(tiff.make()));
}

TEST(Reader, KeepsToItsMemoryLimit) {
    TiffMaker tiff{20'000, 20'000};
    tiff.data = raw<std::uint8_t>({0});
    ReadOptions options = quick();
    options.reader_memory = std::int64_t{1} << 30;
    EXPECT_FALSE(read(tiff.make(), options));
}

TEST(Reader, FilesInMemoryGrowButDoNotShrink) {
    const Result<Descriptor> file = memory_file("test");
    ASSERT_TRUE(file);
    EXPECT_EQ(ftruncate(file.value().get(), 1000), 0);
    EXPECT_NE(ftruncate(file.value().get(), 999), 0);
}

TEST(Reader, FilesOnDiskAreReadThroughTheSandbox) {
    const Scratch scratch;
    const std::string path = scratch.write("a.ppm", std::string("P5 2 1 255\n\xff\0", 13));
    expect_row(read_image(path, quick()), 0, {1.0f, 0.0f});
}

TEST(Reader, TellsWhatItIs) {
    const Result<ReaderInfo> info = reader_info(quick());
    ASSERT_TRUE(info) << info.error().message();
    EXPECT_TRUE(fs::exists(info->program));
    EXPECT_TRUE(info->openimageio.starts_with("2.")) << info->openimageio;
    EXPECT_TRUE(info->calls_filtered);
    EXPECT_EQ(info->landlock, static_cast<int>(std::max(0L, syscall(SYS_landlock_create_ruleset, nullptr, 0, 1))));
    EXPECT_EQ(info->files_restricted, info->landlock > 0);
    ReadOptions absent = quick();
    absent.reader = "/nowhere/tex-reader";
    EXPECT_EQ(reader_info(absent).error().code, ErrorCode::io);
}

TEST(Reader, AMissingProgramIsNamedWithItsPackage) {
    ReadOptions options = quick();
    const Scratch alone;
    options.reader = alone.path("tex-reader");
    fs::copy_file(*find_reader({}), options.reader);
    Bytes ppm;
    for (const char c : std::string("P5 1 1 255\nx")) ppm.push_back(static_cast<std::byte>(c));
    const Result<Image> image = read(ppm, options);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::io);
    EXPECT_EQ(image.error().reason,
              "files of this type are read and written by tex-reader-oiio, which is not installed: install the "
              "package libtex-reader-oiio");
    TiffMaker tiff{1, 1};
    tiff.data = raw<std::uint8_t>({255});
    expect_row(read(tiff.make(), options), 0, {1.0f});
    const Result<ReaderInfo> info = reader_info(options);
    ASSERT_TRUE(info) << info.error().message();
    EXPECT_EQ(info->openimageio, "");
}

// The programs restrict themselves, whatever threads their libraries start.
TEST(Reader, FiltersSystemCallsAndRestrictsFiles) {
    for (const ReaderProgram which : {ReaderProgram::pictures, ReaderProgram::other_pictures, ReaderProgram::meshes}) {
        const Result<std::string> program = find_reader({}, which);
        ASSERT_TRUE(program) << program.error().message();
        FILE* pipe = popen((*program + " --version").c_str(), "r");
        char text[200] = {};
        EXPECT_GT(fread(text, 1, sizeof text - 1, pipe), 0u);
        pclose(pipe);
        EXPECT_NE(std::strstr(text, "system calls filtered"), nullptr) << text;
        const bool has_landlock = syscall(SYS_landlock_create_ruleset, nullptr, 0, 1) >= 1;
        EXPECT_NE(std::strstr(text, has_landlock ? "files restricted" : "files not restricted"), nullptr) << text;
    }
}

}  // namespace
}  // namespace tex
