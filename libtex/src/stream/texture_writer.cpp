// SPDX-License-Identifier: Apache-2.0

#include "stream/texture_writer.h"

#include <algorithm>
#include <span>

#include "formats/ktx2/compress_ktx2.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

Result<void> TextureWriter::begin(const std::string& path, const FileType& type, int zstd_level) {
    if (zstd_level > 0) {
        compress_ = type.compress;
        zstd_level_ = zstd_level;
    }
    const auto open = [&path](std::optional<ScratchFile>& scratch) -> Result<void> {
        Result<ScratchFile> opened = ScratchFile::open(path);
        if (!opened) return opened.error();
        scratch.emplace(std::move(*opened));
        return {};
    };
    takes_plain_.assign(layout_.levels.size(), false);
    if (compress_ != nullptr || packing_.tallies) {
        if (Result<void> opened = open(scratch_); !opened) return opened;
    }
    if (packing_.tallies) {
        if (Result<void> opened = open(plain_); !opened) return opened;
    }
    return compress_ == nullptr ? file_->write_at(0, layout_.head) : Result<void>();
}

// Bytes of a level, as they were chosen.
Result<std::vector<std::byte>> TextureWriter::chosen(std::uint64_t offset, std::size_t count) const {
    std::size_t level = 0;
    while (offset < layout_.levels[level].offset ||
           offset >= layout_.levels[level].offset + layout_.levels[level].bytes)
        ++level;
    return (takes_plain_[level] ? plain_ : scratch_)->read_at(offset, count);
}

// Takes the plain blocks of each level that optimisation has not made smaller.
Result<void> TextureWriter::choose_blocks() {
    const int level = zstd_level_ > 0 ? zstd_level_ : kJudgedZstdLevel;
    const auto size_in = [&](const ScratchFile& blocks, const FileLayout::Level& place) {
        return compressed_size(place, level,
                               [&](std::uint64_t offset, std::size_t count) { return blocks.read_at(offset, count); });
    };
    for (std::size_t k = 0; k < layout_.levels.size(); ++k) {
        const Result<std::uint64_t> optimised = size_in(*scratch_, layout_.levels[k]);
        if (!optimised) return optimised.error();
        const Result<std::uint64_t> plain = size_in(*plain_, layout_.levels[k]);
        if (!plain) return plain.error();
        takes_plain_[k] = *plain <= *optimised;
        if (takes_plain_[k]) packing_.tallies->of(first_ + static_cast<int>(k)).take_plain();
    }
    return {};
}

Result<void> TextureWriter::copy_levels() {
    for (const FileLayout::Level& place : layout_.levels) {
        for (std::uint64_t done = 0; done < place.bytes; done += kChunkBytes) {
            const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kChunkBytes, place.bytes - done));
            const Result<std::vector<std::byte>> bytes = chosen(place.offset + done, count);
            if (!bytes) return bytes.error();
            if (Result<void> written = file_->write_at(place.offset + done, *bytes); !written) return written;
        }
    }
    return {};
}

Result<void> TextureWriter::commit() {
    if (!scratch_) return file_->commit();
    const Result<std::uint64_t> size = no_throw([&]() -> Result<std::uint64_t> {
        if (plain_) {
            if (const Result<void> judged = choose_blocks(); !judged) return judged.error();
        }
        if (compress_ == nullptr) {
            const Result<void> copied = copy_levels();
            return copied ? Result<std::uint64_t>(layout_.size) : copied.error();
        }
        return compress_(
            layout_, zstd_level_, [&](std::uint64_t offset, std::size_t count) { return chosen(offset, count); },
            [&](std::uint64_t offset, std::span<const std::byte> bytes) { return file_->write_at(offset, bytes); });
    });
    if (!size) return size.error();
    size_ = static_cast<std::size_t>(*size);
    return file_->commit();
}

Result<void> TextureWriter::write(const LevelRows& rows) {
    return no_throw([&]() -> Result<void> {
        const Format format = packing_.head.format;
        const Extent extent{rows.map.extent().width, rows.height};
        const std::size_t size = level_bytes(format, extent);
        const std::size_t stored_size = stored_level_bytes(format, extent, layout_.rearrange);
        const bool rearranged = layout_.rearrange != Rearrange::none;
        rows.scratch.resize(size + (rearranged ? stored_size : plain_ ? size : 0));
        packing_.pack(rows, rows.scratch.data(), plain_ ? rows.scratch.data() + size : nullptr);
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
        if (plain_) {
            const std::span<const std::byte> plain(rows.scratch.data() + size, size);
            if (Result<void> kept = plain_->write_at(offset, plain); !kept) return kept;
        }
        return scratch_ ? scratch_->write_at(offset, stored) : file_->write_at(offset, stored);
    });
}

}  // namespace tex::inline v1
