// SPDX-License-Identifier: Apache-2.0
// uastc_parts.h: what a block of UASTC holds, for transcoders.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "blocks/astc_mode.h"
#include "blocks/uastc_modes.h"
#include "blocks/uastc_write.h"

namespace tex::inline v1 {

struct UastcParts {
    int mode = kUastcSolid;
    unsigned pattern_number = 0;
    const UastcPattern* pattern = nullptr;
    int second_channel = -1;  // the one that has the second plane
    UastcHints hints;
    std::uint8_t color[4] = {};               // of blocks of one colour
    std::uint8_t ends[kAstcMostColors] = {};  // codes, by subset, channel (luminance and alpha, RGB or RGBA) and end
    std::uint8_t weights[2][16] = {};         // indices, by plane

    [[nodiscard]] const UastcMode& row() const { return kUastcModeTable[mode]; }
    // The code of R, G, B or A at an end of a subset.
    [[nodiscard]] int end(int subset, int channel, int which) const {
        const int stored = row().channels == 2 ? channel / 3 : channel;
        return stored < row().channels ? ends[2 * (row().channels * subset + stored) + which] : 255;
    }
};

// Null for blocks of the mode that is reserved, and of patterns that do not exist.
[[nodiscard]] std::optional<UastcParts> read_uastc_parts(const std::byte* block);

}  // namespace tex::inline v1
