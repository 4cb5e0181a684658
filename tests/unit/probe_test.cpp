// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <unistd.h>

#include "scratch.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

const std::string kSamples = TEX_SOURCE_DIR "/samples/";

}  // namespace

TEST(Probe, StatesTheExtentThatReadingFinds) {
    for (const std::string name :
         {"bricks.png", "ramp.png", "broken/N304-jpeg-blocks.png", "broken/N105-not-power-of-two.png",
          "broken/N501-level-not-unit.dds", "broken/N404-y-contradicts-file.ktx2"}) {
        const auto image = read_image(kSamples + name);
        const auto extent = probe(kSamples + name);
        ASSERT_TRUE(image && extent) << name;
        EXPECT_EQ(*extent, image->extent()) << name;
    }
}

TEST(Probe, RefusesWhatItCannotKnow) {
    const auto missing = probe("/none/a.png");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::io);
    const auto text = probe(kSamples + "normals.toml");
    ASSERT_FALSE(text);
    EXPECT_EQ(text.error().code, ErrorCode::unsupported);
    const auto folder = probe(kSamples);
    ASSERT_FALSE(folder);
    EXPECT_EQ(folder.error().code, ErrorCode::io);
    ReadOptions few;
    few.max_texels = 10;
    EXPECT_FALSE(probe(kSamples + "bricks.png", few));
}

TEST(Probe, ReadsNoTexels) {
    // The header of a file whose texels are missing.
    std::ifstream whole(kSamples + "bricks.png", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(whole), std::istreambuf_iterator<char>()};
    const Scratch scratch;
    const auto extent = probe(scratch.write("cut.png", bytes.substr(0, bytes.size() / 2)));
    ASSERT_TRUE(extent) << extent.error().message();
    EXPECT_EQ(*extent, read_image(kSamples + "bricks.png")->extent());
}

}  // namespace tex
