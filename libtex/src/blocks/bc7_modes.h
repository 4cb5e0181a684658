// SPDX-License-Identifier: Apache-2.0
// bc7_modes.h: the eight modes of BC7 blocks (Khronos Data Format Specification 1.3, chapter BPTC, table "BC7 modes").

#pragma once

namespace tex::inline v1 {

// In bits of a block, but the number of subsets.
struct Bc7Mode {
    int subsets;
    int partition;
    int rotation;
    int selection;            // of the indices
    int color, alpha;         // of each endpoint and channel
    int own_p, shared_p;      // a lowest bit for each endpoint, or for each subset
    int index, second_index;  // of each texel
};

inline constexpr Bc7Mode kBc7Modes[8] = {
    {3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0}, {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
    {2, 6, 0, 0, 7, 0, 1, 0, 2, 0}, {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0},
};

}  // namespace tex::inline v1
