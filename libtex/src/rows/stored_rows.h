// SPDX-License-Identifier: Apache-2.0
// stored_rows.h: decodes texels into a caller's rows, which have no room beside their texels. Allocates nothing.

#pragma once

#include <cstddef>

#include <tex/format.h>

#include "kernels/decode.h"

namespace tex::inline v1 {

// Texels that are decoded together, on the stack: whole blocks of every size, and whole vectors.
inline constexpr int kDecodeChunk = 240;

// Rows of a strip, of at most kDecodeChunk texels.
struct StripOnStack {
    static constexpr int kTallestBlock = 12;
    float values[4][kTallestBlock * kDecodeChunk];

    ChannelRows rows(const bool wanted[4]) {
        ChannelRows out;
        for (int c = 0; c < 4; ++c) out.channel[c] = wanted[c] ? values[c] : nullptr;
        return out;
    }
    float* row(int channel, int r) { return values[channel] + r * kDecodeChunk; }
};

// A level in a caller's memory.
struct StoredRows {
    const std::byte* bytes;
    std::size_t pitch;  // from a row of blocks, or of texels, to the next
    Format format;
    FormatInfo info;
    int width, height;

    // Decodes `count` texels of the strip that begins at row j, from column i on, as many rows as a block has. Their
    // rows have room for whole blocks.
    void decode(int j, int i, int count, const ChannelRows& rows, std::ptrdiff_t stride) const;

    // Decodes the strip that begins at row j into rows of exactly `width` texels; channels that are null are left out.
    void decode_exactly(int j, float* const channels[4], std::ptrdiff_t stride) const;
};

}  // namespace tex::inline v1
