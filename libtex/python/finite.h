// SPDX-License-Identifier: Apache-2.0
// finite.h: checks that arrays hold numbers only, and normals.

#pragma once

#include <tex/types.h>

namespace tex::python {

// Whether no texel is infinite or NaN.
[[nodiscard]] bool is_finite(PlaneView<const float> plane);

// Whether no x or y is below 0, and the values are of about unit length as colours, (n + 1) / 2, but not as components.
// Texels that are not finite do not count.
[[nodiscard]] bool looks_like_colours(const NormalMap& map);

}  // namespace tex::python
