// SPDX-License-Identifier: Apache-2.0
// ground.h: elevation models that lie on the ground (Ground in tex/types.h).

#pragma once

#include <tex/height.h>

#include "rows/height_source.h"

namespace tex::inline v1 {

// Whether texel_size() is defined. Errors: bad_option.
Result<void> check_ground(const Ground& ground);

// Whether heights from this source have a unit, and not fractions of a range or the brightness of colours.
[[nodiscard]] bool have_unit(const PictureFacts& facts, const HeightSource& source);

}  // namespace tex::inline v1
