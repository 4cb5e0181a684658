// SPDX-License-Identifier: Apache-2.0
// What ImageMagick's DDS reader makes of our files.

#include <cstdlib>

#include <gtest/gtest.h>

#include "peer_texture.h"

namespace {

// The base level as ImageMagick decodes it, through an 8-bit RGBA PNG.
tex::Result<tex::Image> read_by_imagemagick(const std::string& dds) {
    const std::string png = peers::scratch_path("imagemagick.png");
    const std::string command = "convert '" + dds + "[0]' -define png:color-type=6 -depth 8 'PNG32:" + png + "'";
    if (std::system(command.c_str()) != 0) return tex::Error{tex::ErrorCode::io, dds, "ImageMagick failed"};
    return tex::read_image(png);
}

TEST(ImageMagick, ReadsTheBaseLevelOfDxt5nmAsWeDecodeIt) {
    for (const tex::Extent extent : {tex::Extent{64, 64}, tex::Extent{129, 66}, tex::Extent{5, 7}}) {
        const tex::Texture texture = peers::bumpy_texture(extent, tex::Encoding::dxt5nm);
        const std::string path = peers::scratch_path("imagemagick.dds");
        ASSERT_TRUE(tex::write_texture(path, texture));
        const auto theirs = read_by_imagemagick(path);
        ASSERT_TRUE(theirs) << theirs.error().message();
        const auto ours = tex::decode(texture, 0);
        ASSERT_EQ(theirs->extent(), extent);
        ASSERT_EQ(theirs->planes.size(), 4u);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                for (std::size_t c = 0; c < 4; ++c) {
                    ASSERT_NEAR(theirs->planes[c].at(i, j), ours->planes[c].at(i, j), 2.0f / 255.0f)
                        << "texel " << i << ", " << j << " channel " << c;
                }
            }
        }
    }
}

// It does not look at the masks: what it shows is right because blue comes first.
TEST(ImageMagick, ReadsUncompressedTexturesAsWeDecodeThem) {
    for (const tex::Encoding encoding : {tex::Encoding::rgb8, tex::Encoding::rgba8, tex::Encoding::ag8}) {
        const tex::Texture texture = peers::bumpy_texture({5, 7}, encoding);
        const std::string path = peers::scratch_path("imagemagick.dds");
        ASSERT_TRUE(tex::write_texture(path, texture));
        const auto theirs = read_by_imagemagick(path);
        ASSERT_TRUE(theirs) << theirs.error().message();
        const auto ours = tex::decode(texture, 0);
        ASSERT_EQ(theirs->extent(), ours->extent());
        for (std::size_t c = 0; c < ours->planes.size(); ++c) {
            for (int i = 0; i < 5; ++i)
                ASSERT_EQ(theirs->planes[c].at(i, 6), ours->planes[c].at(i, 6)) << "channel " << c;
        }
    }
}

}  // namespace
