// SPDX-License-Identifier: Apache-2.0
// height_bytes.h: heights that a picture holds in two or three channels of 8 bits.

#pragma once

#include <cstdint>

#include <tex/height.h>

#include "kernels/height_field.h"

namespace tex::inline v1 {

// Writes `count` heights. `has_numbers`: the values are 0 to 255, not 0 to 1. Returns the implausible ones
// (HeightReport). Precondition: `channel` is terrain_rgb, terrarium or rg16.
std::int64_t height_bytes_row(const ColorRow& in, HeightChannel channel, bool has_numbers, int count, float* out);

}  // namespace tex::inline v1
