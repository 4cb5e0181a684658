// SPDX-License-Identifier: Apache-2.0
// unpack.h: turns rows of decoded values into rows of normals.

#pragma once

namespace tex::inline v1 {

struct UnpackRule {
    bool is_unsigned = true;  // values are (n + 1) / 2
    bool is_z01 = false;      // z is stored as it is
    bool snap_flat = false;   // unsigned values from 127/255 to 128/255 are 0
    bool flip_y = false;
    bool keep_length = false;
    bool keep_invalid = false;  // vectors that are not finite become NaN, not (0, 0, 1)
    bool keep_unit = false;     // do not change vectors that are stored with unit length, apart from rounding
};

// Normals of `count` texels from the values of their components. If z is null, it is reconstructed. The computation is
// that of unpack() in pack.h. Rows are read and written in whole vectors, so they are padded like the rows of a
// Plane. The outputs may be the inputs.
void unpack_row(const float* x, const float* y, const float* z, const UnpackRule& rule, int count, float* out_x,
                float* out_y, float* out_z);

}  // namespace tex::inline v1
