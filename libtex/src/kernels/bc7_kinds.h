// SPDX-License-Identifier: Apache-2.0
// bc7_kinds.h: the ways in which the encoder uses the modes of BC7.

#pragma once

namespace tex::inline v1 {

// The lowest bits of endpoints.
enum class Bc7Lowest {
    none,
    ones,    // 1, so that an alpha of 255 is exact
    shared,  // one for both endpoints of a subset
    own,     // one for each endpoint
};

struct Bc7Kind {
    int mode;
    int subsets;
    int bits;  // of endpoints of colours, with the lowest one
    int levels;
    Bc7Lowest lowest;
    bool has_alpha;  // alpha is on the line
    bool is_exchanged;
    int scalar_bits, scalar_levels;  // of the second plane; 0 if there is none
};

// In this order; Bc7Batch depends on it.
enum Bc7KindNumber {
    kBc7Planes = 0,      // 3 of two planes, of which the second one has a component of the normal
    kBc7One = 3,         // one line
    kBc7Parts = 4,       // 4 of several subsets
    kBc7PartsAlpha = 8,  // two subsets with alpha
    kBc7OneAlpha = 9,    // one line with alpha
    kBc7Apart = 10,      // 3 of a line and alpha in the second plane
    kBc7Kinds = 13,
};

inline constexpr Bc7Kind kBc7KindTable[kBc7Kinds] = {
    {4, 1, 5, 4, Bc7Lowest::none, true, false, 6, 8},    {4, 1, 5, 8, Bc7Lowest::none, true, true, 6, 4},
    {5, 1, 7, 4, Bc7Lowest::none, true, false, 8, 4},    {6, 1, 8, 16, Bc7Lowest::ones, false, false, 0, 0},
    {1, 2, 7, 8, Bc7Lowest::shared, false, false, 0, 0}, {3, 2, 8, 4, Bc7Lowest::own, false, false, 0, 0},
    {0, 3, 5, 8, Bc7Lowest::own, false, false, 0, 0},    {2, 3, 5, 4, Bc7Lowest::none, false, false, 0, 0},
    {7, 2, 6, 4, Bc7Lowest::own, true, false, 0, 0},     {6, 1, 8, 16, Bc7Lowest::own, true, false, 0, 0},
    {4, 1, 5, 4, Bc7Lowest::none, false, false, 6, 8},   {4, 1, 5, 8, Bc7Lowest::none, false, true, 6, 4},
    {5, 1, 7, 4, Bc7Lowest::none, false, false, 8, 4},
};

}  // namespace tex::inline v1
