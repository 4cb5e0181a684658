// SPDX-License-Identifier: Apache-2.0
// Taps and samples must equal those of a plain loop in double and float exactly, on every instruction set.

#include "kernels/bilinear.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "rows/border.h"
#include "rows/sampler.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};
constexpr int kCounts[] = {1, 2, 15, 16, 17, 33, 257};

struct Tap {
    int first, second;
    float weight;
};

double reduced(Wrap wrap, double u) {
    if (wrap == Wrap::repeat) return u - std::floor(u);
    if (wrap == Wrap::mirror) return u - 2.0 * std::floor(u / 2.0);
    return std::clamp(u, -1.0, 2.0);
}

Tap tap_at(double u, Wrap wrap, int n) {
    const double place = reduced(wrap, u) * n - 0.5;
    const double whole = std::floor(place);
    const int index = static_cast<int>(whole);
    return {border_index(wrap, index, n), border_index(wrap, index + 1, n), static_cast<float>(place - whole)};
}

struct Axis {
    double start, step, rest;
};

// At and between the centres of texels, backwards, far outside, and at places where rounding reaches the end of a
// period.
constexpr Axis kAxes[] = {
    {0.0, 1.0 / 64, 0.0}, {0.3, 4.0 / 257, 0.0}, {-7.25, 0.013, 0.7}, {1.0, -0.4, 0.0},
    {0.0, 0.0, -1e-18},   {1e6, 0.11, -3.0},     {0.0, 1e-4, 0.5},
};

TEST(Bilinear, TapsAreThoseOfAPlainLoop) {
    on_every_target([] {
        for (const Wrap wrap : kWraps) {
            for (const int n : {1, 2, 3, 16, 64, 257}) {
                for (const Axis& axis : kAxes) {
                    for (const int count : kCounts) {
                        Taps taps(count);
                        const TapRow row = taps.row();
                        tap_row(axis.start, axis.step, axis.rest, wrap, n, taps.padded(), row);
                        // Kernels also read the taps past the end.
                        for (int i = 0; i < taps.padded(); ++i) {
                            const Tap tap = tap_at((axis.start + axis.step * (i + 0.5)) + axis.rest, wrap, n);
                            ASSERT_EQ(row.first[i], tap.first)
                                << name_of(kWrapNames, wrap) << " " << n << " " << axis.start << " " << i;
                            ASSERT_EQ(row.second[i], tap.second)
                                << name_of(kWrapNames, wrap) << " " << n << " " << axis.start << " " << i;
                            ASSERT_EQ(row.weight[i], tap.weight)
                                << name_of(kWrapNames, wrap) << " " << n << " " << axis.start << " " << i;
                        }
                    }
                }
            }
        }
    });
}

float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }

float sample_at(const Plane<float>& plane, const UvMap& map, Wrap wrap_x, Wrap wrap_y, int i, int j) {
    const double x = i + 0.5, y = j + 0.5;
    const Tap column = tap_at((map.u0 + map.ux * x) + map.uy * y, wrap_x, plane.extent().width);
    const Tap row = tap_at((map.v0 + map.vx * x) + map.vy * y, wrap_y, plane.extent().height);
    const float* upper = plane.row(row.first);
    const float* lower = plane.row(row.second);
    return mix(mix(upper[column.first], upper[column.second], column.weight),
               mix(lower[column.first], lower[column.second], column.weight), row.weight);
}

// Steps below one texel, at one texel, above one and above two, so that texels are permuted and gathered; the last rows
// and columns, which have no texels after them; rotations.
TEST(Bilinear, SamplesAreThoseOfAPlainLoop) {
    on_every_target([] {
        for (const int size : {1, 3, 17, 64, 100}) {
            const Plane<float> plane = fields::plane_of({size, 5}, [](int i, int j) { return fields::noise(i, j); });
            for (const Wrap wrap : kWraps) {
                for (const double texels : {0.3, 1.0, 1.7, 2.5, -1.0}) {
                    for (const double turn : {0.0, 0.01}) {
                        const Extent extent{90, 7};
                        const UvMap map{0.21, texels / size, turn, -0.4, turn, 0.11};
                        Sampler sampler(plane.extent(), extent, map, wrap, wrap);
                        Plane<float> row({extent.width, 1});
                        for (int j = 0; j < extent.height; ++j) {
                            sampler.place(j);
                            sampler.sample(plane, row.row(0));
                            for (int i = 0; i < extent.width; ++i) {
                                ASSERT_EQ(row.at(i, 0), sample_at(plane, map, wrap, wrap, i, j))
                                    << size << " " << texels << " " << turn << " " << i << "," << j;
                            }
                        }
                    }
                }
            }
        }
    });
}

TEST(Bilinear, WhatLiesOverTheResultIsTakenAsItIs) {
    const Plane<float> plane = fields::plane_of({20, 3}, [](int i, int j) { return fields::noise(i, j); });
    Sampler same(plane.extent(), plane.extent(), stretch(plane.extent()), Wrap::repeat, Wrap::repeat);
    same.place(2);
    EXPECT_EQ(same.row_of(plane), plane.row(2));
    Sampler other(plane.extent(), {20, 4}, stretch({20, 4}), Wrap::repeat, Wrap::repeat);
    other.place(2);
    EXPECT_EQ(other.row_of(plane), nullptr);
}

}  // namespace
}  // namespace tex
