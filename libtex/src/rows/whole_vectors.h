// SPDX-License-Identifier: Apache-2.0
// whole_vectors.h: kernels on rows of a caller, which end with their last texels.
//
// Kernels read and write whole vectors. They run on as many texels of a row as fill vectors of any processor; what is
// left is copied to the stack and back. A kernel for this makes each texel of the same texels of its inputs.

#pragma once

#include <algorithm>
#include <cstddef>

namespace tex::inline v1 {

// The floats of the widest vector (kRowAlignment).
inline constexpr int kWhole = 16;

// Calls kernel(from, to, count) with the rows `from` and `to`, for all `width` texels. Rows may be the same.
template <std::size_t kIn, std::size_t kOut, class Kernel>
void in_whole_vectors(int width, const float* const (&from)[kIn], float* const (&to)[kOut], const Kernel& kernel) {
    const int whole = width / kWhole * kWhole, rest = width - whole;
    if (whole > 0) kernel(from, to, whole);
    if (rest == 0) return;
    float in[kIn][kWhole] = {}, out[kOut][kWhole];
    const float* in_rows[kIn];
    float* out_rows[kOut];
    for (std::size_t k = 0; k < kIn; ++k) {
        std::copy_n(from[k] + whole, rest, in[k]);
        in_rows[k] = in[k];
    }
    for (std::size_t k = 0; k < kOut; ++k) out_rows[k] = out[k];
    kernel(in_rows, out_rows, rest);
    for (std::size_t k = 0; k < kOut; ++k) std::copy_n(out[k], rest, to[k] + whole);
}

}  // namespace tex::inline v1
