// SPDX-License-Identifier: Apache-2.0

#include <tex/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "blocks/extent.h"

namespace tex::inline v1 {
namespace {

constexpr SampleKind kUnorm = SampleKind::unorm;
constexpr SampleKind kSnorm = SampleKind::snorm;
constexpr SampleKind kFloat = SampleKind::floating;

struct FormatRow {
    Format format;
    FormatInfo info;
};

constexpr FormatRow blocks(Format format, SampleKind sample, int channels, std::size_t bytes, int bits = 8) {
    return {format, {sample, channels, bits, {kBlockEdge, kBlockEdge}, bytes}};
}

constexpr FormatRow astc(Format format, int width, int height) { return {format, {kUnorm, 4, 8, {width, height}, 16}}; }

constexpr FormatRow texels(Format format, SampleKind sample, int bits, int channels) {
    const auto bytes = static_cast<std::size_t>(channels * bits / 8);
    return {format, {sample, channels, bits, {1, 1}, bytes}};
}

// In the order of Format.
constexpr FormatRow kFormats[] = {
    blocks(Format::bc1_unorm, kUnorm, 4, 8),
    blocks(Format::bc2_unorm, kUnorm, 4, 16),
    blocks(Format::bc3_unorm, kUnorm, 4, 16),
    blocks(Format::bc4_unorm, kUnorm, 1, 8),
    blocks(Format::bc4_snorm, kSnorm, 1, 8),
    blocks(Format::bc5_unorm, kUnorm, 2, 16),
    blocks(Format::bc5_snorm, kSnorm, 2, 16),
    blocks(Format::bc6h_ufloat, kFloat, 3, 16, 16),
    blocks(Format::bc6h_sfloat, kFloat, 3, 16, 16),
    blocks(Format::bc7_unorm, kUnorm, 4, 16),
    blocks(Format::eac_r11_unorm, kUnorm, 1, 8, 11),
    blocks(Format::eac_r11_snorm, kSnorm, 1, 8, 11),
    blocks(Format::eac_rg11_unorm, kUnorm, 2, 16, 11),
    blocks(Format::eac_rg11_snorm, kSnorm, 2, 16, 11),
    astc(Format::astc_4x4_unorm, 4, 4),
    astc(Format::astc_5x4_unorm, 5, 4),
    astc(Format::astc_5x5_unorm, 5, 5),
    astc(Format::astc_6x5_unorm, 6, 5),
    astc(Format::astc_6x6_unorm, 6, 6),
    astc(Format::astc_8x5_unorm, 8, 5),
    astc(Format::astc_8x6_unorm, 8, 6),
    astc(Format::astc_8x8_unorm, 8, 8),
    astc(Format::astc_10x5_unorm, 10, 5),
    astc(Format::astc_10x6_unorm, 10, 6),
    astc(Format::astc_10x8_unorm, 10, 8),
    astc(Format::astc_10x10_unorm, 10, 10),
    astc(Format::astc_12x10_unorm, 12, 10),
    astc(Format::astc_12x12_unorm, 12, 12),
    texels(Format::r8_unorm, kUnorm, 8, 1),
    texels(Format::rg8_unorm, kUnorm, 8, 2),
    texels(Format::rgb8_unorm, kUnorm, 8, 3),
    texels(Format::rgba8_unorm, kUnorm, 8, 4),
    texels(Format::r8_snorm, kSnorm, 8, 1),
    texels(Format::rg8_snorm, kSnorm, 8, 2),
    texels(Format::rgba8_snorm, kSnorm, 8, 4),
    texels(Format::r16_unorm, kUnorm, 16, 1),
    texels(Format::rg16_unorm, kUnorm, 16, 2),
    texels(Format::rgb16_unorm, kUnorm, 16, 3),
    texels(Format::rgba16_unorm, kUnorm, 16, 4),
    texels(Format::r16_snorm, kSnorm, 16, 1),
    texels(Format::rg16_snorm, kSnorm, 16, 2),
    texels(Format::rgba16_snorm, kSnorm, 16, 4),
    texels(Format::r16_float, kFloat, 16, 1),
    texels(Format::rg16_float, kFloat, 16, 2),
    texels(Format::rgb16_float, kFloat, 16, 3),
    texels(Format::rgba16_float, kFloat, 16, 4),
    texels(Format::r32_float, kFloat, 32, 1),
    texels(Format::rg32_float, kFloat, 32, 2),
    texels(Format::rgb32_float, kFloat, 32, 3),
    texels(Format::rgba32_float, kFloat, 32, 4),
};

constexpr Swizzle kXyz1 = {Component::x, Component::y, Component::z, Component::one};

struct EncodingRow {
    Encoding encoding;
    EncodingInfo info;
};

// In the order of Encoding.
constexpr EncodingRow kEncodings[] = {
    {Encoding::dxt5nm, {Format::bc3_unorm, kSwizzleDxt5nm}},
    {Encoding::bc5, {Format::bc5_unorm, kSwizzleXy}},
    {Encoding::bc5_snorm, {Format::bc5_snorm, kSwizzleXy}},
    {Encoding::eac_rg11, {Format::eac_rg11_unorm, kSwizzleXy}},
    {Encoding::eac_rg11_snorm, {Format::eac_rg11_snorm, kSwizzleXy}},
    {Encoding::astc_4x4, {Format::astc_4x4_unorm, kSwizzleXxxy}},
    {Encoding::astc_5x4, {Format::astc_5x4_unorm, kSwizzleXxxy}},
    {Encoding::astc_5x5, {Format::astc_5x5_unorm, kSwizzleXxxy}},
    {Encoding::astc_6x5, {Format::astc_6x5_unorm, kSwizzleXxxy}},
    {Encoding::astc_6x6, {Format::astc_6x6_unorm, kSwizzleXxxy}},
    {Encoding::astc_8x5, {Format::astc_8x5_unorm, kSwizzleXxxy}},
    {Encoding::astc_8x6, {Format::astc_8x6_unorm, kSwizzleXxxy}},
    {Encoding::astc_8x8, {Format::astc_8x8_unorm, kSwizzleXxxy}},
    {Encoding::rgb8, {Format::rgb8_unorm, kXyz1}},
    {Encoding::rgba8, {Format::rgba8_unorm, kXyz1}},
    {Encoding::rgb16, {Format::rgb16_unorm, kXyz1}},
    {Encoding::ag8, {Format::rgba8_unorm, kSwizzleDxt5nm}},
    {Encoding::rg8, {Format::rg8_unorm, kSwizzleXy}},
    {Encoding::rg16, {Format::rg16_unorm, kSwizzleXy}},
    {Encoding::half, {Format::rgb16_float, kXyz1}},
    {Encoding::float_, {Format::rgb32_float, kXyz1}},
    {Encoding::rgba16, {Format::rgba16_unorm, kXyz1}},
    {Encoding::rgba16f, {Format::rgba16_float, kXyz1}},
    {Encoding::rgba32f, {Format::rgba32_float, kXyz1}},
};

static_assert([] {
    for (std::size_t k = 0; k < std::size(kFormats); ++k) {
        if (kFormats[k].format != static_cast<Format>(k) || kFormatNames[k].value != static_cast<Format>(k))
            return false;
    }
    for (std::size_t k = 0; k < std::size(kEncodings); ++k) {
        if (kEncodings[k].encoding != static_cast<Encoding>(k)) return false;
    }
    return std::size(kFormats) == std::size(kFormatNames) && std::size(kEncodings) == std::size(kEncodingNames);
}());

}  // namespace

FormatInfo format_info(Format format) {
    const auto at = static_cast<std::size_t>(format);
    return at < std::size(kFormats) ? kFormats[at].info : FormatInfo{SampleKind::unorm, 0, 0, {1, 1}, 0};
}

OtherPlanes can_hold(Encoding encoding) {
    const auto [format, swizzle] = encoding_info(encoding);
    const FormatInfo info = format_info(format);
    const bool has_z = swizzle[2] == Component::z;
    return {has_z, info.channels == 4 && !info.has_blocks() && swizzle[3] == Component::one, has_z};
}

bool can_optimise(Encoding encoding) { return format_info(encoding_info(encoding).format).has_blocks(); }

float steepest_slope(Encoding encoding) {
    const EncodingInfo info = encoding_info(encoding);
    const FormatInfo format = format_info(info.format);
    if (format.sample == SampleKind::floating) return std::numeric_limits<float>::infinity();
    const bool has_z = std::find(info.swizzle.begin(), info.swizzle.end(), Component::z) != info.swizzle.end();
    // In codes: the range from 0 to 1.
    const double half_range = 0.5 * (std::pow(2.0, format.bits) - (format.sample == SampleKind::snorm ? 2 : 1));
    if (has_z) return static_cast<float>(half_range);
    const double x = 1.0 - 0.5 / half_range;
    return static_cast<float>(x / std::sqrt(1.0 - x * x));
}

std::optional<Format> format_of(SampleKind sample, int bits, int channels) {
    const auto* row = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const FormatRow& r) {
        return !r.info.has_blocks() && r.info.sample == sample && r.info.bits == bits && r.info.channels == channels;
    });
    return row == std::end(kFormats) ? std::nullopt : std::optional(row->format);
}

std::size_t level_bytes(Format format, Extent extent) {
    const FormatInfo info = format_info(format);
    return static_cast<std::size_t>(blocks_across(extent.width, info.block.width)) *
           static_cast<std::size_t>(blocks_across(extent.height, info.block.height)) * info.block_bytes;
}

std::string to_string(const Swizzle& swizzle) {
    std::string letters;
    for (const Component component : swizzle) letters += name_of(kComponentNames, component);
    return letters;
}

EncodingInfo encoding_info(Encoding encoding) {
    const auto at = static_cast<std::size_t>(encoding);
    return at < std::size(kEncodings) ? kEncodings[at].info : EncodingInfo{};
}

}  // namespace tex::inline v1
