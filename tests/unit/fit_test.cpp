// SPDX-License-Identifier: Apache-2.0
// The quick fits, the rows of blocks made with them and with the searches, and the table of single greens.

#include "kernels/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "kernels/encode.h"
#include "kernels/single_greens.h"
#include "rows/codecs.h"

namespace {

using tex::Effort;

constexpr int kWidth = 4 * 77;  // more than two vectors of blocks, and a part of one

// Four padded rows of noise around slopes of many ranges.
std::vector<float> noisy_rows() {
    std::vector<float> rows(4 * (kWidth + 12));
    std::mt19937 random(5);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const float range = 1.0f / static_cast<float>(1 << (k % 320 / 40));
        rows[k] = range * (static_cast<float>(random() % 2001) / 1000.0f - 1.0f);
    }
    return rows;
}

std::vector<std::byte> encode(const std::vector<float>& values, Effort effort) {
    tex::BlockRow row;
    for (int k = 0; k < 4; ++k) row.x[k] = row.y[k] = values.data() + k * (kWidth + 12);
    row.width = kWidth;
    std::vector<std::byte> blocks(16 * kWidth / 4);
    tex::encode_dxt5nm(row, effort, blocks.data());
    return blocks;
}

double error_of(const std::vector<float>& values, const std::vector<std::byte>& blocks, bool green) {
    double sum = 0;
    for (int block = 0; block < kWidth / 4; ++block) {
        float x[16], r[16], g[16], b[16], a[16];
        tex::decode_bc4_unorm(blocks.data() + 16 * block, x);
        tex::decode_bc1(blocks.data() + 16 * block + 8, tex::Bc1Mode::four_colors, r, g, b, a);
        for (int k = 0; k < 16; ++k) {
            const double decoded = 2.0 * (green ? g[k] : x[k]) - 1.0;
            sum += std::pow(decoded - values[static_cast<std::size_t>(k / 4 * (kWidth + 12) + 4 * block + k % 4)], 2);
        }
    }
    return sum;
}

TEST(Encode, NoEffortIsWorseThanACheaperOne) {
    const std::vector<float> values = noisy_rows();
    for (const bool green : {false, true}) {
        const double fast = error_of(values, encode(values, Effort::fast), green);
        const double normal = error_of(values, encode(values, Effort::normal), green);
        const double best = error_of(values, encode(values, Effort::best), green);
        EXPECT_LT(normal, fast);
        EXPECT_LT(best, normal);
        EXPECT_LT(normal, 1.15 * best);
        EXPECT_LT(fast, 1.5 * best);
    }
}

// A row of decoded blocks. Their endpoints are random and at least 8 codes apart; each block uses only some values of
// its palette, but at least three.
std::vector<float> decoded_rows(tex::Encoding encoding, bool second, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> rows(4 * (kWidth + 12));
    for (int block = 0; block < kWidth / 4; ++block) {
        std::byte bytes[8];
        for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
        const bool green = encoding == tex::Encoding::dxt5nm && second;
        const auto code = [&](int k) {
            return encoding == tex::Encoding::bc5_snorm ? static_cast<std::int8_t>(bytes[k])
                                                        : std::to_integer<int>(bytes[k]);
        };
        if (!green && std::abs(code(0) - code(1)) < 8) bytes[0] ^= std::byte{0x40};
        float palette[16], r[16], b[16], a[16];
        const auto set_indices = [&](int first, int count) {  // texel k takes index first + k % count
            std::uint64_t indices = 0;
            for (int k = 0; k < 16; ++k)
                indices |= static_cast<std::uint64_t>(first + k % count) << ((green ? 2 : 3) * k);
            const int header = green ? 4 : 2;
            for (int k = header; k < 8; ++k) bytes[k] = static_cast<std::byte>(indices >> (8 * (k - header)));
        };
        const int most = green ? 4 : 8;
        const int count = green ? 3 : 3 + static_cast<int>(random() % 4);
        set_indices(static_cast<int>(random()) & (most - count), count);
        if (green)
            tex::decode_bc1(bytes, tex::Bc1Mode::four_colors, r, palette, b, a);
        else if (encoding == tex::Encoding::bc5_snorm)
            tex::decode_bc4_snorm(bytes, palette);
        else
            tex::decode_bc4_unorm(bytes, palette);
        for (int k = 0; k < 16; ++k) {
            const float n = encoding == tex::Encoding::bc5_snorm ? palette[k] : 2.0f * palette[k] - 1.0f;
            rows[static_cast<std::size_t>(k / 4 * (kWidth + 12) + 4 * block + k % 4)] = n;
        }
    }
    return rows;
}

TEST(Encode, FindsThePalettesOfBlocksThatWereDecodedBefore) {
    for (const tex::Encoding encoding : {tex::Encoding::dxt5nm, tex::Encoding::bc5, tex::Encoding::bc5_snorm}) {
        for (unsigned seed = 0; seed < 8; ++seed) {
            const std::vector<float> values[2] = {decoded_rows(encoding, false, seed),
                                                  decoded_rows(encoding, true, 100 + seed)};
            tex::BlockRow row;
            for (int k = 0; k < 4; ++k) {
                row.x[k] = values[0].data() + k * (kWidth + 12);
                row.y[k] = values[1].data() + k * (kWidth + 12);
            }
            row.width = kWidth;
            std::vector<std::byte> blocks(16 * kWidth / 4);
            tex::encode_blocks(row, {encoding}, blocks.data());
            for (int block = 0; block < kWidth / 4; ++block) {
                float decoded[2][16], r[16], b[16], a[16];
                for (int channel = 0; channel < 2; ++channel) {
                    const std::byte* bytes = blocks.data() + 16 * block + 8 * channel;
                    const bool green = encoding == tex::Encoding::dxt5nm && channel == 1;
                    if (green)
                        tex::decode_bc1(bytes, tex::Bc1Mode::four_colors, r, decoded[1], b, a);
                    else if (encoding == tex::Encoding::bc5_snorm)
                        tex::decode_bc4_snorm(bytes, decoded[channel]);
                    else
                        tex::decode_bc4_unorm(bytes, decoded[channel]);
                    for (int k = 0; k < 16; ++k) {
                        const float n = encoding == tex::Encoding::bc5_snorm ? decoded[channel][k]
                                                                             : 2.0f * decoded[channel][k] - 1.0f;
                        const float before =
                            values[channel][static_cast<std::size_t>(k / 4 * (kWidth + 12) + 4 * block + k % 4)];
                        ASSERT_NEAR(n * 127.5f, before * 127.5f, 0.1f)
                            << tex::name_of(tex::kEncodingNames, encoding) << " seed " << seed << " channel " << channel
                            << " block " << block;
                    }
                }
            }
        }
    }
}

// The rows of both channels, from one array.
struct Rows {
    const float* x[4];
    const float* y[4];
    explicit Rows(const std::vector<float>& values) {
        for (int k = 0; k < 4; ++k) x[k] = y[3 - k] = &values[static_cast<std::size_t>(k * (kWidth + 12))];
    }
};

TEST(Fit, WritesTheBlocksAskedForAndNothingElseOnEveryTarget) {
    std::vector<float> values = noisy_rows();
    // The first blocks are smooth: each has a few integer codes, or a single value.
    for (std::size_t k = 0; k < 40; ++k) values[k] = static_cast<float>((k / 4 + 255) % 511) / 255.0f - 1.0f;
    const Rows rows(values);
    for (const Effort effort : {Effort::fast, Effort::normal}) {
        for (const int encoding : {0, 1, 2}) {
            const auto fit = [&](int count, std::byte* blocks) {
                if (encoding == 0)
                    return tex::fit_dxt5nm_blocks({rows.x, false}, {rows.y, true}, count, effort, blocks);
                return tex::fit_bc5_blocks({rows.x, false}, {rows.y, true}, count,
                                           encoding == 1 ? tex::kBc4Unorm : tex::kBc4Snorm, effort, blocks);
            };
            std::vector<std::byte> all(16 * 77);
            const bool extremes = fit(77, all.data());
            for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                for (const int count : {1, 7, 8, 9, 31, 32, 33, 64, 77}) {
                    std::vector<std::byte> some(16 * 77, std::byte{0xAB});
                    EXPECT_EQ(fit(count, some.data()) && count == 77, extremes && count == 77)
                        << hwy::TargetName(target);
                    for (std::size_t k = 0; k < some.size(); ++k) {
                        const bool written = k < static_cast<std::size_t>(16 * count);
                        ASSERT_EQ(some[k], written ? all[k] : std::byte{0xAB})
                            << count << " blocks, byte " << k << ", " << hwy::TargetName(target) << ", encoding "
                            << encoding;
                    }
                }
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST(SingleGreens, AreOnTheirPalettesAndNearest) {
    const auto on_palette = [](int third, int lower, int distance) {
        const int low = tex::widen_green(lower);
        const int high = tex::widen_green(lower + distance);
        return third == 3 * low || third == 3 * high || third == 2 * low + high || third == low + 2 * high;
    };
    for (int third = 0; third <= tex::kMostThirds; ++third) {
        const tex::SingleGreen& below = tex::single_green_below(third);
        const tex::SingleGreen& above = tex::single_green_above(third);
        EXPECT_LE(below.third, third);
        EXPECT_GE(above.third, third);
        int least = tex::kMostThirds;
        for (const std::int32_t packed : {tex::single_greens_below()[third], tex::single_greens_above()[third]}) {
            EXPECT_TRUE(on_palette(packed >> 16, packed >> 8 & 0xFF, packed & 0xFF));
            EXPECT_LE(packed & 0xFF, tex::kMaxSingleDistance);
            least = std::min(least, std::abs((packed >> 16) - third));
        }
        EXPECT_LE(least, 2);
        EXPECT_LE(tex::single_greens_below()[third] >> 16, third);
        EXPECT_GE(tex::single_greens_above()[third] >> 16, third);
        EXPECT_TRUE(on_palette(below.third, below.lower, below.distance) &&
                    on_palette(above.third, above.lower, above.distance));
    }
    EXPECT_EQ(tex::single_greens_above()[383] >> 8 & 0xFF, 31);  // flat, 127.5 codes
    EXPECT_EQ(tex::single_greens_above()[383] & 0xFF, 2);
}

}  // namespace
