// SPDX-License-Identifier: Apache-2.0
// astc_decode.h: decodes one block of ASTC of two dimensions and low dynamic range, in exact integers. (Khronos Data
// Format Specification 1.3, "ASTC Compressed Texture Image Formats".)

#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <tex/format.h>

#include "blocks/astc_mode.h"

namespace tex::inline v1 {

// The texels of a block in rows of its width. The pointers of channels (R, G, B, A) that are not needed are null.
struct AstcTexels {
    float* channel[4] = {};
};

// The value of 16 bits, from 0 to 65535, that interpolation gives, as a float: the greatest half that is not above
// code / 65536, and 1 for the last code.
[[nodiscard]] inline float astc_value(int code) {
    // Halves of at least 2^-14 have 11 significant bits; below, all codes are halves.
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(code)) & 0xffffe000u;
    return code == 0xffff ? 1.0f : std::bit_cast<float>(bits) * (1.0f / 65536.0f);
}

// Any 16 bytes decode. Values are from 0 to 1. Blocks that are not valid, those of one colour of high dynamic range,
// and partitions with endpoints of high dynamic range become magenta (1, 0, 1, 1), as in libastcenc's profile for low
// dynamic range.
void decode_astc(Extent block, const std::byte* bytes, const AstcTexels& texels);

// The endpoints of a block: the texels of each partition lie on the line between two of them.
struct AstcLines {
    AstcMode mode;
    int partitions = 1;                            // at most 3
    std::uint8_t partition[kAstcMostTexels] = {};  // of each texel
    int ends[3][2][2] = {};                        // by partition and channel (R, A), from 0 to 255
};

// Reads them from a block that encode_astc() has written; if there are two planes of weights, the second one belongs to
// alpha. Empty for a block of one colour, which has no endpoints.
[[nodiscard]] std::optional<AstcLines> read_astc_lines(Extent block, const std::byte* bytes);

}  // namespace tex::inline v1
