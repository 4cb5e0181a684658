// SPDX-License-Identifier: Apache-2.0
// eac_fit.h: the quick encoder of EAC blocks, with one block in each lane of 16 bits.
//
// Ten tables are tried, each with the multiplier that suits the block's range and with the base whose palette stands
// in the middle of the range (eac_fit.cpp), then the two bases beside that of the best one; the palette with the least
// sum of distances is kept. Values are in units of 1/16 of a code of 11 bits, and all sums are whole numbers, so the
// result does not depend on the instruction set, nor on the other blocks.

#pragma once

#include <cstddef>

#include "blocks/eac.h"
#include "kernels/fit.h"

namespace tex::inline v1 {

// Fits `count` blocks that lie entirely in the rows, and writes 16 bytes for each: EAC RG11 from x and y.
void fit_eac_blocks(const FitRows& x, const FitRows& y, int count, EacCodes codes, std::byte* blocks);

}  // namespace tex::inline v1
