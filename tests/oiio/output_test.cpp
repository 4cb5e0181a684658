// SPDX-License-Identifier: Apache-2.0
// What the plug-in writes, through OpenImageIO's interface.

#include <gtest/gtest.h>

#include "oiio/plugin.h"

namespace tex::oiio {
namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

class OiioOutput : public testing::Test {
protected:
    // Writes a picture of one colour, with 8 bits. Returns the error, or an empty text.
    std::string write(const std::string& name, const ImageSpec& spec) {
        const auto output = new_output();
        if (!output->open(scratch_.path(name), spec, ImageOutput::Create)) return output->geterror();
        const std::vector<unsigned char> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels), 128);
        output->write_image(TypeDesc::UINT8, pixels.data());
        return output->close() ? "" : output->geterror();
    }
    Scratch scratch_;
};

TEST_F(OiioOutput, EachWrongAttributeIsAnErrorWithoutAFile) {
    const struct {
        const char* name;
        const char* word;
        const char* error;
    } kCases[] = {
        {"tex:format", "dxt9", "tex:format is \"dxt9\"; it must be one of dxt5nm, bc5, "},
        {"tex:format", "eac-rg11", "a dds file cannot hold eac-rg11; set the attribute tex:format"},
        {"tex:y", "left", "tex:y is \"left\"; it must be one of up, down"},
        {"normalYAxis", "left", "normalYAxis is \"left\"; it must be one of up, down"},
        {"tex:effort", "bset", "tex:effort is \"bset\"; it must be one of fast, normal, best"},
        {"tex:metric", "x", "it must be one of component, angle"},
        {"tex:mips", "-1", "tex:mips is \"-1\"; it must be keep, all or a number from 1 to 32"},
        {"tex:swizzle", "xyzxyz", "four letters for R, G, B and A"},
        {"tex:dds-header", "x", "it must be one of legacy, dx10"},
        {"tex:dds-mark", "2", "it must be 0 or 1"},
        {"tex:zstd", "23", "it must be a number from 0 to 22"},
        {"tex:zstd", "99999999999", "it must be a number from 0 to 22"},
        {"tex:fromat", "bc5", "there is no attribute tex:fromat; tex-oiio(7) lists them"},
    };
    for (const auto& c : kCases) {
        ImageSpec spec(8, 8, 3, TypeDesc::UINT8);
        spec.attribute(c.name, c.word);
        const std::string error = write("x.dds", spec);
        EXPECT_NE(error.find(c.error), std::string::npos) << error;
        EXPECT_EQ(error.rfind(scratch_.path("x.dds") + ": ", 0), 0u) << error;
        EXPECT_TRUE(scratch_.list().empty());
    }
}

TEST_F(OiioOutput, PicturesThatAreNoNormalMapsAreErrors) {
    const auto error = [&](const std::string& name, const ImageSpec& spec) { return write(name, spec); };
    EXPECT_NE(error("x.dds", ImageSpec(8, 8, 1, TypeDesc::UINT8)).find("2 to 4 channels, not 1"), std::string::npos);
    EXPECT_NE(error("x.dds", ImageSpec(8, 8, 5, TypeDesc::UINT8)).find("2 to 4 channels, not 5"), std::string::npos);
    EXPECT_NE(error("x.tex", ImageSpec(8, 8, 3, TypeDesc::UINT8)).find("must end in .dds"), std::string::npos);
    EXPECT_NE(error("none/x.dds", ImageSpec(8, 8, 3, TypeDesc::UINT8)).find("none"), std::string::npos);
    ImageSpec volume(8, 8, 3, TypeDesc::UINT8);
    volume.depth = 2;
    EXPECT_NE(error("x.dds", volume).find("volumes"), std::string::npos);
    EXPECT_TRUE(scratch_.list().empty());
}

// A file appears when it is complete, and an old one stays until then.
TEST_F(OiioOutput, APictureWithoutItsLastRowLeavesTheOldFile) {
    scratch_.write("x.dds", "old");
    const std::vector<unsigned char> row(24, 128);
    const auto output = new_output();
    ASSERT_TRUE(output->open(scratch_.path("x.dds"), ImageSpec(8, 8, 3, TypeDesc::UINT8), ImageOutput::Create));
    for (int y = 0; y < 7; ++y) ASSERT_TRUE(output->write_scanline(y, 0, TypeDesc::UINT8, row.data()));
    EXPECT_FALSE(output->close());
    EXPECT_EQ(output->geterror(),
              scratch_.path("x.dds") + ": level 0 has 7 of 8 scanlines or tiles; no file is written");
    EXPECT_EQ(scratch_.read("x.dds"), "old");

    ASSERT_TRUE(output->open(scratch_.path("x.dds"), ImageSpec(8, 8, 3, TypeDesc::UINT8), ImageOutput::Create));
    ASSERT_TRUE(output->write_scanline(0, 0, TypeDesc::UINT8, row.data()));
    EXPECT_FALSE(output->write_scanline(2, 0, TypeDesc::UINT8, row.data()));
    EXPECT_FALSE(output->close());
    EXPECT_EQ(scratch_.read("x.dds"), "old");
    EXPECT_EQ(scratch_.list(), std::vector<std::string>{"x.dds"});
}

TEST_F(OiioOutput, TilesOutsideOfThePictureAreRefused) {
    ImageSpec spec(40, 20, 3, TypeDesc::UINT8);
    spec.tile_width = spec.tile_height = 16;
    const std::vector<unsigned char> tile(16 * 16 * 3, 128);
    const struct {
        int x, y, z;
    } kWrong[] = {{1, 0, 0}, {-1, 0, 0}, {-16, 0, 0}, {0, 8, 0}, {0, -16, 0}, {48, 0, 0}, {0, 0, 1}, {16, 0, 0}};
    for (const auto& at : kWrong) {
        const auto output = new_output();
        ASSERT_TRUE(output->open(scratch_.path("x.dds"), spec, ImageOutput::Create));
        EXPECT_FALSE(output->write_tile(at.x, at.y, at.z, TypeDesc::UINT8, tile.data())) << at.x << ", " << at.y;
        EXPECT_FALSE(output->close());
    }
    EXPECT_TRUE(scratch_.list().empty());
}

// Pixels from tiles and from scanlines, at an origin of their own, in every type, are the same file.
TEST_F(OiioOutput, TilesScanlinesAndTypesGiveTheSameFile) {
    ImageSpec spec(37, 20, 3, TypeDesc::UINT8);
    std::vector<unsigned char> pixels(37 * 20 * 3);
    for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] = static_cast<unsigned char>(100 + (k * 7) % 57);
    const auto written = [&](const ImageSpec& how) {
        const auto output = new_output();
        EXPECT_TRUE(output->open(scratch_.path("x.ktx2"), how, ImageOutput::Create)) << output->geterror();
        EXPECT_TRUE(output->write_image(TypeDesc::UINT8, pixels.data())) << output->geterror();
        EXPECT_TRUE(output->close()) << output->geterror();
        return scratch_.read("x.ktx2");
    };
    const std::string expected = written(spec);
    ASSERT_FALSE(expected.empty());
    ImageSpec tiled = spec;
    tiled.tile_width = tiled.tile_height = 16;
    EXPECT_EQ(written(tiled), expected);
    tiled.x = 5;
    tiled.y = -3;
    EXPECT_EQ(written(tiled), expected);
    for (const auto type : {TypeDesc::UINT16, TypeDesc::FLOAT, TypeDesc::DOUBLE, TypeDesc::UINT32}) {
        ImageSpec other = spec;
        other.set_format(type);
        other.attribute("normalEncoding", "unsigned");
        EXPECT_EQ(written(other), expected) << type;
    }
}

TEST_F(OiioOutput, LevelsAreWrittenAsTheyCome) {
    const MipChain chain = bumpy_chain({32, 16});
    const auto texture = pack(chain, {Encoding::rgb16});
    const auto output = new_output();
    for (std::size_t k = 0; k < chain.levels.size(); ++k) {
        const Extent extent = chain.levels[k].extent();
        ImageSpec spec(extent.width, extent.height, 3, TypeDesc::UINT16);
        spec.attribute("tex:format", "rgb16");
        spec.attribute("normalYAxis", "up");
        const auto image = decode(*pack(chain, {Encoding::rgb16}), static_cast<int>(k));
        std::vector<float> pixels;
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                for (const Plane<float>& plane : image->planes) pixels.push_back(plane.at(i, j));
            }
        }
        ASSERT_TRUE(
            output->open(scratch_.path("x.ktx2"), spec, k == 0 ? ImageOutput::Create : ImageOutput::AppendMIPLevel))
            << output->geterror();
        ASSERT_TRUE(output->write_image(TypeDesc::FLOAT, pixels.data()));
    }
    ASSERT_TRUE(output->close()) << output->geterror();
    const auto expected = unpack(*texture);
    const auto read = unpack(*read_texture(scratch_.path("x.ktx2")));
    ASSERT_EQ(read->levels.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k) {
        for (int j = 0; j < read->levels[k].extent().height; ++j) {
            for (int i = 0; i < read->levels[k].extent().width; ++i) {
                EXPECT_NEAR(read->levels[k].x.at(i, j), expected->levels[k].x.at(i, j), 4e-5f);
                EXPECT_NEAR(read->levels[k].y.at(i, j), expected->levels[k].y.at(i, j), 4e-5f);
            }
        }
    }
}

TEST_F(OiioOutput, LevelsOfAnotherExtentAreErrors) {
    const std::vector<unsigned char> pixels(64 * 64 * 3, 128);
    for (const Extent second : {Extent{17, 8}, Extent{32, 16}, Extent{16, 7}}) {
        const auto output = new_output();
        ASSERT_TRUE(output->open(scratch_.path("x.dds"), ImageSpec(32, 16, 3, TypeDesc::UINT8), ImageOutput::Create));
        ASSERT_TRUE(output->write_image(TypeDesc::UINT8, pixels.data()));
        EXPECT_FALSE(output->open(scratch_.path("x.dds"), ImageSpec(second.width, second.height, 3, TypeDesc::UINT8),
                                  ImageOutput::AppendMIPLevel));
        EXPECT_NE(output->geterror().find("level 1 must have half the width and height"), std::string::npos);
        EXPECT_FALSE(output->close());
    }
    // Nothing follows a level of one texel.
    const auto last = new_output();
    for (const int side : {2, 1, 1}) {
        const bool is_level = last->open(scratch_.path("x.dds"), ImageSpec(side, side, 3, TypeDesc::UINT8),
                                         side == 2 ? ImageOutput::Create : ImageOutput::AppendMIPLevel);
        if (!is_level) break;
        ASSERT_TRUE(last->write_image(TypeDesc::UINT8, pixels.data()));
    }
    EXPECT_NE(last->geterror().find("level 2 must have half the width and height"), std::string::npos);
    EXPECT_FALSE(last->close());
    const auto output = new_output();
    ASSERT_TRUE(output->open(scratch_.path("x.dds"), ImageSpec(32, 16, 3, TypeDesc::UINT8), ImageOutput::Create));
    EXPECT_FALSE(
        output->open(scratch_.path("x.dds"), ImageSpec(32, 16, 3, TypeDesc::UINT8), ImageOutput::AppendSubimage));
    EXPECT_TRUE(scratch_.list().empty());
}

// OpenImageIO's pixels are multiplied by alpha, unless they say otherwise.
TEST_F(OiioOutput, ColoursAreDividedByTheirAlpha) {
    const float normal[] = {0.75f, 0.5f, 0.9330127f};
    for (const bool multiplied : {true, false}) {
        std::vector<float> pixels;
        for (int k = 0; k < 16; ++k) {
            for (const float c : normal) pixels.push_back(multiplied ? c * 0.25f : c);
            pixels.push_back(0.25f);
        }
        ImageSpec spec(4, 4, 4, TypeDesc::FLOAT);
        spec.attribute("tex:format", "float");
        spec.attribute("normalEncoding", "unsigned");
        if (!multiplied) spec.attribute("oiio:UnassociatedAlpha", 1);
        const auto output = new_output();
        ASSERT_TRUE(output->open(scratch_.path("x.ktx2"), spec, ImageOutput::Create)) << output->geterror();
        ASSERT_TRUE(output->write_image(TypeDesc::FLOAT, pixels.data()));
        ASSERT_TRUE(output->close()) << output->geterror();
        const auto chain = unpack(*read_texture(scratch_.path("x.ktx2")));
        EXPECT_NEAR(chain->levels[0].x.at(0, 0), 0.5f, 1e-6f);
        EXPECT_NEAR(chain->levels[0].y.at(0, 0), 0.0f, 1e-6f);
    }
}

// A filter may have made a texel brighter than its alpha. What is in RGB is a colour all the same.
TEST_F(OiioOutput, ColoursBrighterThanTheirAlphaAreDividedToo) {
    std::vector<float> pixels;
    for (int k = 0; k < 64; ++k) {
        const float p = 0.3f * static_cast<float>(k % 8) / 8.0f, q = 0.2f * static_cast<float>(k / 8) / 8.0f;
        for (const float c : {0.5f + p, 0.5f + q, 0.9f}) pixels.push_back(0.25f * c);
        pixels.push_back(k == 63 ? 0.2f : 0.25f);
    }
    ImageSpec spec(8, 8, 4, TypeDesc::FLOAT);
    spec.attribute("tex:format", "float");
    spec.attribute("normalEncoding", "unsigned");
    const auto output = new_output();
    ASSERT_TRUE(output->open(scratch_.path("x.ktx2"), spec, ImageOutput::Create)) << output->geterror();
    ASSERT_TRUE(output->write_image(TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->close()) << output->geterror();
    const auto chain = unpack(*read_texture(scratch_.path("x.ktx2")));
    EXPECT_NEAR(chain->levels[0].x.at(0, 0), 0.0f, 1e-6f);
    EXPECT_NEAR(chain->levels[0].y.at(0, 0), 0.0f, 1e-6f);
    EXPECT_NEAR(chain->levels[0].z.at(0, 0), 1.0f, 1e-6f);
}

// x is in A and R, G and B were multiplied by it: at each level, or at none.
TEST_F(OiioOutput, LevelsAreDividedAsTheBaseLevelIs) {
    const MipChain chain = bumpy_chain({32, 16});
    const auto output = new_output();
    for (std::size_t k = 0; k < chain.levels.size(); ++k) {
        const NormalMap& level = chain.levels[k];
        const Extent extent = level.extent();
        ImageSpec spec(extent.width, extent.height, 4, TypeDesc::FLOAT);
        spec.attribute("tex:format", "ag8");
        spec.attribute("normalEncoding", "unsigned");
        spec.attribute("tex:swizzle", "1y1x");
        std::vector<float> pixels;
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const float a = 0.5f + 0.5f * level.x.at(i, j), g = 0.5f + 0.5f * level.y.at(i, j);
                for (const float c : {a, a * g, a, a}) pixels.push_back(c);
            }
        }
        ASSERT_TRUE(
            output->open(scratch_.path("x.ktx2"), spec, k == 0 ? ImageOutput::Create : ImageOutput::AppendMIPLevel))
            << output->geterror();
        ASSERT_TRUE(output->write_image(TypeDesc::FLOAT, pixels.data()));
    }
    ASSERT_TRUE(output->close()) << output->geterror();
    const auto read = unpack(*read_texture(scratch_.path("x.ktx2")));
    ASSERT_EQ(read->levels.size(), chain.levels.size());
    for (std::size_t k = 0; k < chain.levels.size(); ++k) {
        for (int j = 0; j < chain.levels[k].extent().height; ++j) {
            for (int i = 0; i < chain.levels[k].extent().width; ++i) {
                ASSERT_NEAR(read->levels[k].x.at(i, j), chain.levels[k].x.at(i, j), 0.01f) << k;
                ASSERT_NEAR(read->levels[k].y.at(i, j), chain.levels[k].y.at(i, j), 0.01f) << k;
            }
        }
    }
}

}  // namespace
}  // namespace tex::oiio
