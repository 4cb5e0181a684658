// SPDX-License-Identifier: Apache-2.0

#include <tex/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <span>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "reference/astc_block.h"
#include "unit/textures.h"

namespace tex {
namespace {

MipChain bumps(Extent extent, float height) {
    MipChain chain;
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float x = height * std::sin(static_cast<float>(i) * 0.4f),
                        y = height * std::cos(static_cast<float>(j) * 0.3f);
            map.x.at(i, j) = x;
            map.y.at(i, j) = y;
            map.z.at(i, j) = std::sqrt(1.0f - x * x - y * y);
        }
    }
    chain.levels.push_back(std::move(map));
    return chain;
}

// A packed texture, with its swizzle mark removed.
Texture unmarked(const MipChain& chain, Encoding encoding) {
    auto texture = pack(chain, {encoding, YAxis::up, Effort::fast});
    EXPECT_TRUE(texture);
    texture->swizzle_known = false;
    texture->swizzle = {Component::x, Component::y, Component::z, Component::other};
    return std::move(*texture);
}

std::string guess(const Texture& texture) {
    const auto swizzle = guess_swizzle(texture);
    EXPECT_TRUE(swizzle);
    return std::string(name_of(kSwizzleNames, *swizzle));
}

}  // namespace

TEST(Swizzle, IsToldFromTheTexels) {
    for (const Extent extent : {Extent{64, 64}, Extent{5, 7}}) {
        EXPECT_EQ(guess(unmarked(bumps(extent, 0.5f), Encoding::dxt5nm)), "dxt5nm");
        EXPECT_EQ(guess(unmarked(bumps(extent, 0.5f), Encoding::ag8)), "dxt5nm");
        EXPECT_EQ(guess(unmarked(bumps(extent, 0.5f), Encoding::rgba8)), "rgb");
        EXPECT_EQ(guess(unmarked(bumps(extent, 0.02f), Encoding::dxt5nm)), "dxt5nm");
        EXPECT_EQ(guess(unmarked(bumps(extent, 0.02f), Encoding::rgba8)), "rgb");
    }
}

TEST(Swizzle, OfFlatMapsIsToldFromTheirLength) {
    EXPECT_EQ(guess(unmarked(bumps({16, 16}, 0.0f), Encoding::dxt5nm)), "dxt5nm");
    EXPECT_EQ(guess(unmarked(bumps({16, 16}, 0.0f), Encoding::rgba8)), "rgb");
}

// Gloss or height beside a flat map does not make it DXT5nm.
TEST(Swizzle, OfFlatMapsWithDataInAlphaIsRgb) {
    Texture texture = unmarked(bumps({16, 16}, 0.0f), Encoding::rgba8);
    for (std::size_t k = 0; k < 256; ++k) texture.levels[0].bytes[4 * k + 3] = static_cast<std::byte>(k);
    EXPECT_EQ(guess(texture), "rgb");
    Texture packed = unmarked(bumps({16, 16}, 0.0f), Encoding::ag8);
    for (std::size_t k = 0; k < 256; ++k) packed.levels[0].bytes[4 * k + 3] = static_cast<std::byte>(k);
    EXPECT_EQ(guess(packed), "dxt5nm");
}

// Equal colours beside a varying alpha are x and y in KTX2, and y and x elsewhere.
TEST(Swizzle, OfGreyWithAlphaDependsOnTheConvention) {
    Texture texture = unmarked(bumps({16, 16}, 0.5f), Encoding::ag8);
    for (std::size_t k = 0; k < 256; ++k)
        texture.levels[0].bytes[4 * k] = texture.levels[0].bytes[4 * k + 2] = texture.levels[0].bytes[4 * k + 1];
    EXPECT_EQ(guess(texture), "dxt5nm");
    texture.x_in_grey = true;
    EXPECT_EQ(guess(texture), "ra");
    Texture plain = unmarked(bumps({16, 16}, 0.5f), Encoding::rgba8);
    plain.x_in_grey = true;
    EXPECT_EQ(guess(plain), "rgb");
}

// No value of a flat map is negative, although the format is signed.
TEST(Swizzle, OfFlatFloatsIsToldFromBothReadings) {
    const auto flat = [](std::initializer_list<float> texel) {
        Texture texture;
        texture.format = Format::rgba32_float;
        texture.levels.push_back({{4, 4}, {}});
        for (int k = 0; k < 16; ++k) {
            const auto bytes = std::as_bytes(std::span(texel.begin(), texel.size()));
            texture.levels[0].bytes.insert(texture.levels[0].bytes.end(), bytes.begin(), bytes.end());
        }
        return guess(texture);
    };
    EXPECT_EQ(flat({0.0f, 0.0f, 1.0f, 1.0f}), "rgb");
    EXPECT_EQ(flat({0.5f, 0.5f, 1.0f, 1.0f}), "rgb");
    EXPECT_EQ(flat({1.0f, 0.5f, 1.0f, 0.5f}), "dxt5nm");
    EXPECT_EQ(flat({0.0f, 0.0f, 1.0f, 0.3f}), "rgb");
}

TEST(Swizzle, OfRxgbIsToldFromTheUnitVectors) {
    Texture texture = unmarked(bumps({32, 32}, 0.5f), Encoding::rgba8);
    for (std::size_t k = 0; k < texture.levels[0].bytes.size(); k += 4) {
        std::swap(texture.levels[0].bytes[k], texture.levels[0].bytes[k + 3]);
        texture.levels[0].bytes[k] = std::byte{0};
    }
    EXPECT_EQ(guess(texture), "rxgb");
}

// Maps with a constant channel: flat ones, and those that slope along one axis.
TEST(Swizzle, OfAstcIsToldFromGreyWithAlpha) {
    const auto layout = [](float along_x, float along_y) {
        MipChain chain = bumps({16, 16}, 0.5f);
        NormalMap& map = chain.levels[0];
        for (int k = 0; k < 16 * 16; ++k) {
            map.x.at(k % 16, k / 16) *= along_x;
            map.y.at(k % 16, k / 16) *= along_y;
        }
        return guess(unmarked(chain, Encoding::astc_4x4));
    };
    EXPECT_EQ(layout(1.0f, 1.0f), "ra");
    EXPECT_EQ(layout(1.0f, 0.0f), "ra");
    EXPECT_EQ(layout(0.0f, 1.0f), "ra");
    EXPECT_EQ(layout(0.0f, 0.0f), "ra");
    Texture texture = unmarked(bumps({8, 4}, 0.0f), Encoding::astc_4x4);
    const auto of_blocks = [&](const std::array<unsigned, 4>& left, const std::array<unsigned, 4>& right) {
        texture.levels[0].bytes.clear();
        for (const auto& rgba : {left, right}) {
            const auto block = reference::one_color(false, rgba);
            texture.levels[0].bytes.insert(texture.levels[0].bytes.end(), block.begin(), block.end());
        }
        return guess(texture);
    };
    EXPECT_EQ(of_blocks({0x8000, 0x8000, 0xffff, 0xffff}, {0x8000, 0x8000, 0xffff, 0xffff}), "rgb");
    EXPECT_EQ(of_blocks({0x8000, 0x8000, 0x8000, 0xffff}, {0x4000, 0x4000, 0x4000, 0xffff}), "rgb") << "heights";
    EXPECT_EQ(of_blocks({0xffff, 0x8000, 0xffff, 0x8000}, {0xffff, 0x8000, 0xffff, 0x4000}), "dxt5nm");
}

TEST(Swizzle, OfTheFileIsTrusted) {
    Texture texture = unmarked(bumps({16, 16}, 0.5f), Encoding::rgba8);
    texture.swizzle = {Component::z, Component::y, Component::x, Component::other};
    texture.swizzle_known = true;
    EXPECT_EQ(guess(texture), "bgr");
    Texture two = unmarked(bumps({16, 16}, 0.5f), Encoding::rg8);
    two.swizzle = {Component::y, Component::x, Component::zero, Component::one};
    EXPECT_EQ(guess(two), "gr");
}

TEST(Swizzle, OfRealFilesIsToldFromTheirTexels) {
    TEX_NEEDS_SHARED_DATA();
    const std::pair<const char*, const char*> expected[] = {
        {"torque_TP_Ryder_DXT5nm_256_mips9_nvtt.dds", "dxt5nm"},
        {"torque_Grenade2_DXT5nm_GGGR_512_mips10.dds", "dxt5nm"},
        {"torque_rock_DXT5nm_GGGR_256_mips9.dds", "dxt5nm"},
        {"urho_Stone_DXT5_xGxR_1024_mips11.dds", "dxt5nm"},
        {"reference/run_DXT5nm_dx9.dds", "dxt5nm"},
        {"d3d_RifleStock_DXT1_747x600_mips10_nvtt.dds", "rgb"},
        {"d3d_dwarf_armor_RGBA8_512_mips10.dds", "rgb"},
    };
    for (const auto& [file, name] : expected) {
        auto texture = read_texture(shared_data() / "dds" / file);
        ASSERT_TRUE(texture) << texture.error().message();
        texture->swizzle_known = false;  // ignore the file's own statement
        EXPECT_EQ(guess(*texture), name) << file;
    }
}

}  // namespace tex
