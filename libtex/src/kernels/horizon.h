// SPDX-License-Identifier: Apache-2.0
// kernels/horizon.h: the horizons of a band of lines side by side.
//
// A sweep goes from row to row; a line is one lane. What lies behind the sweep on a line is its upper convex hull, a
// stack from the farthest point to the nearest. Horizons are rises for each row of distance.
//
// A point n rows away whose rise is r counts as r / n - bend n.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// With half as many lines, a texel of 4096x4096 takes a tenth longer.
inline constexpr int kBandBits = 8;
inline constexpr int kBandLines = 1 << kBandBits;

// The height of a hole: so low that nothing beside it can see it. Heights are at most kMaxSlope.
inline constexpr float kHoleHeight = -1e30f;

// The hulls of a band. Entry k of line i of the stacks, height and row, is at [2 (kBandLines k + i)]; the two nearest
// points of each hull are also in `top` and `second`.
struct HullBand {
    float* points;  // stacks, with room for as many points as are pushed
    alignas(64) std::int32_t counts[kBandLines];
    alignas(64) float top_heights[kBandLines];
    alignas(64) float top_rows[kBandLines];
    alignas(64) float second_heights[kBandLines];
    alignas(64) float second_rows[kBandLines];
};

// Empties the hulls.
void clear_hulls(HullBand& band);

// A row of heights: line i has the height heights[i] + fraction (heights[i + 1] - heights[i]).
struct LineRow {
    const float* heights;  // kBandLines + 1 of them
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

// Rows whose horizons are found together, at most.
inline constexpr int kMostRows = 4;

// Texels of a row: their heights, the lines beside them, the points near them, and where their horizons go.
struct TexelRow {
    const float* own;
    LineRow line;
    const NearPoint* points;
    int count;
    float* horizons;
};

// Adds one point of `count` rows to the hull of each line: the highest above the horizon of the texels of a row that
// comes soon after them. The rows follow one another and lie before all others.
void push_highest(HullBand& band, const LineRow* rows, int count, const TexelRow& seen_from, float bend);

// The horizons of rows that follow one another: the greatest of what the points near a texel and the hull of its line
// give. A hull is searched once, for a texel in the middle, and each texel takes the best of the point that is found
// and of those beside it. No hull may be empty.
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
