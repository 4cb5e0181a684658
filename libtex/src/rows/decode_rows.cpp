// SPDX-License-Identifier: Apache-2.0

#include "rows/decode_rows.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "blocks/astc.h"
#include "blocks/extent.h"

namespace tex {

void decode_row_of_blocks(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                          std::ptrdiff_t stride) {
    if (!is_astc(format)) return decode_blocks(format, blocks, blocks_across(width), rows, stride);
    const Extent extent{width, format_info(format).block.height};
    std::vector<float> rgba(4 * static_cast<std::size_t>(extent.texels()));
    decode_astc(format, blocks, extent, rgba.data());
    const float* from = rgba.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < width; ++i, from += 4) {
            for (int c = 0; c < 4; ++c) {
                if (rows.channel[c] != nullptr) rows.channel[c][j * stride + i] = from[c];
            }
        }
    }
}

int strip_rows_of(Format format) {
    const FormatInfo info = format_info(format);
    return info.has_blocks() ? info.block.height : kBlockEdge;
}

int strips_at_once(Extent extent, int strip_rows) { return std::max(1, (1 << 16) / (strip_rows * extent.width)); }

void decode_strip(Format format, const Level& level, int strip, const ChannelRows& rows, std::ptrdiff_t stride) {
    const int width = level.extent.width;
    const std::size_t pitch = level_bytes(format, {width, 1});  // of a row of blocks, for block formats
    if (format_info(format).has_blocks()) {
        decode_row_of_blocks(format, level.bytes.data() + static_cast<std::size_t>(strip) * pitch, width, rows, stride);
        return;
    }
    const int first = strip * kBlockEdge;
    const int end = std::min(level.extent.height, first + kBlockEdge);
    for (int j = first; j < end; ++j) {
        ChannelRows row;
        for (int c = 0; c < 4; ++c) {
            float* const channel = rows.channel[c];
            row.channel[c] = channel == nullptr ? nullptr : channel + (j - first) * stride;
        }
        decode_texels(format, level.bytes.data() + static_cast<std::size_t>(j) * pitch, width, row);
    }
}

}  // namespace tex
