// SPDX-License-Identifier: Apache-2.0
// encode_astc.h: encodes normals as blocks of ASTC with x as luminance and y as alpha; and single channels.
//
// Each block's errors are guessed in all plans of its effort (astc_guess.h). It is fitted to those that seem best
// (astc_fit.h), together with other blocks of the same plan. The least error, as the decoder makes it, decides.

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/pack.h>

namespace tex::inline v1 {

// Encodes rows of blocks, up to 8x8 texels each. `xy` holds the texels: x and y of a normal for each, clamped to [-1,
// 1], `extent.height` rows of `extent.width` texels. Blocks that are partly outside repeat the last texels. A block
// depends on its texels alone. Throws std::bad_alloc.
//
// Without lent memory, which takes astc_memory() for at most `rows` rows of blocks at once, it comes from the heap. The
// first call for a format and an effort, or prepare_astc(), makes tables, which stay on the heap.
void encode_astc(Format format, Effort effort, const float* xy, Extent extent, std::byte* blocks);

// Encodes one channel, values from 0 to 1, as luminance: red, green and blue are equal, and alpha is 1.
void encode_astc_luminance(Format format, Effort effort, const float* luminance, Extent extent, std::byte* blocks);

void prepare_astc(Format format, Effort effort);
[[nodiscard]] bool is_astc_prepared(Format format, Effort effort);
[[nodiscard]] std::size_t astc_memory(Format format, Effort effort, int width, int rows);
// So many rows of blocks are encoded together best.
[[nodiscard]] int astc_rows_at_once(Format format, int width);

}  // namespace tex::inline v1
