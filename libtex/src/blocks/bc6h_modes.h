// SPDX-License-Identifier: Apache-2.0
// bc6h_modes.h: the modes of BC6H blocks, as the table of the Khronos Data Format Specification (BPTC, "Block
// descriptions for BC6H block modes") lists their bits.

#pragma once

namespace tex::inline v1 {

struct Bc6hMode {
    unsigned number;      // the lowest two bits of the block, or five if those are 2 or 3
    bool is_transformed;  // the endpoints after the first one are differences from it
    int subsets;
    int endpoint_bits;
    int delta_bits[3];  // of R, G and B of the endpoints after the first one

    // The bits after the number, lowest first: channel and endpoint, then the bits of its value. "r0:9-0" means bits 0
    // to 9, "r0:10-11" bit 11 and then bit 10. With two subsets, five bits of the partition follow; then the indices.
    const char* fields;
};

// clang-format off
inline constexpr Bc6hMode kBc6hModes[] = {
    {0, true, 2, 10, {5, 5, 5},
     "g2:4 b2:4 b3:4 r0:9-0 g0:9-0 b0:9-0 r1:4-0 g3:4 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:4-0 b3:1 b2:3-0 "
     "r2:4-0 b3:2 r3:4-0 b3:3"},
    {1, true, 2, 7, {6, 6, 6},
     "g2:5 g3:4 g3:5 r0:6-0 b3:0 b3:1 b2:4 g0:6-0 b2:5 b3:2 g2:4 b0:6-0 b3:3 b3:5 b3:4 r1:5-0 g2:3-0 "
     "g1:5-0 g3:3-0 b1:5-0 b2:3-0 r2:5-0 r3:5-0"},
    {2, true, 2, 11, {5, 4, 4},
     "r0:9-0 g0:9-0 b0:9-0 r1:4-0 r0:10 g2:3-0 g1:3-0 g0:10 b3:0 g3:3-0 b1:3-0 b0:10 b3:1 b2:3-0 "
     "r2:4-0 b3:2 r3:4-0 b3:3"},
    {6, true, 2, 11, {4, 5, 4},
     "r0:9-0 g0:9-0 b0:9-0 r1:3-0 r0:10 g3:4 g2:3-0 g1:4-0 g0:10 g3:3-0 b1:3-0 b0:10 b3:1 b2:3-0 "
     "r2:3-0 b3:0 b3:2 r3:3-0 g2:4 b3:3"},
    {10, true, 2, 11, {4, 4, 5},
     "r0:9-0 g0:9-0 b0:9-0 r1:3-0 r0:10 b2:4 g2:3-0 g1:3-0 g0:10 b3:0 g3:3-0 b1:4-0 b0:10 b2:3-0 "
     "r2:3-0 b3:1 b3:2 r3:3-0 b3:4 b3:3"},
    {14, true, 2, 9, {5, 5, 5},
     "r0:8-0 b2:4 g0:8-0 g2:4 b0:8-0 b3:4 r1:4-0 g3:4 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:4-0 b3:1 b2:3-0 "
     "r2:4-0 b3:2 r3:4-0 b3:3"},
    {18, true, 2, 8, {6, 5, 5},
     "r0:7-0 g3:4 b2:4 g0:7-0 b3:2 g2:4 b0:7-0 b3:3 b3:4 r1:5-0 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:4-0 b3:1 "
     "b2:3-0 r2:5-0 r3:5-0"},
    {22, true, 2, 8, {5, 6, 5},
     "r0:7-0 b3:0 b2:4 g0:7-0 g2:5 g2:4 b0:7-0 g3:5 b3:4 r1:4-0 g3:4 g2:3-0 g1:5-0 g3:3-0 b1:4-0 b3:1 "
     "b2:3-0 r2:4-0 b3:2 r3:4-0 b3:3"},
    {26, true, 2, 8, {5, 5, 6},
     "r0:7-0 b3:1 b2:4 g0:7-0 b2:5 g2:4 b0:7-0 b3:5 b3:4 r1:4-0 g3:4 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:5-0 "
     "b2:3-0 r2:4-0 b3:2 r3:4-0 b3:3"},
    {30, false, 2, 6, {6, 6, 6},
     "r0:5-0 g3:4 b3:0 b3:1 b2:4 g0:5-0 g2:5 b2:5 b3:2 g2:4 b0:5-0 g3:5 b3:3 b3:5 b3:4 r1:5-0 g2:3-0 "
     "g1:5-0 g3:3-0 b1:5-0 b2:3-0 r2:5-0 r3:5-0"},
    {3, false, 1, 10, {10, 10, 10},
     "r0:9-0 g0:9-0 b0:9-0 r1:9-0 g1:9-0 b1:9-0"},
    {7, true, 1, 11, {9, 9, 9},
     "r0:9-0 g0:9-0 b0:9-0 r1:8-0 r0:10 g1:8-0 g0:10 b1:8-0 b0:10"},
    {11, true, 1, 12, {8, 8, 8},
     "r0:9-0 g0:9-0 b0:9-0 r1:7-0 r0:10-11 g1:7-0 g0:10-11 b1:7-0 b0:10-11"},
    {15, true, 1, 16, {4, 4, 4},
     "r0:9-0 g0:9-0 b0:9-0 r1:3-0 r0:10-15 g1:3-0 g0:10-15 b1:3-0 b0:10-15"},
};
// clang-format on

}  // namespace tex::inline v1
