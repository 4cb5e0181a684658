// SPDX-License-Identifier: Apache-2.0

#include <tex/transcode.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "blocks/astc_decode.h"
#include "blocks/etc1s.h"
#include "blocks/extent.h"
#include "blocks/uastc_to.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr int kTexelsOfBlock = 16;

Format shown_format(GpuFormat format) {
    switch (format) {
        case GpuFormat::astc: return Format::rgba16_unorm;
        case GpuFormat::bc7: return Format::bc7_unorm;
        case GpuFormat::etc1: return Format::rgb8_unorm;
        default: return Format::bc1_unorm;
    }
}

// Puts the texels of a block, of `bytes` each, where they are in the level.
void put_texels(const std::byte* texels, std::size_t bytes, Extent extent, int column, int row, std::byte* level) {
    for (int k = 0; k < kTexelsOfBlock; ++k) {
        const int i = 4 * column + k % 4, j = 4 * row + k / 4;
        if (i >= extent.width || j >= extent.height) continue;
        const auto at =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i);
        std::memcpy(level + at * bytes, texels + static_cast<std::size_t>(k) * bytes, bytes);
    }
}

void show_astc(const std::byte* block, Extent extent, int column, int row, std::byte* level) {
    std::uint16_t rgba[kTexelsOfBlock][4];
    uastc_to_astc(block, rgba);
    for (auto& texel : rgba) {
        for (std::uint16_t& code : texel) code = static_cast<std::uint16_t>(65535.0f * astc_value(code) + 0.5f);
    }
    put_texels(reinterpret_cast<const std::byte*>(rgba), sizeof rgba[0], extent, column, row, level);
}

void show_etc1(Format from, const std::byte* block, Extent extent, int column, int row, std::byte* level) {
    std::uint8_t rgb[kTexelsOfBlock][3];
    if (from == Format::uastc_4x4_unorm) {
        uastc_to_etc1(block, rgb);
    } else {
        std::uint8_t codes[3][kTexelsOfBlock];
        std::uint8_t* const channels[3] = {codes[0], codes[1], codes[2]};
        decode_etc1s(block, channels);
        for (int k = 0; k < kTexelsOfBlock; ++k) {
            for (int c = 0; c < 3; ++c) rgb[k][c] = codes[c][k];
        }
    }
    put_texels(reinterpret_cast<const std::byte*>(rgb), sizeof rgb[0], extent, column, row, level);
}

// A row of blocks.
void show_row(Format from, GpuFormat format, const Level& level, int row, std::byte* out) {
    const int across = blocks_across(level.extent.width, 4);
    const std::size_t bytes = format_info(from).block_bytes;
    for (int column = 0; column < across; ++column) {
        const auto at =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(across) + static_cast<std::size_t>(column);
        const std::byte* const block = level.bytes.data() + at * bytes;
        switch (format) {
            case GpuFormat::astc: show_astc(block, level.extent, column, row, out); break;
            case GpuFormat::bc7: uastc_to_bc7(block, out + at * 16); break;
            case GpuFormat::etc1: show_etc1(from, block, level.extent, column, row, out); break;
            case GpuFormat::bc1: uastc_to_bc1(block, out + at * 8); break;
        }
    }
}

Result<void> check_transcoded(const Texture& texture, GpuFormat format) {
    const auto usable = first_error(check_usable(texture), check_known("format", kGpuFormatNames, format));
    if (!usable) return usable;
    const bool is_etc1s = texture.format == Format::etc1s_rgb_unorm || texture.format == Format::etc1s_rgba_unorm;
    const std::string name{name_of(kGpuFormatNames, format)};
    if (texture.format != Format::uastc_4x4_unorm && !is_etc1s)
        return bad_option(name + " is made of UASTC and ETC1S of Basis Universal, and this is neither");
    if (is_etc1s && format != GpuFormat::etc1)
        return bad_option("what " + name + " becomes of ETC1S is not known here, only etc1");
    const bool has_alpha = format == GpuFormat::astc || format == GpuFormat::bc7;
    if (!has_alpha && (texture.swizzle[3] == Component::x || texture.swizzle[3] == Component::y))
        return bad_option("x or y is in alpha, which " + name + " does not have");
    return {};
}

}  // namespace

Result<Texture> transcode(const Texture& texture, GpuFormat format, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Texture> {
        if (auto possible = check_transcoded(texture, format); !possible) return possible.error();
        Texture shown = texture;
        shown.format = shown_format(format);
        for (std::size_t k = 0; k < shown.levels.size(); ++k) {
            const Level& from = texture.levels[k];
            Level& to = shown.levels[k];
            to.bytes.assign(level_bytes(shown.format, from.extent), std::byte{0});
            const int rows = blocks_across(from.extent.height, 4);
            const auto done = parallel_for(execution, rows, 1, [&](int begin, int end) {
                for (int row = begin; row < end; ++row) show_row(texture.format, format, from, row, to.bytes.data());
            });
            if (!done) return done.error();
        }
        return shown;
    });
}

}  // namespace tex::inline v1
