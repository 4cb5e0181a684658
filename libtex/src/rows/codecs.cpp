// SPDX-License-Identifier: Apache-2.0

#include "rows/codecs.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <tex/tex_c.h>

#include "kernels/angle_search.h"
#include "kernels/encode_astc.h"
#include "kernels/encode_bc7.h"
#include "kernels/encode_uastc.h"
#include "kernels/encode_uastc_colors.h"
#include "rows/decode_rows.h"
#include "rows/rdo_rows.h"

namespace tex::inline v1 {
namespace {

using enum Format;

constexpr SampleKind kUnorm = SampleKind::unorm;
constexpr SampleKind kSnorm = SampleKind::snorm;
constexpr SampleKind kFloat = SampleKind::floating;
constexpr Extent k4x4 = {kBlockEdge, kBlockEdge};

constexpr WholeBlocks kAstcBlocks = {
    2,           encode_astc,      encode_astc_luminance, optimise_astc_band, prepare_astc, is_astc_prepared,
    astc_memory, astc_rows_at_once};
constexpr WholeBlocks kBc7Blocks = {.values = 4,
                                    .encode = encode_bc7,
                                    .encode_values = nullptr,
                                    .optimise = optimise_rgb_band,
                                    .prepare = [](Format, Effort) {},
                                    .is_prepared = [](Format, Effort) { return true; },
                                    .memory = bc7_memory,
                                    .rows_at_once = bc7_rows_at_once,
                                    .read_entries = read_bc7_entries};
// Puts x into red, and what is there does not count.
BlockEntries read_bc7_rxgb_entries(const std::byte* block) {
    BlockEntries entries = read_bc7_entries(block);
    for (auto& code : entries.code) code[0] = std::exchange(code[3], 255);
    return entries;
}
constexpr WholeBlocks kBc7RxgbBlocks = [] {
    WholeBlocks blocks = kBc7Blocks;
    blocks.encode = encode_bc7_rxgb;
    blocks.read_entries = read_bc7_rxgb_entries;
    return blocks;
}();
constexpr WholeBlocks kUastcBlocks = {.values = 3,
                                      .encode = encode_uastc,
                                      .encode_values = nullptr,
                                      .optimise = optimise_rgb_band,
                                      .prepare = [](Format, Effort) {},
                                      .is_prepared = [](Format, Effort) { return true; },
                                      .memory = uastc_memory,
                                      .rows_at_once = uastc_rows_at_once,
                                      .read_entries = read_uastc_entries,
                                      .encode_colors = encode_uastc_colors};

constexpr WholeBlocks kUastcXyBlocks = [] {
    WholeBlocks blocks = kUastcBlocks;
    blocks.values = 2;
    blocks.encode = encode_uastc_xy;
    blocks.memory = uastc_xy_memory;
    return blocks;
}();

void decode_row_of_texels(Format format, const std::byte* texels, int width, const ChannelRows& rows, std::ptrdiff_t) {
    decode_texels(format, texels, width, rows);
}

constexpr Codec kTexels = {.khr_model = kKhrRgbsda, .decode = decode_row_of_texels, .has_grid = false};
constexpr Codec kBc1 = {kKhrBc1, decode_blocks};
constexpr Codec kBc2 = {kKhrBc2, decode_blocks};
constexpr Codec kBc3 = {.khr_model = kKhrBc3,
                        .decode = decode_blocks,
                        .encode_halves = encode_dxt5nm,
                        .halves = {HalfKind::bc4_unorm, HalfKind::green},
                        .swizzle = kSwizzleDxt5nm};
constexpr Codec kBc4 = {kKhrBc4, decode_blocks, encode_bc5_unorm, {HalfKind::bc4_unorm, HalfKind::bc4_unorm}};
constexpr Codec kBc4Snorm = {kKhrBc4, decode_blocks, encode_bc5_snorm, {HalfKind::bc4_snorm, HalfKind::bc4_snorm}};
constexpr Codec kBc5 = {kKhrBc5, decode_blocks, encode_bc5_unorm, {HalfKind::bc4_unorm, HalfKind::bc4_unorm}};
constexpr Codec kBc5Snorm = {kKhrBc5, decode_blocks, encode_bc5_snorm, {HalfKind::bc4_snorm, HalfKind::bc4_snorm}};
constexpr Codec kBc6h = {.khr_model = kKhrBc6h, .decode = decode_row_of_bptc, .is_written = false};
constexpr Codec kBc7 = {.khr_model = kKhrBc7, .decode = decode_row_of_bptc, .whole = &kBc7Blocks};
constexpr Codec kUastc = {.khr_model = kKhrUastc, .decode = decode_row_of_basis, .whole = &kUastcBlocks};
constexpr Codec kEtc1s = {.khr_model = kKhrEtc1s, .decode = decode_row_of_basis, .is_written = false};
constexpr Codec kEac = {kKhrEtc2, decode_blocks, encode_eac_unorm, {HalfKind::eac_unorm, HalfKind::eac_unorm}};
constexpr Codec kEacSnorm = {kKhrEtc2, decode_blocks, encode_eac_snorm, {HalfKind::eac_snorm, HalfKind::eac_snorm}};
constexpr Codec kAstc = {.khr_model = kKhrAstc,
                         .decode = decode_row_of_astc,
                         .whole = &kAstcBlocks,
                         .has_grid = false,
                         .swizzle = kSwizzleXxxy};
constexpr Codec kLargeAstc = {
    .khr_model = kKhrAstc, .decode = decode_row_of_astc, .has_grid = false, .swizzle = kSwizzleXxxy};

constexpr FormatInfo in_astc(int width, int height) { return {kUnorm, 4, 8, {width, height}, 16}; }

constexpr FormatInfo in_texels(SampleKind sample, int bits, int channels) {
    return {sample, channels, bits, {1, 1}, static_cast<std::size_t>(channels * bits / 8)};
}

// In the order of Format.
constexpr FormatRow kFormats[] = {
    {bc1_unorm, &kBc1, {kUnorm, 4, 8, k4x4, 8}, fourcc("DXT1"), {71, 72, 70}, {133, 134}, {0x83f1, 0x8c4d, 0x83f0}},
    {bc2_unorm, &kBc2, {kUnorm, 4, 8, k4x4, 16}, fourcc("DXT3"), {74, 75, 73}, {135, 136}, {0x83f2, 0x8c4e}},
    {bc3_unorm, &kBc3, {kUnorm, 4, 8, k4x4, 16}, fourcc("DXT5"), {77, 78, 76}, {137, 138}, {0x83f3, 0x8c4f}},
    {bc4_unorm, &kBc4, {kUnorm, 1, 8, k4x4, 8}, fourcc("ATI1"), {80, 0, 79}, {139}, {0x8dbb}},
    {bc4_snorm, &kBc4Snorm, {kSnorm, 1, 8, k4x4, 8}, fourcc("BC4S"), {81}, {140}, {0x8dbc}},
    {bc5_unorm, &kBc5, {kUnorm, 2, 8, k4x4, 16}, fourcc("ATI2"), {83, 0, 82}, {141}, {0x8dbd}},
    {bc5_snorm, &kBc5Snorm, {kSnorm, 2, 8, k4x4, 16}, fourcc("BC5S"), {84}, {142}, {0x8dbe}},
    {bc6h_ufloat, &kBc6h, {kFloat, 3, 16, k4x4, 16}, 0, {95, 0, 94}, {143}, {0x8e8f}},
    {bc6h_sfloat, &kBc6h, {kFloat, 3, 16, k4x4, 16}, 0, {96}, {144}, {0x8e8e}},
    {bc7_unorm, &kBc7, {kUnorm, 4, 8, k4x4, 16}, 0, {98, 99, 97}, {145, 146}, {0x8e8c, 0x8e8d}},
    {eac_r11_unorm, &kEac, {kUnorm, 1, 11, k4x4, 8}, 0, {}, {153}, {0x9270}},
    {eac_r11_snorm, &kEacSnorm, {kSnorm, 1, 11, k4x4, 8}, 0, {}, {154}, {0x9271}},
    {eac_rg11_unorm, &kEac, {kUnorm, 2, 11, k4x4, 16}, 0, {}, {155}, {0x9272}},
    {eac_rg11_snorm, &kEacSnorm, {kSnorm, 2, 11, k4x4, 16}, 0, {}, {156}, {0x9273}},
    {astc_4x4_unorm, &kAstc, in_astc(4, 4), 0, {}, {157, 158}, {0x93b0, 0x93d0}},
    {astc_5x4_unorm, &kAstc, in_astc(5, 4), 0, {}, {159, 160}, {0x93b1, 0x93d1}},
    {astc_5x5_unorm, &kAstc, in_astc(5, 5), 0, {}, {161, 162}, {0x93b2, 0x93d2}},
    {astc_6x5_unorm, &kAstc, in_astc(6, 5), 0, {}, {163, 164}, {0x93b3, 0x93d3}},
    {astc_6x6_unorm, &kAstc, in_astc(6, 6), 0, {}, {165, 166}, {0x93b4, 0x93d4}},
    {astc_8x5_unorm, &kAstc, in_astc(8, 5), 0, {}, {167, 168}, {0x93b5, 0x93d5}},
    {astc_8x6_unorm, &kAstc, in_astc(8, 6), 0, {}, {169, 170}, {0x93b6, 0x93d6}},
    {astc_8x8_unorm, &kAstc, in_astc(8, 8), 0, {}, {171, 172}, {0x93b7, 0x93d7}},
    {astc_10x5_unorm, &kLargeAstc, in_astc(10, 5), 0, {}, {173, 174}, {0x93b8, 0x93d8}},
    {astc_10x6_unorm, &kLargeAstc, in_astc(10, 6), 0, {}, {175, 176}, {0x93b9, 0x93d9}},
    {astc_10x8_unorm, &kLargeAstc, in_astc(10, 8), 0, {}, {177, 178}, {0x93ba, 0x93da}},
    {astc_10x10_unorm, &kLargeAstc, in_astc(10, 10), 0, {}, {179, 180}, {0x93bb, 0x93db}},
    {astc_12x10_unorm, &kLargeAstc, in_astc(12, 10), 0, {}, {181, 182}, {0x93bc, 0x93dc}},
    {astc_12x12_unorm, &kLargeAstc, in_astc(12, 12), 0, {}, {183, 184}, {0x93bd, 0x93dd}},
    {r8_unorm, &kTexels, in_texels(kUnorm, 8, 1), kD3dL8, {61, 0, 60}, {9, 15}},
    {rg8_unorm, &kTexels, in_texels(kUnorm, 8, 2), 0, {49, 0, 48}, {16, 22}},
    {rgb8_unorm, &kTexels, in_texels(kUnorm, 8, 3), kD3dR8G8B8, {}, {23, 29}},
    {rgba8_unorm, &kTexels, in_texels(kUnorm, 8, 4), kD3dA8R8G8B8, {28, 29, 27}, {37, 43}},
    {r8_snorm, &kTexels, in_texels(kSnorm, 8, 1), 0, {63}, {10}},
    {rg8_snorm, &kTexels, in_texels(kSnorm, 8, 2), 0, {51}, {17}},
    {rgba8_snorm, &kTexels, in_texels(kSnorm, 8, 4), 0, {31}, {38}},
    {r16_unorm, &kTexels, in_texels(kUnorm, 16, 1), kD3dL16, {56, 0, 53}, {70}},
    {rg16_unorm, &kTexels, in_texels(kUnorm, 16, 2), 0, {35, 0, 33}, {77}},
    {rgb16_unorm, &kTexels, in_texels(kUnorm, 16, 3), 0, {}, {84}},
    {rgba16_unorm, &kTexels, in_texels(kUnorm, 16, 4), 36, {11, 0, 9}, {91}},
    {r16_snorm, &kTexels, in_texels(kSnorm, 16, 1), 0, {58}, {71}},
    {rg16_snorm, &kTexels, in_texels(kSnorm, 16, 2), 0, {37}, {78}},
    {rgba16_snorm, &kTexels, in_texels(kSnorm, 16, 4), 110, {13}, {92}},
    {r16_float, &kTexels, in_texels(kFloat, 16, 1), 111, {54}, {76}},
    {rg16_float, &kTexels, in_texels(kFloat, 16, 2), 112, {34}, {83}},
    {rgb16_float, &kTexels, in_texels(kFloat, 16, 3), 0, {}, {90}},
    {rgba16_float, &kTexels, in_texels(kFloat, 16, 4), 113, {10}, {97}},
    {r32_float, &kTexels, in_texels(kFloat, 32, 1), 114, {41, 0, 39}, {100}},
    {rg32_float, &kTexels, in_texels(kFloat, 32, 2), 115, {16, 0, 15}, {103}},
    {rgb32_float, &kTexels, in_texels(kFloat, 32, 3), 0, {6, 0, 5}, {106}},
    {rgba32_float, &kTexels, in_texels(kFloat, 32, 4), 116, {2, 0, 1}, {109}},
    {uastc_4x4_unorm, &kUastc, {kUnorm, 4, 8, k4x4, 16}, 0, {}, {}},
    {etc1s_rgb_unorm, &kEtc1s, {kUnorm, 3, 8, k4x4, 8}, 0, {}, {}},
    {etc1s_rgba_unorm, &kEtc1s, {kUnorm, 4, 8, k4x4, 16}, 0, {}, {}},
};

constexpr Swizzle kXyz1 = {Component::x, Component::y, Component::z, Component::one};
constexpr Swizzle k1yzx = {Component::one, Component::y, Component::z, Component::x};

struct EncodingRow {
    Encoding encoding;
    int number_in_c;
    EncodingInfo info;
    const WholeBlocks* whole = nullptr;  // where its codec writes another layout
};

// In the order of Encoding.
constexpr EncodingRow kEncodings[] = {
    {Encoding::dxt5nm, TEX_ENCODING_DXT5NM, {bc3_unorm, kSwizzleDxt5nm}},
    {Encoding::bc5, TEX_ENCODING_BC5, {bc5_unorm, kSwizzleXy}},
    {Encoding::bc5_snorm, TEX_ENCODING_BC5_SNORM, {bc5_snorm, kSwizzleXy}},
    {Encoding::eac_rg11, TEX_ENCODING_EAC_RG11, {eac_rg11_unorm, kSwizzleXy}},
    {Encoding::eac_rg11_snorm, TEX_ENCODING_EAC_RG11_SNORM, {eac_rg11_snorm, kSwizzleXy}},
    {Encoding::astc_4x4, TEX_ENCODING_ASTC_4X4, {astc_4x4_unorm, kSwizzleXxxy}},
    {Encoding::astc_5x4, TEX_ENCODING_ASTC_5X4, {astc_5x4_unorm, kSwizzleXxxy}},
    {Encoding::astc_5x5, TEX_ENCODING_ASTC_5X5, {astc_5x5_unorm, kSwizzleXxxy}},
    {Encoding::astc_6x5, TEX_ENCODING_ASTC_6X5, {astc_6x5_unorm, kSwizzleXxxy}},
    {Encoding::astc_6x6, TEX_ENCODING_ASTC_6X6, {astc_6x6_unorm, kSwizzleXxxy}},
    {Encoding::astc_8x5, TEX_ENCODING_ASTC_8X5, {astc_8x5_unorm, kSwizzleXxxy}},
    {Encoding::astc_8x6, TEX_ENCODING_ASTC_8X6, {astc_8x6_unorm, kSwizzleXxxy}},
    {Encoding::astc_8x8, TEX_ENCODING_ASTC_8X8, {astc_8x8_unorm, kSwizzleXxxy}},
    {Encoding::rgb8, TEX_ENCODING_RGB8, {rgb8_unorm, kXyz1}},
    {Encoding::rgba8, TEX_ENCODING_RGBA8, {rgba8_unorm, kXyz1}},
    {Encoding::rgb16, TEX_ENCODING_RGB16, {rgb16_unorm, kXyz1}},
    {Encoding::ag8, TEX_ENCODING_AG8, {rgba8_unorm, kSwizzleDxt5nm}},
    {Encoding::rg8, TEX_ENCODING_RG8, {rg8_unorm, kSwizzleXy}},
    {Encoding::rg16, TEX_ENCODING_RG16, {rg16_unorm, kSwizzleXy}},
    {Encoding::half, TEX_ENCODING_HALF, {rgb16_float, kXyz1}},
    {Encoding::float_, TEX_ENCODING_FLOAT, {rgb32_float, kXyz1}},
    {Encoding::rgba16, TEX_ENCODING_RGBA16, {rgba16_unorm, kXyz1}},
    {Encoding::rgba16f, TEX_ENCODING_RGBA16F, {rgba16_float, kXyz1}},
    {Encoding::rgba32f, TEX_ENCODING_RGBA32F, {rgba32_float, kXyz1}},
    {Encoding::bc7, TEX_ENCODING_BC7, {bc7_unorm, kXyz1}},
    {Encoding::uastc, TEX_ENCODING_UASTC, {uastc_4x4_unorm, kXyz1}},
    {Encoding::uastc_rrrg, TEX_ENCODING_UASTC_RRRG, {uastc_4x4_unorm, kSwizzleXxxy}, &kUastcXyBlocks},
    {Encoding::bc7_rxgb, TEX_ENCODING_BC7_RXGB, {bc7_unorm, k1yzx}, &kBc7RxgbBlocks},
};

static_assert([] {
    for (std::size_t k = 0; k < std::size(kFormats); ++k) {
        if (kFormats[k].format != Format(k) || kFormatNames[k].value != Format(k)) return false;
    }
    for (std::size_t k = 0; k < std::size(kEncodings); ++k) {
        if (kEncodings[k].encoding != Encoding(k) || kEncodings[k].number_in_c != static_cast<int>(k)) return false;
    }
    return std::size(kFormats) == std::size(kFormatNames) && std::size(kEncodings) == std::size(kEncodingNames);
}());

}  // namespace

const FormatRow& format_row(Format format) { return kFormats[static_cast<std::size_t>(format)]; }

FormatInfo format_info(Format format) {
    const auto at = static_cast<std::size_t>(format);
    return at < std::size(kFormats) ? kFormats[at].info : FormatInfo{SampleKind::unorm, 0, 0, {1, 1}, 0};
}

EncodingInfo encoding_info(Encoding encoding) {
    const auto at = static_cast<std::size_t>(encoding);
    return at < std::size(kEncodings) ? kEncodings[at].info : EncodingInfo{};
}

const WholeBlocks* whole_blocks(Encoding encoding) {
    const WholeBlocks* const own = kEncodings[static_cast<std::size_t>(encoding)].whole;
    return own != nullptr ? own : codec_of(encoding).whole;
}

std::optional<Format> format_of(SampleKind sample, int bits, int channels) {
    const auto* row = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const FormatRow& r) {
        return !r.info.has_blocks() && r.info.sample == sample && r.info.bits == bits && r.info.channels == channels;
    });
    return row == std::end(kFormats) ? std::nullopt : std::optional(row->format);
}

std::optional<MarkedFormat> find_format(FormatNumbers FormatRow::*registry, std::uint32_t number) {
    for (const FormatRow& row : kFormats) {
        const FormatNumbers& numbers = row.*registry;
        if (number == 0) break;
        if (number == numbers.exact || number == numbers.typeless) return MarkedFormat{row.format, false};
        if (number == numbers.srgb) return MarkedFormat{row.format, true};
    }
    return std::nullopt;
}

bool has_basis_blocks(Format format) {
    const std::uint32_t model = format_row(format).codec->khr_model;
    return model == kKhrUastc || model == kKhrEtc1s;
}

void encode_blocks(const BlockRow& row, const PackOptions& options, std::byte* blocks) {
    const Codec& codec = codec_of(options.encoding);
    codec.encode_halves(row, options.effort, blocks);
    if (options.effort == Effort::best && options.metric == Metric::angle && !keeps_slope(codec.halves[0]))
        improve_angles(row, codec.halves, kAngleReach, blocks);
}

}  // namespace tex::inline v1
