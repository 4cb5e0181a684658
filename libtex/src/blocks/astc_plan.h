// SPDX-License-Identifier: Apache-2.0
// astc_plan.h: what an encoder needs to know about the ways of storing blocks of two channels, x and y, as luminance
// and alpha, or of one channel as luminance: grids of weights and what texels make of them, the values that weights and
// endpoints can have; and writing.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "blocks/astc_mode.h"

namespace tex::inline v1 {

// Encoders write blocks of up to 8x8 texels.
inline constexpr int kAstcMostPlanned = 64;

// A share that a weight of the grid has in a texel.
struct AstcShare {
    int texel;
    float share;  // of 1
};

struct AstcGrid {
    Extent extent;
    int texels = 0, weights = 0;
    bool is_full = false;  // each texel has its own weight
    // The weights around a texel, and their shares in it in sixteenths.
    int around[kAstcMostPlanned][4];
    float infill[kAstcMostPlanned][4];
    AstcShare shares[4 * kAstcMostPlanned];  // by weight
    int begin[kAstcMostWeights + 1];         // of a weight in `shares`
    // All weights, most of them after one that shares no texel with them: a processor need not wait for that one.
    int order[kAstcMostWeights];
    float over_sum[kAstcMostWeights];      // 1 / the sum of the shares of a weight
    float over_squares[kAstcMostWeights];  // 1 / the sum of their squares
};

// The values of weights, from 0 to 64, or of endpoints, from 0 to 255.
struct AstcValues {
    float nearest[257];            // of weights to halves of 0 to 128; of endpoints to 0 to 255
    float lower[256], upper[256];  // the next values of endpoints, or the same at the ends
    std::uint8_t stored[256];      // how a value is stored
};
[[nodiscard]] const AstcValues& astc_weight_values(int range);
[[nodiscard]] const AstcValues& astc_color_values(int range);

// The endpoints of a base and an offset: the base has steps of half those of a value, and so has the offset, which is
// from -32 to 31. The highest bit of the base stands in the value of the offset, so that the offsets from bases of 128
// and more are not those from others.
struct AstcOffsets {
    float nearest[256], lower[256], upper[256];  // bases, as endpoints in AstcValues
    // Offsets stand at 32 + offset, and 64 places farther for bases from 128.
    float nearest_offset[128], lower_offset[128], upper_offset[128];
    std::uint8_t stored_base[128];       // by the lower 7 bits of the base
    std::int16_t stored_offset[2 * 64];  // by the place of the offset: the next lower one that can be stored, or -1

    static int place(int base, int offset) { return 32 + offset + (base >= 128 ? 64 : 0); }
};
[[nodiscard]] const AstcOffsets& astc_color_offsets(int range);

struct AstcPlan {
    AstcMode mode;
    unsigned mode_bits = 0;
    int partitions = 1;
    int channels = 2;
    int color_range = 0;
    const AstcGrid* grid = nullptr;
    const AstcValues* weights = nullptr;
    const AstcValues* colors = nullptr;
    const AstcOffsets* offsets = nullptr;  // of two channels
    bool is_mixed = false;                 // some partitions may have bases and offsets and others not
    int mixed = -1;                        // the plan that differs in this alone, if there is one
};

// A way to divide the texels of a block into two or three partitions, none of them empty.
struct AstcPattern {
    unsigned index;
    std::uint64_t later[2];  // a bit for each texel: whether it is in the second one; in the third one
};

// All ways to store blocks of a size. No two patterns divide the texels alike.
struct AstcPlans {
    Extent block;
    int channels = 2;
    std::vector<std::unique_ptr<AstcGrid>> grids;
    std::vector<AstcPlan> plans;           // mixed ones last
    std::vector<AstcPattern> patterns[2];  // of two partitions; of three
};

// Made at the first call for a size and one or two channels. Throws std::bad_alloc.
[[nodiscard]] const AstcPlans& astc_plans(Extent block, int channels = 2);

// What a block of a plan holds.
struct AstcContent {
    std::uint8_t weights[2][kAstcMostWeights];  // by plane; 0 to 64
    std::uint8_t ends[3][2][2];                 // by partition and channel (x, y): the endpoints
    unsigned pattern = 0;                       // the index of the partition
    unsigned offsets = 0;  // a bit for each partition: whether its endpoints are stored as bases and offsets
};

void write_astc(const AstcPlan& plan, const AstcContent& content, std::byte* block);

}  // namespace tex::inline v1
