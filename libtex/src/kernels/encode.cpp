// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "kernels/bc4_search.h"
#include "kernels/clusters.h"
#include "kernels/fit.h"
#include "kernels/green_search.h"
#include "kernels/six_values.h"

namespace tex::inline v1 {
namespace {

// The number of blocks that are encoded together.
constexpr int kRun = 64;

// One channel of a row of blocks.
struct Channel {
    const float* const* rows;
    int width;
    int height;
    bool negate;

    [[nodiscard]] int blocks() const { return blocks_across(width); }
    // The number of blocks that lie entirely in the level. All others are searched, because fits weight all texels
    // equally.
    [[nodiscard]] int whole_blocks() const { return height == kBlockEdge ? width / kBlockEdge : 0; }

    // A quick test whether a whole block may have the lowest or the greatest code.
    [[nodiscard]] bool reaches_extremes(int block) const {
        float most = 0.0f;
        for (int k = 0; k < kBlockTexels; ++k)
            most = std::max(most, std::abs(rows[k / kBlockEdge][kBlockEdge * block + k % kBlockEdge]));
        return most > 0.9999f;
    }

    [[nodiscard]] BlockTexels texels(int block, int top) const {
        BlockTexels texels;
        texels.mask = 0;
        for (int k = 0; k < kBlockTexels; ++k) {
            const int i = kBlockEdge * block + k % kBlockEdge;
            const float n = rows[k / kBlockEdge][std::min(i, width - 1)];
            texels.values[k] = to_code_units(negate ? -n : n, top);
            if (i < width && k / kBlockEdge < height) texels.mask |= 1u << k;
        }
        return texels;
    }
};

Channel channel_x(const BlockRow& row) { return {row.x, row.width, row.height, false}; }
Channel channel_y(const BlockRow& row) { return {row.y, row.width, row.height, row.negate_y}; }

// Whether a block that was decoded before may have had 6 values and the lowest or the greatest code: it has one of
// these codes, and up to eight values.
bool may_have_six_values(const BlockTexels& texels, int top) {
    const auto [least, greatest] = std::minmax_element(texels.values, texels.values + kBlockTexels);
    if (*least == *greatest || (*least != 0 && *greatest != top * kCodeUnit)) return false;
    std::int32_t values[8];
    int count = 0;
    for (const std::int32_t value : texels.values) {
        if (std::find(values, values + count, value) != values + count) continue;
        if (count == 8) return false;
        values[count++] = value;
    }
    return true;
}

// Searches for the optimum of the blocks from `first` on.
template <class Endpoints, class Search, class Write>
void search_blocks(const Channel& channel, int first, int top, Search search, Write write, std::byte* blocks) {
    BlockTexels texels[kRun];
    ClusterBounds bounds[kRun];
    Endpoints endpoints[kRun];
    int at[kRun];
    int count = 0;
    for (int block = first; block < channel.blocks(); ++block) {
        texels[count] = channel.texels(block, top);
        at[count++] = block;
    }
    if (count == 0) return;
    cluster_bounds(texels, count, bounds);
    search(texels, bounds, count, endpoints);
    for (int k = 0; k < count; ++k) write(texels[k], endpoints[k], blocks + 16 * std::ptrdiff_t{at[k]});
}

// Improves the first `count` blocks, which have been fitted, where palettes of 6 values are better.
void try_six_values(const Channel& channel, Bc4Codes codes, int count, std::byte* blocks) {
    for (int index = 0; index < count; ++index) {
        if (!channel.reaches_extremes(index)) continue;
        const BlockTexels texels = channel.texels(index, codes.top);
        if (!may_have_six_values(texels, codes.top)) continue;
        std::byte* const block = blocks + 16 * std::ptrdiff_t{index};
        const auto code = [&](int k) { return (std::to_integer<int>(block[k]) + codes.bias) & 0xFF; };
        const Bc4Endpoints fitted{code(0), code(1)};
        const Bc4Endpoints best = with_six_values(texels, codes, fitted);
        if (best.e0 != fitted.e0 || best.e1 != fitted.e1) write_bc4(texels, codes, best, block);
    }
}

void search_bc4(const Channel& channel, Bc4Codes codes, int first, std::byte* blocks) {
    search_blocks<Bc4Endpoints>(
        channel, first, codes.top,
        [&](const BlockTexels* texels, const ClusterBounds* bounds, int count, Bc4Endpoints* endpoints) {
            search_bc4_blocks(texels, bounds, count, codes, endpoints);
        },
        [&](const BlockTexels& texels, Bc4Endpoints e, std::byte* block) { write_bc4(texels, codes, e, block); },
        blocks);
}

// Calls encode(run of the row, blocks).
template <class Encode>
void for_each_run(const BlockRow& row, std::byte* blocks, Encode encode) {
    for (int first = 0; kBlockEdge * first < row.width; first += kRun) {
        BlockRow run = row;
        run.width = std::min(row.width - kBlockEdge * first, kBlockEdge * kRun);
        for (int k = 0; k < kBlockEdge; ++k) {
            run.x[k] += kBlockEdge * std::ptrdiff_t{first};
            run.y[k] += kBlockEdge * std::ptrdiff_t{first};
        }
        encode(run, blocks + 16 * std::ptrdiff_t{first});
    }
}

void encode_bc5(const BlockRow& row, Bc4Codes codes, Effort effort, std::byte* blocks) {
    const Channel x = channel_x(row);
    const int fitted = effort == Effort::best ? 0 : x.whole_blocks();
    const bool extremes =
        fitted > 0 && fit_bc5_blocks({row.x, false}, {row.y, row.negate_y}, fitted, codes, effort, blocks);
    const Channel y = channel_y(row);
    if (extremes) {
        try_six_values(x, codes, fitted, blocks);
        try_six_values(y, codes, fitted, blocks + 8);
    }
    if (fitted == x.blocks()) return;
    search_bc4(x, codes, fitted, blocks);
    search_bc4(y, codes, fitted, blocks + 8);
}

void encode_dxt5nm_run(const BlockRow& row, Effort effort, std::byte* blocks) {
    const Channel x = channel_x(row);
    const int fitted = effort == Effort::best ? 0 : x.whole_blocks();
    const bool extremes =
        fitted > 0 && fit_dxt5nm_blocks({row.x, false}, {row.y, row.negate_y}, fitted, effort, blocks);
    if (extremes) try_six_values(x, kBc4Unorm, fitted, blocks);
    if (fitted == x.blocks()) return;
    search_bc4(x, kBc4Unorm, fitted, blocks);
    search_blocks<GreenEndpoints>(channel_y(row), fitted, 255, search_green_blocks, write_green, blocks + 8);
}

}  // namespace

void encode_dxt5nm(const BlockRow& row, Effort effort, std::byte* blocks) {
    for_each_run(row, blocks, [&](const BlockRow& run, std::byte* to) { encode_dxt5nm_run(run, effort, to); });
}

void encode_bc5_unorm(const BlockRow& row, Effort effort, std::byte* blocks) {
    for_each_run(row, blocks, [&](const BlockRow& run, std::byte* to) { encode_bc5(run, kBc4Unorm, effort, to); });
}

void encode_bc5_snorm(const BlockRow& row, Effort effort, std::byte* blocks) {
    for_each_run(row, blocks, [&](const BlockRow& run, std::byte* to) { encode_bc5(run, kBc4Snorm, effort, to); });
}

}  // namespace tex::inline v1
