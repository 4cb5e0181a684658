// SPDX-License-Identifier: Apache-2.0
// Occlusion in the lengths of vectors: as Terrain3D packs and reads it, kept, given, written apart, and refused.

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tex/check.h>
#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/pipeline.h>

#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

constexpr Extent kSize{40, 24};

// Terrain3D, src/terrain_3d_util.cpp, pack_image() of 2025: what becomes of a colour, in double.
double packed_color(double color, double occlusion) {
    const double length = std::sqrt(occlusion) * 0.5 + 0.5;
    return color * length + (1.0 - length) * 0.5;
}

// Terrain3D, src/shaders/main.glsl: occlusion of a texel.
double shader_occlusion(double x, double y, double z) {
    const double root = std::sqrt(x * x + y * y + z * z) * 2.0 - 1.0;  // below 0 by rounding alone
    return root > 0.0 ? root * root : 0.0;
}

Plane<float> occlusion() {
    std::mt19937 random(7);
    Plane<float> plane(kSize);
    for (int j = 0; j < kSize.height; ++j) {
        for (int i = 0; i < kSize.width; ++i) plane.at(i, j) = static_cast<float>(random() % 256) / 255.0f;
    }
    return plane;
}

NormalMap occluded_map() {
    NormalMap map = wavy_map(kSize);
    map.length = occlusion();
    return map;
}

class LengthDataTest : public StreamTest {
protected:
    LengthDataTest() {
        options_.write.sync = false;
        options_.source.inspect = true;
        options_.source.unpack.others.length = true;
        options_.pack = [this](const SourceInfo&) { return PackOptions{encoding_, YAxis::up}; };
        const Texture texture = pack(chain_from(occluded_map()), {Encoding::rgba8, YAxis::up}).value();
        input_ = StreamTest::write("in.png", encode_file(texture, Container::png).value());
    }
    Result<PackFileReport> run(Container kind) { return pack_file(input_, path("out"), kind, options_); }
    [[nodiscard]] Image stored(int level = 0) const { return decode(read_texture(path("out")).value(), level).value(); }
    // The channels that are left out, as letters.
    static std::string lost(const Result<PackFileReport>& report) {
        std::string names;
        for (const ExtraChannel& other : report.value().source.others) names += other.name;
        return names;
    }

    PackFileOptions options_;
    Encoding encoding_ = Encoding::rgba8;
    std::string input_;
};

double length_at(const Image& image, int i, int j) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double n = 2.0 * static_cast<double>(image.planes[c].at(i, j)) - 1.0;
        sum += n * n;
    }
    return std::sqrt(sum);
}

TEST_F(LengthDataTest, CodesAreThoseOfTerrain3d) {
    const NormalMap map = occluded_map();
    const Image image = decode(read_texture(input_).value(), 0).value();
    for (int j = 0; j < kSize.height; ++j) {
        for (int i = 0; i < kSize.width; ++i) {
            const float components[] = {map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)};
            for (std::size_t c = 0; c < 3; ++c) {
                const double color = (static_cast<double>(components[c]) + 1.0) / 2.0;
                const double theirs = packed_color(color, static_cast<double>(map.length.at(i, j)));
                ASSERT_NEAR(static_cast<double>(image.planes[c].at(i, j)), theirs, 0.5001 / 255.0) << i << ' ' << j;
            }
        }
    }
}

TEST_F(LengthDataTest, WhatIsReadIsWhatTheShaderReads) {
    for (const Encoding encoding : {Encoding::float_, Encoding::rgb16, Encoding::half, Encoding::rgba8}) {
        const Texture texture = pack(chain_from(occluded_map()), {encoding, YAxis::down}).value();
        const Image image = decode(texture, 0).value();
        UnpackOptions unpacking;
        unpacking.others.length = true;
        const MipChain chain = unpack(texture, unpacking).value();
        const NormalMap& map = chain.levels[0];
        const bool is_unorm = format_info(texture.format).sample == SampleKind::unorm;
        for (int j = 0; j < kSize.height; ++j) {
            for (int i = 0; i < kSize.width; ++i) {
                const auto component = [&](std::size_t c) {
                    const double value = static_cast<double>(image.planes[c].at(i, j));
                    return is_unorm ? 2.0 * value - 1.0 : value;
                };
                const double theirs = std::min(1.0, shader_occlusion(component(0), component(1), component(2)));
                ASSERT_NEAR(static_cast<double>(map.length.at(i, j)), theirs, 1e-5);
                const double unit = std::sqrt(static_cast<double>(map.x.at(i, j) * map.x.at(i, j)) +
                                              static_cast<double>(map.y.at(i, j) * map.y.at(i, j)) +
                                              static_cast<double>(map.z.at(i, j) * map.z.at(i, j)));
                ASSERT_NEAR(unit, 1.0, 1e-5) << "the normals are unit";
            }
        }
    }
    EXPECT_TRUE(unpack(read_texture(input_).value())->levels[0].length.empty()) << "nobody said that lengths are data";
}

TEST_F(LengthDataTest, SmallerLevelsHoldTheMeanOfOcclusion) {
    options_.mip = MipOptions();
    encoding_ = Encoding::rgba32f;
    input_ = StreamTest::write(
        "in.exr", encode_file(pack(chain_from(occluded_map()), {Encoding::float_}).value(), Container::exr).value());
    ASSERT_TRUE(run(Container::dds));
    std::vector<double> level;
    const Plane<float> base = occlusion();
    for (int k = 0; k < kSize.texels(); ++k)
        level.push_back(static_cast<double>(base.at(k % kSize.width, k / kSize.width)));
    Extent extent = kSize;
    for (int n = 1; n < 4; ++n) {
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
        const Image image = stored(n);
        for (int j = 0; j < half.height; ++j) {
            for (int i = 0; i < half.width; ++i) {
                const double theirs = shader_occlusion(static_cast<double>(image.planes[0].at(i, j)),
                                                       static_cast<double>(image.planes[1].at(i, j)),
                                                       static_cast<double>(image.planes[2].at(i, j)));
                ASSERT_NEAR(theirs, means[static_cast<std::size_t>(j * half.width + i)], 1e-5) << n;
            }
        }
        level = means;
        extent = half;
    }
}

TEST_F(LengthDataTest, StreamsAndMemoryGiveTheSameBytes) {
    for (const bool levels : {false, true}) {
        options_.mip.reset();
        if (levels) options_.mip = MipOptions();
        for (const Encoding encoding : {Encoding::rgba8, Encoding::rgb16, Encoding::rgba16f}) {
            encoding_ = encoding;
            ASSERT_TRUE(run(Container::ktx2));
            UnpackOptions unpacking;
            unpacking.others = {false, true, true};
            MipChain chain = unpack(read_texture(input_).value(), unpacking).value();
            if (levels) chain = build_mip_chain(std::move(chain.levels[0])).value();
            const auto bytes = encode_file(pack(chain, {encoding, YAxis::up}).value(), Container::ktx2);
            EXPECT_EQ(bytes_of(path("out")), *bytes) << name_of(kEncodingNames, encoding) << levels;
        }
    }
}

TEST_F(LengthDataTest, CodesStayWhereTheyCan) {
    options_.keep_codes = true;
    EXPECT_EQ(lost(run(Container::tga)), "");
    EXPECT_EQ(read_texture(path("out"))->levels[0].bytes, read_texture(input_)->levels[0].bytes);
    encoding_ = Encoding::rgb16;  // other codes, the same lengths
    EXPECT_EQ(lost(run(Container::png)), "");
    const Image before = decode(read_texture(input_).value(), 0).value(), after = stored();
    for (int j = 0; j < kSize.height; ++j) {
        for (int i = 0; i < kSize.width; ++i)
            ASSERT_NEAR(length_at(after, i, j), std::min(1.0, std::max(0.5, length_at(before, i, j))), 1e-4);
    }
}

TEST_F(LengthDataTest, WhatIsLostIsNamed) {
    encoding_ = Encoding::bc5;
    EXPECT_EQ(lost(run(Container::dds)), "L");
    options_.source.unpack.others.length = false;
    EXPECT_EQ(lost(run(Container::dds)), "") << "lengths are no data unless somebody says so";
}

TEST_F(LengthDataTest, IsGivenAndWrittenApart) {
    input_ = StreamTest::write(
        "unit.png", encode_file(pack(chain_from(wavy_map(kSize)), {Encoding::rgb16}).value(), Container::png).value());
    options_.source.unpack.others.length = false;
    options_.others.length = ExtraData{1.0f, []() -> Result<Plane<float>> { return occlusion(); }};
    options_.keep_codes = true;
    encoding_ = Encoding::rgb16;
    ASSERT_TRUE(run(Container::png));
    std::filesystem::rename(path("out"), path("both.png"));
    input_ = path("both.png");
    options_.others = {};
    options_.source.unpack.others.length = true;
    options_.apart.length = ExtraFile{path("ao.png"), Container::png};
    ASSERT_TRUE(run(Container::png));
    const Image apart = decode(read_texture(path("ao.png")).value(), 0).value(), normals = stored();
    const Plane<float> expected = occlusion();
    for (int j = 0; j < kSize.height; ++j) {
        for (int i = 0; i < kSize.width; ++i) {
            ASSERT_NEAR(apart.planes[0].at(i, j), expected.at(i, j), 0.6f / 255.0f);
            ASSERT_NEAR(length_at(normals, i, j), 1.0, 1e-4) << "it is not there twice";
        }
    }
}

TEST_F(LengthDataTest, AVectorWithoutZHasNoLength) {
    const auto refuses = [this](const std::string& words) {
        const auto done = run(Container::dds);
        ASSERT_FALSE(done) << words;
        EXPECT_EQ(done.error().code, ErrorCode::bad_option) << words;
        EXPECT_NE(done.error().message().find(words), std::string::npos) << done.error().message();
        EXPECT_FALSE(std::filesystem::exists(path("out")));
    };
    options_.others = {ExtraData{0.5f}, {}, ExtraData{0.5f}};
    refuses("blue and length exclude each other");
    options_.others = {ExtraData{0.5f}, {}, {}};
    refuses("blue and length exclude each other");
    options_.others = {{}, {}, ExtraData{0.5f}};
    encoding_ = Encoding::bc5;
    refuses("bc5 has no length for data beside the normals; these formats have: rgb8");
    encoding_ = Encoding::rgb8;
    options_.source.unpack.keep_length = true;
    refuses("keep_length");
    NormalMap map = occluded_map();
    map.blue = occlusion();
    EXPECT_FALSE(pack(chain_from(std::move(map)), {Encoding::rgba8}));
}

TEST_F(LengthDataTest, IsNoFault) {
    const Texture texture = read_texture(input_).value();
    const auto ids = [&](const CheckOptions& options) {
        std::string ids;
        const CheckReport report = check("in.png", texture, options).value();
        for (const Finding& finding : report.findings) ids += finding.rule->id;
        return ids;
    };
    CheckOptions options;
    // Occlusion that is noise leaves nothing that looks like normals, unless the options say that it is in the lengths.
    EXPECT_NE(ids(options).find_first_not_of("N"), std::string::npos);
    options.any_length = true;
    EXPECT_EQ(ids(options).find("N201"), std::string::npos);
}

TEST_F(LengthDataTest, DataArePutBesideNormalsInMemory) {
    NormalMap map = wavy_map(kSize);
    const auto give = []() -> Result<Plane<float>> { return occlusion(); };
    ASSERT_TRUE(put_others(map, {{}, ExtraData{0.25f}, ExtraData{1.0f, give}}, Encoding::rgba16));
    EXPECT_EQ(map.alpha.at(3, 4), 0.25f);
    EXPECT_EQ(map.length.at(3, 4), occlusion().at(3, 4));
    EXPECT_FALSE(put_others(map, {ExtraData{0.25f}, {}, {}}, Encoding::rgba16)) << "there is data in the lengths";
    EXPECT_FALSE(put_others(map, {{}, ExtraData{0.25f}, {}}, Encoding::rgb16)) << "no room";
    NormalMap small = wavy_map({3, 3});
    EXPECT_FALSE(put_others(small, {{}, ExtraData{1.0f, give}, {}}, Encoding::rgba8)) << "another extent";
    EXPECT_FALSE(put_others(small, {{}, ExtraData{1.0f, {}, true}, {}}, Encoding::rgba8)) << "no heights here";
}

}  // namespace
}  // namespace tex
