// SPDX-License-Identifier: Apache-2.0
// Data that are put beside normals: into which encodings, which bytes, which levels, and what is refused.

#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tex/bake.h>
#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/pipeline.h>

#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

constexpr Extent kExtent{48, 32};

// Multiples of 1/255, all of them.
Plane<float> codes(int factor) {
    Plane<float> plane(kExtent);
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i)
            plane.at(i, j) = static_cast<float>(factor * (i + j * kExtent.width) % 256) / 255.0f;
    }
    return plane;
}

std::function<Result<Plane<float>>()> gives(int factor) {
    return [factor]() -> Result<Plane<float>> { return codes(factor); };
}

class GivenExtrasTest : public StreamTest {
protected:
    GivenExtrasTest() {
        options_.write.sync = false;
        options_.pack = [this](const SourceInfo&) { return PackOptions{encoding_, YAxis::up, Effort::fast}; };
        const Texture texture = pack(chain_from(wavy_map(kExtent)), {Encoding::float_, YAxis::up}).value();
        input_ = StreamTest::write("in.exr", encode_file(texture, Container::exr).value());
    }
    Result<PackFileReport> run(Container kind) { return pack_file(input_, path("out"), kind, options_); }
    [[nodiscard]] Texture output() const { return read_texture(path("out")).value(); }
    // Level `level` of the output, as its file stores it.
    [[nodiscard]] Image stored(int level = 0) const { return decode(output(), level).value(); }

    PackFileOptions options_;
    Encoding encoding_ = Encoding::rgba8;
    std::string input_;
};

void expect_near(const Plane<float>& a, const Plane<float>& b, float most, const std::string& what) {
    ASSERT_EQ(a.extent(), b.extent()) << what;
    for (int j = 0; j < a.extent().height; ++j) {
        for (int i = 0; i < a.extent().width; ++i) ASSERT_NEAR(a.at(i, j), b.at(i, j), most) << what << i << ' ' << j;
    }
}

TEST_F(GivenExtrasTest, EveryEncodingHoldsWhatItSays) {
    options_.others.blue = ExtraData{1.0f, gives(3)};
    for (const auto& row : kEncodingNames) {
        encoding_ = row.value;
        const Container kind = can_hold(Container::dds, encoding_) ? Container::dds : Container::ktx2;
        const ExtraSet held = can_hold(encoding_);
        options_.others.alpha.reset();
        if (held.alpha) options_.others.alpha = ExtraData{1.0f, gives(7)};
        const auto done = run(kind);
        ASSERT_EQ(static_cast<bool>(done), held.blue) << row.name;
        if (!done) {
            EXPECT_EQ(done.error().code, ErrorCode::bad_option);
            EXPECT_NE(done.error().reason.find("these formats have: rgb8, rgba8"), std::string::npos)
                << done.error().message();
            continue;
        }
        const Image image = stored();
        expect_near(image.planes[2], codes(3), 3e-4f, std::string(row.name));
        const float most = row.value == Encoding::rgba16f ? 1.0f / 4096.0f : 1e-7f;
        if (held.alpha) expect_near(image.planes[3], codes(7), most, std::string(row.name));
        EXPECT_NE(output().swizzle[2], Component::z) << "whoever reads the file reconstructs z";
    }
}

TEST_F(GivenExtrasTest, TheNormalsAreThoseOfAFileWithoutThem) {
    ASSERT_TRUE(run(Container::dds));
    const NormalMap plain = std::move(unpack(output())->levels[0]);
    options_.others = {ExtraData{0.25f}, ExtraData{1.0f, gives(5)}};
    ASSERT_TRUE(run(Container::dds));
    const NormalMap with = std::move(unpack(output())->levels[0]);
    expect_near(with.x, plain.x, 0.02f, "x");
    expect_near(with.z, plain.z, 0.02f, "z, which is reconstructed");
    expect_near(with.alpha, codes(5), 0.0f, "alpha");
    EXPECT_TRUE(plain.alpha.empty()) << "it is 1 everywhere";
}

TEST_F(GivenExtrasTest, SmallerLevelsFollowTheKind) {
    const NormalMap base = wavy_map(kExtent);
    MipOptions mip;
    const RoughnessChain rough = build_roughness_chain(base, codes(3), RoughnessModel::vmf, mip).value();
    Plane<float> smooth = codes(3);
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) smooth.at(i, j) = 1.0f - smooth.at(i, j);
    }
    const RoughnessChain inverse = build_roughness_chain(base, smooth, RoughnessModel::vmf, mip).value();
    options_.others = {ExtraData{1.0f, gives(3)}, ExtraData{1.0f, gives(3)}};
    for (const auto& [blue, alpha] :
         {std::pair(ExtraKind::roughness, ExtraKind::gloss), std::pair(ExtraKind::gloss, ExtraKind::roughness),
          std::pair(ExtraKind::height, ExtraKind::roughness)}) {
        mip.roughness = RoughnessModel::vmf;
        mip.blue = blue;
        mip.alpha = alpha;
        options_.mip = mip;
        ASSERT_TRUE(run(Container::dds));
        const auto expect_levels = [&](std::size_t channel, ExtraKind kind) {
            for (int level = 1; level < 5; ++level) {
                const Image image = stored(level);
                const auto k = static_cast<std::size_t>(level);
                Plane<float> expected = (kind == ExtraKind::gloss ? inverse : rough).levels[k].clone();
                for (int j = 0; kind == ExtraKind::gloss && j < expected.extent().height; ++j) {
                    for (int i = 0; i < expected.extent().width; ++i) expected.at(i, j) = 1.0f - expected.at(i, j);
                }
                expect_near(image.planes[channel], expected, 0.501f / 255.0f,
                            std::string(name_of(kExtraKindNames, kind)));
            }
        };
        if (blue != ExtraKind::height) expect_levels(2, blue);
        expect_levels(3, alpha);
    }
}

TEST_F(GivenExtrasTest, VerbsInMemoryGiveTheSameBytes) {
    for (const auto& kind : kExtraKindNames) {
        MipOptions mip;
        mip.alpha = mip.blue = kind.value;
        options_.mip = mip;
        options_.others = {ExtraData{1.0f, gives(3)}, ExtraData{1.0f, gives(7)}};
        ASSERT_TRUE(run(Container::ktx2));
        NormalMap map = std::move(unpack(read_texture(input_).value())->levels[0]);
        map.blue = codes(3);
        map.alpha = codes(7);
        const MipChain chain = build_mip_chain(std::move(map), mip).value();
        const auto bytes =
            encode_file(pack(chain, {Encoding::rgba8, YAxis::up, Effort::fast}).value(), Container::ktx2);
        EXPECT_EQ(bytes_of(path("out")), *bytes) << kind.name;
    }
}

TEST_F(GivenExtrasTest, HeightsThatAreBakedGoBesideTheirNormals) {
    std::vector<std::byte> grey(static_cast<std::size_t>(kExtent.texels()));
    for (std::size_t k = 0; k < grey.size(); ++k) grey[k] = static_cast<std::byte>(k * 7);
    Texture heights;
    heights.format = Format::r8_unorm;
    heights.levels.push_back({kExtent, grey});
    const std::string input = StreamTest::write("h.png", encode_file(heights, Container::png).value());
    BakeFileOptions options;
    options.write.sync = false;
    options.pack.encoding = Encoding::rgba8;
    options.others = {{}, ExtraData{1.0f, {}, true}};
    ASSERT_TRUE(bake_file(input, path("out"), Container::dds, options));
    const Texture out = output();
    for (std::size_t k = 0; k < grey.size(); ++k) ASSERT_EQ(out.levels[0].bytes[4 * k + 3], grey[k]) << k;
    EXPECT_GT(out.levels.size(), 1u);
}

// Heights of 16 bits stay what they are in A of 16 bits and of floats, in every container.
TEST_F(GivenExtrasTest, HeightsOf16BitsLoseNothing) {
    std::vector<std::byte> grey(2 * static_cast<std::size_t>(kExtent.texels()));
    for (std::size_t k = 0; k < grey.size(); ++k) grey[k] = static_cast<std::byte>(k * 37 % 251);
    Texture heights;
    heights.format = Format::r16_unorm;
    heights.levels.push_back({kExtent, grey});
    const std::string input = StreamTest::write("h.png", encode_file(heights, Container::png).value());
    const Image expected = decode(heights, 0).value();
    BakeFileOptions options;
    options.write.sync = false;
    options.others.alpha = ExtraData{1.0f, {}, true};
    for (const Encoding encoding : {Encoding::rgba16, Encoding::rgba16f, Encoding::rgba32f}) {
        for (const auto& kind : kContainerNames) {
            if (!can_hold(kind.value, encoding)) continue;
            options.pack.encoding = encoding;
            ASSERT_TRUE(bake_file(input, path("out"), kind.value, options)) << kind.name;
            const Image image = stored();
            ASSERT_EQ(image.planes.size(), 4u) << kind.name;
            const float most = encoding == Encoding::rgba16f ? 1.0f / 2048.0f : 0.0f;
            expect_near(image.planes[3], expected.planes[0], most, std::string(kind.name));
        }
    }
}

// A picture with four channels, larger than a strip.
Texture large_picture(Extent extent, const Plane<float>& green, const Plane<float>& blue) {
    NormalMap map = flat_map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            map.y.at(i, j) = 2.0f * green.at(i, j) - 1.0f;
            map.z.at(i, j) = 2.0f * blue.at(i, j) - 1.0f;
        }
    }
    return pack(chain_from(std::move(map)), {Encoding::rgb16, YAxis::up}).value();
}

// Two channels of one file, read with the rows of the normals: the bytes of planes that are held.
TEST_F(GivenExtrasTest, FilesGiveWhatPlanesGive) {
    constexpr Extent kLarge{310, 401};
    Plane<float> green(kLarge), blue(kLarge);
    for (int j = 0; j < kLarge.height; ++j) {
        for (int i = 0; i < kLarge.width; ++i) {
            green.at(i, j) = static_cast<float>((7 * i + 13 * j) % 251) / 250.0f;
            blue.at(i, j) = static_cast<float>((5 * i + 3 * j) % 241) / 240.0f;
        }
    }
    const Texture normals = pack(chain_from(wavy_map(kLarge)), {Encoding::float_, YAxis::up}).value();
    input_ = StreamTest::write("large.exr", encode_file(normals, Container::exr).value());
    encoding_ = Encoding::rgba16;
    options_.mip = MipOptions();
    options_.mip->alpha = ExtraKind::roughness;
    for (const Container type : {Container::png, Container::dds, Container::tiff}) {
        Texture picture = large_picture(kLarge, green, blue);
        picture.swizzle_known = picture.y_known = false;
        const std::string file = StreamTest::write("given", encode_file(picture, type).value());
        const Image stored = read_image(file).value();
        const auto plane_of = [&](const char* name) {
            return [&stored, name]() -> Result<Plane<float>> {
                return stored.planes[static_cast<std::size_t>(stored.find(name))].clone();
            };
        };
        options_.others = {ExtraData{1.0f, plane_of("B")}, ExtraData{1.0f, plane_of("G")}};
        ASSERT_TRUE(run(Container::ktx2));
        const Bytes expected = bytes_of(path("out"));
        const auto from_file = [&](HeightChannel channel) {
            ExtraData data;
            data.picture = ExtraPicture{file, {}, channel};
            return data;
        };
        options_.others = {from_file(HeightChannel::b), from_file(HeightChannel::g)};
        for (const int threads : {1, 2}) {
            std::filesystem::remove(path("out"));
            const auto done = pack_file(input_, path("out"), Container::ktx2, options_, {threads, {}});
            ASSERT_TRUE(done) << done.error().message();
            EXPECT_EQ(bytes_of(path("out")), expected) << name_of(kContainerNames, type);
        }
    }
}

TEST_F(GivenExtrasTest, WhatIsWrongWithAFileNamesIt) {
    const auto refuses = [this](const std::string& file, ErrorCode code, const std::string& words) {
        ExtraData data;
        data.picture = ExtraPicture{file};
        options_.others = {{}, data};
        const auto done = run(Container::dds);
        ASSERT_FALSE(done) << words;
        EXPECT_EQ(done.error().code, code) << done.error().message();
        EXPECT_NE(done.error().message().find(words), std::string::npos) << done.error().message();
        EXPECT_FALSE(std::filesystem::exists(path("out")));
        NormalMap map = wavy_map(kExtent);
        const auto put = put_others(map, options_.others, Encoding::rgba8);
        ASSERT_FALSE(put);
        EXPECT_EQ(put.error().code, code);
    };
    refuses(path("none.png"), ErrorCode::io, "none.png: no such file");
    RoughnessChain one;
    one.levels.emplace_back(Extent{5, 4}, 0.5f);
    const Bytes small = encode_file(pack_roughness(one).value(), Container::png).value();
    refuses(StreamTest::write("small.png", small), ErrorCode::bad_option,
            "alpha: the map has 5x4 texels, the normals have 48x32");
    one.levels[0] = codes(3);
    Bytes whole = encode_file(pack_roughness(one).value(), Container::png).value();
    refuses(StreamTest::write("cut.png", Bytes(whole.begin(), whole.end() - 80)), ErrorCode::bad_data, "cut.png: ");
    Texture unknown = pack_roughness(one, Format::r32_float).value();
    const float hole = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&unknown.levels[0].bytes[100 * sizeof hole], &hole, sizeof hole);
    const Bytes holes = encode_file(unknown, Container::exr).value();
    refuses(StreamTest::write("holes.exr", holes), ErrorCode::bad_data, "holes.exr: ");
}

TEST_F(GivenExtrasTest, WhatCannotBeIsRefused) {
    const auto refuses = [this](const std::string& words) {
        const auto done = run(Container::dds);
        ASSERT_FALSE(done) << words;
        EXPECT_EQ(done.error().code, ErrorCode::bad_option) << words;
        EXPECT_NE(done.error().message().find(words), std::string::npos) << done.error().message();
        EXPECT_FALSE(std::filesystem::exists(path("out")));
    };
    options_.others = {{}, ExtraData{1.5f}};
    refuses("alpha: must be from 0 to 1");
    options_.others = {{}, ExtraData{1.0f, []() -> Result<Plane<float>> { return Plane<float>(Extent{3, 2}, 0.0f); }}};
    refuses("alpha: the map has 3x2 texels, the normals have 48x32");
    options_.others = {{}, ExtraData{1.0f, {}, true}};
    refuses("there are no heights");
    options_.others = {};
    options_.apart.alpha = ExtraFile{path("apart.png"), Container::png};
    refuses("has no alpha beside the normals");
    options_.apart.alpha.reset();
    options_.mip = MipOptions();
    options_.mip->domain = MipDomain::slope;
    options_.mip->alpha = ExtraKind::roughness;
    refuses("roughness and gloss need the domain vector");
    options_.mip.reset();
    const Texture levels = pack(build_mip_chain(wavy_map(kExtent)).value(), {Encoding::bc5, YAxis::up}).value();
    input_ = StreamTest::write("in.dds", encode_file(levels, Container::dds).value());
    options_.others = {ExtraData{0.5f}, {}};
    refuses("has smaller levels");
}

TEST_F(GivenExtrasTest, WhatIsBesideTheNormalsIsWrittenApart) {
    options_.others = {ExtraData{1.0f, gives(3)}, ExtraData{1.0f, gives(7)}};
    ASSERT_TRUE(run(Container::dds));
    std::filesystem::rename(path("out"), path("both.dds"));
    input_ = path("both.dds");
    options_.others = {};
    encoding_ = Encoding::rgb8;
    options_.source.inspect = true;
    options_.apart.blue = ExtraFile{path("blue.png"), Container::png};
    options_.apart.alpha = ExtraFile{path("alpha.tga"), Container::tga};
    const auto done = run(Container::png);
    ASSERT_TRUE(done) << done.error().message();
    EXPECT_TRUE(done->source.others.empty()) << "nothing is lost";
    expect_near(decode(read_texture(path("blue.png")).value(), 0).value().planes[0], codes(3), 0.0f, "blue");
    expect_near(decode(read_texture(path("alpha.tga")).value(), 0).value().planes[0], codes(7), 0.0f, "alpha");
}

}  // namespace
}  // namespace tex
