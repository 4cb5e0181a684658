// SPDX-License-Identifier: Apache-2.0
// chords.h: the chords between normals and decoded components (rate-distortion optimisation, rows/rdo_pass.h).

#pragma once

#include <cstddef>

namespace tex::inline v1 {

// The lengths of the chords |n - m| between 16 unit normals and the decoded components x and y, as readers make normals
// of them: (x, y, sqrt(1 - x^2 - y^2)), or the unit vector along (x, y, 0) where x^2 + y^2 is above 1.
void block_chords(const float* const normals[3], const float x[16], const float y[16], float chords[16]);

// For many candidates for one component of a block's texels: the sum of the chords that block_chords() computes, each
// times `inside`, in the order of the texels; or kTooLong if a chord is longer than `most`.
inline constexpr float kTooLong = 1e30f;
struct ChordTexels {
    const float* own;    // the component that candidates replace, of the normals
    const float* other;  // the other one
    const float* z;
    const float* decoded;  // the other component of all candidates
    const float* most;
    const float* inside;
};
// `values` has the candidates of texel k from k * stride on. The rows of `values`, and `sums`, have room for a whole
// vector past the last candidate.
void chord_sums(const ChordTexels& texels, const float* values, int stride, int count, float* sums);

}  // namespace tex::inline v1
