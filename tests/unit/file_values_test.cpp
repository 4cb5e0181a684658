// SPDX-License-Identifier: Apache-2.0

#include "formats/file_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include <tex/bake.h>
#include <tex/file.h>
#include <tex/height.h>
#include <tex/pack.h>

#include "formats/exr/exr_rows.h"
#include "unit/exr_files.h"
#include "unit/tiff_maker.h"

namespace tex {
namespace {

// Two texels of one channel, as floats.
struct Values {
    float first, second;
    bool stored;
};

std::optional<Values> values_of(Bytes bytes, FileValues wanted = FileValues::automatic) {
    Result<InputFile> file = InputFile::from_memory("h", std::move(bytes));
    ReadOptions options = quick();
    options.values = wanted;
    const Result<Image> image = read_image(*file, options);
    if (!image) return std::nullopt;
    return Values{image->planes[0].at(0, 0), image->planes[0].at(1, 0), image->stored};
}

Bytes tiff_of(int bits, int sample_format, std::initializer_list<std::uint32_t> codes) {
    TiffMaker tiff{2, 1};
    tiff.bits = bits;
    tiff.sample_format = sample_format;
    for (const std::uint32_t code : codes) put(tiff.data, code, bits / 8);
    return tiff.make();
}

TEST(FileValues, SignedAndLongIntegersAreNumbers) {
    const auto check = [](const Bytes& bytes, float first, float second) {
        const auto values = values_of(bytes);
        ASSERT_TRUE(values);
        EXPECT_TRUE(values->stored);
        EXPECT_EQ(values->first, first);
        EXPECT_EQ(values->second, second);
    };
    check(tiff_of(16, 2, {0x8000, 1234}), -32768.0f, 1234.0f);
    check(tiff_of(8, 2, {0x80, 127}), -128.0f, 127.0f);
    check(tiff_of(32, 2, {static_cast<std::uint32_t>(-8849), 8848860}), -8849.0f, 8848860.0f);
    check(tiff_of(32, 1, {0, 4000000000u}), 0.0f, 4000000000.0f);
}

TEST(FileValues, UnsignedShortsAreFractionsUnlessTheCallerWantsNumbers) {
    const Bytes bytes = tiff_of(16, 1, {0, 65535});
    EXPECT_EQ(values_of(bytes)->second, 1.0f);
    EXPECT_FALSE(values_of(bytes)->stored);
    EXPECT_EQ(values_of(bytes, FileValues::stored)->second, 65535.0f);
    EXPECT_EQ(values_of(tiff_of(16, 2, {0x8000, 32767}), FileValues::unit)->second, 1.0f);
}

TEST(FileValues, EveryCodeOfAPngComesBackWhole) {
    Texture texture;
    texture.format = Format::r16_unorm;
    texture.levels.push_back({{256, 256}, {}});
    for (std::uint32_t code = 0; code < 65536; ++code) put(texture.levels[0].bytes, code, 2);
    Result<InputFile> file = InputFile::from_memory("a.png", *encode_file(texture, Container::png));
    ReadOptions options;
    options.values = FileValues::stored;
    const Result<Image> image = read_image(*file, options);
    ASSERT_TRUE(image);
    for (int code = 0; code < 65536; ++code)
        ASSERT_EQ(image->planes[0].at(code % 256, code / 256), static_cast<float>(code));
}

TEST(FileValues, UintOfAnExrIsANumber) {
    Result<InputFile> file =
        InputFile::from_memory("h.exr", exr_file({5, 4}, {"height"}, Imf::UINT, Imf::ZIP_COMPRESSION));
    const Result<Image> image = read_image(*file, {});
    ASSERT_TRUE(image);
    EXPECT_TRUE(image->stored);
    EXPECT_EQ(image->planes[0].at(2, 1), static_cast<float>(2 * 123456789u + 1));
}

TEST(FileValues, ColoursAndVectorsAreNoQuantities) {
    TiffMaker tiff{1, 1, 3, 16, 2, 2};
    put(tiff.data, 32767, 2);
    put(tiff.data, 0, 2);
    put(tiff.data, 0, 2);
    Result<InputFile> file = InputFile::from_memory("n.tif", tiff.make());
    const Result<Image> image = read_image(*file, quick());
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_FALSE(image->stored);
    EXPECT_EQ(image->planes[0].at(0, 0), 1.0f);
}

TEST(FileValues, ANoDataValueIsThatOfTheFile) {
    Image image;
    image.names = {"Y"};
    image.bits = 16;
    image.planes.emplace_back(Extent{2, 1}, 1.0f);
    image.planes[0].at(1, 0) = 0.25f;
    HeightOptions options;
    options.fill_invalid = true;
    options.no_data = 65535.0f;
    EXPECT_EQ(height_field(image, options)->report.invalid_texels, 1);
    options.no_data = 0.25f;
    EXPECT_EQ(height_field(image, options)->report.invalid_texels, 1);
    image.stored = true;
    image.sample = SampleKind::floating;
    image.scale = 0.5;
    image.offset = -3.0;
    options.no_data = 8.0f;  // 1.0 after scale and offset
    EXPECT_EQ(height_field(image, options)->report.invalid_texels, 1);
}

class Elevations : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << "no ../shared/data/wild";
    }
    const std::string kFolder = TEX_SOURCE_DIR "/../shared/data/wild/";
};

// The mean tilt of central differences of the metres, by a script in Python.
TEST_F(Elevations, InMetresHaveTheSlopesOfMetres) {
    const Result<Image> image = read_image(kFolder + "dem_int16_metres_100x100_void.tif");
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_TRUE(image->stored);
    HeightOptions options;
    options.wrap_x = options.wrap_y = Wrap::clamp;
    options.no_data = -32768.0f;
    options.fill_invalid = true;
    Result<PictureHeights> field = height_field(*image, options);
    ASSERT_TRUE(field) << field.error().message();
    EXPECT_GT(field->report.invalid_texels, 0);
    EXPECT_TRUE(field->report.stored);
    const Strength strength = strength_from_world(image->extent(), 1.0, 3000.0).value();
    field->bumpiness_x = strength.x;
    field->bumpiness_y = strength.y;
    const NormalMap map = *bake(*field, {});
    double tilt = 0.0;
    for (int j = 0; j < 100; ++j) {
        for (int i = 0; i < 100; ++i) tilt += std::acos(static_cast<double>(map.z.at(i, j))) / 10000.0;
    }
    EXPECT_NEAR(tilt * 180.0 / 3.14159265358979, 16.9211, 0.0001);
}

TEST_F(Elevations, OfGdalHaveItsScaleAndOffset) {
    const Result<Image> image = read_image(kFolder + "gtif_scale_offset.tif");
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_TRUE(image->stored);
    EXPECT_EQ(image->scale, 0.1);
    EXPECT_EQ(image->offset, -1000.0);
    EXPECT_FLOAT_EQ(image->planes[0].at(20, 30), -924.0f);
    // oiiotool prints 760 for this texel of both files.
    const Result<Image> srtm = read_image(kFolder + "gtif_srtm_s16_void.tif");
    ASSERT_TRUE(srtm) << srtm.error().message();
    EXPECT_EQ(srtm->no_data, -32768.0f);
    EXPECT_EQ(srtm->planes[0].at(20, 30), 760.0f);
}

// The last blocks reach beyond the picture, and its planes do not. (The sanitizers see where rows are written.)
TEST(FileValues, StoredValuesOfBlocksStayInThePicture) {
    for (const Encoding encoding : {Encoding::bc5, Encoding::dxt5nm, Encoding::bc7}) {
        for (const int height : {1, 5, 9, 11}) {
            NormalMap map({7, height});
            for (int j = 0; j < height; ++j) {
                for (int i = 0; i < 7; ++i) {
                    map.x.at(i, j) = 0.1f * static_cast<float>(i);
                    map.y.at(i, j) = 0.05f * static_cast<float>(j);
                    map.z.at(i, j) = 0.7f;
                }
            }
            MipChain chain;
            chain.levels.push_back(std::move(map));
            const auto texture = pack(chain, {encoding});
            ASSERT_TRUE(texture) << texture.error().message();
            const auto bytes = encode_file(*texture, Container::ktx2);
            ASSERT_TRUE(bytes) << bytes.error().message();
            Result<InputFile> file = InputFile::from_memory("h.ktx2", *bytes);
            ReadOptions options = quick();
            options.values = FileValues::stored;
            const Result<Image> image = read_image(*file, options);
            ASSERT_TRUE(image) << image.error().message();
            const auto decoded = decode(*texture, 0);
            ASSERT_EQ(image->extent(), (Extent{7, height}));
            for (int j = 0; j < height; ++j) {
                for (int i = 0; i < 7; ++i)
                    EXPECT_NEAR(image->planes[0].at(i, j), 255.0f * decoded->planes[0].at(i, j), 0.01f);
            }
        }
    }
}

}  // namespace
}  // namespace tex
