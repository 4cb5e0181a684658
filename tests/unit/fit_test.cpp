// SPDX-License-Identifier: Apache-2.0
// The quick fits, the rows of blocks made of them and of the searches, and the table of single greens.

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
    // The first blocks are smooth: a few whole codes each, and one value.
    for (std::size_t k = 0; k < 40; ++k) values[k] = static_cast<float>((k / 4 + 255) % 511) / 255.0f - 1.0f;
    const Rows rows(values);
    for (const Effort effort : {Effort::fast, Effort::normal}) {
        for (const int encoding : {0, 1, 2}) {
            const auto fit = [&](int count, std::byte* blocks) {
                if (encoding == 0) return tex::fit_dxt5nm_blocks({rows.x, false}, {rows.y, true}, count, effort, blocks);
                return tex::fit_bc5_blocks({rows.x, false}, {rows.y, true}, count, encoding == 1 ? tex::kBc4Unorm : tex::kBc4Snorm, effort, blocks);
            };
            std::vector<std::byte> all(16 * 77);
            const bool extremes = fit(77, all.data());
            for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                for (const int count : {1, 7, 8, 9, 31, 32, 33, 64, 77}) {
                    std::vector<std::byte> some(16 * 77, std::byte{0xAB});
                    EXPECT_EQ(fit(count, some.data()) && count == 77, extremes && count == 77) << hwy::TargetName(target);
                    for (std::size_t k = 0; k < some.size(); ++k) {
                        const bool written = k < static_cast<std::size_t>(16 * count);
                        ASSERT_EQ(some[k], written ? all[k] : std::byte{0xAB})
                            << count << " blocks, byte " << k << ", " << hwy::TargetName(target) << ", encoding " << encoding;
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
        EXPECT_TRUE(on_palette(below.third, below.lower, below.distance) && on_palette(above.third, above.lower, above.distance));
    }
    EXPECT_EQ(tex::single_greens_above()[383] >> 8 & 0xFF, 31);  // flat, 127.5 codes
    EXPECT_EQ(tex::single_greens_above()[383] & 0xFF, 2);
}

}  // namespace
