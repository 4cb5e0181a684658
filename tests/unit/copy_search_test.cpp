// SPDX-License-Identifier: Apache-2.0
// The scores of what blocks may copy, against fits in double, and the shapes of halves against the decoders.

#include "kernels/copy_search.h"

#include <algorithm>
#include <array>
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
                    nearest = std::min(nearest, std::fabs(found.line.offset - shape.line.offset) +
                                                    std::fabs(found.line.slope - shape.line.slope));
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
                std::vector<float> products(static_cast<std::size_t>(count) + 16), least(products.size()), errors[3];
                const CopyScores scores =
                    score_copies(table.table, count, v, keeps_slope(kind), products.data(), least.data());
                for (int i = 0; i < count; ++i) {
                    const std::array<float, 3> found = copy_errors(scores, i);
                    for (std::size_t q = 0; q < 3; ++q) errors[q].push_back(found[q]);
                }
                for (int q = 0; q < 3; ++q) {
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
    for (const int count : {0, 1, 2, 15, 16, 17, 33, 257, 1000}) {
        std::mt19937 random(static_cast<unsigned>(count));
        const Table table(HalfKind::bc4_unorm, count, random);
        std::vector<float> prices(static_cast<std::size_t>(count) + 16), products[2], least[2];
        for (float& value : prices) value = static_cast<float>(random() % 100) / 10.0f;
        float v[2][16];
        for (float(&of)[16] : v) {
            for (float& value : of) value = from_minus_one_to_one(random);
        }

        on_every_target([&] {
            CopyScores scores[2];
            for (int c = 0; c < 2; ++c) {
                products[c].resize(prices.size());
                least[c].resize(prices.size());
                scores[c] = score_copies(table.table, count, v[c], false, products[c].data(), least[c].data());
            }
            const CopyCosts costs{&scores[0], &scores[1], 0.1f, 2.0f, prices.data(), {2.0f, 1.0f, 0.0f}};
            std::vector<CheapCopy> all;
            for (int at = count - 1; at >= 0; --at) {
                const std::array<float, 3> one = copy_errors(scores[0], at);
                const std::array<float, 3> two = copy_errors(scores[1], at);
                for (int q = 2; q >= 0; --q) {
                    const auto of = static_cast<std::size_t>(q);
                    const float length = 2.0f * std::sqrt(one[of] + two[of] + 0.1f);
                    all.push_back({length + prices[static_cast<std::size_t>(at)] + costs.extra[q], at, q});
                }
            }
            std::stable_sort(all.begin(), all.end(), [](auto a, auto b) { return a.cost < b.cost; });
            CheapCopies cheapest;
            add_cheapest(costs, count, cheapest);
            std::size_t found = 0;
            for (const CheapCopy& copy : cheapest) {
                EXPECT_EQ(copy.cost, all[found].cost);
                EXPECT_EQ(copy.at, all[found].at);
                EXPECT_EQ(copy.copied, all[found].copied);
                ++found;
            }
            EXPECT_EQ(found, static_cast<std::size_t>(std::min(3 * count, CheapCopies::kMost)));
        });
    }
}

// Beside the chords of one candidate at a time.
TEST(CopySearch, SumsTheChordsOfManyCandidatesOnEveryTarget) {
    std::mt19937 random(5);
    constexpr int kStride = 80;
    float normals[3][16], decoded[16], most[16], inside[16];
    for (std::size_t k = 0; k < 16; ++k) {
        normals[0][k] = 0.6f * from_minus_one_to_one(random);
        normals[1][k] = 0.6f * from_minus_one_to_one(random);
        normals[2][k] = std::sqrt(1.0f - normals[0][k] * normals[0][k] - normals[1][k] * normals[1][k]);
        decoded[k] = normals[1][k] + 0.1f * from_minus_one_to_one(random);
        most[k] = 0.4f;
        inside[k] = k % 4 == 3 ? 0.0f : 1.0f;
    }
    std::vector<float> values(std::size_t{16} * kStride);
    for (int k = 0; k < 16; ++k) {
        for (int i = 0; i < kStride; ++i)
            values[static_cast<std::size_t>(k * kStride + i)] =
                normals[0][k] + 0.004f * static_cast<float>(i) * from_minus_one_to_one(random);
    }
    for (const int count : {1, 2, 15, 16, 17, 33, 64}) {
        on_every_target([&] {
            float sums[kStride];
            chord_sums({normals[0], normals[1], normals[2], decoded, most, inside}, values.data(), kStride, count,
                       sums);
            int forbidden = 0;
            for (int i = 0; i < count; ++i) {
                float x[16], chords[16], sum = 0.0f;
                for (int k = 0; k < 16; ++k) x[k] = values[static_cast<std::size_t>(k * kStride + i)];
                const float* const of[3] = {normals[0], normals[1], normals[2]};
                block_chords(of, x, decoded, chords);
                for (std::size_t k = 0; k < 16; ++k) sum += chords[k] * inside[k];
                if (*std::max_element(chords, chords + 16) > 0.4f) sum = kTooLong, ++forbidden;
                EXPECT_EQ(sums[i], sum) << i;
            }
            if (count == 64) {
                EXPECT_TRUE(forbidden > 0 && forbidden < count) << forbidden;
            }
        });
    }
}

}  // namespace
}  // namespace tex
