// SPDX-License-Identifier: Apache-2.0
// bc7_write.h: a block of BC7 from what it holds.

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

inline constexpr int kBc7BlockBytes = 16;

// What a block holds. The lowest bits of endpoints that a mode stores apart are part of their codes.
struct Bc7Content {
    int mode;
    unsigned partition = 0;
    unsigned rotation = 0;      // 0: none, else the channel, from 1, that alpha takes the place of
    bool is_exchanged = false;  // of mode 4: colours have the indices of 3 bits
    // By subset and channel. The channels are those before rotation.
    std::uint8_t ends[3][2][4];
    std::uint8_t color[16], alpha[16];  // indices of all texels; of alpha only in modes 4 and 5
};

// Exchanges endpoints where an index would not fit.
void write_bc7(const Bc7Content& content, std::byte* block);

}  // namespace tex::inline v1
