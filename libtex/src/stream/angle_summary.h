// SPDX-License-Identifier: Apache-2.0
// angle_summary.h: sums of the angles between two maps, from rows to an AngularError.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// Sums over one row.
struct AngleSums {
    double sum = 0.0;
    double squares = 0.0;
    float max = -1.0f;
    int max_column = 0;  // the first column with that angle
};

AngleSums sum_angles(const float* degrees, int count);

// Summarises all rows of `degrees`, whose sums are `rows`. Angles are finite and at least 0. `left_out` are zeros
// that do not count, and less than all. Errors: out_of_memory.
[[nodiscard]] Result<AngularError> summarise_angles(const Plane<float>& degrees, const std::vector<AngleSums>& rows,
                                                    std::int64_t left_out, const Execution& execution);

}  // namespace tex::inline v1
