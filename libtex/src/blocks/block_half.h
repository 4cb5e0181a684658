// SPDX-License-Identifier: Apache-2.0
// block_half.h: one of the two 8-byte halves of a block with two channels, as a palette on a line: what rate-distortion
// optimisation copies and fits.
//
// A texel has the value offset + slope * weight, where its index selects the weight. Weights and slope follow from the
// bytes:
//
//             first bytes                weight                       offset             slope
//     BC4     2: e0, e1                  1 for e0, 0 for e1, k/7      e1                 e0 - e1
//     green   4: c0, c1                  1 for c0, 0 for c1, k/3      c1                 c0 - c1
//     EAC     2: base, multiplier and    the table's modifier         the base           8 multiplier (or 1)
//                table

#pragma once

#include <cstddef>

namespace tex::inline v1 {

inline constexpr int kHalfBytes = 8;

enum class HalfKind { bc4_unorm, bc4_snorm, green, eac_unorm, eac_snorm };

// Decodes a half into components in [-1, 1], as unpack() does, and in the same order.
void decode_half(HalfKind kind, const std::byte* half, float values[16]);

struct HalfLine {
    float offset, slope;  // in components
};
struct HalfShape {
    float weights[16];
    HalfLine line;
    bool is_line;  // false for the palette of BC4 with 6 values, which can only be copied as a whole
};
HalfShape half_shape(HalfKind kind, const std::byte* half);

// What is copied from another half, counted from its end.
enum class Copied { indices, all_but_first, all };

// The number of bytes in front of what is copied: 2 (green: 4), 1 (green: 2), 0.
int literals_before(HalfKind kind, Copied copied);

// Whether copying all but the first leaves the offset free (EAC: the multiplier is copied). Otherwise the slope is
// free.
constexpr bool keeps_slope(HalfKind kind) { return kind == HalfKind::eac_unorm || kind == HalfKind::eac_snorm; }

// What the squared error of any line with the weights of a shape follows from.
class HalfFit {
public:
    HalfFit(const HalfShape& shape, const float values[16]);
    // The line with the least sum of squares, if the weights and what follows from copying are given. The slope is not
    // negative, unless it is copied.
    [[nodiscard]] HalfLine line(HalfKind kind, Copied copied) const;
    // The sum of the squared differences between the values and a line, at least 0. Decoders limit values to [-1, 1],
    // which is ignored.
    [[nodiscard]] float squared_error(HalfLine line) const;

private:
    const HalfLine own_;
    float w_ = 0.0f, ww_ = 0.0f, v_ = 0.0f, vv_ = 0.0f, wv_ = 0.0f;  // sums of weights, values and products
};

// A half with the indices of another one.
struct HalfVariant {
    std::byte half[kHalfBytes];
    HalfLine line;
};

// The halves that copy from `source` and are close to a line: at most kMostVariants. Returns their number.
inline constexpr int kMostVariants = 9;
int half_variants(HalfKind kind, const std::byte* source, Copied copied, HalfLine line,
                  HalfVariant variants[kMostVariants]);

}  // namespace tex::inline v1
