// SPDX-License-Identifier: Apache-2.0
// kernels/sky_light.h: the light above horizons, direction by direction.

#pragma once

namespace tex::inline v1 {

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

// What is seen in a direction.
struct SkyView {
    const float* horizons;
    SkyDirection direction;
};

// Adds the light above the horizons of one or two views from `count` texels with the slopes p (to the right) and q
// (upwards), which sky.sky and sky.horizon do without. Reads and writes no other texels.
void add_sky(const SkyView* views, int view_count, const float* p, const float* q, int count, const SkyRow& sky);

// Turns sums over `directions` into occlusion, sky view and unit vectors; the vector of a texel that sees nothing
// becomes its normal. Holes become 1, 1, (0, 0, 1) and 0. Rows may be written up to a whole vector (64 bytes) past
// their last texel.
void finish_sky(const float* heights, const float* p, const float* q, int directions, int count, const SkyRow& sky);

}  // namespace tex::inline v1
