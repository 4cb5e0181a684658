// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode_uastc.h"

#include <algorithm>

#include "blocks/extent.h"
#include "kernels/uastc_batch.h"

namespace tex::inline v1 {
namespace {

constexpr int kEdge = 4;

}  // namespace

int uastc_rows_at_once(Format, int width) { return std::max(1, 2 * UastcBatch::kMost / blocks_across(width, kEdge)); }

std::size_t uastc_memory(Format, Effort effort, int, int) {
    return LentMemory::taken_by(sizeof(UastcBatch)) + UastcBatch::memory(uastc_effort(effort)) + LentMemory::kStep;
}

void encode_uastc(Format, Effort effort, const float* texels, Extent extent, std::byte* blocks) {
    WorkingVector<UastcBatch> batches;  // exactly one
    batches.reserve(1);
    batches.emplace_back(uastc_effort(effort));
    UastcBatch& batch = batches.front();
    int count = 0;
    std::byte* first = blocks;
    for (int top = 0; top < extent.height; top += kEdge) {
        for (int left = 0; left < extent.width; left += kEdge) {
            float(*const to)[3] = batch.texels(count);
            for (int k = 0; k < kEdge * kEdge; ++k) {
                const int i = std::min(left + k % kEdge, extent.width - 1);
                const int j = std::min(top + k / kEdge, extent.height - 1);
                std::copy_n(texels + 3 * (static_cast<std::ptrdiff_t>(j) * extent.width + i), 3, to[k]);
            }
            if (++count < UastcBatch::kMost) continue;
            batch.encode(count, first);
            first += count * kUastcBlockBytes;
            count = 0;
        }
    }
    if (count > 0) batch.encode(count, first);
}

}  // namespace tex::inline v1
