// SPDX-License-Identifier: Apache-2.0
// What is in a map beside its normals: kept where it can be, and named where it is left out.

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <tex/blend.h>
#include <tex/file.h>
#include <tex/pipeline.h>

#include "stream/pack_stream.h"
#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

constexpr Extent kExtent{32, 16};

class ExtraInspectorTest : public StreamTest {
protected:
    ExtraInspectorTest() {
        options_.write.sync = false;
        options_.source.inspect = true;
        options_.pack = [this](const SourceInfo&) { return PackOptions{encoding_, YAxis::up, Effort::fast}; };
    }

    // x, y, z in R, G, B; alpha holds all codes, twice.
    [[nodiscard]] Texture texture(Encoding encoding = Encoding::rgba8) const {
        MipChain chain;
        chain.levels.push_back(wavy_map(kExtent));
        Texture texture = pack(chain, {encoding, YAxis::up}).value();
        for (std::size_t k = 0; k < 512; ++k) texture.levels[0].bytes[4 * k + 3] = alpha(k);
        texture.swizzle = {Component::x, Component::y, Component::z, Component::other};
        return texture;
    }
    static std::byte alpha(std::size_t texel) { return static_cast<std::byte>(texel * 77); }

    [[nodiscard]] std::string write(const Texture& texture, Container kind) const {
        return StreamTest::write("in." + std::string(name_of(kContainerNames, kind)),
                                 encode_file(texture, kind, options_.write).value());
    }
    Result<PackFileReport> run(const std::string& input, Container kind) {
        return pack_file(input, path("out"), kind, options_);
    }
    [[nodiscard]] Texture output() const { return read_texture(path("out")).value(); }

    // The channels that are left out, as letters.
    static std::string names(const SourceInfo& info) {
        std::string names;
        for (const ExtraChannel& other : info.others) names += other.name;
        return names;
    }

    PackFileOptions options_;
    Encoding encoding_ = Encoding::rgba8;
};

TEST_F(ExtraInspectorTest, AlphaStaysInEveryFileOfRgba8) {
    for (const Container from : {Container::png, Container::dds, Container::ktx2, Container::tga}) {
        for (const Container to : {Container::png, Container::dds, Container::ktx2, Container::tga}) {
            const auto done = run(write(texture(), from), to);
            ASSERT_TRUE(done) << done.error().message();
            EXPECT_EQ(names(done->source), "");
            const Texture out = output();
            ASSERT_EQ(out.format, Format::rgba8_unorm);
            for (std::size_t k = 0; k < 512; ++k) ASSERT_EQ(out.levels[0].bytes[4 * k + 3], alpha(k)) << k;
        }
    }
}

TEST_F(ExtraInspectorTest, SmallerLevelsHoldTheMeanOfAlpha) {
    for (const MipDomain domain : {MipDomain::vector, MipDomain::slope}) {
        options_.mip = MipOptions();
        options_.mip->domain = domain;
        options_.mip->filter = MipFilter::box;
        ASSERT_TRUE(run(write(texture(), Container::png), Container::dds));
        const Texture out = output();
        ASSERT_EQ(out.levels.size(), 6u);
        std::vector<double> level(512);
        for (std::size_t k = 0; k < 512; ++k) level[k] = std::to_integer<int>(alpha(k));
        Extent extent = kExtent;
        for (std::size_t n = 1; n < 5; ++n) {
            const Extent half{extent.width / 2, extent.height / 2};
            std::vector<double> means;
            for (int j = 0; j < half.height; ++j) {
                for (int i = 0; i < half.width; ++i) {
                    const auto at = [&](int di, int dj) {
                        return level[static_cast<std::size_t>((2 * j + dj) * extent.width + 2 * i + di)];
                    };
                    means.push_back((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4.0);
                }
            }
            for (std::size_t k = 0; k < means.size(); ++k)
                ASSERT_NEAR(std::to_integer<int>(out.levels[n].bytes[4 * k + 3]), means[k], 0.5001) << n << ' ' << k;
            level = means;
            extent = half;
        }
    }
}

TEST_F(ExtraInspectorTest, WhatAnOutputLacksIsNamed) {
    const std::string input = write(texture(), Container::png);
    encoding_ = Encoding::bc5;
    EXPECT_EQ(names(run(input, Container::dds)->source), "A");
    MoreFile more;
    more.output = path("more");
    more.container = Container::png;
    more.write = options_.write;
    more.pack = [](const SourceInfo&) { return PackOptions{Encoding::rgba8, YAxis::up}; };
    options_.more = {more};
    EXPECT_EQ(names(run(input, Container::dds)->source), "A") << "one output lacks it";
    EXPECT_EQ(read_texture(path("more"))->levels[0].bytes[4 * 300 + 3], alpha(300)) << "the other has it";
    encoding_ = Encoding::rgba8;
    EXPECT_EQ(names(run(input, Container::dds)->source), "");
}

TEST_F(ExtraInspectorTest, AreLeftOutWhenAsked) {
    options_.source.drop_others = true;
    const auto done = run(write(texture(), Container::png), Container::png);
    ASSERT_TRUE(done);
    EXPECT_EQ(names(done->source), "");
    for (std::size_t k = 0; k < 512; ++k) ASSERT_EQ(output().levels[0].bytes[4 * k + 3], std::byte{255});
}

// Constants and copies of x, y or z are no data of their own.
TEST_F(ExtraInspectorTest, RepetitionsAreNotNamed) {
    encoding_ = Encoding::bc5;
    Texture plain = texture();
    for (std::size_t k = 0; k < 512; ++k) plain.levels[0].bytes[4 * k + 3] = std::byte{200};
    EXPECT_EQ(names(run(write(plain, Container::png), Container::dds)->source), "");
    Texture grey = texture(Encoding::ag8);
    for (std::size_t k = 0; k < 512; ++k) {
        std::byte* const texel = &grey.levels[0].bytes[4 * k];
        texel[0] = texel[2] = texel[1];
        texel[3] = static_cast<std::byte>(100 + k % 50);
    }
    grey.swizzle = kSwizzleDxt5nm;
    EXPECT_EQ(names(run(write(grey, Container::png), Container::dds)->source), "");
    options_.source.unpack.swizzle = kSwizzleXy;  // z is rebuilt, and blue is z
    EXPECT_EQ(names(run(write(plain, Container::png), Container::dds)->source), "");
    Texture labpbr = plain;
    for (std::size_t k = 0; k < 512; ++k) labpbr.levels[0].bytes[4 * k + 2] = alpha(k);
    EXPECT_EQ(names(run(write(labpbr, Container::png), Container::dds)->source), "B");
}

TEST_F(ExtraInspectorTest, TheAlphaOfTheBaseStaysInABlend) {
    const std::string base = write(texture(), Container::png);
    BlendFileOptions blend;
    blend.source.inspect = true;
    blend.write.sync = false;
    blend.pack = [](const SourceInfo&) { return PackOptions{Encoding::rgba8, YAxis::up}; };
    blend.layers.emplace_back().input = base;
    const auto done = blend_file(base, path("out"), Container::dds, blend);
    ASSERT_TRUE(done) << done.error().message();
    EXPECT_EQ(names(done->source), "");
    const Texture out = output();
    for (std::size_t k = 0; k < 512; ++k) ASSERT_EQ(out.levels[0].bytes[4 * k + 3], alpha(k)) << k;
}

// The alpha of the base is sampled as its normals are: bilinearly, or from means if the result is smaller.
TEST_F(ExtraInspectorTest, TheAlphaOfTheBaseFollowsTheExtentOfABlend) {
    const std::string base = write(texture(), Container::png);
    BlendFileOptions blend;
    blend.source.inspect = true;
    blend.write.sync = false;
    blend.pack = [](const SourceInfo&) { return PackOptions{Encoding::rgba8, YAxis::up}; };
    blend.layers.emplace_back().input = base;
    blend.mip.levels = 1;
    blend.blend.extent = {kExtent.width / 2, kExtent.height / 2};
    const auto done = blend_file(base, path("out"), Container::dds, blend);
    ASSERT_TRUE(done) << done.error().message();
    EXPECT_EQ(names(done->source), "");
    const auto at = [](int i, int j) {
        return std::to_integer<int>(alpha(static_cast<std::size_t>(j * kExtent.width + i)));
    };
    const Texture half = output();
    for (int j = 0; j < kExtent.height / 2; ++j) {
        for (int i = 0; i < kExtent.width / 2; ++i) {
            const double mean =
                (at(2 * i, 2 * j) + at(2 * i + 1, 2 * j) + at(2 * i, 2 * j + 1) + at(2 * i + 1, 2 * j + 1)) / 4.0;
            const auto texel = static_cast<std::size_t>(j * kExtent.width / 2 + i);
            ASSERT_NEAR(std::to_integer<int>(half.levels[0].bytes[4 * texel + 3]), mean, 0.5001) << i << ' ' << j;
        }
    }
    blend.blend.extent = {kExtent.width * 2, kExtent.height};
    ASSERT_TRUE(blend_file(base, path("out"), Container::dds, blend));
    const Texture wide = output();
    for (int i = 0; i + 1 < kExtent.width; ++i) {
        const auto between = static_cast<std::size_t>(2 * i + 1);  // a quarter of the way to the next texel
        ASSERT_NEAR(std::to_integer<int>(wide.levels[0].bytes[4 * between + 3]), 0.75 * at(i, 0) + 0.25 * at(i + 1, 0),
                    0.5001);
    }
    // The verb in memory, and an output that has no room.
    MipChain maps = std::move(read_normals(base)->chain), again = std::move(read_normals(base)->chain);
    std::vector<Layer> layers(1);
    layers[0].detail = std::move(again);
    NormalMap result = tex::blend(std::move(maps), std::move(layers), blend.blend).value();
    const Texture packed = pack(chain_from(std::move(result)), {Encoding::rgba8, YAxis::up}).value();
    EXPECT_EQ(packed.levels[0].bytes, wide.levels[0].bytes);
    blend.pack = [](const SourceInfo&) { return PackOptions{Encoding::rgb8, YAxis::up}; };
    EXPECT_EQ(names(blend_file(base, path("out"), Container::png, blend)->source), "A");
}

TEST_F(ExtraInspectorTest, BytesDoNotDependOnSizesAndThreads) {
    options_.mip = MipOptions();
    const std::string input = write(texture(), Container::png);
    ASSERT_TRUE(run(input, Container::ktx2));
    const Bytes whole = bytes_of(path("out"));
    for (const int threads : {1, 2, 3}) {
        for (const int texels : {1, 40, 200}) {
            InputFile file = std::move(*InputFile::open(input));
            const StreamSizes sizes{texels, 0, texels};
            ASSERT_TRUE(pack_stream(file, path("out"), Container::ktx2, options_, {threads, {}}, sizes));
            EXPECT_EQ(bytes_of(path("out")), whole) << threads << ' ' << texels;
        }
    }
}

}  // namespace
}  // namespace tex
