// SPDX-License-Identifier: Apache-2.0
// kernels/stored.h: rows of a stored level as the rules of a check see them.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace tex::inline v1 {

// A row of stored values. A component is scale * value + offset. z is null if it is not stored; then it is
// reconstruct_z(x, y).
struct StoredRow {
    const float *x, *y, *z;
    float scale, offset;
};

// Properties of a vector. Those of z and of the length need a stored z.
enum class VectorTrait {
    not_finite,   // the square of the length is infinite or NaN; the vector has no other property
    beyond_unit,  // x^2 + y^2 is above a limit
    null_vector,  // these four have limits, too
    off_length,
    z_below,
    z_behind,
    flat_low,  // the stored x and y are equal to a value
    flat_high,
};
inline constexpr std::size_t kVectorTraits = 8;

struct VectorLimits {
    float beyond_square;
    float null_square;
    float least_square, most_square;  // outside these, the length is off
    float below, behind;
    float low_flat, high_flat;
};

struct VectorCounts {
    std::array<int, kVectorTraits> count{};
    std::array<int, kVectorTraits> first{};  // the first such vector, if there is one
    // Sums over finite vectors.
    int finite = 0;
    double x = 0.0, y = 0.0, z = 0.0, length = 0.0;  // sums
    float min_length = std::numeric_limits<float>::max(), max_length = 0.0f;
};

// Counts the vectors of a row. Sums are those of 16 lanes: lane k holds texels k, k + 16, ... in this order.
void count_stored_vectors(const StoredRow& row, const VectorLimits& limits, int width, VectorCounts& counts);

// Extends [low, high] to the values of a row; NaN is left out.
void widen_range(const float* values, int count, float& low, float& high);

// The vectors of a row, unit or not. Without a stored z, x and y outside the unit circle are shortened to it, as in
// unpack(). Vectors longer than 4, and those that are not finite, become 0.
void restore_stored_vectors(const StoredRow& row, int width, float* x, float* y, float* z);

// out[i] is the mean of the texels 2 i and 2 i + 1 of both rows: (upper + upper + lower + lower) / 4.
void average_pairs(const float* upper, const float* lower, int count, float* out);

}  // namespace tex::inline v1
