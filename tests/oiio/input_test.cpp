// SPDX-License-Identifier: Apache-2.0
// What the plug-in reads, through OpenImageIO's interface.

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "oiio/plugin.h"

namespace tex::oiio {
namespace {

class OiioInput : public testing::Test {
protected:
    // A file with these levels.
    std::string file(const std::string& name, Extent extent, const PackOptions& options) {
        const auto texture = pack(bumpy_chain(extent), options);
        EXPECT_TRUE(texture);
        const auto written = write_texture(scratch_.path(name), *texture);
        EXPECT_TRUE(written) << written.error().message();
        return scratch_.path(name);
    }
    Scratch scratch_;
};

// The value in [0, 1] of a component, as packing to 16 bits stores it.
float code16(float n) { return std::floor((n + 1.0f) / 2.0f * 65535.0f + 0.5f) / 65535.0f; }

TEST_F(OiioInput, EveryEncodingAndLevelIsNormalsAsColours) {
    for (const Named<Encoding>& row : kEncodingNames) {
        const std::string path = file("x.ktx2", {37, 20}, {row.value});
        const auto input = new_input();
        ASSERT_TRUE(input) << OIIO::geterror();
        OIIO::ImageSpec spec;
        ASSERT_TRUE(input->open(path, spec)) << row.name << ": " << input->geterror();
        const bool floats = format_info(encoding_info(row.value).format).sample == SampleKind::floating;
        EXPECT_EQ(spec.format, floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT16);
        EXPECT_EQ(spec.get_string_attribute("tex:format"), oiio::read_as(row.name));
        const auto expected = unpack(*read_texture(path));
        ASSERT_TRUE(expected);
        for (std::size_t k = 0; k < expected->levels.size(); ++k) {
            const NormalMap& map = expected->levels[k];
            const std::vector<float> pixels = pixels_of(*input, static_cast<int>(k));
            ASSERT_EQ(pixels.size(), static_cast<std::size_t>(map.extent().texels()) * 3) << row.name << ", " << k;
            float largest = 0.0f;
            for (int j = 0, at = 0; j < map.extent().height; ++j) {
                for (int i = 0; i < map.extent().width; ++i) {
                    for (const float n : {map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)}) {
                        const float wanted = floats ? (n + 1.0f) / 2.0f : code16(n);
                        largest = std::max(largest, std::abs(pixels[static_cast<std::size_t>(at++)] - wanted));
                    }
                }
            }
            EXPECT_LE(largest, 1e-7f) << row.name << ", level " << k;  // OpenImageIO divides by 65535 in its own way
        }
        EXPECT_FALSE(input->seek_subimage(0, static_cast<int>(expected->levels.size())));
        EXPECT_FALSE(input->seek_subimage(1, 0));
    }
}

// Whole images of our own writer say nothing about mistakes that both sides share: green of a DirectX map stays.
TEST_F(OiioInput, YStaysAsInTheFileAndIsStated) {
    NormalMap map({4, 4});
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) map.x.at(i, j) = 0.0f, map.y.at(i, j) = 0.6f, map.z.at(i, j) = 0.8f;
    }
    MipChain chain;
    chain.levels.push_back(std::move(map));
    PackOptions options{Encoding::rgb8};
    options.y_axis = YAxis::down;
    ASSERT_TRUE(write_texture(scratch_.path("down.ktx2"), *pack(chain, options)));
    const auto input = new_input();
    OIIO::ImageSpec spec;
    ASSERT_TRUE(input->open(scratch_.path("down.ktx2"), spec));
    EXPECT_EQ(spec.get_string_attribute("tex:y"), "down");
    EXPECT_EQ(spec.get_string_attribute("normalYAxis"), "down");
    EXPECT_EQ(spec.get_string_attribute("libtex.normal"), "rgb -y");
    const std::vector<float> pixels = pixels_of(*input, 0);
    ASSERT_EQ(pixels.size(), 48u);
    EXPECT_NEAR(pixels[0], 0.5f, 0.003f);
    EXPECT_NEAR(pixels[1], 0.2f, 0.003f);
    EXPECT_NEAR(pixels[2], 0.9f, 0.003f);
}

TEST_F(OiioInput, StoredChannelsAreThoseThatDecodeReturns) {
    OIIO::ImageSpec raw;
    raw.attribute("tex:unpack", 0);
    for (const Named<Encoding>& row : kEncodingNames) {
        const std::string path = file("x.ktx2", {37, 20}, {row.value});
        const Texture texture = *read_texture(path);
        const auto input = new_input();
        OIIO::ImageSpec spec;
        ASSERT_TRUE(input->open(path, spec, raw)) << row.name << ": " << input->geterror();
        EXPECT_EQ(spec.nchannels, format_info(texture.format).channels) << row.name;
        EXPECT_EQ(spec.get_string_attribute("libtex.normal"), layout_name(texture.swizzle) + " +y") << row.name;
        EXPECT_EQ(spec.get_int_attribute("oiio:UnassociatedAlpha"), spec.nchannels == 4 ? 1 : 0) << row.name;
        for (int k = 0; k < static_cast<int>(texture.levels.size()); ++k) {
            const Image image = *decode(texture, k);
            const std::vector<float> pixels = pixels_of(*input, k);
            ASSERT_EQ(pixels.size(), static_cast<std::size_t>(image.extent().texels()) * image.planes.size());
            float largest = 0.0f;
            std::size_t at = 0;
            for (int j = 0; j < image.extent().height; ++j) {
                for (int i = 0; i < image.extent().width; ++i) {
                    for (const Plane<float>& plane : image.planes)
                        largest = std::max(largest, std::abs(pixels[at++] - plane.at(i, j)));
                }
            }
            EXPECT_LE(largest, 1e-7f) << row.name << ", level " << k;
        }
    }
}

// A height or a roughness has no direction.
TEST_F(OiioInput, OneChannelIsReadAsItIs) {
    Texture texture;
    texture.format = Format::r16_unorm;
    texture.swizzle = {Component::other, Component::other, Component::other, Component::other};
    const unsigned short codes[] = {0, 65535, 1000, 30000};
    const auto* bytes = reinterpret_cast<const std::byte*>(codes);
    texture.levels.push_back({{2, 2}, std::vector<std::byte>(bytes, bytes + sizeof codes)});
    ASSERT_TRUE(write_texture(scratch_.path("height.ktx2"), texture));
    const auto input = new_input();
    OIIO::ImageSpec spec;
    ASSERT_TRUE(input->open(scratch_.path("height.ktx2"), spec)) << input->geterror();
    EXPECT_EQ(spec.nchannels, 1);
    EXPECT_EQ(spec.format, OIIO::TypeDesc::UINT16);
    EXPECT_EQ(spec.channelnames, std::vector<std::string>{"Y"});
    unsigned short read[4] = {};
    ASSERT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT16, read));
    EXPECT_TRUE(std::equal(codes, codes + 4, read));
}

TEST_F(OiioInput, AConfigurationNamesTheLayout) {
    const std::string path = file("x.ktx2", {16, 16}, {Encoding::ag8});
    OIIO::ImageSpec config, spec;
    config.attribute("tex:swizzle", "rgb");
    const auto input = new_input();
    ASSERT_TRUE(input->open(path, spec, config));
    EXPECT_EQ(spec.get_string_attribute("tex:layout"), "rgb");
    config.attribute("tex:swizzle", "1y1x");
    ASSERT_TRUE(input->open(path, spec, config));
    EXPECT_EQ(spec.get_string_attribute("tex:layout"), "dxt5nm");
    config.attribute("tex:swizzle", "xx");
    EXPECT_FALSE(input->open(path, spec, config));
    EXPECT_NE(input->geterror().find("tex:swizzle is \"xx\"; it must be one of rgb, "), std::string::npos);
}

TEST_F(OiioInput, ErrorsNameTheFileAndTheReason) {
    const std::string path = file("x.dds", {16, 16}, {Encoding::dxt5nm});
    std::filesystem::resize_file(path, 140);
    scratch_.write("text.ktx2", "no texture at all");
    std::filesystem::create_directory(scratch_.path("folder.ktx2"));
    const auto input = new_input();
    OIIO::ImageSpec spec;
    const auto error = [&](const std::string& name) {
        EXPECT_FALSE(input->open(scratch_.path(name), spec)) << name;
        return input->geterror();
    };
    EXPECT_EQ(error("x.dds"), read_texture(path).error().message());
    EXPECT_EQ(error("text.ktx2"), scratch_.path("text.ktx2") + ": not a DDS, KTX2 or ASTC file");
    EXPECT_EQ(error("folder.ktx2"), scratch_.path("folder.ktx2") + ": not a regular file");
    EXPECT_EQ(error("none.ktx2"), scratch_.path("none.ktx2") + ": no such file");
    EXPECT_FALSE(input->read_native_scanline(0, 0, 0, 0, nullptr));
    EXPECT_FALSE(input->seek_subimage(0, 0));
}

TEST_F(OiioInput, MisspeltAttributesAreErrors) {
    const std::string path = file("x.dds", {16, 16}, {Encoding::dxt5nm});
    for (const char* const name : {"tex:unpak", "tex:y", "tex:format"}) {
        OIIO::ImageSpec spec, config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        config.attribute(name, "x");
        const auto input = new_input();
        EXPECT_FALSE(input->open(path, spec, config)) << name;
        EXPECT_EQ(input->geterror(), path + ": there is no attribute " + name +
                                         " for reading; there are tex:unpack, tex:swizzle and tex:length-in");
    }
}

// The reader refuses what libtex refuses, with the same words, and returns all pixels of the others.
TEST_F(OiioInput, HostileFilesAreRefusedAsByTheLibrary) {
    int read = 0, refused = 0;
    const auto input = new_input();
    for (const std::string folder : {"/tests/fuzz/corpus/dds", "/tests/fuzz/corpus/ktx2", "/tests/fuzz/corpus/astc",
                                     "/../shared/data/bad", "/../shared/data/dds"}) {
        if (!std::filesystem::exists(TEX_SOURCE_DIR + folder)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(TEX_SOURCE_DIR + folder)) {
            const std::string path = entry.path().string();
            if (!input->valid_file(path) || !entry.is_regular_file()) continue;
            auto texture = read_texture(path);
            OIIO::ImageSpec spec;
            ASSERT_EQ(input->open(path, spec), texture.has_value()) << path;
            if (!texture) {
                EXPECT_EQ(input->geterror(), texture.error().message());
                ++refused;
                continue;
            }
            ++read;
            texture->swizzle = *guess_swizzle(*texture);
            const bool readable = format_info(texture->format).channels == 1 || unpack(*texture).has_value();
            for (std::size_t k = 0; k < texture->levels.size(); ++k)
                EXPECT_NE(pixels_of(*input, static_cast<int>(k)).empty(), readable) << path;
            if (!readable) {
                EXPECT_EQ(input->geterror().rfind(path + ": the swizzle ", 0), 0u);
            }
        }
    }
    EXPECT_GE(read, 20);
    EXPECT_GE(refused, 20);
}

}  // namespace
}  // namespace tex::oiio
