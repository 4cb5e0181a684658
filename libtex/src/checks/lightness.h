// SPDX-License-Identifier: Apache-2.0
// lightness.h: the lightness of colours (HSL), which image editors multiply while hue and saturation stay.

#pragma once

#include <array>

namespace tex::inline v1 {

// A colour whose lightness, the mean of its largest and its least channel, is multiplied by `by`.
std::array<double, 3> with_lightness(const std::array<double, 3>& color, double by);

}  // namespace tex::inline v1
