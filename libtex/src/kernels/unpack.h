// SPDX-License-Identifier: Apache-2.0
// unpack.h: rows of decoded values to rows of normals.

#pragma once

namespace tex {

struct UnpackRule {
    bool is_unsigned = true;  // values are (n + 1) / 2
    bool snap_flat = false;   // unsigned values from 127/255 to 128/255 are 0
    bool flip_y = false;
    bool keep_length = false;
    bool keep_unit = false;  // leave vectors that are of unit length, but for rounding, as they are stored
};

// Normals of `count` texels from the values of their components; z may be null: it is reconstructed then. See unpack()
// in unpack.h for what is computed. Rows are read and written in whole vectors: they are padded as rows of a Plane are.
// The outputs may be the inputs.
void unpack_row(const float* x, const float* y, const float* z, const UnpackRule& rule, int count, float* out_x,
                float* out_y, float* out_z);

}  // namespace tex
