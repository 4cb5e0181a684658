// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode_bc7.h"

#include <algorithm>

#include "blocks/extent.h"
#include "kernels/bc7_batch.h"

namespace tex::inline v1 {
namespace {

constexpr int kEdge = 4;

// Texels of which blocks that are partly outside repeat the last ones.
struct Bc7Source {
    const float* texels;
    Extent extent;

    const float* texel(int left, int top, int k) const {
        const int i = std::min(left + k % kEdge, extent.width - 1), j = std::min(top + k / kEdge, extent.height - 1);
        return texels + 4 * (static_cast<std::ptrdiff_t>(j) * extent.width + i);
    }

    // Filters of ones leave values that are less by a rounding error.
    bool has_alpha(int left, int top) const {
        constexpr float kOne = 254.5f / 255.0f;
        for (int k = 0; k < kEdge * kEdge; ++k) {
            if (!(texel(left, top, k)[3] >= kOne)) return true;
        }
        return false;
    }
};

}  // namespace

int bc7_rows_at_once(Format, int width) { return std::max(1, 2 * Bc7Batch::kMost / blocks_across(width, kEdge)); }

std::size_t bc7_memory(Format, Effort effort, int, int) {
    return LentMemory::taken_by(sizeof(Bc7Batch)) + Bc7Batch::memory(bc7_effort(effort)) + LentMemory::kStep;
}

namespace {

// `exchanges`: red and alpha, which only modes with alpha have.
void encode_bc7_blocks(Effort effort, bool exchanges, const float* texels, Extent extent, std::byte* blocks) {
    const Bc7Source source = {texels, extent};
    WorkingVector<Bc7Batch> batches;  // exactly one
    batches.reserve(1);
    batches.emplace_back(bc7_effort(effort), exchanges);
    Bc7Batch& batch = batches.front();
    std::byte* places[Bc7Batch::kMost];
    // Blocks with data in alpha apart from the others, so that a block depends on no other one.
    for (const bool has_alpha : {false, true}) {
        int count = 0;
        std::byte* place = blocks;
        for (int top = 0; top < extent.height; top += kEdge) {
            for (int left = 0; left < extent.width; left += kEdge, place += kBc7BlockBytes) {
                if ((exchanges || source.has_alpha(left, top)) != has_alpha) continue;
                float(*const to)[4] = batch.texels(count);
                for (int k = 0; k < kEdge * kEdge; ++k) std::copy_n(source.texel(left, top, k), 4, to[k]);
                places[count++] = place;
                if (count < Bc7Batch::kMost) continue;
                batch.encode(count, has_alpha, places);
                count = 0;
            }
        }
        if (count > 0) batch.encode(count, has_alpha, places);
    }
}

}  // namespace

void encode_bc7(Format, Effort effort, const float* texels, Extent extent, std::byte* blocks) {
    encode_bc7_blocks(effort, false, texels, extent, blocks);
}

void encode_bc7_rxgb(Format, Effort effort, const float* texels, Extent extent, std::byte* blocks) {
    encode_bc7_blocks(effort, true, texels, extent, blocks);
}

}  // namespace tex::inline v1
