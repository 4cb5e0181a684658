// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "blocks/eac.h"
#include "kernels/clusters.h"
#include "kernels/eac_fit.h"
#include "kernels/eac_search.h"
#include "kernels/eac_units.h"
#include "kernels/encode.h"

namespace tex::inline v1 {
namespace {

// The number of blocks that are encoded together.
constexpr int kRun = 64;
constexpr int kRunTexels = kBlockEdge * kRun;

// One channel of a run of blocks, in units of 1/kEacUnit code.
struct Units {
    std::int32_t rows[kBlockEdge][kRunTexels];
};

// Texels outside the level repeat the last one of their row.
void load(const float* const* rows, int first, int width, bool negate, int top, Units& units) {
    for (int k = 0; k < kBlockEdge; ++k) {
        std::int32_t* const row = units.rows[k];
        eac_units(rows[k] + first, width, negate, top, row);
        std::fill(row + width, row + whole_blocks(width), row[width - 1]);
    }
}

BlockTexels texels_of(const Units& units, int block, int width, int height) {
    BlockTexels texels;
    for (int k = 0; k < kBlockTexels; ++k)
        texels.values[k] = units.rows[k / kBlockEdge][kBlockEdge * block + k % kBlockEdge];
    if (kBlockEdge * (block + 1) <= width && height == kBlockEdge) return texels;
    texels.mask = 0;
    for (int k = 0; k < kBlockTexels; ++k) {
        const bool inside = kBlockEdge * block + k % kBlockEdge < width && k / kBlockEdge < height;
        texels.mask |= inside ? 1u << k : 0u;
    }
    return texels;
}

void encode_run(const Units& units, int width, int height, EacCodes codes, Effort effort, std::byte* blocks) {
    BlockTexels texels[kRun];
    ClusterBounds bounds[kRun] = {};
    const int count = blocks_across(width);
    for (int block = 0; block < count; ++block) texels[block] = texels_of(units, block, width, height);
    if (effort == Effort::best) cluster_bounds(texels, count, bounds);
    encode_eac_blocks(texels, bounds, count, codes, effort, blocks);
}

void encode_eac(const BlockRow& row, EacCodes codes, Effort effort, std::byte* blocks) {
    // Blocks that lie partly outside the level are searched at every effort, because fits weight all texels equally.
    const int fitted = effort == Effort::fast && row.height == kBlockEdge ? row.width / kBlockEdge : 0;
    if (fitted > 0) fit_eac_blocks({row.x, false}, {row.y, row.negate_y}, fitted, codes, blocks);
    Units units;
    for (int first = kBlockEdge * fitted; first < row.width; first += kRunTexels) {
        const int width = std::min(row.width - first, kRunTexels);
        std::byte* const to = blocks + 16 * std::ptrdiff_t{first / kBlockEdge};
        load(row.x, first, width, false, codes.top, units);
        encode_run(units, width, row.height, codes, effort, to);
        load(row.y, first, width, row.negate_y, codes.top, units);
        encode_run(units, width, row.height, codes, effort, to + 8);
    }
}

}  // namespace

void encode_eac_unorm(const BlockRow& row, Effort effort, std::byte* blocks) {
    encode_eac(row, kEacUnorm, effort, blocks);
}

void encode_eac_snorm(const BlockRow& row, Effort effort, std::byte* blocks) {
    encode_eac(row, kEacSnorm, effort, blocks);
}

}  // namespace tex::inline v1
