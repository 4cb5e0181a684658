// SPDX-License-Identifier: Apache-2.0
// bc7_lines.h: fits endpoints and indices of BC7 on lines.

#pragma once

#include "kernels/bc7_fit.h"

namespace tex::inline v1 {

// Lines through x, y, z, and alpha if the kind has it and `has_alpha` is set.
void fit_bc7_lines(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group);

}  // namespace tex::inline v1
