// SPDX-License-Identifier: Apache-2.0
// finite.h: checks that arrays hold numbers only.

#pragma once

#include <tex/image.h>

namespace tex::python {

// Whether no texel is infinite or NaN.
[[nodiscard]] bool is_finite(PlaneView<const float> plane);

}  // namespace tex::python
