// SPDX-License-Identifier: Apache-2.0
// decode_rows.h: decodes rows of texels and of blocks of any format.

#pragma once

#include <cstddef>

#include <tex/format.h>

#include "kernels/decode.h"

namespace tex::inline v1 {

// Decodes `width` texels: a row, or the blocks that cover them, as many rows as a block has. Row k of a channel is at
// channel + k * stride, and needs room for whole blocks of 4x4 texels (a row of a Plane has it).
void decode_row(Format format, const std::byte* from, int width, const ChannelRows& rows, std::ptrdiff_t stride);

// For formats of these codecs. For all other blocks, see kernels/decode.h.
void decode_row_of_bptc(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                        std::ptrdiff_t stride);
void decode_row_of_basis(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                         std::ptrdiff_t stride);
void decode_row_of_astc(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                        std::ptrdiff_t stride);

// A level is decoded strip by strip: a row of blocks, or four rows of texels in formats without blocks.
[[nodiscard]] int strip_rows_of(Format format);

// The number of strips that one thread takes at once, so that starting it pays.
[[nodiscard]] int strips_at_once(Extent extent, int strip_rows);

// Decodes the rows of strip `strip` into `rows`. The rows are `stride` apart and must have room for all rows of a
// strip, with the width rounded up to whole blocks.
void decode_strip(Format format, const Level& level, int strip, const ChannelRows& rows, std::ptrdiff_t stride);

}  // namespace tex::inline v1
