// SPDX-License-Identifier: Apache-2.0
// Data beside the normals, through the plug-in: further channels, read and written.

#include <cmath>

#include <gtest/gtest.h>

#include "oiio/plugin.h"

namespace tex::oiio {
namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr Extent kExtent{24, 16};

// Codes of 8 bits, which every depth but half holds exactly.
Plane<float> data(int factor, Extent extent = kExtent) {
    Plane<float> plane(extent);
    for (int k = 0; k < extent.texels(); ++k)
        plane.at(k % extent.width, k / extent.width) = static_cast<float>(factor * k % 256) / 255.0f;
    return plane;
}

class OiioExtras : public testing::Test {
protected:
    std::string file(const std::string& name, MipChain chain, Encoding encoding) {
        const auto written = write_texture(scratch_.path(name), *pack(chain, {encoding}));
        EXPECT_TRUE(written) << written.error().message();
        return scratch_.path(name);
    }
    // A map with one level and these data.
    static MipChain chain_with(Plane<float> NormalMap::*place, int factor) {
        MipChain chain = bumpy_chain(kExtent);
        chain.levels.resize(1);
        chain.levels[0].*place = data(factor);
        return chain;
    }
    void go(const std::string& script) {
        const cli::Ran ran = oiio::shell(scratch_, "set -e\n" + script);
        EXPECT_EQ(ran.code, 0) << script << "\n" << ran.out << ran.err;
    }
    Scratch scratch_;
};

void expect_channel(OIIO::ImageInput& input, int channel, const Plane<float>& expected, float most) {
    const std::vector<float> pixels = pixels_of(input, 0);
    const int channels = input.spec().nchannels;
    ASSERT_EQ(pixels.size(), static_cast<std::size_t>(kExtent.texels() * channels));
    for (int k = 0; k < kExtent.texels(); ++k) {
        ASSERT_NEAR(pixels[static_cast<std::size_t>(k * channels + channel)],
                    expected.at(k % kExtent.width, k / kExtent.width), most);
    }
}

TEST_F(OiioExtras, AlphaAndBlueAreChannels) {
    const std::vector<std::string> with_alpha = {"R", "G", "B", "A"}, with_blue = {"R", "G", "B", "blue"};
    for (const Encoding encoding : {Encoding::rgba8, Encoding::rgba16, Encoding::rgba16f, Encoding::rgba32f}) {
        const std::string name(name_of(kEncodingNames, encoding));
        const float most = encoding == Encoding::rgba16f ? 0.5f / 2048.0f : 1e-7f;
        for (const std::string type : {"a.ktx2", "a.dds"}) {
            const auto input = new_input();
            ImageSpec spec;
            ASSERT_TRUE(input->open(file(type, chain_with(&NormalMap::alpha, 7), encoding), spec)) << name;
            EXPECT_EQ(spec.channelnames, with_alpha) << name;
            EXPECT_EQ(spec.alpha_channel, 3);
            EXPECT_EQ(spec.get_int_attribute("oiio:UnassociatedAlpha"), 1);
            EXPECT_EQ(spec.get_string_attribute("tex:format"), name);
            expect_channel(*input, 3, data(7), most);
        }
        const auto input = new_input();
        ImageSpec spec;
        ASSERT_TRUE(input->open(file("b.ktx2", chain_with(&NormalMap::blue, 5), encoding), spec)) << name;
        EXPECT_EQ(spec.channelnames, with_blue) << name;
        EXPECT_EQ(spec.alpha_channel, -1);
        expect_channel(*input, 3, data(5), most);
        expect_channel(
            *input, 2,
            [] {  // z, rebuilt
                Plane<float> z(kExtent);
                const MipChain chain = bumpy_chain(kExtent);
                for (int j = 0; j < kExtent.height; ++j) {
                    for (int i = 0; i < kExtent.width; ++i) z.at(i, j) = chain.levels[0].z.at(i, j) / 2.0f + 0.5f;
                }
                return z;
            }(),
            0.01f);
    }
}

TEST_F(OiioExtras, LengthsAreAChannelIfTheConfigurationSaysSo) {
    const std::string path = file("l.ktx2", chain_with(&NormalMap::length, 7), Encoding::float_);
    const auto input = new_input();
    ImageSpec spec, config;
    ASSERT_TRUE(input->open(path, spec));
    EXPECT_EQ(spec.nchannels, 3);
    config.attribute("tex:length-in", "occlusion");
    ASSERT_TRUE(input->open(path, spec, config));
    EXPECT_EQ(spec.channelnames.back(), "length");
    expect_channel(*input, 3, data(7), 2e-6f);
    config.attribute("tex:length-in", "height");
    EXPECT_FALSE(input->open(path, spec, config));
    EXPECT_NE(input->geterror().find("it must be one of occlusion, ignore"), std::string::npos);
}

// From file to file, with all levels, as programs copy.
TEST_F(OiioExtras, CopiesHaveTheSameData) {
    for (const auto place : {&NormalMap::alpha, &NormalMap::blue}) {
        for (const Encoding encoding : {Encoding::rgba8, Encoding::rgba16, Encoding::rgba32f}) {
            MipChain chain = bumpy_chain(kExtent);
            for (NormalMap& level : chain.levels) level.*place = data(3, level.extent());
            const std::string from = file("from.ktx2", std::move(chain), encoding);
            go("oiiotool " + from + " -o to.ktx2");
            const Texture to = *read_texture(scratch_.path("to.ktx2")), source = *read_texture(from);
            EXPECT_EQ(to.format, source.format);
            EXPECT_EQ(to.swizzle, source.swizzle);
            ASSERT_EQ(to.levels.size(), source.levels.size());
            const std::size_t plane = place == &NormalMap::alpha ? 3 : 2;
            for (int k = 0; k < static_cast<int>(to.levels.size()); ++k) {
                const Image a = *decode(to, k), b = *decode(source, k);
                for (int j = 0; j < a.extent().height; ++j) {
                    for (int i = 0; i < a.extent().width; ++i)
                        ASSERT_EQ(a.planes[plane].at(i, j), b.planes[plane].at(i, j)) << k;
                }
            }
        }
    }
}

TEST_F(OiioExtras, ProgramsWriteTheBytesOfTheCommands) {
    MipChain chain = bumpy_chain({64, 32});
    chain.levels.resize(1);
    chain.levels[0].alpha = data(7, {64, 32});
    file("n.png", std::move(chain), Encoding::rgba8);
    const std::string ours = " --no-sync --normalize --format rgba8 -o ";
    go("convert -size 64x32 plasma:grey20-grey90 -colorspace gray -depth 8 o.png\n"
       "oiiotool --iconfig oiio:UnassociatedAlpha 1 n.png --attrib tex:format rgba8 --attrib tex:mips all"
       " --attrib tex:kind roughness -o a.ktx2\n"
       "pack-normals n.png --mips all --kind roughness" +
       ours +
       "b.ktx2\ncmp a.ktx2 b.ktx2\n"
       "oiiotool --iconfig oiio:UnassociatedAlpha 1 n.png --ch R,G,B o.png --ch blue=Y --chappend --attrib tex:format "
       "rgba8"
       " --attrib tex:mips all --attrib tex:kind occlusion -o a.dds\n"
       "pack-normals n.png --blue o.png --alpha none --kind occlusion --mips all" +
       ours +
       "b.dds\ncmp a.dds b.dds\n"
       "oiiotool --iconfig oiio:UnassociatedAlpha 1 n.png o.png --ch length=Y --chappend --attrib tex:format rgba16"
       " -o a.ktx2\n"
       "pack-normals n.png --length o.png --mips keep --no-sync --normalize --format rgba16 -o b.ktx2\n"
       "cmp a.ktx2 b.ktx2\n"
       // What an encoding lacks is left out, or, if it has been named, an error.
       "oiiotool --iconfig oiio:UnassociatedAlpha 1 n.png --attrib tex:format bc5 -o a.dds\n"
       "pack-normals n.png --drop --no-sync --normalize --mips keep --format bc5 -o b.dds\ncmp a.dds b.dds\n"
       "! oiiotool n.png --ch R,G,B o.png --ch blue=Y --chappend --attrib tex:format bc5 -o no.dds 2>&1 | grep .\n"
       "test ! -e no.dds");
}

TEST_F(OiioExtras, MistakesAreErrors) {
    const auto error = [&](const ImageSpec& spec) {
        const auto output = new_output();
        EXPECT_FALSE(output->open(scratch_.path("x.dds"), spec, ImageOutput::Create));
        return output->geterror();
    };
    ImageSpec spec(8, 8, 4, TypeDesc::UINT8);
    spec.channelnames[3] = "blue";
    spec.attribute("tex:format", "bc5");
    EXPECT_NE(error(spec).find("bc5 has no room for the channel blue"), std::string::npos);
    spec.attribute("tex:format", "rgba8");
    spec.attribute("tex:kind", "rust");
    EXPECT_NE(error(spec).find("tex:kind is \"rust\"; it must be one of height, "), std::string::npos);
    ImageSpec few(8, 8, 2, TypeDesc::UINT8);
    few.channelnames = {"R", "blue"};
    EXPECT_NE(error(few).find("a normal map has 2 to 4 channels, not 1, besides those called"), std::string::npos);
}

// Only what alpha was multiplied with is divided by it.
TEST_F(OiioExtras, NamedChannelsAreNotDividedByAlpha) {
    ImageSpec spec(4, 4, 5, TypeDesc::FLOAT);
    spec.channelnames = {"R", "G", "B", "blue", "A"};
    spec.alpha_channel = 4;
    spec.attribute("tex:format", "rgba32f");
    spec.attribute("normalEncoding", "unsigned");
    std::vector<float> pixels;
    for (int k = 0; k < 16; ++k) {
        for (const float c : {0.5f * 0.25f, 0.5f * 0.25f, 1.0f * 0.25f, 0.125f, 0.25f}) pixels.push_back(c);
    }
    const auto output = new_output();
    ASSERT_TRUE(output->open(scratch_.path("x.ktx2"), spec, ImageOutput::Create)) << output->geterror();
    ASSERT_TRUE(output->write_image(TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->close()) << output->geterror();
    const Image stored = *decode(*read_texture(scratch_.path("x.ktx2")), 0);
    EXPECT_EQ(stored.planes[2].at(1, 1), 0.125f);
    EXPECT_EQ(stored.planes[3].at(1, 1), 0.25f);
    EXPECT_NEAR(stored.planes[0].at(1, 1), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace tex::oiio
