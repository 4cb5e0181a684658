// SPDX-License-Identifier: Apache-2.0
// scaled.h: finds maps that were enlarged by a whole factor, without a filter or by linear interpolation.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

struct Enlargement {
    int factor = 1;          // 1: none was found
    bool is_linear = false;  // otherwise texels were repeated
};

// Looks at 64 rows and 64 columns of x and y, for factors from 2 to 16. Repeated texels are equal within squares whose
// corners lie at multiples of the factor. Linear interpolation leaves second differences half-way between such corners
// alone; elsewhere they are below the rounding to 8 bits. A picture that was compressed afterwards shows neither.
Enlargement find_enlargement(const Stored& stored);

}  // namespace tex::inline v1
