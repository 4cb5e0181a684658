// SPDX-License-Identifier: Apache-2.0

#include "kernels/stored.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tex/types.h>

#include "unit/targets.h"

namespace tex {
namespace {

using FloatRow = std::vector<float>;

constexpr int kWidths[] = {1, 2, 15, 16, 17, 33, 257};
constexpr VectorLimits kLimits{1.03f, 0.01f, 0.97f, 1.03f, -0.016f, -0.1f, 127.0f / 255.0f, 128.0f / 255.0f};

// Codes of 8 bits with what damaged files hold; some texels are flat, one in x only.
FloatRow random_row(std::mt19937& random, int width) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kOdd[] = {kNan, kInfinity, -kInfinity, 1e30f, -0.0f, 3.0e38f, 2.5f};
    FloatRow row(static_cast<std::size_t>(width));
    for (float& value : row) {
        const auto kind = random() % 20;
        value = kind < 2    ? kOdd[random() % std::size(kOdd)]
                : kind < 10 ? static_cast<float>(127 + random() % 2) / 255.0f
                            : static_cast<float>(random() % 256) / 255.0f;
    }
    return row;
}

struct Rows {
    FloatRow x, y, z;
    bool has_z, is_signed;
    [[nodiscard]] StoredRow row() const {
        return {x.data(), y.data(), has_z ? z.data() : nullptr, is_signed ? 1.0f : 2.0f, is_signed ? 0.0f : -1.0f};
    }
};

template <class Test>
void for_all_rows(const Test& test) {
    std::mt19937 random(9);
    for (const int width : kWidths) {
        for (int k = 0; k < 12; ++k) {
            const Rows rows{random_row(random, width), random_row(random, width), random_row(random, width), k % 2 == 0,
                            k % 4 < 2};
            on_every_target([&] { test(rows, width); });
        }
    }
}

VectorCounts expected_counts(const Rows& rows, int width) {
    VectorCounts counts;
    double sums[4][16] = {};
    const StoredRow row = rows.row();
    for (int i = 0; i < width; ++i) {
        const auto mark = [&](VectorTrait trait, bool holds) {
            const auto k = static_cast<std::size_t>(trait);
            if (holds && counts.count[k]++ == 0) counts.first[k] = i;
        };
        const float x = row.x[i] * row.scale + row.offset, y = row.y[i] * row.scale + row.offset;
        const float z = rows.has_z ? row.z[i] * row.scale + row.offset : reconstruct_z(x, y);
        const float square = x * x + y * y + z * z;
        if (!(square < std::numeric_limits<float>::max())) {
            mark(VectorTrait::not_finite, true);
            continue;
        }
        mark(VectorTrait::beyond_unit, x * x + y * y > kLimits.beyond_square);
        mark(VectorTrait::null_vector, rows.has_z && square < kLimits.null_square);
        mark(VectorTrait::off_length, rows.has_z && (square > kLimits.most_square || square < kLimits.least_square));
        mark(VectorTrait::z_below, rows.has_z && z < kLimits.below);
        mark(VectorTrait::z_behind, rows.has_z && z < kLimits.behind);
        mark(VectorTrait::flat_low, row.x[i] == kLimits.low_flat && row.y[i] == kLimits.low_flat);
        mark(VectorTrait::flat_high, row.x[i] == kLimits.high_flat && row.y[i] == kLimits.high_flat);
        const float length = std::sqrt(square);
        const float values[] = {x, y, z, length};
        for (int k = 0; k < 4; ++k) sums[k][i % 16] += static_cast<double>(values[k]);
        ++counts.finite;
        counts.min_length = std::min(counts.min_length, length);
        counts.max_length = std::max(counts.max_length, length);
    }
    double* const totals[] = {&counts.x, &counts.y, &counts.z, &counts.length};
    for (int k = 0; k < 4; ++k) {
        for (const double sum : sums[k]) *totals[k] += sum;
    }
    return counts;
}

TEST(StoredRows, CountsAreThoseOfPlainLoopsOnEveryTarget) {
    for_all_rows([](const Rows& rows, int width) {
        const VectorCounts expected = expected_counts(rows, width);
        VectorCounts counts;
        count_stored_vectors(rows.row(), kLimits, width, counts);
        EXPECT_EQ(counts.count, expected.count);
        EXPECT_EQ(counts.first, expected.first);
        EXPECT_EQ(counts.finite, expected.finite);
        EXPECT_EQ(counts.x, expected.x);
        EXPECT_EQ(counts.y, expected.y);
        EXPECT_EQ(counts.z, expected.z);
        EXPECT_EQ(counts.length, expected.length);
        EXPECT_EQ(counts.min_length, expected.min_length);
        EXPECT_EQ(counts.max_length, expected.max_length);
    });
}

TEST(StoredRows, RangesLeaveOutNan) {
    for_all_rows([](const Rows& rows, int width) {
        float low = 0.25f, high = 0.5f, expected_low = low, expected_high = high;
        for (const float value : rows.x) {
            if (value < expected_low) expected_low = value;
            if (value > expected_high) expected_high = value;
        }
        widen_range(rows.x.data(), width, low, high);
        EXPECT_EQ(low, expected_low);
        EXPECT_EQ(high, expected_high);
    });
}

TEST(StoredRows, VectorsAreThoseOfPlainLoopsOnEveryTarget) {
    for_all_rows([](const Rows& rows, int width) {
        const StoredRow row = rows.row();
        const auto size = static_cast<std::size_t>(width);
        FloatRow x(size), y(size), z(size);
        restore_stored_vectors(row, width, x.data(), y.data(), z.data());
        for (std::size_t i = 0; i < size; ++i) {
            float nx = row.x[i] * row.scale + row.offset, ny = row.y[i] * row.scale + row.offset;
            if (!rows.has_z) {
                const float beyond = std::max(1.0f, std::sqrt(nx * nx + ny * ny));
                nx /= beyond;
                ny /= beyond;
            }
            const float nz = rows.has_z ? row.z[i] * row.scale + row.offset : reconstruct_z(nx, ny);
            const bool usable = nx * nx + ny * ny + nz * nz <= 16.0f;
            EXPECT_EQ(x[i], usable ? nx : 0.0f) << i;
            EXPECT_EQ(y[i], usable ? ny : 0.0f) << i;
            EXPECT_EQ(z[i], usable ? nz : 0.0f) << i;
        }
    });
}

TEST(StoredRows, AveragesAreThoseOfPlainLoopsOnEveryTarget) {
    std::mt19937 random(5);
    for (const int width : kWidths) {
        FloatRow upper(static_cast<std::size_t>(2 * width)), lower(upper.size());
        for (FloatRow* row : {&upper, &lower}) {
            for (float& value : *row) value = static_cast<float>(random() % 100'000) / 99'999.0f;
        }
        on_every_target([&] {
            FloatRow out(static_cast<std::size_t>(width));
            average_pairs(upper.data(), lower.data(), width, out.data());
            for (std::size_t i = 0; i < out.size(); ++i)
                EXPECT_EQ(out[i], (upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1]) * 0.25f) << i;
        });
    }
}

}  // namespace
}  // namespace tex
