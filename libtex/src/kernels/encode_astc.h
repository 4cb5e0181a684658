// SPDX-License-Identifier: Apache-2.0
// encode_astc.h: encodes normals as blocks of ASTC with x as luminance and y as alpha.
//
// Each block's errors are guessed in all plans of its effort (astc_guess.h). It is fitted to those that seem best
// (astc_fit.h), together with other blocks of the same plan. The least error, as the decoder makes it, decides.

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/pack_options.h>

namespace tex {

// Whether encode_astc() writes it: sizes up to 8x8.
[[nodiscard]] bool encodes_astc(Format format);

// Encodes rows of blocks. `xy` holds the texels: x and y of a normal for each, clamped to [-1, 1], `extent.height` rows
// of `extent.width` texels. Blocks that are partly outside repeat the last texels. A block depends on its texels alone.
// Throws std::bad_alloc.
void encode_astc(Format format, Effort effort, const float* xy, Extent extent, std::byte* blocks);

}  // namespace tex
