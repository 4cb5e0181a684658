// SPDX-License-Identifier: Apache-2.0

#include <tex/format.h>

namespace tex {
namespace {

constexpr FormatInfo block_info(SampleKind sample, int channels, std::size_t bytes) {
    return {sample, channels, 8, 4, bytes};
}

constexpr FormatInfo texel_info(SampleKind sample, int channels, int bits) {
    return {sample, channels, bits, 1, static_cast<std::size_t>(channels) * static_cast<std::size_t>(bits / 8)};
}

}  // namespace

FormatInfo format_info(Format format) {
    constexpr SampleKind kUnorm = SampleKind::unorm;
    constexpr SampleKind kSnorm = SampleKind::snorm;
    constexpr SampleKind kFloat = SampleKind::floating;
    switch (format) {
        case Format::bc1_unorm: return block_info(kUnorm, 4, 8);
        case Format::bc2_unorm:
        case Format::bc3_unorm: return block_info(kUnorm, 4, 16);
        case Format::bc4_unorm: return block_info(kUnorm, 1, 8);
        case Format::bc4_snorm: return block_info(kSnorm, 1, 8);
        case Format::bc5_unorm: return block_info(kUnorm, 2, 16);
        case Format::bc5_snorm: return block_info(kSnorm, 2, 16);
        case Format::r8_unorm: return texel_info(kUnorm, 1, 8);
        case Format::rg8_unorm: return texel_info(kUnorm, 2, 8);
        case Format::rgb8_unorm: return texel_info(kUnorm, 3, 8);
        case Format::rgba8_unorm: return texel_info(kUnorm, 4, 8);
        case Format::r8_snorm: return texel_info(kSnorm, 1, 8);
        case Format::rg8_snorm: return texel_info(kSnorm, 2, 8);
        case Format::rgba8_snorm: return texel_info(kSnorm, 4, 8);
        case Format::r16_unorm: return texel_info(kUnorm, 1, 16);
        case Format::rg16_unorm: return texel_info(kUnorm, 2, 16);
        case Format::rgb16_unorm: return texel_info(kUnorm, 3, 16);
        case Format::rgba16_unorm: return texel_info(kUnorm, 4, 16);
        case Format::r16_snorm: return texel_info(kSnorm, 1, 16);
        case Format::rg16_snorm: return texel_info(kSnorm, 2, 16);
        case Format::rgba16_snorm: return texel_info(kSnorm, 4, 16);
        case Format::r16_float: return texel_info(kFloat, 1, 16);
        case Format::rg16_float: return texel_info(kFloat, 2, 16);
        case Format::rgb16_float: return texel_info(kFloat, 3, 16);
        case Format::rgba16_float: return texel_info(kFloat, 4, 16);
        case Format::r32_float: return texel_info(kFloat, 1, 32);
        case Format::rg32_float: return texel_info(kFloat, 2, 32);
        case Format::rgb32_float: return texel_info(kFloat, 3, 32);
        case Format::rgba32_float: return texel_info(kFloat, 4, 32);
    }
    return {};
}

std::size_t level_bytes(Format format, Extent extent) {
    const FormatInfo info = format_info(format);
    const auto blocks = [&](int texels) {
        return (static_cast<std::size_t>(texels) + static_cast<std::size_t>(info.block) - 1) /
               static_cast<std::size_t>(info.block);
    };
    return blocks(extent.width) * blocks(extent.height) * info.block_bytes;
}

std::string to_string(const Swizzle& swizzle) {
    std::string letters;
    for (const Component component : swizzle) letters += name_of(kComponentNames, component);
    return letters;
}

EncodingInfo encoding_info(Encoding encoding) {
    constexpr Component kZero = Component::zero;
    constexpr Component kOne = Component::one;
    constexpr Component kX = Component::x;
    constexpr Component kY = Component::y;
    constexpr Component kZ = Component::z;
    switch (encoding) {
        case Encoding::dxt5nm: return {Format::bc3_unorm, {kOne, kY, kOne, kX}};
        case Encoding::bc5: return {Format::bc5_unorm, {kX, kY, kZero, kOne}};
        case Encoding::bc5_snorm: return {Format::bc5_snorm, {kX, kY, kZero, kOne}};
        case Encoding::rgb8: return {Format::rgb8_unorm, {kX, kY, kZ, kOne}};
        case Encoding::rgba8: return {Format::rgba8_unorm, {kX, kY, kZ, kOne}};
        case Encoding::rgb16: return {Format::rgb16_unorm, {kX, kY, kZ, kOne}};
        case Encoding::ag8: return {Format::rgba8_unorm, {kOne, kY, kOne, kX}};
        case Encoding::rg8: return {Format::rg8_unorm, {kX, kY, kZero, kOne}};
        case Encoding::rg16: return {Format::rg16_unorm, {kX, kY, kZero, kOne}};
        case Encoding::half: return {Format::rgb16_float, {kX, kY, kZ, kOne}};
        case Encoding::float_: return {Format::rgb32_float, {kX, kY, kZ, kOne}};
    }
    return {};
}

}  // namespace tex
