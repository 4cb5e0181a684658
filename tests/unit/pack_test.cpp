// SPDX-License-Identifier: Apache-2.0

#include <tex/pack.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "unit/normal_maps.h"
#include "unit/packing.h"

namespace {

using packing::bumpy;
using packing::chain_of;
using packing::decode_codes;
using packing::pack_bytes;
using tex::Effort;
using tex::Encoding;
using tex::Extent;
using tex::MipChain;
using tex::NormalMap;

constexpr Encoding kAllEncodings[] = {Encoding::dxt5nm, Encoding::bc5,   Encoding::bc5_snorm, Encoding::rgb8,
                                      Encoding::rgba8,  Encoding::rgb16, Encoding::ag8,       Encoding::rg8,
                                      Encoding::rg16,   Encoding::half,  Encoding::float_};
constexpr Effort kAllEfforts[] = {Effort::fast, Effort::normal, Effort::best};

template <class T>
std::vector<T> as(const std::vector<std::byte>& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

int unorm(float n, int top) {
    const float code = std::floor((n + 1.0f) * 0.5f * static_cast<float>(top) + 0.5f);
    return static_cast<int>(std::min(std::max(code, 0.0f), static_cast<float>(top)));
}

TEST(Pack, UnormCodesFollowTheFormulaInEveryLayout) {
    for (const Extent extent :
         {Extent{1, 1}, Extent{2, 3}, Extent{15, 2}, Extent{16, 1}, Extent{17, 2}, Extent{257, 3}}) {
        const MipChain chain = chain_of(bumpy(extent, 3));
        const NormalMap& map = chain.levels[0];
        const auto rgb8 = as<std::uint8_t>(pack_bytes(chain, {Encoding::rgb8}));
        const auto rgba8 = as<std::uint8_t>(pack_bytes(chain, {Encoding::rgba8}));
        const auto ag8 = as<std::uint8_t>(pack_bytes(chain, {Encoding::ag8}));
        const auto rg8 = as<std::uint8_t>(pack_bytes(chain, {Encoding::rg8}));
        const auto rgb16 = as<std::uint16_t>(pack_bytes(chain, {Encoding::rgb16}));
        const auto rg16 = as<std::uint16_t>(pack_bytes(chain, {Encoding::rg16}));
        ASSERT_EQ(rgb8.size(), static_cast<std::size_t>(3 * extent.texels()));
        ASSERT_EQ(rg16.size(), static_cast<std::size_t>(2 * extent.texels()));
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const auto t = static_cast<std::size_t>(j * extent.width + i);
                const float n[3] = {map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)};
                for (std::size_t c = 0; c < 3; ++c) {
                    EXPECT_EQ(rgb8[3 * t + c], unorm(n[c], 255));
                    EXPECT_EQ(rgba8[4 * t + c], unorm(n[c], 255));
                    EXPECT_EQ(rgb16[3 * t + c], unorm(n[c], 65535));
                }
                EXPECT_EQ(rgba8[4 * t + 3], 255);
                EXPECT_EQ(ag8[4 * t + 0], 255);
                EXPECT_EQ(ag8[4 * t + 1], unorm(n[1], 255));
                EXPECT_EQ(ag8[4 * t + 2], 255);
                EXPECT_EQ(ag8[4 * t + 3], unorm(n[0], 255));
                EXPECT_EQ(rg8[2 * t], unorm(n[0], 255));
                EXPECT_EQ(rg8[2 * t + 1], unorm(n[1], 255));
                EXPECT_EQ(rg16[2 * t], unorm(n[0], 65535));
                EXPECT_EQ(rg16[2 * t + 1], unorm(n[1], 65535));
            }
        }
    }
}

TEST(Pack, FlatIs128And128And255) {
    const auto rgb8 = as<std::uint8_t>(pack_bytes(chain_of(tex::uniform_map({3, 3}, 0, 0, 1)), {Encoding::rgb8}));
    EXPECT_EQ(rgb8, (std::vector<std::uint8_t>{128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128,
                                               255, 128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255}));
}

TEST(Pack, CodesAreClamped) {
    const auto rgb16 =
        as<std::uint16_t>(pack_bytes(chain_of(tex::uniform_map({1, 1}, -1.5f, 1.5f, 1)), {Encoding::rgb16}));
    EXPECT_EQ(rgb16, (std::vector<std::uint16_t>{0, 65535, 65535}));
}

TEST(Pack, FloatsAreTheComponentsAndHalvesRoundToNearestEven) {
    const MipChain chain = chain_of(tex::uniform_map({2, 1}, 0.1f, -1.0f / 3.0f, 1.0f + 1.0f / 2048.0f));
    EXPECT_EQ(as<float>(pack_bytes(chain, {Encoding::float_}))[4], -1.0f / 3.0f);
    const auto half = as<std::uint16_t>(pack_bytes(chain, {Encoding::half}));
    ASSERT_EQ(half.size(), 6u);
    EXPECT_EQ(half[0], 0x2E66);  // 0.1 is 0x2E66 + 0.4 in units of the last place
    EXPECT_EQ(half[1], 0xB555);
    EXPECT_EQ(half[2], 0x3C00);  // 1 + half a unit in the last place: rounds to even
}

TEST(Pack, YDownStoresMinusYAndNothingElse) {
    const MipChain up = chain_of(bumpy({37, 11}, 5));
    MipChain down = chain_of(bumpy({37, 11}, 5));
    for (int j = 0; j < 11; ++j) {
        for (int i = 0; i < 37; ++i) down.levels[0].y.at(i, j) *= -1.0f;
    }
    for (const Encoding encoding : kAllEncodings) {
        EXPECT_EQ(pack_bytes(down, {encoding, tex::YAxis::down}), pack_bytes(up, {encoding, tex::YAxis::up}));
    }
    const auto flat = as<std::uint32_t>(
        pack_bytes(chain_of(tex::uniform_map({1, 1}, 0, 0, 1)), {Encoding::float_, tex::YAxis::down}));
    EXPECT_EQ(flat[1], 0u);  // not -0
}

TEST(Pack, TextureSaysWhatItHolds) {
    MipChain chain;
    for (int level = 0; level < 4; ++level) chain.levels.push_back(bumpy(tex::level_extent({13, 6}, level), 1));
    for (const Encoding encoding : kAllEncodings) {
        const auto texture = tex::pack(chain, {encoding, tex::YAxis::down});
        ASSERT_TRUE(texture);
        EXPECT_EQ(texture->format, tex::encoding_info(encoding).format);
        EXPECT_EQ(texture->swizzle, tex::encoding_info(encoding).swizzle);
        EXPECT_TRUE(texture->swizzle_known && texture->y_known);
        EXPECT_EQ(texture->y_axis, tex::YAxis::down);
        ASSERT_EQ(texture->levels.size(), 4u);
        for (int level = 0; level < 4; ++level) {
            const tex::Level& packed = texture->levels[static_cast<std::size_t>(level)];
            EXPECT_EQ(packed.extent, tex::level_extent({13, 6}, level));
            EXPECT_EQ(packed.bytes.size(), tex::level_bytes(texture->format, packed.extent));
        }
    }
}

TEST(Pack, TheSameBytesOnEveryTargetAndWithEveryNumberOfThreads) {
    MipChain chain;
    for (int level = 0; level < 8; ++level) chain.levels.push_back(bumpy(tex::level_extent({197, 75}, level), 9));
    for (const Encoding encoding : kAllEncodings) {
        for (const Effort effort : kAllEfforts) {
            if (effort == Effort::best && encoding != Encoding::dxt5nm) continue;
            const auto expected = pack_bytes(chain, {encoding, tex::YAxis::up, effort});
            for (const int threads : {2, 3, 7}) {
                EXPECT_EQ(pack_bytes(chain, {encoding, tex::YAxis::up, effort}, threads), expected);
            }
            for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                EXPECT_EQ(pack_bytes(chain, {encoding, tex::YAxis::up, effort}), expected) << hwy::TargetName(target);
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST(Pack, CancelStopsAndSaysSo) {
    tex::Execution execution;
    execution.progress = [](double) { return false; };
    const auto texture = tex::pack(chain_of(bumpy({256, 256}, 1)), {Encoding::rgb8}, execution);
    ASSERT_FALSE(texture);
    EXPECT_EQ(texture.error().code, tex::ErrorCode::cancelled);
}

// R and B of DXT5nm decode to exactly 255 in every texel. c0 > c1 if they differ; if they are equal, only index 0 is
// used.
TEST(Pack, Dxt5nmColourBlocksAreSafeForEveryDecoder) {
    for (const Effort effort : kAllEfforts) {
        const auto bytes = pack_bytes(chain_of(bumpy({131, 66}, 11)), {Encoding::dxt5nm, tex::YAxis::up, effort});
        for (std::size_t at = 0; at < bytes.size(); at += 16) {
            const auto word = [&](std::size_t k) {
                return std::to_integer<unsigned>(bytes[at + k]) | std::to_integer<unsigned>(bytes[at + k + 1]) << 8;
            };
            const unsigned c0 = word(8);
            const unsigned c1 = word(10);
            EXPECT_EQ(c0 & 0xF81F, 0xF81Fu);
            EXPECT_EQ(c1 & 0xF81F, 0xF81Fu);
            EXPECT_GE(c0, c1);
            EXPECT_TRUE(c0 > c1 || (word(12) | word(14)) == 0);
        }
    }
}

// The rules by which decoders interpolate with integers: w of `whole` parts of b.
int amd(int a, int b, int w, int whole) {
    const int part = whole == 3 ? (w == 1 ? 21 : 43) : (w * 64 * 2 + whole) / (2 * whole);
    return ((64 - part) * a + part * b + 32) >> 6;
}
int intel(int a, int b, int w, int whole) {
    const int part = (w * 256 * 2 + whole) / (2 * whole);
    return ((256 - part) * a + part * b + 128) >> 8;
}
int truncating(int a, int b, int w, int whole) { return ((whole - w) * a + w * b) / whole; }

TEST(Pack, FlatDecodesTo127Or128UnderEveryVendorsRule) {
    for (const Effort effort : kAllEfforts) {
        for (const float x : {0.0f, 1.0f / 255.0f, -1.0f / 255.0f}) {
            const auto bytes =
                pack_bytes(chain_of(tex::uniform_map({4, 4}, x, x, 1)), {Encoding::dxt5nm, tex::YAxis::up, effort});
            const auto byte = [&](std::size_t k) { return std::to_integer<int>(bytes[k]); };
            float decoded_x[16], decoded_y[16];
            decode_codes(bytes.data(), Encoding::dxt5nm, decoded_x, decoded_y);
            for (int k = 0; k < 16; ++k) {
                EXPECT_NEAR(decoded_x[k], 127.5f, 0.5001f);
                EXPECT_NEAR(decoded_y[k], 127.5f, 0.5001f);
            }
            for (const auto rule : {amd, intel, truncating}) {
                const int a0 = byte(0), a1 = byte(1);
                const int alpha_index = byte(2) & 7;
                const int steps = a0 > a1 ? 7 : 5;
                const int alpha = alpha_index == 0 ? a0 : alpha_index == 1 ? a1 : rule(a0, a1, alpha_index - 1, steps);
                ASSERT_LE(alpha_index, steps);
                EXPECT_TRUE(alpha == 127 || alpha == 128) << alpha;
                const int g0 = tex::widen_green((byte(8) | byte(9) << 8) >> 5 & 63);
                const int g1 = tex::widen_green((byte(10) | byte(11) << 8) >> 5 & 63);
                const int green_index = byte(12) & 3;
                const int green = green_index == 0 ? g0 : green_index == 1 ? g1 : rule(g0, g1, green_index - 1, 3);
                EXPECT_TRUE(green == 127 || green == 128) << green;
            }
        }
    }
}

TEST(Pack, ConstantBlocksAreWithinHalfACodeAtEveryLevel) {
    for (const Encoding encoding : {Encoding::dxt5nm, Encoding::bc5, Encoding::bc5_snorm}) {
        for (int code = 0; code < 256; ++code) {
            const float n = static_cast<float>(code) / 127.5f - 1.0f;
            for (const Effort effort : kAllEfforts) {
                const auto bytes =
                    pack_bytes(chain_of(tex::uniform_map({4, 4}, n, n, 0)), {encoding, tex::YAxis::up, effort});
                float x[16], y[16];
                decode_codes(bytes.data(), encoding, x, y);
                EXPECT_NEAR(x[0], static_cast<float>(code), 0.51f);
                EXPECT_NEAR(y[0], static_cast<float>(code), encoding == Encoding::dxt5nm ? 1.01f : 0.51f);
            }
        }
    }
}

TEST(Pack, TexelsOutsideTheLevelCarryNoWeight) {
    // Two columns of a 4x4 block are inside. The block must be as good as one with these texels alone, whatever the
    // padding of the rows contains.
    NormalMap map(Extent{6, 3});
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 16; ++i) {
            map.x.row(j)[i] = i < 6 ? 0.1f * static_cast<float>(j) : 1e30f;
            map.y.row(j)[i] = i < 6 ? -0.2f + 0.01f * static_cast<float>(i) : -1e30f;
        }
    }
    const auto bytes = pack_bytes(chain_of(std::move(map)), {Encoding::bc5});
    float x[16], y[16];
    decode_codes(bytes.data() + 16, Encoding::bc5, x, y);
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 2; ++i) {
            EXPECT_NEAR(x[4 * j + i] / 127.5f - 1.0f, 0.1f * static_cast<float>(j), 0.003f);
            EXPECT_NEAR(y[4 * j + i] / 127.5f - 1.0f, -0.2f + 0.01f * static_cast<float>(4 + i), 0.003f);
        }
    }
}

TEST(Pack, EncodeBlocksGivesTheSameBytesWithAnyStrideAndPitch) {
    const MipChain chain = chain_of(bumpy({37, 14}, 3));
    const tex::NormalMap& map = chain.levels[0];
    std::vector<float> x(41 * 14), y(45 * 14);
    for (int j = 0; j < 14; ++j) {
        std::copy_n(map.x.row(j), 37, &x[static_cast<std::size_t>(41 * j)]);
        std::copy_n(map.y.row(j), 37, &y[static_cast<std::size_t>(45 * j)]);
    }
    for (const Encoding encoding : {Encoding::dxt5nm, Encoding::bc5, Encoding::bc5_snorm}) {
        for (const tex::PackOptions& options :
             {tex::PackOptions{encoding, tex::YAxis::down, Effort::fast}, tex::PackOptions{encoding},
              tex::PackOptions{encoding, tex::YAxis::up, Effort::best, tex::Metric::angle}}) {
            const std::vector<std::byte> packed = pack_bytes(chain, options);
            constexpr std::size_t kRow = 10 * 16;
            constexpr std::size_t kPitch = kRow + 8;
            std::vector<std::byte> blocks(4 * kPitch);
            ASSERT_TRUE(
                tex::encode_blocks({x.data(), {37, 14}, 41}, {y.data(), {37, 14}, 45}, options, blocks.data(), kPitch));
            for (std::size_t k = 0; k < packed.size(); ++k)
                ASSERT_EQ(packed[k], blocks[k / kRow * kPitch + k % kRow]) << k;
        }
    }
}

TEST(EncodeBlocks, RefusesWhatDoesNotFit) {
    const tex::Plane<float> plane({8, 8}), other({4, 8});
    std::vector<std::byte> blocks(64);
    const auto code = [&](const tex::Plane<float>& y, Encoding encoding, std::size_t pitch) {
        return tex::encode_blocks(plane.view(), y.view(), {encoding}, blocks.data(), pitch).error().code;
    };
    EXPECT_EQ(code(other, Encoding::bc5, 32), tex::ErrorCode::bad_option);
    EXPECT_EQ(code(plane, Encoding::rgb8, 32), tex::ErrorCode::bad_option);
    EXPECT_EQ(code(plane, Encoding::bc5, 31), tex::ErrorCode::bad_option);
}

// Rows with other texels beside them, which must stay; the blocks at the right and at the bottom are cut.
TEST(DecodeBlocks, GiveTheTexelsOfDecode) {
    const tex::MipChain chain = chain_of(bumpy({38, 14}, 3));
    for (const Encoding encoding :
         {Encoding::bc5, Encoding::dxt5nm, Encoding::astc_5x4, Encoding::rgb8, Encoding::half}) {
        const auto texture = tex::pack(chain, {encoding}).value();
        const auto wanted = tex::decode(texture, 0).value();
        const int channels = tex::format_info(texture.format).channels;
        constexpr std::ptrdiff_t kStride = 41;
        std::vector<float> rows(static_cast<std::size_t>(4 * 14 * kStride), -7.0f);
        std::array<tex::PlaneView<float>, 4> views;
        for (int c = 0; c < channels; ++c)
            views[static_cast<std::size_t>(c)] = {rows.data() + c * 14 * kStride, {38, 14}, kStride};
        const std::size_t pitch = tex::level_bytes(texture.format, {38, 1});
        ASSERT_TRUE(tex::decode_blocks(texture.format, texture.levels[0].bytes.data(), pitch, views));
        for (int c = 0; c < channels; ++c) {
            for (int j = 0; j < 14; ++j) {
                for (int i = 0; i < 38; ++i)
                    ASSERT_EQ(views[static_cast<std::size_t>(c)].at(i, j),
                              wanted.planes[static_cast<std::size_t>(c)].at(i, j));
                for (int i = 38; i < kStride; ++i)
                    ASSERT_EQ(rows[static_cast<std::size_t>((c * 14 + j) * kStride + i)], -7.0f);
            }
        }
        EXPECT_FALSE(tex::decode_blocks(texture.format, texture.levels[0].bytes.data(), pitch - 1, views));
        views[1].stride = 40;
        EXPECT_FALSE(tex::decode_blocks(texture.format, texture.levels[0].bytes.data(), pitch, views));
    }
}

}  // namespace
