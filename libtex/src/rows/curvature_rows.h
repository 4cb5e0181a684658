// SPDX-License-Identifier: Apache-2.0
// curvature_rows.h: rows of curvature from rows of normals.

#pragma once

#include <tex/height.h>
#include <tex/types.h>

namespace tex::inline v1 {

class CurvatureRows {
public:
    // `map` must outlive this object. With `of_slopes`, p and q take the place of -x and -y.
    CurvatureRows(const NormalMap& map, bool of_slopes, Wrap wrap_x, Wrap wrap_y);

    // Computes row j into `out`, which has room for whole vectors.
    void make(int j, float* out);

private:
    // Where a value beyond the border comes from.
    struct Neighbour {
        int index;
        float sign;
    };
    static Neighbour neighbour(Wrap wrap, int i, int n);
    void load(int j, float* x, float* y) const;

    const NormalMap& map_;
    bool of_slopes_;
    Wrap wrap_x_, wrap_y_;
    float factor_x_, factor_y_;
    Plane<float> rows_;  // x and y of this row, y above, y below, and scratch
};

// Added in the order of texels.
double sum_of_squares(const float* values, int count);

}  // namespace tex::inline v1
