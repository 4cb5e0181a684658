// SPDX-License-Identifier: Apache-2.0
// few_values.h: maps of few colours, or of few values in each channel.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

// The number of colours of a picture with a palette, 256 or less; 0 if there are more, or few texels.
int few_colors(const Stored& stored);

// The number of values that x and y take, at most, if they are codes of 8 bits that lie 4 or more from each other, as
// after a reduction to few levels; 0 if they do not.
int few_levels(const Stored& stored);

}  // namespace tex::inline v1
