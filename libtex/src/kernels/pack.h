// SPDX-License-Identifier: Apache-2.0
// pack.h: packs rows of normals into rows of whole-number codes.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// One stored channel of a row: `values` are components in [-1, 1], or null for a channel that is constantly 1. A
// negated channel stores -values. Other data are in [0, 1].
struct PackChannel {
    const float* values = nullptr;
    bool negate = false;
    bool is_other = false;
};

// The number of bytes (elements, for 16 bits) per channel that a kernel may write past the last texel of an interleaved
// row.
inline constexpr int kPackSlack = 16;

// Interleaves 2, 3 or 4 channels as unorm codes of 8 or 16 bits:
//
//     code = floor((n + 1) * 0.5 * (2^bits - 1) + 0.5), clamped to the valid codes
//
// computed in float, from left to right; of other data, floor(n * (2^bits - 1) + 0.5). Reads whole vectors: rows are
// padded like the rows of a Plane. `out` has room for channels * (width + kPackSlack) codes.
void pack_unorm8(const PackChannel* channels, int count, int width, std::uint8_t* out);
void pack_unorm16(const PackChannel* channels, int count, int width, std::uint16_t* out);

}  // namespace tex::inline v1
