// SPDX-License-Identifier: Apache-2.0
// layout_fit.h: finds the channels that hold the normals of a picture whose R, G and B are none.

#pragma once

#include <string>

#include "checks/stored.h"

namespace tex::inline v1 {

// The channels of x, y and, if it is stored, z, in the words of --swizzle: "ag", "abg". Empty if no channels fit.
//
// Alpha is x or y, as in all layouts that engines use beside R, G and B. The other is the channel whose slopes, with
// those of alpha, have least curl, as a surface has (see curl.h). z is a channel that makes unit vectors of the two.
// Precondition: the picture has R, G, B and alpha, unsigned.
[[nodiscard]] std::string fitting_layout(const Stored& stored);

// What a finding adds about them: "; A and G have the slopes of a surface, as x and y (--swizzle ag)". Empty if no
// channels fit.
[[nodiscard]] std::string fitting_layout_text(const Stored& stored);

}  // namespace tex::inline v1
