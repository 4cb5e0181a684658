// SPDX-License-Identifier: Apache-2.0
// The scores of what blocks may copy, against fits in double, and the shapes of halves against the decoders.

#include "kernels/copy_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blocks/half_block.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr HalfKind kKinds[] = {HalfKind::bc4_unorm, HalfKind::bc4_snorm, HalfKind::green, HalfKind::eac_unorm,
                               HalfKind::eac_snorm};

float from_minus_one_to_one(std::mt19937& random) { return static_cast<float>(random() % 2001) / 1000.0f - 1.0f; }

void make_half(std::mt19937& random, std::byte half[kHalfBytes]) {
    for (int k = 0; k < kHalfBytes; ++k) half[k] = static_cast<std::byte>(random());
}

TEST(HalfBlock, ShapesAreWhatDecodersMake) {
    std::mt19937 random(1);
    for (const HalfKind kind : kKinds) {
        int lines = 0;
        for (int trial = 0; trial < 500; ++trial) {
            std::byte half[kHalfBytes];
            make_half(random, half);
            const HalfShape shape = half_shape(kind, half);
            if (!shape.is_line) continue;
            ++lines;
            float values[16];
            decode_half(kind, half, values);
            for (int k = 0; k < 16; ++k) {
                const float line = shape.line.offset + shape.line.slope * shape.weights[k];
                EXPECT_NEAR(std::clamp(line, -1.0f, 1.0f), values[k], 1e-4f);
            }
        }
        EXPECT_GT(lines, 200);
    }
}

TEST(HalfBlock, VariantsKeepWhatIsCopiedAndComeCloseToTheLine) {
    std::mt19937 random(2);
    for (const HalfKind kind : kKinds) {
        for (int trial = 0; trial < 200; ++trial) {
            std::byte half[kHalfBytes];
            make_half(random, half);
            const HalfShape shape = half_shape(kind, half);
            if (!shape.is_line) continue;
            for (const Copied copied : {Copied::indices, Copied::all_but_first}) {
                HalfVariant variants[kMostVariants];
                const int count = half_variants(kind, half, copied, shape.line, variants);
                ASSERT_LE(count, kMostVariants);
                const int literals = literals_before(kind, copied);
                float nearest = 10.0f;
                for (int v = 0; v < count; ++v) {
                    EXPECT_TRUE(std::equal(half + literals, half + kHalfBytes, variants[v].half + literals));
                    const HalfShape found = half_shape(kind, variants[v].half);
                    EXPECT_TRUE(found.is_line);
                    nearest = std::min(nearest,
                                       std::fabs(found.line.offset - shape.line.offset) + std::fabs(found.line.slope - shape.line.slope));
                }
                if (shape.line.slope > 0.0f) {
                    EXPECT_LT(nearest, 1e-4f);
                }
            }
        }
    }
}

// Tables of random halves that kernels may read past their end.
struct Table {
    std::vector<float> values[21];
    LineTable table{};
    Table(HalfKind kind, int count, std::mt19937& random) {
        for (std::vector<float>& column : values) column.resize(static_cast<std::size_t>(count) + 16);
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            std::byte half[kHalfBytes];
            HalfShape shape{};
            while (!shape.is_line || shape.line.slope < 0.0f) {
                make_half(random, half);
                shape = half_shape(kind, half);
            }
            for (std::size_t k = 0; k < 16; ++k) {
                values[k][i] = shape.weights[k];
                values[16][i] += shape.weights[k];
                values[17][i] += shape.weights[k] * shape.weights[k];
            }
            values[18][i] = 1.0f / (16.0f * values[17][i] - values[16][i] * values[16][i]);
            values[19][i] = shape.line.offset;
            values[20][i] = shape.line.slope;
        }
        for (std::size_t k = 0; k < 16; ++k) table.weights[k] = values[k].data();
        table.sum = values[16].data();
        table.squares = values[17].data();
        table.inverse = values[18].data();
        table.offset = values[19].data();
        table.slope = values[20].data();
    }
    // The sum of squares for a line, in double.
    [[nodiscard]] double error(std::size_t i, const float* v, double offset, double slope) const {
        double sum = 0.0;
        for (std::size_t k = 0; k < 16; ++k) {
            const double d = double{v[k]} - offset - slope * double{values[k][i]};
            sum += d * d;
        }
        return sum;
    }
};

TEST(CopySearch, ErrorsAreThoseOfLeastSquaresOnEveryTarget) {
    for (const HalfKind kind : {HalfKind::bc4_unorm, HalfKind::green, HalfKind::eac_snorm}) {
        for (const int count : {1, 2, 15, 16, 17, 33, 257}) {
            std::mt19937 random(static_cast<unsigned>(count));
            const Table table(kind, count, random);
            float v[16];
            for (float& value : v) value = from_minus_one_to_one(random);
            std::vector<float> wanted[3];
            on_every_target([&] {
                std::vector<float> errors[3];
                for (std::vector<float>& of : errors) of.resize(static_cast<std::size_t>(count) + 16);
                float* const out[3] = {errors[0].data(), errors[1].data(), errors[2].data()};
                copy_errors(table.table, count, v, keeps_slope(kind), out);
                for (int q = 0; q < 3; ++q) {
                    errors[q].resize(static_cast<std::size_t>(count));
                    if (wanted[q].empty()) wanted[q] = errors[q];
                    EXPECT_EQ(errors[q], wanted[q]);
                }
            });
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
                double w = 0.0, ww = 0.0, sv = 0.0, wv = 0.0;
                for (std::size_t k = 0; k < 16; ++k) {
                    const double weight = table.values[k][i];
                    w += weight, ww += weight * weight, sv += double{v[k]}, wv += weight * double{v[k]};
                }
                const double free_slope = std::max(0.0, (16.0 * wv - w * sv) / (16.0 * ww - w * w));
                const double offset = table.values[19][i];
                const double slope = table.values[20][i];
                const double tolerance = 2e-4 * (1.0 + slope * slope * ww);
                EXPECT_NEAR(wanted[0][i], table.error(i, v, (sv - free_slope * w) / 16.0, free_slope), tolerance);
                EXPECT_NEAR(wanted[2][i], table.error(i, v, offset, slope), tolerance);
                const double own_slope = keeps_slope(kind) ? slope : std::max(0.0, (wv - offset * w) / ww);
                const double own_offset = keeps_slope(kind) ? (sv - slope * w) / 16.0 : offset;
                EXPECT_NEAR(wanted[1][i], table.error(i, v, own_offset, own_slope), tolerance);
            }
        }
    }
}

TEST(CopySearch, FindsTheCheapestOnEveryTarget) {
    for (const int count : {1, 2, 15, 16, 17, 33, 257}) {
        std::mt19937 random(static_cast<unsigned>(count));
        std::vector<float> errors(static_cast<std::size_t>(count) + 16), prices(errors.size());
        for (float& value : errors) value = static_cast<float>(random() % 100);
        for (float& value : prices) value = static_cast<float>(random() % 100) / 10.0f;
        std::vector<float> sorted;
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
            sorted.push_back(2.0f * std::sqrt(errors[k] + 3.0f) + prices[k] + 1.0f);
        const std::vector<float> costs = sorted;
        std::sort(sorted.begin(), sorted.end());
        std::vector<int> wanted;
        on_every_target([&] {
            CheapCopies cheapest;
            add_cheapest({errors.data(), nullptr, 3.0f, 2.0f, prices.data(), 1.0f, 1}, count, cheapest);
            std::vector<int> found;
            for (const CheapCopy& copy : cheapest) {
                EXPECT_EQ(copy.cost, sorted[found.size()]);
                EXPECT_EQ(copy.cost, costs[static_cast<std::size_t>(copy.at)]);
                EXPECT_EQ(copy.copied, 1);
                found.push_back(copy.at);
            }
            EXPECT_EQ(static_cast<int>(found.size()), std::min(count, CheapCopies::kMost));
            if (wanted.empty()) wanted = found;
            EXPECT_EQ(found, wanted);
        });
    }
}

}  // namespace
}  // namespace tex
