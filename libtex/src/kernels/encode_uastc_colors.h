// SPDX-License-Identifier: Apache-2.0
// encode_uastc_colors.h: encodes values that are no directions as blocks of UASTC: R, G and B, such as occlusion,
// roughness and metalness, with the least squared error of codes.
//
// A block is fitted in the modes of RGB and, if it is grey, of luminance: one line of 8, 16 or 32 weights; lines in two
// or three subsets, as moments suggest; two planes. The best fits are improved, and the least error, as decoders make
// it, decides. Hints for transcoders follow (uastc_color_hints.h).

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/pack.h>

namespace tex::inline v1 {

// Encodes rows of blocks of 4x4 texels. `rgb` holds three values from 0 to 1 of each texel, `extent.height` rows of
// `extent.width`; others are clamped. Alpha is 1. Blocks that are partly outside repeat the last texels. A block
// depends on its texels alone. What is one colour, and a channel that is 0 or 1 in a whole block, comes back exactly.
void encode_uastc_colors(Format format, Effort effort, const float* rgb, Extent extent, std::byte* blocks);

}  // namespace tex::inline v1
