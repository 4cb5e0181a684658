// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_expand.h"

#include <algorithm>
#include <cstring>

namespace tex::inline v1 {
namespace {

// Texel i of less than 8 bits, or of 8: the first is in the highest bits of a byte.
unsigned index_at(const std::uint8_t* row, std::size_t i, unsigned bits) {
    const std::size_t at = i * bits;
    return row[at / 8] >> (8 - bits - at % 8) & ((1u << bits) - 1);
}

void expand_palette(const PngKind& kind, const std::uint8_t* row, std::size_t width, std::uint8_t* out) {
    const auto bits = static_cast<unsigned>(kind.bit_depth);
    const std::size_t channels = kind.has_transparency ? 4 : 3;
    for (std::size_t i = 0; i < width; ++i, out += channels) {
        std::memcpy(out, kind.palette[bits == 8 ? row[i] : index_at(row, i, bits)].data(), channels);
    }
}

void expand_grey(const PngKind& kind, const std::uint8_t* row, std::size_t width, std::uint8_t* out) {
    const auto bits = static_cast<unsigned>(kind.bit_depth);
    const unsigned top = (1u << bits) - 1, factor = 255 / top;
    for (std::size_t i = 0; i < width; ++i) {
        const unsigned code = index_at(row, i, bits);
        *out++ = static_cast<std::uint8_t>(code * factor);
        if (kind.has_transparency) *out++ = code == (kind.hidden[0] & top) ? 0 : 255;
    }
}

// Texels of whole bytes, and alpha.
void add_alpha(const PngKind& kind, const std::uint8_t* row, std::size_t width, std::uint8_t* out) {
    const std::size_t sample = static_cast<std::size_t>(kind.bit_depth) / 8;
    const std::size_t texel = static_cast<std::size_t>(kind.channels) * sample;
    std::uint8_t hidden[6] = {};
    for (std::size_t k = 0; k < texel; ++k) {
        const unsigned code = kind.hidden[k / sample];
        hidden[k] = static_cast<std::uint8_t>(sample == 2 && k % 2 == 0 ? code >> 8 : code);
    }
    for (std::size_t i = 0; i < width; ++i, row += texel, out += texel + sample) {
        std::memcpy(out, row, texel);
        std::memset(out + texel, std::equal(hidden, hidden + texel, row) ? 0 : 255, sample);
    }
}

}  // namespace

void expand_png_row(const PngKind& kind, const std::uint8_t* row, std::size_t width, std::uint8_t* out) {
    if (kind.is_expanded()) {
        std::memcpy(out, row, kind.row_bytes(width));
    } else if (kind.is_palette) {
        expand_palette(kind, row, width, out);
    } else if (kind.bit_depth < 8) {
        expand_grey(kind, row, width, out);
    } else {
        add_alpha(kind, row, width, out);
    }
}

}  // namespace tex::inline v1
