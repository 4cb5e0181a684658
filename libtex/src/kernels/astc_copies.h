// SPDX-License-Identifier: Apache-2.0
// astc_copies.h: estimates for earlier blocks what it costs a block of ASTC, BC7 or UASTC to copy them
// (rows/rdo_copies.h).

#pragma once

namespace tex::inline v1 {

// The numbers that say most about two channels of a block: for each of them, coordinates of its texels beside an
// orthonormal basis.
inline constexpr int kAstcCoarse = 6;

// Earlier blocks, an array for each number. The arrays can be read a whole vector (64 bytes) past their last value.
struct AstcCopyTable {
    const float* coarse[kAstcCoarse];  // of what they decode to
    // Their endpoints: a direction (cos, sin), and along it and across (-sin, cos) the middle and half of the length.
    const float *cos, *sin;
    const float* middle[2];
    const float* half[2];
    const float* noise;     // the squared error that rounding weights makes
    const float* literals;  // bytes of weights
};

// A block that searches: means, sums of products of differences from them, and coarse numbers.
struct AstcCopyTexels {
    float texels;
    float mean[2];
    float xx, xy, yy;
    float coarse[kAstcCoarse];
};

// For each of `count` earlier blocks, a cost that is at most that of copying it as a whole
//     wholes = scale * sqrt(squared distance of coarse numbers) + prices
// and an estimate of that of copying its endpoints
//     fronts = scale * sqrt(squared distance from what lies between them + noise) + prices + literal * literals
// where texels are taken to be spread evenly along the endpoints and across, as their means and variances say. Whole
// vectors are written.
void astc_copy_costs(const AstcCopyTable& table, const AstcCopyTexels& block, const float* prices, float scale,
                     float literal, int count, float* wholes, float* fronts);

}  // namespace tex::inline v1
