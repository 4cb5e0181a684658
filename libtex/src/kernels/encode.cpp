// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode.h"

#include <algorithm>
#include <cassert>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "kernels/angle_search.h"
#include "kernels/bc4_search.h"
#include "kernels/clusters.h"
#include "kernels/fit.h"
#include "kernels/green_search.h"

namespace tex {
namespace {

// Blocks that are searched together.
constexpr int kRun = 64;

// One channel of a row of blocks.
struct Channel {
    const float* const* rows;
    int width;
    int height;
    bool negate;

    [[nodiscard]] int blocks() const { return (width + 3) / 4; }
    // Blocks that lie whole in the level: the others are always searched, as fits weigh all texels alike.
    [[nodiscard]] int whole_blocks() const { return height == 4 ? width / 4 : 0; }

    [[nodiscard]] BlockTexels texels(int block, int top) const {
        BlockTexels texels;
        texels.mask = 0;
        for (int k = 0; k < 16; ++k) {
            const int i = 4 * block + k % 4;
            const float n = rows[k / 4][std::min(i, width - 1)];
            texels.values[k] = to_code_units(negate ? -n : n, top);
            if (i < width && k / 4 < height) texels.mask |= 1u << k;
        }
        return texels;
    }
};

Channel channel_x(const BlockRow& row) { return {row.x, row.width, row.height, false}; }
Channel channel_y(const BlockRow& row) { return {row.y, row.width, row.height, row.negate_y}; }

// The optimum of blocks [first, channel.blocks()), a run at a time.
template <class Endpoints, class Search, class Write>
void search_blocks(const Channel& channel, int first, int top, Search search, Write write, std::byte* blocks) {
    BlockTexels texels[kRun];
    ClusterBounds bounds[kRun];
    Endpoints endpoints[kRun];
    for (; first < channel.blocks(); first += kRun) {
        const int count = std::min(kRun, channel.blocks() - first);
        for (int k = 0; k < count; ++k) texels[k] = channel.texels(first + k, top);
        cluster_bounds(texels, count, bounds);
        search(texels, bounds, count, endpoints);
        for (int k = 0; k < count; ++k) write(texels[k], endpoints[k], blocks + 16 * (first + k));
    }
}

void search_bc4(const Channel& channel, Bc4Codes codes, int first, std::byte* blocks) {
    search_blocks<Bc4Endpoints>(
        channel, first, codes.top,
        [&](const BlockTexels* texels, const ClusterBounds* bounds, int count, Bc4Endpoints* endpoints) {
            search_bc4_blocks(texels, bounds, count, codes, endpoints);
        },
        [&](const BlockTexels& texels, Bc4Endpoints e, std::byte* block) { write_bc4(texels, codes, e, block); }, blocks);
}

void search_green(const Channel& channel, int first, std::byte* blocks) {
    search_blocks<GreenEndpoints>(channel, first, 255, search_green_blocks, write_green, blocks);
}

void encode_bc5(const BlockRow& row, Bc4Codes codes, Effort effort, std::byte* blocks) {
    const Channel x = channel_x(row);
    const Channel y = channel_y(row);
    const int fitted = effort == Effort::best ? 0 : x.whole_blocks();
    if (fitted > 0) fit_bc5_blocks({row.x, false}, {row.y, row.negate_y}, fitted, codes, effort, blocks);
    if (fitted == x.blocks()) return;
    search_bc4(x, codes, fitted, blocks);
    search_bc4(y, codes, fitted, blocks + 8);
}

}  // namespace

void encode_dxt5nm(const BlockRow& row, Effort effort, std::byte* blocks) {
    const Channel x = channel_x(row);
    const int fitted = effort == Effort::best ? 0 : x.whole_blocks();
    if (fitted > 0) fit_dxt5nm_blocks({row.x, false}, {row.y, row.negate_y}, fitted, effort, blocks);
    if (fitted == x.blocks()) return;
    search_bc4(x, kBc4Unorm, fitted, blocks);
    search_green(channel_y(row), fitted, blocks + 8);
}

void encode_bc5_unorm(const BlockRow& row, Effort effort, std::byte* blocks) { encode_bc5(row, kBc4Unorm, effort, blocks); }

void encode_bc5_snorm(const BlockRow& row, Effort effort, std::byte* blocks) { encode_bc5(row, kBc4Snorm, effort, blocks); }

void encode_blocks(const BlockRow& row, const PackOptions& options, std::byte* blocks) {
    switch (options.encoding) {
        case Encoding::dxt5nm: encode_dxt5nm(row, options.effort, blocks); break;
        case Encoding::bc5: encode_bc5_unorm(row, options.effort, blocks); break;
        case Encoding::bc5_snorm: encode_bc5_snorm(row, options.effort, blocks); break;
        default: assert(false && "not an encoding in blocks"); return;
    }
    if (options.effort == Effort::best && options.metric == Metric::angle) improve_angles(row, options.encoding, blocks);
}

}  // namespace tex
