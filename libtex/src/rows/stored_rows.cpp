// SPDX-License-Identifier: Apache-2.0

#include "rows/stored_rows.h"

#include <algorithm>

#include "rows/decode_rows.h"

namespace tex::inline v1 {

void StoredRows::decode(int j, int i, int count, const ChannelRows& rows, std::ptrdiff_t stride) const {
    const std::byte* from = bytes + static_cast<std::size_t>(j / info.block.height) * pitch +
                            static_cast<std::size_t>(i / info.block.width) * info.block_bytes;
    decode_row(format, from, count, rows, stride);
}

// Whole blocks go directly to the caller's rows, what is left through the stack.
void StoredRows::decode_exactly(int j, float* const channels[4], std::ptrdiff_t stride) const {
    const int block = info.block.width, rows = std::min(info.block.height, height - j);
    const int direct = rows == info.block.height ? width / block * block : 0;
    bool wanted[4];
    ChannelRows to;
    for (int c = 0; c < 4; ++c) {
        wanted[c] = channels[c] != nullptr;
        to.channel[c] = wanted[c] ? channels[c] + j * stride : nullptr;
    }
    if (direct > 0) decode(j, 0, direct, to, stride);
    StripOnStack strip;
    for (int i = direct; i < width; i += kDecodeChunk) {
        const int count = std::min(kDecodeChunk, width - i);
        decode(j, i, count, strip.rows(wanted), kDecodeChunk);
        for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < rows && wanted[c]; ++r)
                std::copy_n(strip.row(c, r), count, to.channel[c] + r * stride + i);
        }
    }
}

}  // namespace tex::inline v1
