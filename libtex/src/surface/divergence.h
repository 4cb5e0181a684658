// SPDX-License-Identifier: Apache-2.0
// divergence.h: the right side of the equation for heights: Dx^T p + Dy^T q of the slopes p and q, where Dx and Dy are
// the derivatives that bake() takes (rows/bake_rows.h).
//
// At borders, the transposed derivative continues slopes as follows. On a mirrored axis, slopes along the axis change
// their sign beyond the border. On a clamped axis, slopes become those of a mirrored axis:
//
//     forward   bake() gives the last two texels the same slope: their mean is that of the last difference
//     others    a ramp of slope 1, which keeps its slope in a clamped field, has less near the borders of a mirrored
//               one: slopes are multiplied by that
//
// The latter is a half for the border texels and `central`, and exact: a clamped field is found without iteration. If
// slopes are not those of any field, a border texel thereby has a quarter of the weight of others (central), or the two
// texels together have the weight of one (forward). It is an approximation for kernels that are wider or smooth.

#pragma once

#include <functional>

#include <tex/height.h>

#include "memory/lent_memory.h"
#include "rows/bake_rows.h"

namespace tex::inline v1 {

struct SurfaceAxis {
    Wrap wrap = Wrap::repeat;
    float ratio = 1.0f;  // as AxisOperator::ratio
};

// Writes the slopes of row j, 0 <= j < height, with room for whole vectors.
using SlopesOf = std::function<void(int j, float* p, float* q)>;

class DivergenceRows {
public:
    DivergenceRows(Extent extent, SlopesOf slopes, const Gradient& gradient, SurfaceAxis x, SurfaceAxis y);

    // Computes row j into `out`, which has room for whole vectors. Rows must follow one another, from any row on.
    void make(int j, float* out);

private:
    void fetch(int j);
    void settle_border(int source, float* p, float* q);
    void extend(float* p, float* q) const;

    Extent extent_;
    SlopesOf slopes_;
    const Gradient& gradient_;
    SurfaceAxis x_, y_;
    int radius_, lead_;
    int next_ = 0;
    bool begun_ = false;
    Plane<float> p_, q_;   // a window of rows, each with an apron
    Plane<float> beside_;  // scratch: one row of p and of q
    WorkingVector<const float*> window_;
    WorkingVector<float> ramp_x_, ramp_y_;  // the slope of a mirrored ramp in the first texels from a border
};

}  // namespace tex::inline v1
