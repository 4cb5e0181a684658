// SPDX-License-Identifier: Apache-2.0
// height_bytes.h: heights that a picture holds in two or three channels of 8 bits.

#pragma once

#include <optional>

#include <tex/height.h>

#include "kernels/height_field.h"
#include "rows/height_source.h"

namespace tex::inline v1 {

// The height of the codes r, g and b, from 0 to 255; with `has_numbers`, rg16 and gr16 are not divided. Precondition:
// `channel` is terrain_rgb, terrarium, rg16 or gr16.
double height_of_bytes(double r, double g, double b, HeightChannel channel, bool has_numbers = true);

// Whether a place on the Earth may have this height in metres.
bool is_on_earth(double height);

// Writes `count` heights. `has_numbers`: the values are 0 to 255, not 0 to 1. Texels whose alpha is 0 become NaN;
// `alpha` may be null. Returns what is implausible (HeightReport), and the steps. Precondition: `channel` is
// terrain_rgb, terrarium, rg16 or gr16.
HeightCounts height_bytes_row(const ColorRow& in, const float* alpha, HeightChannel channel, bool has_numbers,
                              int count, float* out);

// Whether the counts of a picture show that the two bytes of rg16 or gr16 are exchanged. From texel to texel, the low
// byte of a surface varies more than the high one.
std::optional<Error> exchanged_bytes(const HeightCounts& counts, HeightChannel channel);

}  // namespace tex::inline v1
