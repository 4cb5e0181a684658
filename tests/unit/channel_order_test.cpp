// SPDX-License-Identifier: Apache-2.0
// BC5 of which the file does not say whether x or y comes first.

#include "checks/channel_order.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/pack.h>

#include "reference/dds_file.h"
#include "unit/textures.h"

namespace tex {
namespace {

// The slopes of waves in several directions, which have no curl.
MipChain waves(Extent extent) {
    constexpr double kWaves[][3] = {
        {0.31, 0.17, 1.0}, {0.11, -0.29, 1.3}, {-0.23, 0.05, 0.9}, {0.04, 0.37, 0.8}, {0.41, -0.38, 0.4}};
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            double p = 0.0, q = 0.0;  // to the right, and upwards
            for (const auto& [u, v, height] : kWaves) {
                p += height * u * std::cos(u * i - v * j);
                q += height * v * std::cos(u * i - v * j);
            }
            const double length = std::sqrt(p * p + q * q + 1.0);
            map.x.at(i, j) = static_cast<float>(-p / length);
            map.y.at(i, j) = static_cast<float>(-q / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
    }
    MipChain chain;
    chain.levels.push_back(std::move(map));
    return chain;
}

MipChain exchanged(MipChain chain) {
    std::swap(chain.levels[0].x, chain.levels[0].y);
    return chain;
}

// A DDS file with the FourCC ATI2 and these blocks.
std::string ati2(const MipChain& chain, std::uint32_t code = 0) {
    const auto texture = pack(chain, {Encoding::bc5, YAxis::up, Effort::fast});
    EXPECT_TRUE(texture);
    const auto side = static_cast<std::uint32_t>(texture->extent().width);
    auto file = reference::dds_coded(side, side, 1, reference::four_cc("ATI2"));
    file[reference::dds::kBitCount] = code;
    const auto& bytes = texture->levels[0].bytes;
    file.data.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return write_dds(file);
}

Texture read(const std::string& file) {
    auto texture = read_texture(std::as_bytes(std::span(file)), "a.dds");
    EXPECT_TRUE(texture);
    return std::move(*texture);
}

std::string order_of(const std::string& file) { return layout_name(guess_swizzle(read(file)).value()); }

TEST(ChannelOrder, IsThatInWhichTheSlopesHaveNoCurl) {
    const MipChain chain = waves({128, 128});
    EXPECT_EQ(order_of(ati2(chain)), "rg");
    EXPECT_EQ(order_of(ati2(exchanged(waves({128, 128})))), "gr");
    EXPECT_TRUE(read(ati2(chain)).order_open);
}

// GIMP 2.10.34 and NVIDIA's texture tools 2.1.2 write red, which is x, to the first block, without a code.
TEST(ChannelOrder, IsToldByTheCodeOrTheSignature) {
    const std::string file = ati2(exchanged(waves({128, 128})));
    EXPECT_EQ(order_of(ati2(exchanged(waves({128, 128})), reference::four_cc("A2XY"))), "rg");
    std::string gimp = file;
    std::memcpy(&gimp[reference::dds::kReserved], "GIMP-DDS\\\x09\x03", 11);
    EXPECT_EQ(order_of(gimp), "rg");
    EXPECT_FALSE(read(gimp).order_open);
    std::string nvtt = file;
    std::memcpy(&nvtt[reference::dds::kReserved + 36], "NVTT", 4);
    EXPECT_EQ(order_of(nvtt), "rg");
    std::string libtex = file;
    std::memcpy(&libtex[reference::dds::kReserved + 12], "LTEXgr +y", 9);
    EXPECT_EQ(order_of(libtex), "gr");
}

// OpenImageIO, Pillow, DirectXTex and Godot take red from the first block.
TEST(ChannelOrder, IsXFirstIfTheTexelsDoNotShowIt) {
    const auto flat = [](Extent extent) {
        MipChain chain;
        NormalMap map;
        map.x = Plane<float>(extent, 0.0f);
        map.y = Plane<float>(extent, 0.0f);
        map.z = Plane<float>(extent, 1.0f);
        chain.levels.push_back(std::move(map));
        return chain;
    };
    EXPECT_EQ(order_of(ati2(flat({64, 64}))), "rg");
    EXPECT_EQ(order_of(ati2(exchanged(waves({16, 16})))), "rg") << "too small to show it";
    EXPECT_FALSE(*shown_order(read(ati2(flat({64, 64}))), {}));
}

TEST(ChannelOrder, OfRealFilesIsRight) {
    TEX_NEEDS_SHARED_DATA();
    const std::pair<const char*, const char*> files[] = {
        {"fieldstone_ATI2_512_mips10.dds", "gr"},  // lit from above, stones are bumps in this order alone
        {"amd_wood_ATI2_A2XY_512_mips10.dds", "rg"},
        {"amd_RedLetters_1k_normal_ATI2_A2XY.dds", "rg"},
        {"reference/pillow_bc5_unorm.dds", "rg"},
    };
    for (const auto& [file, name] : files) {
        auto texture = read_texture(shared_data() / "dds" / file);
        ASSERT_TRUE(texture) << file;
        const auto shown = shown_order(*texture, {});
        ASSERT_TRUE(shown) << file;
        EXPECT_EQ(layout_name(shown->value_or(kSwizzleXy)), name) << file << (*shown ? "" : ": not shown");
    }
}

}  // namespace
}  // namespace tex
