// SPDX-License-Identifier: Apache-2.0
// The quick fits, the rows of blocks made of them and of the searches, and the table of single greens.

#include "kernels/fit.h"

#include <array>
#include <cmath>
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

TEST(Fit, WritesTheBlocksAskedForAndNothingElse) {
    const std::vector<float> values = noisy_rows();
    const float* const rows[4] = {&values[0], &values[kWidth + 12], &values[2 * (kWidth + 12)], &values[3 * (kWidth + 12)]};
    std::vector<std::byte> all(16 * 77);
    tex::fit_bc4_blocks(rows, 77, tex::kBc4Unorm, false, Effort::fast, all.data());
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        for (const int count : {1, 7, 8, 9, 31, 32, 33, 64, 77}) {
            std::vector<std::byte> some(16 * 77, std::byte{0xAB});
            tex::fit_bc4_blocks(rows, count, tex::kBc4Unorm, false, Effort::fast, some.data());
            for (std::size_t k = 0; k < some.size(); ++k) {
                const bool written = k < static_cast<std::size_t>(16 * count) && k % 16 < 8;
                ASSERT_EQ(some[k], written ? all[k] : std::byte{0xAB}) << count << " blocks, byte " << k;
            }
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(SingleGreens, AreOnTheirPalettesAndNearest) {
    for (int third = 0; third <= 765; ++third) {
        const tex::SingleGreen& below = tex::single_green_below(third);
        const tex::SingleGreen& above = tex::single_green_above(third);
        EXPECT_LE(below.third, third);
        EXPECT_GE(above.third, third);
        for (const tex::SingleGreen& green : {below, above, tex::nearest_single_green(static_cast<float>(third) / 3.0f)}) {
            const int low = tex::widen_green(green.lower);
            const int high = tex::widen_green(green.lower + green.distance);
            EXPECT_TRUE(green.third == 3 * low || green.third == 3 * high || green.third == 2 * low + high ||
                        green.third == low + 2 * high);
        }
        const tex::SingleGreen near = tex::nearest_single_green(static_cast<float>(third) / 3.0f);
        EXPECT_LE(std::abs(near.third - third), 2);
        EXPECT_LE(near.distance, tex::kMaxSingleDistance);
    }
    const tex::SingleGreen flat = tex::nearest_single_green(127.5f);
    EXPECT_EQ(flat.lower, 31);
    EXPECT_EQ(flat.distance, 2);
}

}  // namespace
