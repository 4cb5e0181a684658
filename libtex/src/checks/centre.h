// SPDX-License-Identifier: Apache-2.0
// centre.h: the typical value of x and y: 1/2 in a map of a flat surface, unless it went through the sRGB curve.

#pragma once

#include "checks/background.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// Medians of the stored x and y over the sampled texels in which at least one of them is not black, so that the fill
// outside UV islands does not count; nor does the background, which may be null. Half, if no texel is left.
// Precondition: x and y are stored.
struct Centre {
    double x = 0.5, y = 0.5;
    // The larger of the distances of x and y from `value`.
    [[nodiscard]] double distance(double value) const;
};
Centre measure_centre(const Stored& stored, const Background* background = nullptr);

// IEC 61966-2-1:1999.
double srgb_encoded(double c);
double srgb_decoded(double c);

}  // namespace tex::inline v1
