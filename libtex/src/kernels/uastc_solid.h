// SPDX-License-Identifier: Apache-2.0
// uastc_solid.h: blocks of UASTC of one direction.

#pragma once

#include "blocks/uastc_write.h"

namespace tex::inline v1 {

// The block of one colour whose direction is nearest to that of a unit vector, with hints.
[[nodiscard]] UastcContent uastc_solid(const float unit[3]);

}  // namespace tex::inline v1
