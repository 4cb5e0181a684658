// SPDX-License-Identifier: Apache-2.0
// texels.h: one channel of a 4x4 block, as the block encoders read it.

#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace tex::inline v1 {

// Encoders use whole numbers, so that they compare errors exactly. Values are multiples of 1/1024 of a code. This
// represents 8-bit sources exactly and changes others by less than 0.0003 degrees.
inline constexpr std::int32_t kCodeUnit = 1024;

struct BlockTexels {
    std::int32_t values[16];      // row-major, in units of 1/kCodeUnit of a code, 0 to top * kCodeUnit
    std::uint32_t mask = 0xFFFF;  // bit k is set if texel k lies in the level; other texels have no weight
};

// A component in [-1, 1] (clamped), mapped to the codes 0 to `top`, in units of 1/kCodeUnit. Computed in float, from
// left to right; halves are rounded up.
inline std::int32_t to_code_units(float n, int top) {
    const float half_range = 0.5f * static_cast<float>(top) * static_cast<float>(kCodeUnit);
    const float clamped = std::fmin(std::fmax(n, -1.0f), 1.0f);
    return static_cast<std::int32_t>(std::floor(clamped * half_range + half_range + 0.5f));
}

// An entry of a palette, and the square of its distance to what was wanted.
struct Nearest {
    int index;
    std::int64_t squared;
};

// The nearest entry, the first if several are equally near.
template <int N>
Nearest nearest(const std::int64_t (&palette)[N], std::int64_t wanted) {
    Nearest best{0, std::numeric_limits<std::int64_t>::max()};
    for (int k = 0; k < N; ++k) {
        const std::int64_t d = wanted - palette[k];
        if (d * d < best.squared) best = {k, d * d};
    }
    return best;
}

}  // namespace tex::inline v1
