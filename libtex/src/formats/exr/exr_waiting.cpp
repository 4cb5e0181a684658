// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_waiting.h"

#include <iterator>
#include <utility>

namespace tex::inline v1 {

Result<void> ExrWaitingBlocks::add(int number, ExrChunks chunks) {
    held_bytes_ += chunks.bytes.size();
    held_[number] = std::move(chunks);
    while (held_bytes_ > kMostHeld && !output_.empty()) {
        if (Result<void> moved = move_last(); !moved) return moved;
    }
    return {};
}

// Moves the block that must wait longest to the scratch file.
Result<void> ExrWaitingBlocks::move_last() {
    if (!scratch_) {
        Result<ScratchFile> scratch = ScratchFile::open(output_);
        if (!scratch) return scratch.error();
        scratch_.emplace(std::move(*scratch));
    }
    auto [number, chunks] = std::move(*std::prev(held_.end()));
    held_.erase(number);
    const std::size_t count = chunks.bytes.size();
    held_bytes_ -= count;
    if (Result<void> written = scratch_->write_at(end_, chunks.bytes); !written) return written;
    moved_[number] = {end_, count, std::move(chunks.sizes)};
    end_ += count;
    return {};
}

Result<std::optional<ExrChunks>> ExrWaitingBlocks::take(int number) {
    if (auto held = held_.extract(number)) {
        held_bytes_ -= held.mapped().bytes.size();
        return std::optional(std::move(held.mapped()));
    }
    auto moved = moved_.extract(number);
    if (!moved) return std::optional<ExrChunks>();
    Result<std::vector<std::byte>> bytes = scratch_->read_at(moved.mapped().at, moved.mapped().count);
    if (!bytes) return bytes.error();
    return std::optional(ExrChunks{std::move(*bytes), std::move(moved.mapped().sizes)});
}

}  // namespace tex::inline v1
