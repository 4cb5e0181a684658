// SPDX-License-Identifier: Apache-2.0
// uastc_xy_hints.h: hints for transcoders that make ETC1 of the grey of a block of UASTC, and EAC of its alpha (ETC2
// RGBA; EAC RG11). See uastc_hints.h.

#pragma once

#include <cstdint>

#include <tex/pack.h>

#include "blocks/uastc_write.h"

namespace tex::inline v1 {

// Finds those with the least squared errors; `grey` and `alpha` are what decoders make of the block. The bias is always
// the one that moves nothing. More effort tries more multipliers of EAC.
void find_uastc_xy_hints(Effort effort, const std::uint8_t grey[16], const std::uint8_t alpha[16], UastcHints& hints);

// The hints of a block of one grey.
[[nodiscard]] UastcHints grey_hints(std::uint8_t grey);

}  // namespace tex::inline v1
