// SPDX-License-Identifier: Apache-2.0
// uastc_color_hints.h: hints for transcoders that make ETC1 and BC1 of a block of values: those with the least squared
// error in R, G and B. See uastc_hints.h.

#pragma once

#include <cstdint>

#include <tex/pack.h>

#include "blocks/uastc_write.h"
#include "kernels/uastc_color_fit.h"

namespace tex::inline v1 {

// Sets the hints of a block that has all else.
void find_uastc_color_hints(Effort effort, const UastcColors& colors, UastcContent& content);

// The block of one colour, with hints.
[[nodiscard]] UastcContent uastc_solid_color(const std::uint8_t color[3]);

}  // namespace tex::inline v1
