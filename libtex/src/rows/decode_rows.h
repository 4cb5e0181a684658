// SPDX-License-Identifier: Apache-2.0
// decode_rows.h: decodes a row of blocks of any format.

#pragma once

#include <cstddef>

#include <tex/format.h>

#include "kernels/decode.h"

namespace tex {

// Decodes the blocks that cover `width` texels: as many rows as a block has. Row k of a channel is at channel + k *
// stride, and needs room for whole blocks of 4x4 texels (a row of a Plane has it). Throws std::bad_alloc.
void decode_row_of_blocks(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                          std::ptrdiff_t stride);

}  // namespace tex
