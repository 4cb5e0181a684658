// SPDX-License-Identifier: Apache-2.0
// kernels/horizon.h: the horizons of a band of lines side by side, and the light above them.
//
// A sweep goes from row to row; a line is one lane. What lies behind the sweep on a line is its upper convex hull, a
// stack from the farthest point to the nearest. Horizons are rises for each row of distance.
//
// A point n rows away whose rise is r counts as r / n - bend n.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// 128 lines: with 64, a texel of 4096x4096 takes a quarter longer than one of 1024x1024.
inline constexpr int kBandBits = 7;
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

// Adds the highest point of `count` rows to the hull of each line; the last one, which is the nearest, if several are.
// The rows follow one another and lie before all others.
void push_highest(HullBand& band, const LineRow* rows, int count, float bend);

// A point near a texel, between two texels a and b: a_weight (a[i] - own[i]) + b_weight (b[i] - own[i]) - drop.
struct NearPoint {
    const float* a;
    const float* b;
    float a_weight, b_weight, drop;
};
inline constexpr int kMostNearPoints = 8;

// The horizon of texels with the heights `own` in this row: the greatest of what the points near it and the hull of its
// line give. No hull may be empty.
void find_horizons(const HullBand& band, const float* own, const NearPoint* points, int count, float row, float bend,
                   float* horizons);

// A direction in which horizons are measured.
struct SkyDirection {
    float x, y;      // a unit vector, to the right and upwards
    float for_rows;  // rows in a unit of distance
    bool is_level;   // no horizon lies below the level
};

// What is summed over the directions; null: is not wanted.
struct SkyRow {
    float* occlusion;
    float* sky;
    float* x;
    float* y;
    float* z;
    float* horizon;  // not a sum: the sine of the last horizon, or 0 below the level
};

// Adds the light above the horizons of `count` texels with the slopes p (to the right) and q (upwards), which
// sky.sky and sky.horizon do without. Reads and writes no other texels.
void add_sky(const float* horizons, const float* p, const float* q, const SkyDirection& direction, int count,
             const SkyRow& sky);

// Turns sums over `directions` into occlusion, sky view and unit vectors; the vector of a texel that sees nothing
// becomes its normal. Holes become 1, 1, (0, 0, 1) and 0. Rows may be written up to a whole vector (64 bytes) past
// their last texel.
void finish_sky(const float* heights, const float* p, const float* q, int directions, int count, const SkyRow& sky);

// What scale_heights() met.
struct ScaledHeights {
    std::int64_t holes = 0;
    bool are_finite = true;  // holes apart
};

// out[i] = scale in[i], limited to +-kMaxSlope; kHoleHeight where in[i] is NaN. Rows may be read and written up to a
// whole vector past their last texel.
ScaledHeights scale_heights(const float* in, float scale, int count, float* out);

}  // namespace tex::inline v1
