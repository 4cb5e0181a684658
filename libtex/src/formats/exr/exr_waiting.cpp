// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_waiting.h"

#include <utility>

namespace tex {

Result<void> ExrWaitingBlocks::add(int number, ExrChunks chunks) {
    const std::size_t count = chunks.bytes.size();
    held_ += count;
    blocks_[number] = {std::move(chunks), 0, count, true};
    // The blocks that are taken next stay in memory.
    for (auto last = blocks_.rbegin(); held_ > kMostHeld && last != blocks_.rend() && !output_.empty(); ++last) {
        if (!last->second.is_held) continue;
        if (Result<void> moved = move_out(last->second); !moved) return moved;
    }
    return {};
}

Result<void> ExrWaitingBlocks::move_out(Waiting& block) {
    if (!scratch_) {
        Result<ScratchFile> scratch = ScratchFile::open(output_);
        if (!scratch) return scratch.error();
        scratch_.emplace(std::move(*scratch));
    }
    if (Result<void> written = scratch_->write_at(end_, block.chunks.bytes); !written) return written;
    block.at = end_;
    end_ += block.count;
    block.is_held = false;
    held_ -= block.count;
    block.chunks.bytes = std::vector<std::byte>();  // which, unlike clear(), frees them
    return {};
}

Result<std::optional<ExrChunks>> ExrWaitingBlocks::take(int number) {
    const auto found = blocks_.find(number);
    if (found == blocks_.end()) return std::optional<ExrChunks>();
    Waiting block = std::move(found->second);
    blocks_.erase(found);
    if (block.is_held) {
        held_ -= block.count;
    } else {
        Result<std::vector<std::byte>> bytes = scratch_->read_at(block.at, block.count);
        if (!bytes) return bytes.error();
        block.chunks.bytes = std::move(*bytes);
    }
    return std::optional(std::move(block.chunks));
}

}  // namespace tex
