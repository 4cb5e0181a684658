// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode_astc.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "blocks/astc_void.h"
#include "blocks/extent.h"
#include "kernels/astc_batch.h"
#include "kernels/astc_effort.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {
namespace {

// So many blocks are encoded together: enough that most plans are those of several blocks.
constexpr int kBatch = 2048;

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

// The guides that were made, by channels, size of blocks and effort.
constexpr std::size_t kGuides = 2 * 8 * 3;
std::array<std::atomic<const AstcGuide*>, kGuides> made_guides;

std::size_t guide_number(Format format, Effort effort, int channels) {
    const std::size_t size = static_cast<std::size_t>(format) - static_cast<std::size_t>(Format::astc_4x4_unorm);
    return 3 * (8 * to_size(channels - 1) + size) + static_cast<std::size_t>(effort);
}

const AstcGuide& guide_of(Format format, Effort effort, int channels) {
    static std::mutex mutex;
    static std::array<std::unique_ptr<const AstcGuide>, kGuides> kept;
    const std::size_t at = guide_number(format, effort, channels);
    if (const AstcGuide* const made = made_guides[at].load(std::memory_order_acquire)) return *made;
    // Not std::call_once: where no memory is left, glibc cannot load what lets an exception pass through that.
    const std::lock_guard lock(mutex);
    if (!kept[at]) {
        const AstcPlans& plans = astc_plans(format_info(format).block, channels);
        kept[at] = std::make_unique<const AstcGuide>(make_astc_guide(plans, astc_effort(format, effort).reach));
        made_guides[at].store(kept[at].get(), std::memory_order_release);
    }
    return *kept[at];
}

// Memory that is taken at once: the heap gives many pieces back to the system after each call, which costs a tenth of
// the time of `fast`.
struct OnePiece {
    explicit OnePiece(std::size_t size) : bytes(new std::byte[size]), memory(bytes.get(), size), lend(memory) {}
    const std::unique_ptr<std::byte[]> bytes;
    LentMemory memory;
    const Lend lend;
};

// Encodes two planes whose values are from 0 to kAstcOne; with one channel, the other one is zeros. `read` gets a row
// and writes `count` rows of both planes from there on.
void encode_planes(Format format, Effort effort, int channels, Extent extent, std::byte* blocks,
                   const std::function<void(int first, int count, float* x, float* y)>& read) {
    const Extent block = format_info(format).block;
    const int across = blocks_across(extent.width, block.width), down = blocks_across(extent.height, block.height);
    std::optional<OnePiece> piece;
    if (lent_memory() == nullptr) piece.emplace(astc_memory(format, effort, extent.width, down));
    WorkingVector<float> planes[2];  // of a row of blocks
    for (WorkingVector<float>& plane : planes) plane.resize(to_size(extent.width * block.height));
    const AstcEffort spends = astc_effort(format, effort);
    WorkingVector<AstcBatch> batches;  // exactly one
    batches.reserve(1);
    const int all = across * down;
    batches.emplace_back(guide_of(format, effort, channels), spends, std::min(kBatch, all));
    AstcBatch* const batch = &batches.front();
    const int lanes = batch->lanes();
    for (int first = 0; first < all; first += kBatch) {
        const int count = std::min(kBatch, all - first);
        for (int n = first; n < first + count; ++n) {
            const int left = n % across * block.width, top = n / across * block.height;
            const int rows = std::min(block.height, extent.height - top);
            if (n == first || left == 0) read(top, rows, planes[0].data(), planes[1].data());
            const int inside = std::min(block.width, extent.width - left);
            for (int c = 0; c < 2; ++c) {
                float* to = batch->values(n - first, c);
                for (int j = 0; j < block.height; ++j, to += block.width * lanes) {
                    const float* const row = planes[c].data() + to_size(std::min(j, rows - 1) * extent.width + left);
                    for (int i = 0; i < inside; ++i) to[i * lanes] = row[i];
                    for (int i = inside; i < block.width; ++i) to[i * lanes] = row[inside - 1];
                }
            }
        }
        batch->encode(count, blocks + kAstcBlockBytes * static_cast<std::ptrdiff_t>(first));
    }
}

}  // namespace

void prepare_astc(Format format, Effort effort) { guide_of(format, effort, 2); }

bool is_astc_prepared(Format format, Effort effort) {
    return made_guides[guide_number(format, effort, 2)].load(std::memory_order_acquire) != nullptr;
}

int astc_rows_at_once(Format format, int width) {
    return std::max(1, kBatch / blocks_across(width, format_info(format).block.width));
}

std::size_t astc_memory(Format format, Effort effort, int width, int rows) {
    const Extent block = format_info(format).block;
    const AstcEffort spends = astc_effort(format, effort);
    const std::size_t most = std::min(to_size(kBatch), to_size(blocks_across(width, block.width)) * to_size(rows));
    const std::size_t values = 2 * (most + kAstcLanes) * to_size(block.width * block.height) + 16;
    constexpr std::size_t kPlans = 4096;  // more than a size has
    return 2 * to_size(width * block.height) * sizeof(float) + sizeof(AstcBatch) + (values + kPlans) * sizeof(float) +
           most * AstcBatch::bytes_a_block(spends) + 16 * LentMemory::kStep;
}

void encode_astc(Format format, Effort effort, const float* xy, Extent extent, std::byte* blocks) {
    encode_planes(format, effort, 2, extent, blocks, [&](int first, int rows, float* x, float* y) {
        const std::size_t width = to_size(extent.width);
        astc_planes(xy + 2 * to_size(first) * width, to_size(rows) * width, 0.5f * kAstcOne, x, y);
    });
}

void encode_astc_luminance(Format format, Effort effort, const float* luminance, Extent extent, std::byte* blocks) {
    encode_planes(format, effort, 1, extent, blocks, [&](int first, int rows, float* values, float*) {
        const float* const from = luminance + to_size(first) * to_size(extent.width);
        std::transform(from, from + rows * extent.width, values,
                       [](float v) { return std::min(std::max(0.0f, v), 1.0f) * kAstcOne; });
    });
}

}  // namespace tex::inline v1
