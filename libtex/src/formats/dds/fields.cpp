// SPDX-License-Identifier: Apache-2.0

#include "formats/dds/fields.h"

#include <bit>
#include <cstring>

namespace tex::inline v1 {
namespace {

// Whether `mask` is one run of bits within the first `bits` bits.
bool is_run(std::uint32_t mask, int bits) {
    const std::uint32_t run = mask >> std::countr_zero(mask);
    return (run & (run + 1)) == 0 && (mask == 0 || 32 - std::countl_zero(mask) <= bits);
}

// A field of `width` bits as a code of `bits` bits, rounded to the nearest.
std::uint32_t scale_code(std::uint32_t code, int width, int bits) {
    if (width == bits) return code;
    const std::uint64_t to = (std::uint64_t{1} << bits) - 1;
    const std::uint64_t from = (std::uint64_t{1} << width) - 1;
    return static_cast<std::uint32_t>((code * to + from / 2) / from);
}

}  // namespace

std::optional<Format> format_of(const FieldLayout& layout) {
    int channels = 0;
    bool narrow = false;
    bool wide = false;
    for (int c = 0; c < 4; ++c) {
        const std::uint32_t mask = layout.fields[static_cast<std::size_t>(c)];
        if (mask == 0) continue;
        channels = c + 1;
        const int width = std::popcount(mask);
        if (!is_run(mask, 8 * layout.texel_bytes) || width > 16) return std::nullopt;
        if (layout.snorm && width != 8 && width != 16) return std::nullopt;
        if (width != 1 && width != 2 && width != 4 && width != 8)
            wide = true;
        else
            narrow = true;
    }
    if (channels == 0 || (layout.snorm && narrow && wide)) return std::nullopt;
    if (layout.snorm && channels == 3) channels = 4;  // no format has three signed channels: add one, 1
    return format_of(layout.snorm ? SampleKind::snorm : SampleKind::unorm, wide ? 16 : 8, channels);
}

void convert_fields(const FieldLayout& layout, const std::byte* source, std::size_t texels, Format format,
                    std::byte* target) {
    const FormatInfo info = format_info(format);
    const std::size_t sample_bytes = static_cast<std::size_t>(info.bits) / 8;
    const auto channels = static_cast<std::size_t>(info.channels);
    for (std::size_t i = 0; i < texels; ++i, source += layout.texel_bytes) {
        std::uint32_t texel = 0;
        std::memcpy(&texel, source, static_cast<std::size_t>(layout.texel_bytes));
        for (std::size_t c = 0; c < channels; ++c, target += sample_bytes) {
            const std::uint32_t mask = layout.fields[c];
            std::uint32_t code = c == 3 ? (1u << info.bits) - 1 : 0;
            if (c == 3 && layout.snorm) code >>= 1;
            if (mask != 0) {
                code = (texel & mask) >> std::countr_zero(mask);
                code = scale_code(code, std::popcount(mask), info.bits);
            }
            std::memcpy(target, &code, sample_bytes);
        }
    }
}

}  // namespace tex::inline v1
