// SPDX-License-Identifier: Apache-2.0
// few_values.h: maps of few colours, or of few values in each channel.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

// What a palette of 256 colours or fewer leaves of a normal map: colours that lie apart, among neighbours that lie as
// far from each other.
struct Palette {
    int colors = 0;        // 0: there is none
    double share = 0.0;    // of the texels: their colour is 3 codes or more from all others,
    double degrees = 0.0;  // and in the mean so far from the nearest one
};
// Precondition: x and y are stored.
Palette find_palette(const Stored& stored);

// The number of values that x and y take, at most, if they are codes of 8 bits that lie 4 or more from each other, as
// after a reduction to few levels; 0 if they do not.
int few_levels(const Stored& stored);

}  // namespace tex::inline v1
