// SPDX-License-Identifier: Apache-2.0
// astc_mode.h: how a block of ASTC is divided: a grid of weights, which texels interpolate, and partitions of the
// texels, each with its own endpoints. (Khronos Data Format Specification 1.3: "Block Mode", "Weight Infill",
// "Partition Pattern Generation".)

#pragma once

#include <cstdint>
#include <optional>

#include <tex/types.h>

namespace tex::inline v1 {

inline constexpr int kAstcBlockBytes = 16;
inline constexpr int kAstcMostTexels = 144;
inline constexpr int kAstcMostWeights = 64;
inline constexpr int kAstcLeastWeightBits = 24;
inline constexpr int kAstcMostWeightBits = 96;
inline constexpr int kAstcMostColors = 18;  // values of endpoints
inline constexpr int kAstcModeBits = 11;
inline constexpr unsigned kAstcVoid = 0x1fc;  // the lowest 9 bits of a block of one colour

// The weights of a block.
struct AstcMode {
    Extent grid{1, 1};
    int planes = 1;  // with two, a chosen channel has its own weights
    int range = 0;   // of kAstcRangeTable

    [[nodiscard]] int weights() const { return grid.width * grid.height * planes; }
    [[nodiscard]] int weight_bits() const;
};

// The mode that these 11 bits mean for blocks of this size, if it is valid. Not for kAstcVoid.
[[nodiscard]] std::optional<AstcMode> astc_mode(unsigned bits, Extent block);

// Where one texel stands between the weights of a grid, along one axis.
struct AstcInfill {
    int first;  // the weight before it
    int part;   // sixteenths of the way to the next one
};
constexpr AstcInfill astc_infill(int texel, int texels, int weights) {
    const int step = (1024 + texels / 2) / (texels - 1);
    const int at = (step * texel * (weights - 1) + 32) >> 6;
    return {at >> 4, at & 15};
}

// The shares, in sixteenths, that the weight before a texel on both axes, its right, its lower and its diagonal
// neighbours have in the weight of the texel.
struct AstcShares {
    int share[4];
};
constexpr AstcShares astc_shares(int part_x, int part_y) {
    const int both = (part_x * part_y + 8) >> 4;
    return {{16 - part_x - part_y + both, part_x - both, part_y - both, both}};
}

// The partitions, 0 to `count` - 1, of the texels of a block, in rows. `index` is of 10 bits.
void astc_partitions(Extent block, int count, unsigned index, std::uint8_t* of_texels);

}  // namespace tex::inline v1
