// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode_uastc.h"

#include <algorithm>
#include <cmath>

#include "blocks/extent.h"
#include "kernels/uastc_batch.h"
#include "kernels/uastc_xy_batch.h"

namespace tex::inline v1 {
namespace {

constexpr int kEdge = 4;

// `read` makes the vector of a texel of so many values.
template <class Batch, class Spends, class Read>
void encode_batches(const Spends& spends, int values, const float* texels, Extent extent, std::byte* blocks,
                    const Read& read) {
    WorkingVector<Batch> batches;  // exactly one
    batches.reserve(1);
    batches.emplace_back(spends);
    Batch& batch = batches.front();
    int count = 0;
    for (int top = 0; top < extent.height; top += kEdge) {
        for (int left = 0; left < extent.width; left += kEdge) {
            float(*const to)[3] = batch.texels(count);
            for (int k = 0; k < kEdge * kEdge; ++k) {
                const int i = std::min(left + k % kEdge, extent.width - 1);
                const int j = std::min(top + k / kEdge, extent.height - 1);
                read(texels + values * (static_cast<std::ptrdiff_t>(j) * extent.width + i), to[k]);
            }
            if (++count < Batch::kMost) continue;
            batch.encode(count, blocks);
            blocks += count * kUastcBlockBytes;
            count = 0;
        }
    }
    if (count > 0) batch.encode(count, blocks);
}

}  // namespace

int uastc_rows_at_once(Format, int width) { return std::max(1, 2 * UastcBatch::kMost / blocks_across(width, kEdge)); }

std::size_t uastc_memory(Format, Effort effort, int, int) {
    return LentMemory::taken_by(sizeof(UastcBatch)) + UastcBatch::memory(uastc_effort(effort)) + LentMemory::kStep;
}

void encode_uastc(Format, Effort effort, const float* texels, Extent extent, std::byte* blocks) {
    encode_batches<UastcBatch>(uastc_effort(effort), 3, texels, extent, blocks,
                               [](const float* from, float to[3]) { std::copy_n(from, 3, to); });
}

std::size_t uastc_xy_memory(Format, Effort effort, int, int) {
    return LentMemory::taken_by(sizeof(UastcXyBatch)) + UastcXyBatch::memory(uastc_xy_effort(effort)) +
           LentMemory::kStep;
}

void encode_uastc_xy(Format, Effort effort, const float* xy, Extent extent, std::byte* blocks) {
    encode_batches<UastcXyBatch>(uastc_xy_effort(effort), 2, xy, extent, blocks, [](const float* from, float to[3]) {
        for (int c = 0; c < 2; ++c) to[c] = std::fmin(std::fmax(from[c], -1.0f), 1.0f);
        // Longer ones become unit vectors without z.
        to[2] = std::sqrt(std::fmax(0.0f, 1.0f - to[0] * to[0] - to[1] * to[1]));
    });
}

}  // namespace tex::inline v1
