// SPDX-License-Identifier: Apache-2.0
// The scores of what blocks may copy, against fits in double, and the shapes of halves against the decoders.

#include "kernels/copy_search.h"
#include "kernels/chords.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blocks/block_half.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr HalfKind kKinds[] = {HalfKind::bc4_unorm, HalfKind::bc4_snorm, HalfKind::green, HalfKind::eac_unorm,
                               HalfKind::eac_snorm};

float from_minus_one_to_one(std::mt19937& random) { return static_cast<float>(random() % 2001) / 1000.0f - 1.0f; }

void make_half(std::mt19937& random, std::byte half[kHalfBytes]) {
    for (int k = 0; k < kHalfBytes; ++k) half[k] = static_cast<std::byte>(random());
}

TEST(BlockHalf, ShapesAreWhatDecodersMake) {
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

TEST(BlockHalf, VariantsKeepWhatIsCopiedAndComeCloseToTheLine) {
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

// Random halves, as a table that kernels may read past its end.
struct Halves {
    std::vector<CopyHalf> halves;
    std::vector<std::int16_t> parts[16], means, lengths;
    CopyTable table{};
    Halves(HalfKind kind, int count, std::mt19937& random) {
        const std::size_t slack = 32;
        for (std::vector<std::int16_t>& column : parts) column.resize(static_cast<std::size_t>(count) + slack);
        means.resize(parts[0].size());
        lengths.resize(parts[0].size());
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            std::byte half[kHalfBytes];
            HalfShape shape{};
            while (!shape.is_line || shape.line.slope < 0.0f) {
                make_half(random, half);
                shape = half_shape(kind, half);
            }
            halves.push_back(copy_half(shape));
            const CopyDirection direction = copy_direction(shape.weights);
            for (std::size_t k = 0; k < 16; ++k) parts[k][i] = direction.parts[k];
            const float mean = halves[i].sum / 16.0f;
            const float length = std::sqrt(std::max(0.0f, halves[i].squares - halves[i].sum * mean));
            const CopySize size = copy_size(shape.line.offset + shape.line.slope * mean, shape.line.slope * length);
            means[i] = size.mean;
            lengths[i] = size.length;
        }
        for (std::size_t k = 0; k < 16; ++k) table.parts[k] = parts[k].data();
        table.means = means.data();
        table.lengths = lengths.data();
        table.halves = halves.data();
    }
};

// The sum of squares for a line, in double.
double line_error(const HalfShape& shape, const float* v, double offset, double slope) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 16; ++k) {
        const double d = double{v[k]} - offset - slope * double{shape.weights[k]};
        sum += d * d;
    }
    return sum;
}

TEST(CopySearch, ErrorsAreThoseOfLeastSquares) {
    for (const HalfKind kind : {HalfKind::bc4_unorm, HalfKind::green, HalfKind::eac_snorm}) {
        std::mt19937 random(7);
        const Halves table(kind, 257, random);
        float v[16];
        for (float& value : v) value = from_minus_one_to_one(random);
        for (const CopyHalf& half : table.halves) {
            const std::array<float, 3> found = copy_errors(half, copy_values(v), keeps_slope(kind));
            double w = 0.0, ww = 0.0, sv = 0.0, wv = 0.0;
            for (std::size_t k = 0; k < 16; ++k) {
                const double weight = half.shape.weights[k];
                w += weight, ww += weight * weight, sv += double{v[k]}, wv += weight * double{v[k]};
            }
            const double free_slope = std::max(0.0, (16.0 * wv - w * sv) / (16.0 * ww - w * w));
            const double offset = half.shape.line.offset;
            const double slope = half.shape.line.slope;
            const double tolerance = 2e-4 * (1.0 + slope * slope * ww);
            EXPECT_NEAR(found[0], line_error(half.shape, v, (sv - free_slope * w) / 16.0, free_slope), tolerance);
            EXPECT_NEAR(found[2], line_error(half.shape, v, offset, slope), tolerance);
            const double own_slope = keeps_slope(kind) ? slope : std::max(0.0, (wv - offset * w) / ww);
            const double own_offset = keeps_slope(kind) ? (sv - slope * w) / 16.0 : offset;
            EXPECT_NEAR(found[1], line_error(half.shape, v, own_offset, own_slope), tolerance);
        }
    }
}

// All copies by their costs, without any bound.
std::vector<CheapCopy> all_copies(const CopySearch& search, int to, int from, bool is_pair) {
    std::vector<CheapCopy> all;
    for (int at = search.count - 1; at >= 0; --at) {
        std::array<float, 3> errors =
            copy_errors(search.tables[from]->halves[at], *search.values[to], search.keeps_slope);
        if (is_pair) {
            const std::array<float, 3> more =
                copy_errors(search.tables[1]->halves[at], *search.values[1], search.keeps_slope);
            for (std::size_t q = 0; q < 3; ++q) errors[q] += more[q];
        }
        for (int q = 2; q >= 0; --q) {
            if (q == 1 && !search.keeps_slope) continue;
            const float rest = is_pair ? 0.0f : search.rests[to];
            const float length = search.scale * std::sqrt(errors[static_cast<std::size_t>(q)] + rest);
            all.push_back({length + search.prices[at] + search.extra[is_pair ? 2 : to][q], at, q});
        }
    }
    std::stable_sort(all.begin(), all.end(), [](auto a, auto b) { return a.cost < b.cost; });
    return all;
}

void expect_cheapest(const CheapCopies& found, const std::vector<CheapCopy>& all, float limit) {
    std::size_t count = 0;
    for (const CheapCopy& copy : found) {
        ASSERT_LT(count, all.size());
        EXPECT_EQ(copy.cost, all[count].cost);
        EXPECT_EQ(copy.at, all[count].at);
        EXPECT_EQ(copy.copied, all[count].copied);
        ++count;
    }
    std::size_t wanted = 0;
    while (wanted < std::min<std::size_t>(CheapCopies::kMost, all.size()) && all[wanted].cost < limit) ++wanted;
    EXPECT_EQ(count, wanted);
}

// The search dismisses most halves by cosines and sizes; beside all costs, with values that are noise, smooth, or those
// of a half of the table.
TEST(CopySearch, FindsTheCheapestOnEveryTarget) {
    for (const HalfKind kind : {HalfKind::bc4_unorm, HalfKind::eac_unorm}) {
        for (const int count : {0, 1, 2, 15, 16, 17, 33, 257, 1000}) {
            std::mt19937 random(static_cast<unsigned>(count));
            const Halves tables[2] = {{kind, count, random}, {kind, count, random}};
            std::vector<float> prices(static_cast<std::size_t>(count));
            for (std::size_t k = 0; k < prices.size(); ++k)
                prices[k] = 0.1f * static_cast<float>((prices.size() - k) / 100);
            for (int trial = 0; trial < 6; ++trial) {
                float v[2][16];
                for (int c = 0; c < 2; ++c) {
                    for (std::size_t k = 0; k < 16; ++k) {
                        const float noise = from_minus_one_to_one(random);
                        const float smooth = 0.03f * static_cast<float>(k % 4 + 2 * (k / 4));
                        v[c][k] = trial < 2 ? noise : smooth + 0.01f * noise;
                    }
                    if (trial < 4 || count == 0) continue;
                    const HalfShape& shape = tables[c].halves[random() % static_cast<unsigned>(count)].shape;
                    for (std::size_t k = 0; k < 16; ++k)
                        v[c][k] = shape.line.offset + shape.line.slope * shape.weights[k];
                }
                const CopyValues values[2] = {copy_values(v[0]), copy_values(v[1])};
                const CopySearch search{{&tables[0].table, &tables[1].table},
                                        {&values[0], &values[1]},
                                        true,
                                        keeps_slope(kind),
                                        count,
                                        2.0f,
                                        {0.1f, 0.02f},
                                        prices.data(),
                                        {{0.2f, 0.1f, 0.0f}, {0.3f, 0.1f, 0.0f}, {0.6f, 0.2f, 0.0f}}};
                const float limit = trial % 2 == 0 ? 3e38f : 3.0f;
                on_every_target([&] {
                    const CheapCopies none(limit);
                    FoundCopies found{{{none, none}, {none, none}}, none};
                    find_copies(search, found);
                    for (int to = 0; to < 2; ++to) {
                        for (int from = 0; from < 2; ++from)
                            expect_cheapest(found.of[to][from], all_copies(search, to, from, false), limit);
                    }
                    expect_cheapest(found.pairs, all_copies(search, 0, 0, true), limit);
                });
            }
        }
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
