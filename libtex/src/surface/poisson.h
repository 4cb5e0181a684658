// SPDX-License-Identifier: Apache-2.0
// poisson.h: solves for the heights whose differences are given, on axes that repeat or are mirrored.

#pragma once

#include <tex/types.h>

#include "memory/lent_memory.h"
#include "rows/bake_rows.h"
#include "surface/axis_transform.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

// One axis of the equation.
struct AxisOperator {
    int texels = 1;
    bool is_mirrored = false;  // else it repeats
    float ratio = 1.0f;        // the weight of the slopes along this axis; 0 on an axis of one texel
};

// Solves A h = b in place of b, where A is the sum of the squared derivatives along x and y:
//
//     A = Dx^T Dx + Dy^T Dy,    Dx = ratio_x (derivative along x) (smoothing along y),    Dy likewise
//
// b must be Dx^T p + Dy^T q of some slopes, so that h is the field whose slopes are nearest to them in the mean square
// (Frankot, Chellappa 1988). Frequencies w at which the response of the kernel is below `least_response` times that of
// the difference of neighbouring texels, 2 sin(w / 2), are left out of the result. So is the constant: of all fields
// with these slopes, h is the one with the smallest mean square.
class PoissonSolver {
public:
    PoissonSolver(const Gradient& gradient, const AxisOperator& x, const AxisOperator& y, float least_response);

    // Errors: out_of_memory, cancelled. The same bytes for every number of threads and every processor.
    [[nodiscard]] Result<void> solve(Plane<float>& b, const Execution& execution, ProgressSpan span) const;

private:
    // The squared responses to each frequency of an axis, padded to whole groups.
    struct Responses {
        WorkingVector<float> slope, smooth, ideal;
    };
    static Responses responses_of(const Gradient& gradient, const AxisOperator& axis, const AxisTransform& transform);

    void transform_rows(Plane<float>& plane, int first, bool inverse) const;
    void solve_columns(Plane<float>& plane, int first) const;

    AxisTransform x_, y_;
    Responses x_responses_, y_responses_;
    float scale_;
    float least_;
};

}  // namespace tex::inline v1
