// SPDX-License-Identifier: Apache-2.0
// kernels/horizon.h: the horizons of a band of lines side by side.
//
// A sweep goes from row to row; a line is one lane. What lies behind the sweep on a line is its upper convex hull, a
// stack from the farthest point to the nearest. Two lines of texels that lie side by side share the hull of the line
// between them. Horizons are rises for each row of distance.
//
// A point n rows away whose rise is r counts as r / n - bend n.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// 256 lines: with 128, a texel takes a fifth more time; with 512, less of it at 4096x4096 alone.
inline constexpr int kHullBits = 7;
inline constexpr int kHulls = 1 << kHullBits;
inline constexpr int kBandLines = 2 * kHulls;

// The height of a hole: so low that nothing beside it can see it. Heights are at most kMaxSlope.
inline constexpr float kHoleHeight = -1e30f;

// The hulls of a band; hull i lies between lines 2 i and 2 i + 1. Entry k of its stack, height and row, is at
// [2 (kHulls k + i)]; the two nearest points of each hull are also in `top` and `second`.
struct HullBand {
    float* points;  // stacks, with room for as many points as are pushed
    alignas(64) std::int32_t counts[kHulls];
    alignas(64) float top_heights[kHulls];
    alignas(64) float top_rows[kHulls];
    alignas(64) float second_heights[kHulls];
    alignas(64) float second_rows[kHulls];
};

// Empties the hulls.
void clear_hulls(HullBand& band);

// A row of heights: hull i has the height heights[2 i] + fraction (heights[2 i + 1] - heights[2 i]).
struct LineRow {
    const float* heights;  // kBandLines of them
    float fraction;
    float row;
};

// A point near a texel, between two texels a and b: a_weight (a[i] - own[i]) + b_weight (b[i] - own[i]) - drop.
struct NearPoint {
    const float* a;
    const float* b;
    float a_weight, b_weight, drop;
};
inline constexpr int kMostNearPoints = 11;

// Texels of a row: their heights, the points near them, and where their horizons go.
struct TexelRow {
    const float* own;
    const NearPoint* points;
    int count;
    float row;
    float* horizons;
};

// Adds one point of `count` rows to the hull of each line: the highest above the horizon of the texels of a row that
// comes soon after them. The rows follow one another and lie before all others.
void push_highest(HullBand& band, const LineRow* rows, int count, const TexelRow& seen_from, float bend);

// The horizons of rows that follow one another: the greatest of what the points near a texel and its hull give. A hull
// is searched once, for a texel in the middle, and each texel takes the best of the point that is found and of those
// beside it. No hull may be empty.
void find_horizons(const HullBand& band, const TexelRow* rows, int count, float bend);

// What scale_heights() met.
struct ScaledHeights {
    std::int64_t holes = 0;
    bool are_finite = true;  // holes apart
};

// out[i] = scale in[i], limited to +-kMaxSlope; kHoleHeight where in[i] is NaN. Rows may be read and written up to a
// whole vector past their last texel.
ScaledHeights scale_heights(const float* in, float scale, int count, float* out);

}  // namespace tex::inline v1
