// SPDX-License-Identifier: Apache-2.0
// What OpenImageIO's own DDS reader makes of our files.

#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>

#include "peer_texture.h"

namespace {

constexpr float kOneCode = 1.001f / 255.0f;  // its decoder truncates to 8 bits

// Every level and every stored channel of `texture`, written to a DDS and read by OpenImageIO.
void expect_same_texels(const tex::Texture& texture, const tex::WriteOptions& options, const std::string& name) {
    const std::string path = peers::scratch_path(name);
    const auto written = tex::write_texture(path, texture, options);
    ASSERT_TRUE(written) << written.error().message();
    const auto input = OIIO::ImageInput::open(path);
    ASSERT_TRUE(input) << OIIO::geterror();
    for (std::size_t k = 0; k < texture.levels.size(); ++k) {
        ASSERT_TRUE(input->seek_subimage(0, static_cast<int>(k))) << path << " has no level " << k;
        const OIIO::ImageSpec spec = input->spec();
        const tex::Extent extent = texture.levels[k].extent;
        ASSERT_EQ(spec.width, extent.width);
        ASSERT_EQ(spec.height, extent.height);
        std::vector<float> theirs(static_cast<std::size_t>(extent.texels()) * static_cast<std::size_t>(spec.nchannels));
        ASSERT_TRUE(input->read_image(0, static_cast<int>(k), 0, spec.nchannels, OIIO::TypeDesc::FLOAT, theirs.data()))
            << input->geterror();
        const auto ours = tex::decode(texture, static_cast<int>(k));
        ASSERT_TRUE(ours);
        const int channels = std::min(spec.nchannels, tex::format_info(texture.format).channels);
        for (int channel = 0; channel < channels; ++channel) {
            EXPECT_LE(peers::largest_difference(*ours, channel, theirs, spec.nchannels), kOneCode)
                << path << " level " << k << " channel " << channel;
        }
    }
    EXPECT_FALSE(input->seek_subimage(0, static_cast<int>(texture.levels.size()))) << "a level too many";
}

TEST(OpenImageIo, ReadsEveryLevelOfDxt5nmAsWeDecodeIt) {
    for (const tex::Extent extent : peers::kExtents) {
        const tex::Texture texture = peers::bumpy_texture(extent, tex::Encoding::dxt5nm);
        expect_same_texels(texture, {}, "legacy.dds");  // version 2.4 knows no BC3 behind a DX10 header
    }
}

TEST(OpenImageIo, ReadsBc5AsWeDecodeIt) {
    tex::WriteOptions options;
    options.dds_header = tex::DdsHeader::dx10;
    expect_same_texels(peers::bumpy_texture({129, 66}, tex::Encoding::bc5), options, "bc5.dds");
}

TEST(OpenImageIo, ReadsBc7AsWeDecodeIt) {
    expect_same_texels(peers::bumpy_texture({129, 66}, tex::Encoding::bc7), {}, "bc7.dds");
}

TEST(OpenImageIo, ReadsUncompressedTexturesAsWeDecodeThem) {
    for (const tex::Encoding encoding : {tex::Encoding::rgb8, tex::Encoding::rgba8, tex::Encoding::ag8}) {
        expect_same_texels(peers::bumpy_texture({37, 20}, encoding), {},
                           std::string(tex::name_of(tex::kEncodingNames, encoding)) + ".dds");
    }
}

TEST(OpenImageIo, RebuildsZWhereTheFileIsMarked) {
    // DDPF_NORMAL makes OpenImageIO return x, y and a z that it computes: x must then stand in R.
    const tex::Texture texture = peers::bumpy_texture({64, 64}, tex::Encoding::dxt5nm);
    tex::WriteOptions options;
    options.dds_mark = true;
    const std::string path = peers::scratch_path("mark.dds");
    ASSERT_TRUE(tex::write_texture(path, texture, options));
    const auto input = OIIO::ImageInput::open(path);
    ASSERT_TRUE(input) << OIIO::geterror();
    const int channels = input->spec().nchannels;
    ASSERT_GE(channels, 3);
    std::vector<float> theirs(64 * 64 * static_cast<std::size_t>(channels));
    ASSERT_TRUE(input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, theirs.data()));
    const auto ours = tex::decode(texture, 0);
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const float* texel = theirs.data() + static_cast<std::ptrdiff_t>((j * 64 + i) * channels);
            ASSERT_NEAR(texel[0], ours->planes[3].at(i, j), kOneCode);
            ASSERT_NEAR(texel[1], ours->planes[1].at(i, j), kOneCode);
        }
    }
}

}  // namespace
