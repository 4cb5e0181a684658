// SPDX-License-Identifier: Apache-2.0
// eac_units.h: rows of components as whole numbers, for EAC's encoders.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// Converts `count` components, or their negatives, as to_eac_units() in blocks/eac.h does. Reads and writes no more.
void eac_units(const float* row, int count, bool negate, int top, std::int32_t* units);

}  // namespace tex::inline v1
