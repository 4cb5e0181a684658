// SPDX-License-Identifier: Apache-2.0

#include "blocks/astc_mode.h"

#include "blocks/astc_ise.h"

namespace tex::inline v1 {
namespace {

constexpr unsigned field(unsigned bits, int at, int count) { return bits >> at & ((1u << count) - 1); }

Extent grid_of(int width, int height) { return {width, height}; }

// The specification's table of block modes for two dimensions, of which each kind has its bits of A and B.
std::optional<Extent> grid_of(unsigned bits) {
    const int a = static_cast<int>(field(bits, 5, 2));
    if (field(bits, 0, 2) != 0) {
        const int b = static_cast<int>(field(bits, 7, 2));
        switch (field(bits, 2, 2)) {
            case 0: return grid_of(b + 4, a + 2);
            case 1: return grid_of(b + 8, a + 2);
            case 2: return grid_of(a + 2, b + 8);
            default: return (b & 2) != 0 ? grid_of((b & 1) + 2, a + 2) : grid_of(a + 2, (b & 1) + 6);
        }
    }
    switch (field(bits, 7, 2)) {
        case 0: return grid_of(12, a + 2);
        case 1: return grid_of(a + 2, 12);
        case 2: return grid_of(a + 6, static_cast<int>(field(bits, 9, 2)) + 6);
        default: break;
    }
    if (a > 1) return std::nullopt;
    return a == 0 ? grid_of(6, 10) : grid_of(10, 6);
}

// A hash of 32 bits: the specification's hash52().
std::uint32_t hash_52(std::uint32_t p) {
    p ^= p >> 15;
    p -= p << 17;
    p += p << 7;
    p += p << 4;
    p ^= p >> 5;
    p += p << 16;
    p ^= p >> 7;
    p ^= p >> 3;
    p ^= p << 6;
    p ^= p >> 17;
    return p;
}

}  // namespace

int AstcMode::weight_bits() const { return astc_ise_bits(range, weights()); }

std::optional<AstcMode> astc_mode(unsigned bits, Extent block) {
    const bool is_first_kind = field(bits, 0, 2) != 0;
    if (!is_first_kind && field(bits, 2, 2) == 0) return std::nullopt;
    const std::optional<Extent> grid = grid_of(bits);
    if (!grid) return std::nullopt;
    const bool has_flags = is_first_kind || field(bits, 7, 2) != 2;  // others use their bits for the grid
    const unsigned low = (is_first_kind ? field(bits, 0, 2) : field(bits, 2, 2)) << 1 | field(bits, 4, 1);
    AstcMode mode;
    mode.grid = *grid;
    mode.range = static_cast<int>(low) - 2 + (has_flags && field(bits, 9, 1) != 0 ? 6 : 0);
    mode.planes = has_flags && field(bits, 10, 1) != 0 ? 2 : 1;
    if (grid->width > block.width || grid->height > block.height || mode.weights() > kAstcMostWeights)
        return std::nullopt;
    const int weight_bits = mode.weight_bits();
    if (weight_bits < kAstcLeastWeightBits || weight_bits > kAstcMostWeightBits) return std::nullopt;
    return mode;
}

void astc_partitions(Extent block, int count, unsigned index, std::uint8_t* of_texels) {
    const bool is_small = block.width * block.height < 31;
    const unsigned seed = index + 1024u * static_cast<unsigned>(count - 1);
    const std::uint32_t hash = hash_52(seed);
    const unsigned first = count == 3 ? 6 : 5, second = (seed & 2) != 0 ? 4 : 5;
    const unsigned shift_x = (seed & 1) != 0 ? second : first, shift_y = (seed & 1) != 0 ? first : second;
    // Lines a x + b y + c, of which the greatest, modulo 64, decides.
    unsigned x[4], y[4], at_row[4];
    for (unsigned k = 0; k < 4; ++k) {
        const unsigned p = hash >> (8 * k) & 15, q = hash >> (8 * k + 4) & 15;
        x[k] = (p * p) >> shift_x;
        y[k] = (q * q) >> shift_y;
        at_row[k] = hash >> (14 - 4 * k);
        if (is_small) {
            x[k] *= 2;
            y[k] *= 2;
        }
    }
    for (int j = 0; j < block.height; ++j) {
        unsigned at[4] = {at_row[0], at_row[1], at_row[2], at_row[3]};
        for (int i = 0; i < block.width; ++i) {
            const unsigned a = at[0] & 63, b = at[1] & 63;
            const unsigned c = count > 2 ? at[2] & 63 : 0, d = count > 3 ? at[3] & 63 : 0;
            std::uint8_t partition = 3;
            if (a >= b && a >= c && a >= d) {
                partition = 0;
            } else if (b >= c && b >= d) {
                partition = 1;
            } else if (c >= d) {
                partition = 2;
            }
            *of_texels++ = partition;
            for (int k = 0; k < 4; ++k) at[k] += x[k];
        }
        for (int k = 0; k < 4; ++k) at_row[k] += y[k];
    }
}

}  // namespace tex::inline v1
