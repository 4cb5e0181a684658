// SPDX-License-Identifier: Apache-2.0
// texture_writer.h: writes rows of levels to DDS and KTX2 files.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/output_file.h"
#include "files/scratch_file.h"
#include "formats/file_layout.h"
#include "formats/file_types.h"
#include "stream/level_writer.h"

namespace tex::inline v1 {

// Writes containers in which the place of every level is known from the start: DDS, KTX2, ASTC.
class TextureWriter final : public LevelWriter {
public:
    // `first` is the level with which the file begins.
    TextureWriter(std::unique_ptr<OutputFile> file, FileLayout layout, LevelPacking packing, int first)
        : file_(std::move(file)), layout_(std::move(layout)), packing_(std::move(packing)), first_(first),
          size_(layout_.size) {}

    // Writes what comes before the texels. Levels go to a scratch file first if they are compressed, because their
    // places are known only when the smaller ones are complete; and if their blocks are optimised, because a whole
    // level is needed to judge whether that makes it smaller.
    Result<void> begin(const std::string& path, const FileType& type, int zstd_level);
    [[nodiscard]] bool is_in_order() const override { return false; }
    [[nodiscard]] int rows_together() const override {
        const FormatInfo format = format_info(packing_.head.format);
        return std::max(packing_.rows_together, format.has_blocks() ? format.block.height : kBlockEdge);
    }
    Result<void> write(const LevelRows& rows) override;
    Result<void> commit() override;
    [[nodiscard]] std::size_t file_bytes() const override { return size_; }
    [[nodiscard]] std::optional<RdoReport> rdo() const override {
        return packing_.tallies ? std::optional(packing_.tallies->report()) : std::nullopt;
    }

private:
    Result<void> choose_blocks();
    Result<void> copy_levels();
    [[nodiscard]] Result<std::vector<std::byte>> chosen(std::uint64_t offset, std::size_t count) const;

    const std::unique_ptr<OutputFile> file_;
    const FileLayout layout_;
    const LevelPacking packing_;
    const int first_;
    std::size_t size_;
    std::optional<ScratchFile> scratch_;
    std::optional<ScratchFile> plain_;  // blocks without optimisation
    std::vector<bool> takes_plain_;     // for each level
    decltype(FileType::compress) compress_ = nullptr;
    int zstd_level_ = 0;
};

}  // namespace tex::inline v1
