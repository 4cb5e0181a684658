// SPDX-License-Identifier: Apache-2.0

#include "kernels/level_sums.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "unit/targets.h"

namespace tex {
namespace {

constexpr int kWidths[] = {1, 2, 15, 16, 17, 33, 257, 700};
constexpr std::size_t kPadding = 16;

// A row of texels with NaN before and after them, which must not count.
struct Texels {
    std::vector<float> values;

    Texels(std::mt19937& random, int width) : values(static_cast<std::size_t>(width) + 3 * kPadding) {
        std::fill(values.begin(), values.end(), std::numeric_limits<float>::quiet_NaN());
        std::uniform_real_distribution<float> any(-1.0f, 1.0f);
        for (int i = 0; i < width; ++i) values[kPadding + static_cast<std::size_t>(i)] = any(random);
    }
    [[nodiscard]] const float* row() const { return values.data() + kPadding; }
};

struct Rows {
    Texels sx, sy, sz, ax, ay, az, rx, ry, above_x, above_y, below_x, below_y;

    Rows(std::mt19937& random, int width)
        : sx(random, width), sy(random, width), sz(random, width), ax(random, width), ay(random, width),
          az(random, width), rx(random, width), ry(random, width), above_x(random, width), above_y(random, width),
          below_x(random, width), below_y(random, width) {}
    [[nodiscard]] LevelRow row(bool at_border) const {
        LevelRow row{{sx.row(), sy.row(), sz.row()},
                     {ax.row(), ay.row(), az.row()},
                     {rx.row(), ry.row()},
                     {above_x.row(), above_y.row()},
                     {below_x.row(), below_y.row()}};
        if (at_border) row.below = {};
        return row;
    }
};

// The definition, in double precision.
LevelSums expected_sums(const LevelRow& row, int count) {
    LevelSums sums;
    for (int i = 0; i < count; ++i) {
        const double s[3] = {row.s.x[i], row.s.y[i], row.s.z[i]}, a[3] = {row.a.x[i], row.a.y[i], row.a.z[i]};
        sums.length += std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
        sums.average_length += std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        const float* const of_r[2] = {row.r.x, row.r.y};
        const float* const above[2] = {row.above.x, row.above.y};
        const float* const below[2] = {row.below.x, row.below.y};
        for (std::size_t c = 0; c < 2; ++c) {
            const double r = of_r[c][i];
            sums.s[c] += s[c], sums.r[c] += r;
            sums.ss += s[c] * s[c], sums.rr += r * r, sums.rs += r * s[c];
            sums.normalised_square += (s[c] - r) * (s[c] - r);
            sums.average_square += (s[c] - a[c]) * (s[c] - a[c]);
            if (i == 0 || i == count - 1 || above[c] == nullptr || below[c] == nullptr) continue;
            const double gx = (static_cast<double>(of_r[c][i + 1]) - of_r[c][i - 1]) / 2.0;
            const double gy = (static_cast<double>(below[c][i]) - above[c][i]) / 2.0;
            sums.xx += gx * gx, sums.xy += gx * gy, sums.yy += gy * gy;
            sums.xr += gx * r, sums.yr += gy * r, sums.xs += gx * s[c], sums.ys += gy * s[c];
        }
    }
    return sums;
}

std::vector<double> values_of(const LevelSums& m) {
    return {m.s[0],           m.s[1], m.r[0], m.r[1], m.ss, m.rr, m.rs, m.length, m.average_length, m.normalised_square,
            m.average_square, m.xx,   m.xy,   m.yy,   m.xr, m.yr, m.xs, m.ys};
}

TEST(LevelSums, AreThoseOfTheDefinitionOnEveryTarget) {
    std::mt19937 random(3);
    for (const int width : kWidths) {
        const Rows rows(random, width);
        for (const bool at_border : {false, true}) {
            const LevelRow row = rows.row(at_border);
            const std::vector<double> expected = values_of(expected_sums(row, width));
            std::vector<double> first;
            on_every_target([&] {
                LevelSums sums;
                add_level_row(row, width, sums);
                const std::vector<double> values = values_of(sums);
                for (std::size_t k = 0; k < values.size(); ++k)
                    EXPECT_NEAR(values[k], expected[k], 1e-6 * width) << "sum " << k << ", width " << width;
                if (first.empty()) first = values;
                EXPECT_EQ(values, first);
            });
        }
    }
}

TEST(LevelSums, AddUp) {
    std::mt19937 random(4);
    const Rows rows(random, 40);
    LevelSums once, twice;
    add_level_row(rows.row(false), 40, once);
    twice.add(once);
    twice.add(once);
    const std::vector<double> single = values_of(once), doubled = values_of(twice);
    for (std::size_t k = 0; k < single.size(); ++k) EXPECT_EQ(doubled[k], 2.0 * single[k]);
}

}  // namespace
}  // namespace tex
