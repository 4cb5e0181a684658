// SPDX-License-Identifier: Apache-2.0

#include "rows/decode_rows.h"

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

}  // namespace tex
