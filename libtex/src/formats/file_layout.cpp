// SPDX-License-Identifier: Apache-2.0

#include "formats/file_layout.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tex::inline v1 {
namespace {

// Texel bytes are copied from memory unchanged, and the files are little-endian.
static_assert(std::endian::native == std::endian::little);

// The bytes of A = 1 for a format of three channels.
std::size_t alpha_one(const FormatInfo& info, std::byte (&alpha)[4]) {
    const std::size_t bytes = static_cast<std::size_t>(info.bits) / 8;
    std::uint32_t code = info.bits == 8 ? 0xffu : 0xffffu;
    if (info.sample == SampleKind::snorm) code >>= 1;
    if (info.sample == SampleKind::floating) code = info.bits == 16 ? 0x3c00u : 0x3f800000u;
    std::memcpy(alpha, &code, sizeof code);
    return bytes;
}

}  // namespace

TextureHead head_of(const Texture& texture) {
    TextureHead head;
    head.format = texture.format;
    head.extent = texture.extent();
    head.levels = static_cast<int>(texture.levels.size());
    head.swizzle = texture.swizzle;
    head.swizzle_known = texture.swizzle_known;
    head.y_axis = texture.y_axis;
    head.y_known = texture.y_known;
    head.bumpiness_x = texture.bumpiness_x;
    head.bumpiness_y = texture.bumpiness_y;
    return head;
}

Format widened(Format format) {
    const FormatInfo info = format_info(format);
    return info.channels == 3 && info.bits > 8 ? *format_of(info.sample, info.bits, 4) : format;
}

std::size_t stored_block_bytes(Format format, Rearrange rearrange) {
    const std::size_t bytes = format_info(format).block_bytes;
    return rearrange == Rearrange::widen ? bytes / 3 * 4 : bytes;
}

std::size_t stored_level_bytes(Format format, Extent extent, Rearrange rearrange) {
    return level_bytes(format, extent) / format_info(format).block_bytes * stored_block_bytes(format, rearrange);
}

void rearrange_texels(Format format, Rearrange rearrange, const std::byte* source, std::size_t texels,
                      std::byte* target) {
    const FormatInfo info = format_info(format);
    const std::size_t from = info.block_bytes;
    switch (rearrange) {
        case Rearrange::none: std::memcpy(target, source, texels * from); break;
        case Rearrange::widen: {
            std::byte alpha[4];
            const std::size_t channel = alpha_one(info, alpha);
            for (std::size_t i = 0; i < texels; ++i, source += from, target += from + channel) {
                std::memcpy(target, source, from);
                std::memcpy(target + from, alpha, channel);
            }
            break;
        }
        case Rearrange::bgr:
            for (std::size_t i = 0; i < texels; ++i, source += from, target += from) {
                target[0] = source[2];
                target[1] = source[1];
                target[2] = source[0];
                if (from == 4) target[3] = source[3];
            }
            break;
    }
}

std::vector<std::byte> assemble(const Texture& texture, const FileLayout& layout) {
    std::vector<std::byte> file(layout.size);
    std::copy(layout.head.begin(), layout.head.end(), file.begin());
    const std::size_t block_bytes = format_info(texture.format).block_bytes;
    for (std::size_t k = 0; k < layout.levels.size(); ++k) {
        const std::vector<std::byte>& bytes = texture.levels[k].bytes;
        rearrange_texels(texture.format, layout.rearrange, bytes.data(), bytes.size() / block_bytes,
                         file.data() + layout.levels[k].offset);
    }
    return file;
}

}  // namespace tex::inline v1
