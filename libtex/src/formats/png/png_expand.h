// SPDX-License-Identifier: Apache-2.0
// png_expand.h: the kinds of texels that a PNG can have, and how they become samples of 8 or 16 bits.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// The kind of the texels, from the chunks IHDR, PLTE and tRNS.
struct PngKind {
    bool is_palette = false;
    int channels = 1;   // in the file: an index counts as one
    int bit_depth = 8;  // in the file: 1, 2, 4, 8 or 16

    using Color = std::array<std::uint8_t, 4>;  // red, green, blue, alpha
    std::array<Color, 256> palette{};           // indices without a colour are black

    bool has_transparency = false;          // there is alpha that the texels of the file do not have
    std::array<std::uint16_t, 3> hidden{};  // without a palette: the texel whose alpha is 0; grey, or red, green, blue

    // An expanded texel has:
    [[nodiscard]] int expanded_channels() const { return (is_palette ? 3 : channels) + (has_transparency ? 1 : 0); }
    [[nodiscard]] int expanded_bits() const { return bit_depth == 16 ? 16 : 8; }
    // Bytes of a row of the file.
    [[nodiscard]] std::size_t row_bytes(std::size_t width) const {
        return (width * static_cast<std::size_t>(channels * bit_depth) + 7) / 8;
    }
    // The distance of the byte to the left, for filters.
    [[nodiscard]] std::size_t filter_step() const {
        return bit_depth < 8 ? 1 : static_cast<std::size_t>(channels * bit_depth / 8);
    }
    // Whether rows of the file need no change.
    [[nodiscard]] bool is_expanded() const { return !is_palette && !has_transparency && bit_depth >= 8; }
};

// Turns a row of `width` texels without a filter into expanded texels: palettes become colours, tRNS becomes alpha, and
// grey of 1, 2 and 4 bits becomes 8 bits by multiplication (by 255, 85 or 17), so that code / 255 is still exactly
// v / (2^n - 1). Samples of 16 bits remain big-endian.
void expand_png_row(const PngKind& kind, const std::uint8_t* row, std::size_t width, std::uint8_t* out);

}  // namespace tex::inline v1
