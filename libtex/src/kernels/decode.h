// SPDX-License-Identifier: Apache-2.0
// decode.h: decodes rows of texels and rows of blocks to floats.

#pragma once

#include <cstddef>

#include <tex/format.h>

namespace tex::inline v1 {

// Where the channels R, G, B and A go. A pointer is null if the channel is not needed or not in the format.
struct ChannelRows {
    float* channel[4] = {};
};

// Decodes `count` texels of a format without blocks. For the values, see decode() in pack.h.
void decode_texels(Format format, const std::byte* texels, int count, const ChannelRows& rows);

// Decodes the blocks of 4x4 texels that cover `width` texels, with row k of a channel at channel + k * stride. The
// values are those of blocks/bc1.h, bc4.h and eac.h, to the last bit.
void decode_blocks(Format format, const std::byte* blocks, int width, const ChannelRows& rows, std::ptrdiff_t stride);

}  // namespace tex::inline v1
