// SPDX-License-Identifier: Apache-2.0
// The quick encoder of EAC blocks: what its blocks decode to, and the bases beside the one that it has chosen.

#include "kernels/eac_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace tex {
namespace {

constexpr int kFitBlocks = 384;
constexpr int kFitStride = 4 * kFitBlocks + 64;

// Four rows of blocks. `value` makes a texel of a block.
template <class Value>
std::vector<float> fit_rows_of(const Value& value) {
    std::vector<float> rows(4 * kFitStride);
    for (std::size_t block = 0; block < kFitBlocks; ++block) {
        for (std::size_t k = 0; k < 16; ++k) rows[k / 4 * kFitStride + 4 * block + k % 4] = value(block);
    }
    return rows;
}

std::array<float, 16> fit_texels_of(const std::vector<float>& rows, std::size_t block) {
    std::array<float, 16> texels{};
    for (std::size_t k = 0; k < 16; ++k) texels[k] = rows[k / 4 * kFitStride + 4 * block + k % 4];
    return texels;
}

std::vector<std::byte> eac_fitted(const std::vector<float>& values, EacCodes codes) {
    const float* rows[4];
    for (std::size_t k = 0; k < 4; ++k) rows[k] = values.data() + k * kFitStride;
    std::vector<std::byte> blocks(16 * kFitBlocks);
    fit_eac_blocks({rows, false}, {rows, false}, kFitBlocks, codes, blocks.data());
    return blocks;
}

// From -1 to 1.
std::array<float, 16> eac_decoded(const std::byte* block, EacCodes codes) {
    std::array<float, 16> values{};
    (codes.bias != 0 ? decode_eac_snorm : decode_eac_unorm)(block, values.data());
    if (codes.bias == 0) {
        for (float& value : values) value = 2.0f * value - 1.0f;
    }
    return values;
}

// At both ends of the range, too, where a base has but one neighbour.
TEST(EacFit, IsWithinAQuarterOfTheRangeOfEachBlock) {
    std::mt19937 random(3);
    const auto unit = [&] { return static_cast<float>(random() % 10001) / 10000.0f; };
    for (const EacCodes& codes : {kEacUnorm, kEacSnorm}) {
        for (const float range : {0.002f, 0.008f, 0.02f, 0.05f, 0.1f, 0.3f, 1.0f}) {
            for (const float low : {-1.0f, -1.0f + range, -0.5f * range, 1.0f - 2.0f * range, 1.0f - range}) {
                const auto values = fit_rows_of([&](std::size_t block) {
                    const float narrow = block % 2 == 0 ? range : 0.25f * range;  // some are at the end alone
                    return low < 0.0f ? low + narrow * unit() : low + range - narrow * unit();
                });
                const auto blocks = eac_fitted(values, codes);
                for (std::size_t block = 0; block < kFitBlocks; ++block) {
                    const auto wanted = fit_texels_of(values, block), got = eac_decoded(&blocks[16 * block], codes);
                    for (std::size_t k = 0; k < 16; ++k)
                        ASSERT_NEAR(got[k], wanted[k], 0.25f * range + 0.004f) << range << " from " << low;
                }
            }
        }
    }
}

// The sum of the distances to the nearest entries, in codes of 11 bits.
double eac_distances(const std::array<float, 16>& values, EacCodes codes, int base, int second) {
    const int multiplier = second >> 4;
    const auto& modifiers = kEacModifiers[second & 15];
    double sum = 0.0;
    for (const float value : values) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const int modifier : modifiers) {
            const int entry = 8 * base + codes.middle + (multiplier == 0 ? modifier : 8 * multiplier * modifier);
            nearest = std::min(nearest, std::abs((static_cast<double>(value) + 1.0) / 2.0 * codes.top - entry));
        }
        sum += nearest;
    }
    return sum;
}

// The bases beside the best one have been tried, so that another one is seldom better.
TEST(EacFit, BasesBesideTheOneChosenAreSeldomBetter) {
    std::mt19937 random(7);
    const auto values = fit_rows_of([&](std::size_t block) {
        const unsigned steps = 2 + block % 4;  // of 8 bits
        return static_cast<float>(40 + block % 45 * 4 + random() % steps) / 127.5f - 1.0f;
    });
    for (const EacCodes& codes : {kEacUnorm, kEacSnorm}) {
        const auto blocks = eac_fitted(values, codes);
        int above = 0, below = 0;
        for (std::size_t block = 0; block < kFitBlocks; ++block) {
            const auto texels = fit_texels_of(values, block);
            const int base = (std::to_integer<int>(blocks[16 * block]) + codes.bias) & 255;
            const int second = std::to_integer<int>(blocks[16 * block + 1]);
            const double sum = eac_distances(texels, codes, base, second) - 0.5;  // values are rounded
            above += eac_distances(texels, codes, base + 1, second) < sum ? 1 : 0;
            below += eac_distances(texels, codes, base - 1, second) < sum ? 1 : 0;
        }
        EXPECT_LE(above, kFitBlocks / 100);
        EXPECT_LE(below, kFitBlocks / 100);
    }
}

}  // namespace
}  // namespace tex
