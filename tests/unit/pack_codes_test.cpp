// SPDX-License-Identifier: Apache-2.0
// pack_file(): which codes stay as they are, and which level is read and how.

#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/pipeline.h>

#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

class PackCodes : public StreamTest {
protected:
    PackCodes() { options_.write.sync = false; }
    // Files are packed with y as in the source.
    static std::function<PackOptions(const SourceInfo&)> packing(Encoding encoding) {
        return [encoding](const SourceInfo& info) {
            PackOptions pack;
            pack.encoding = encoding;
            pack.y_axis = info.y_axis;
            return pack;
        };
    }
    [[nodiscard]] std::string written(const Texture& texture, const std::string& name) const {
        EXPECT_TRUE(write_texture(path(name), texture, options_.write)) << name;
        return path(name);
    }
    [[nodiscard]] NormalMap read_map(const std::string& name) const {
        const auto texture = read_texture(path(name));
        EXPECT_TRUE(texture);
        return std::move(unpack(*texture).value().levels.front());
    }
    PackFileOptions options_;
};

// Floats from 0 to 1 may be colours or components. Only the base level tells: later ones may be nearly flat.
TEST_F(PackCodes, ALevelIsReadAsTheBaseLevelShows) {
    const MipChain chain = build_mip_chain(wavy_map({64, 32})).value();
    Texture colours = pack(chain, {Encoding::float_}).value();
    for (Level& level : colours.levels) {
        for (std::size_t k = 0; k < level.bytes.size(); k += sizeof(float)) {
            float n = 0.0f;
            std::memcpy(&n, &level.bytes[k], sizeof n);
            n = (n + 1.0f) / 2.0f;
            std::memcpy(&level.bytes[k], &n, sizeof n);
        }
    }
    colours.swizzle = {Component::other, Component::other, Component::other, Component::other};  // not stated
    colours.normal_encoding.clear();
    const std::string input = written(colours, "in.exr");
    options_.pack = packing(Encoding::float_);
    for (const int level : {0, 1, 2, 3}) {
        options_.level = level;
        const auto report = pack_file(input, path("out.ktx2"), Container::ktx2, options_);
        ASSERT_TRUE(report) << report.error().message();
        const NormalMap got = read_map("out.ktx2");
        const NormalMap& wanted = chain.levels[static_cast<std::size_t>(level)];
        ASSERT_EQ(got.extent(), wanted.extent());
        for (int i = 0; i < got.extent().width; ++i) {
            ASSERT_NEAR(got.x.at(i, 0), wanted.x.at(i, 0), 1e-5f) << level;
            ASSERT_NEAR(got.y.at(i, 0), wanted.y.at(i, 0), 1e-5f) << level;
        }
    }
}

// With a level and a limit, the smaller levels are built from that level and not taken from the file.
TEST_F(PackCodes, ALevelThatIsTooLargeIsAveraged) {
    MipChain chain = build_mip_chain(wavy_map({64, 64})).value();
    for (std::size_t k = 1; k < chain.levels.size(); ++k) {
        const Extent extent = chain.levels[k].extent();
        chain.levels[k].x = Plane<float>(extent, 0.6f);
        chain.levels[k].y = Plane<float>(extent, 0.0f);
        chain.levels[k].z = Plane<float>(extent, 0.8f);
    }
    const std::string input = written(pack(chain, {Encoding::float_}).value(), "in.ktx2");
    options_.pack = packing(Encoding::float_);
    options_.max_side = 32;
    ASSERT_TRUE(pack_file(input, path("own.ktx2"), Container::ktx2, options_));
    EXPECT_NEAR(read_map("own.ktx2").x.at(3, 5), 0.6f, 1e-5f);
    options_.level = 0;
    ASSERT_TRUE(pack_file(input, path("built.ktx2"), Container::ktx2, options_));
    const NormalMap built = read_map("built.ktx2");
    const NormalMap wanted = std::move(build_mip_chain(wavy_map({64, 64})).value().levels[1]);
    ASSERT_EQ(built.extent(), wanted.extent());
    EXPECT_NEAR(built.x.at(3, 5), wanted.x.at(3, 5), 1e-5f);
    EXPECT_NEAR(built.y.at(20, 9), wanted.y.at(20, 9), 1e-5f);
}

// BC3 with x, y and z in RGB has the format of dxt5nm, which has no z: x and y must be those of a unit vector.
TEST_F(PackCodes, VectorsWithoutTheirZBecomeUnitVectors) {
    Texture texture;
    texture.format = Format::bc3_unorm;
    texture.levels.push_back({{4, 4}, std::vector<std::byte>(16)});
    auto& block = texture.levels[0].bytes;
    block[0] = block[1] = std::byte{255};
    constexpr unsigned kColor = 24u << 11 | 32u << 5 | 24u;  // R and B: 24/31, G: 32/63
    for (const std::size_t k : {8u, 10u}) {
        block[k] = static_cast<std::byte>(kColor & 255);
        block[k + 1] = static_cast<std::byte>(kColor >> 8);
    }
    const std::string input = written(texture, "in.dds");
    options_.source.unpack.swizzle = kSwizzleXyz;
    options_.keep_codes = true;
    options_.pack = packing(Encoding::dxt5nm);
    ASSERT_TRUE(pack_file(input, path("out.dds"), Container::dds, options_));
    const double x = 2.0 * 24.0 / 31.0 - 1.0, y = 2.0 * 32.0 / 63.0 - 1.0;
    const NormalMap got = read_map("out.dds");
    EXPECT_NEAR(got.x.at(1, 1), x / std::sqrt(x * x + y * y + x * x), 0.01);
    options_.pack = packing(Encoding::rgb16);  // no blocks: no codes to keep
    ASSERT_TRUE(pack_file(input, path("out.ktx2"), Container::ktx2, options_));
    EXPECT_NEAR(read_map("out.ktx2").x.at(1, 1), x / std::sqrt(x * x + y * y + x * x), 1e-4);
}

// An output of another format is what it would be alone, although the first one keeps the codes of the source.
TEST_F(PackCodes, OutputsOfOtherFormatsAreAsIfAlone) {
    NormalMap map = wavy_map({40, 24});
    for (int i = 0; i < 40; ++i) {  // codes 127 and 128 beside each other, which may or may not be made flat
        map.x.at(i, 3) = i % 2 == 0 ? 0.0039f : -0.0039f;
        map.y.at(i, 3) = i % 3 == 0 ? 0.0039f : -0.0039f;
        map.z.at(i, 3) = 1.0f;
    }
    const std::string input = written(pack(chain_from(std::move(map)), {Encoding::rgb8}).value(), "in.png");
    options_.keep_codes = true;
    for (const bool snap : {false, true}) {
        options_.source.unpack.snap_flat = snap;
        options_.more.clear();
        options_.pack = packing(Encoding::rgb16);
        ASSERT_TRUE(pack_file(input, path("alone.png"), Container::png, options_));
        options_.pack = packing(Encoding::rgb8);
        options_.more.push_back({path("beside.png"), {}, Container::png, 0, packing(Encoding::rgb16), options_.write});
        ASSERT_TRUE(pack_file(input, path("kept.png"), Container::png, options_));
        EXPECT_TRUE(bytes_of(path("beside.png")) == bytes_of(path("alone.png"))) << snap;
    }
}

}  // namespace
}  // namespace tex
