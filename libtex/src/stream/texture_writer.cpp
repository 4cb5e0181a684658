// SPDX-License-Identifier: Apache-2.0

#include "stream/texture_writer.h"

#include <span>

#include "threads/guard.h"

namespace tex {

Result<void> TextureWriter::commit() {
    if (!scratch_) return file_->commit();
    const Result<std::uint64_t> size = guarded([&] {
        return compress_(
            layout_, compression_level_,
            [&](std::uint64_t offset, std::size_t count) { return scratch_->read_at(offset, count); },
            [&](std::uint64_t offset, std::span<const std::byte> bytes) { return file_->write_at(offset, bytes); });
    });
    if (!size) return size.error();
    size_ = static_cast<std::size_t>(*size);
    return file_->commit();
}

Result<void> TextureWriter::write(const LevelRows& rows) {
    return guarded([&]() -> Result<void> {
        const Format format = packing_.head.format;
        const Extent extent{rows.map.extent().width, rows.height};
        const std::size_t size = level_bytes(format, extent);
        const std::size_t stored_size = stored_level_bytes(format, extent, layout_.rearrange);
        const bool rearranged = layout_.rearrange != Rearrange::none;
        rows.scratch.resize(size + (rearranged ? stored_size : 0));
        packing_.pack(rows, rows.scratch.data());
        std::span<const std::byte> stored(rows.scratch.data(), size);
        if (rearranged) {
            std::byte* target = rows.scratch.data() + size;
            rearrange_texels(format, layout_.rearrange, rows.scratch.data(), size / format_info(format).block_bytes,
                             target);
            stored = {target, stored_size};
        }
        // Each strip begins at the first row of a row of blocks.
        const std::size_t before = stored_level_bytes(format, {extent.width, rows.first}, layout_.rearrange);
        const std::uint64_t offset = layout_.levels[static_cast<std::size_t>(rows.level - first_)].offset + before;
        return scratch_ ? scratch_->write_at(offset, stored) : file_->write_at(offset, stored);
    });
}

}  // namespace tex
