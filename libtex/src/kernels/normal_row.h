// SPDX-License-Identifier: Apache-2.0
// kernels/normal_row.h: a row of normals, as kernels read and write it.

#pragma once

namespace tex::inline v1 {

// Rows may be read and written up to a whole vector (64 bytes) past their last texel. VectorRow is only read:
struct VectorRow {
    const float* x;
    const float* y;
    const float* z;
};

struct NormalRow {
    float* x;
    float* y;
    float* z;

    operator VectorRow() const { return {x, y, z}; }
};

}  // namespace tex::inline v1
