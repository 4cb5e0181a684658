// SPDX-License-Identifier: Apache-2.0
// tga_header.h: what the header, the palette and the footer of a TGA say.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "files/input_file.h"

namespace tex::inline v1 {

inline constexpr std::size_t kTgaHeader = 18;
inline constexpr std::string_view kTgaSignature{"TRUEVISION-XFILE.\0", 18};
inline constexpr std::size_t kTgaFooter = 26;      // offsets of two areas, then the signature
inline constexpr std::size_t kTgaExtension = 495;  // bytes of the extension area
inline constexpr std::size_t kTgaComments = 43;    // in that area: four lines of 81 bytes, each of which ends with a 0
inline constexpr std::size_t kTgaCommentLine = 81;
inline constexpr std::size_t kTgaAlphaType = 494;

enum class TgaTexels { indices, color, grey };

struct TgaHeader {
    TgaTexels texels = TgaTexels::color;
    bool is_rle = false;
    Extent extent;
    int depth = 0;                                     // stored bits of a texel; 15 counts as 16
    bool from_top = false;                             // the first row of the file is the top one
    bool from_right = false;                           // the first texel of a row is the rightmost one
    int channels = 0;                                  // of the picture
    int bits = 8;                                      // of its samples: 5 or 8
    std::int64_t first = 0;                            // the place of the first texel
    std::uint32_t index_0 = 0;                         // the index of the first colour of the palette
    std::vector<std::array<std::uint8_t, 4>> palette;  // codes of R, G, B, A
    std::string normal_mark;

    [[nodiscard]] std::size_t texel_bytes() const { return static_cast<std::size_t>(depth / 8); }
};

// The codes of R, G, B, A of a stored colour of 16, 24 or 32 bits.
inline std::array<std::uint8_t, 4> tga_color(const std::byte* stored, int depth) {
    const auto u8 = [stored](std::size_t k) { return std::to_integer<std::uint8_t>(stored[k]); };
    if (depth == 16) {
        const int code = u8(0) | u8(1) << 8;
        const auto five = [code](int shift) { return static_cast<std::uint8_t>(code >> shift & 31); };
        return {five(10), five(5), five(0), 31};
    }
    return {u8(2), u8(1), u8(0), depth == 32 ? u8(3) : std::uint8_t{255}};
}

// Reads the header of a file whose size is known. Errors: as open_tga().
Result<TgaHeader> read_tga_header(const InputFile& file, const ReadOptions& options);

}  // namespace tex::inline v1
