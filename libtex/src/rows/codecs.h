// SPDX-License-Identifier: Apache-2.0
// codecs.h: a row for each format and one for each encoding: what it is, what decodes, encodes and optimises it, and
// its numbers in files and in C. What can be done with a format or an encoding follows from its row.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <tex/format.h>
#include <tex/pack.h>

#include "blocks/block_entries.h"
#include "blocks/block_half.h"
#include "kernels/decode.h"
#include "kernels/encode.h"

namespace tex::inline v1 {

class RdoTally;

// Encodes blocks in which all components share what a block has: see kernels/encode_astc.h, encode_bc7.h,
// encode_uastc.h and encode_uastc_colors.h.
struct WholeBlocks {
    // How many a texel has: 2 are x and y; 3 are x, y and z; 4 are these and alpha (or, with x in alpha, 1).
    int values;
    void (*encode)(Format format, Effort effort, const float* texels, Extent extent, std::byte* blocks);
    // Encodes one channel; null if there is no such encoder.
    void (*encode_values)(Format format, Effort effort, const float* values, Extent extent, std::byte* blocks);
    // Null if blocks cannot be optimised.
    void (*optimise)(const float* texels, int height, Extent level, int first, const PackOptions& options,
                     std::byte* blocks, RdoTally* tally);  // see optimise_astc_band(), optimise_rgb_band()
    void (*prepare)(Format format, Effort effort);
    bool (*is_prepared)(Format format, Effort effort);
    std::size_t (*memory)(Format format, Effort effort, int width, int rows);
    int (*rows_at_once)(Format format, int width);
    // What optimise_rgb_band() needs; null elsewhere.
    BlockEntries (*read_entries)(const std::byte* block) = nullptr;
    // Encodes R, G and B that are no directions, from 0 to 1, with an alpha of 1; null if there is no such encoder.
    void (*encode_colors)(Format format, Effort effort, const float* rgb, Extent extent, std::byte* blocks) = nullptr;
};

// What formats with the same kind of block have in common.
struct Codec {
    std::uint32_t khr_model;  // khr_df_model_e
    // Decodes the blocks (or the texels) that cover `width` texels: see decode_row().
    void (*decode)(Format format, const std::byte* from, int width, const ChannelRows& rows, std::ptrdiff_t stride);
    // Encodes blocks with a half for x and a half for y, of these kinds; null if there are none. Where a block is one
    // half, it is the first one.
    void (*encode_halves)(const BlockRow& row, Effort effort, std::byte* blocks) = nullptr;
    HalfKind halves[2] = {};
    const WholeBlocks* whole = nullptr;  // unless the encoding has its own: whole_blocks()
    bool is_written = true;              // in files
    bool has_grid = true;                // the borders of blocks show, and levels should consist of whole ones
    // The likeliest layout of normals, for files that do not state it, if it does not follow from the channels.
    std::optional<Swizzle> swizzle = {};
};

// The numbers of one registry for a format; 0 if there is none. All of them describe the same bytes.
struct FormatNumbers {
    std::uint32_t exact = 0;
    std::uint32_t srgb = 0;
    std::uint32_t typeless = 0;
};

struct FormatRow {
    Format format;
    const Codec* codec;
    FormatInfo info;
    std::uint32_t d3d9;     // D3DFORMAT, four letters or a number; 0 if Direct3D 9 lacks the format
    FormatNumbers dxgi;     // DXGI_FORMAT
    FormatNumbers vk;       // VkFormat
    FormatNumbers gl = {};  // glInternalFormat of OpenGL, for formats with blocks
};
[[nodiscard]] const FormatRow& format_row(Format format);

[[nodiscard]] inline const Codec& codec_of(Encoding encoding) {
    return *format_row(encoding_info(encoding).format).codec;
}
// How blocks of this encoding are written; null if they have halves, or if it has none.
[[nodiscard]] const WholeBlocks* whole_blocks(Encoding encoding);

// The format that a number identifies, and whether the number declares sRGB; nullopt for unknown numbers.
struct MarkedFormat {
    Format format;
    bool srgb;
};
[[nodiscard]] std::optional<MarkedFormat> find_format(FormatNumbers FormatRow::*registry, std::uint32_t number);

// Whether blocks of the format are those of Basis Universal: UASTC, ETC1S.
[[nodiscard]] bool has_basis_blocks(Format format);

// Encodes a row of blocks of halves with all options that concern blocks: effort and, except in EAC, metric.
void encode_blocks(const BlockRow& row, const PackOptions& options, std::byte* blocks);

// The four bytes of a FourCC as DDS stores it: fourcc("DXT5").
constexpr std::uint32_t fourcc(const char (&text)[5]) {
    std::uint32_t code = 0;
    for (int k = 3; k >= 0; --k) code = code << 8 | static_cast<unsigned char>(text[k]);
    return code;
}

// D3DFORMATs of texels that are described by masks.
inline constexpr std::uint32_t kD3dR8G8B8 = 20;
inline constexpr std::uint32_t kD3dA8R8G8B8 = 21;
inline constexpr std::uint32_t kD3dL8 = 50;
inline constexpr std::uint32_t kD3dL16 = 81;

// From khr_df.h of the Khronos Data Format Specification.
inline constexpr std::uint32_t kKhrRgbsda = 1;
inline constexpr std::uint32_t kKhrBc1 = 128;
inline constexpr std::uint32_t kKhrBc2 = 129;
inline constexpr std::uint32_t kKhrBc3 = 130;
inline constexpr std::uint32_t kKhrBc4 = 131;
inline constexpr std::uint32_t kKhrBc5 = 132;
inline constexpr std::uint32_t kKhrBc6h = 133;
inline constexpr std::uint32_t kKhrBc7 = 134;
inline constexpr std::uint32_t kKhrEtc2 = 161;  // including EAC
inline constexpr std::uint32_t kKhrAstc = 162;
inline constexpr std::uint32_t kKhrEtc1s = 163;
inline constexpr std::uint32_t kKhrUastc = 166;  // of low dynamic range

}  // namespace tex::inline v1
