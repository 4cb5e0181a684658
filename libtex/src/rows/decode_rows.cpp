// SPDX-License-Identifier: Apache-2.0

#include "rows/decode_rows.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "blocks/astc_decode.h"
#include "blocks/bc6h.h"
#include "blocks/bc7.h"
#include "blocks/etc1s.h"
#include "blocks/extent.h"
#include "blocks/uastc.h"
#include "kernels/samples.h"
#include "rows/codecs.h"

namespace tex::inline v1 {

// Texels of BC6H and BC7 are decoded to codes, which become floats as those of formats without blocks.
void decode_row_of_bptc(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                        std::ptrdiff_t stride) {
    constexpr int kTexels = kBlockEdge * kBlockEdge;
    const FormatInfo info = format_info(format);
    const auto sample_bytes = static_cast<std::size_t>(info.bits / 8);
    const std::size_t texel_bytes = sample_bytes * static_cast<std::size_t>(info.channels);
    std::byte texels[kTexels * 8];
    for (std::ptrdiff_t at = 0; at < width; at += kBlockEdge, blocks += info.block_bytes) {
        if (format == Format::bc7_unorm) {
            std::uint8_t rgba[kTexels][4];
            decode_bc7(blocks, rgba);
            std::memcpy(texels, rgba, sizeof rgba);
        } else {
            std::uint16_t rgb[kTexels][3];
            decode_bc6h(blocks, format == Format::bc6h_sfloat, rgb);
            std::memcpy(texels, rgb, sizeof rgb);
        }
        for (std::size_t c = 0; c < static_cast<std::size_t>(info.channels); ++c) {
            if (rows.channel[c] == nullptr) continue;
            float values[kTexels];
            decode_samples(info.sample, info.bits, texels + c * sample_bytes, texel_bytes, kTexels, values);
            for (int j = 0; j < kBlockEdge; ++j)
                std::memcpy(rows.channel[c] + j * stride + at, values + j * kBlockEdge, kBlockEdge * sizeof(float));
        }
    }
}

// UASTC and ETC1S, whose codes are of 8 bits. They are collected in rows, which become floats as those of formats
// without blocks.
void decode_row_of_basis(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                         std::ptrdiff_t stride) {
    constexpr int kTexels = kBlockEdge * kBlockEdge, kAtOnce = 256;
    const FormatInfo info = format_info(format);
    std::byte collected[4][kBlockEdge][kAtOnce];
    std::uint8_t codes[4][kTexels];
    std::uint8_t* wanted[4];
    for (int c = 0; c < 4; ++c) wanted[c] = rows.channel[c] == nullptr ? nullptr : codes[c];
    for (std::ptrdiff_t first = 0; first < width; first += kAtOnce) {
        const std::ptrdiff_t count = std::min<std::ptrdiff_t>(kAtOnce, width - first);
        for (std::ptrdiff_t at = 0; at < count; at += kBlockEdge, blocks += info.block_bytes) {
            if (format == Format::uastc_4x4_unorm) {
                decode_uastc(blocks, codes);
            } else {
                decode_etc1s(blocks, wanted);
                std::uint8_t* const alpha[3] = {nullptr, wanted[3], nullptr};
                if (format == Format::etc1s_rgba_unorm) decode_etc1s(blocks + kEtc1sBlockBytes, alpha);
            }
            for (int c = 0; c < info.channels; ++c) {
                if (wanted[c] == nullptr) continue;
                for (int j = 0; j < kBlockEdge; ++j)
                    std::memcpy(collected[c][j] + at, codes[c] + j * kBlockEdge, kBlockEdge);
            }
        }
        // Rows have room for whole blocks.
        const auto samples = static_cast<int>((count + kBlockEdge - 1) / kBlockEdge * kBlockEdge);
        for (int c = 0; c < info.channels; ++c) {
            for (int j = 0; wanted[c] != nullptr && j < kBlockEdge; ++j)
                decode_samples(info.sample, info.bits, collected[c][j], 1, samples,
                               rows.channel[c] + j * stride + first);
        }
    }
}

void decode_row_of_astc(Format format, const std::byte* blocks, int width, const ChannelRows& rows,
                        std::ptrdiff_t stride) {
    const Extent block = format_info(format).block;
    float values[4][kAstcMostTexels];
    AstcTexels texels;
    for (int c = 0; c < 4; ++c) texels.channel[c] = rows.channel[c] == nullptr ? nullptr : values[c];
    for (int at = 0; at < width; at += block.width, blocks += kAstcBlockBytes) {
        decode_astc(block, blocks, texels);
        const int count = std::min(block.width, width - at);
        for (int c = 0; c < 4; ++c) {
            if (rows.channel[c] == nullptr) continue;
            for (int j = 0; j < block.height; ++j)
                std::copy_n(values[c] + j * block.width, count, rows.channel[c] + j * stride + at);
        }
    }
}

void decode_row(Format format, const std::byte* from, int width, const ChannelRows& rows, std::ptrdiff_t stride) {
    format_row(format).codec->decode(format, from, width, rows, stride);
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
        decode_row(format, level.bytes.data() + static_cast<std::size_t>(strip) * pitch, width, rows, stride);
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
        decode_row(format, level.bytes.data() + static_cast<std::size_t>(j) * pitch, width, row, stride);
    }
}

}  // namespace tex::inline v1
