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

#include "files/output_file.h"
#include "files/scratch_file.h"
#include "formats/codecs.h"
#include "formats/file_layout.h"
#include "stream/level_writer.h"

namespace tex {

// Writes containers in which the place of every level is known from the start: DDS, KTX2, ASTC.
class TextureWriter final : public LevelWriter {
public:
    // `first` is the level with which the file begins.
    TextureWriter(std::unique_ptr<OutputFile> file, FileLayout layout, LevelPacking packing, int first)
        : file_(std::move(file)), layout_(std::move(layout)), packing_(std::move(packing)), first_(first),
          size_(layout_.size) {}

    Result<void> begin() { return file_->write_at(0, layout_.head); }
    // Instead of begin(): levels go to a scratch file first, because the place of a compressed level is known only when
    // the smaller ones are complete.
    Result<void> begin_compressed(const std::string& path, const Codec& codec, int level) {
        Result<ScratchFile> scratch = ScratchFile::open(path);
        if (!scratch) return scratch.error();
        scratch_.emplace(std::move(*scratch));
        compress_ = codec.compress;
        compression_level_ = level;
        return {};
    }
    [[nodiscard]] bool is_in_order() const override { return false; }
    [[nodiscard]] int rows_together() const override {
        const FormatInfo format = format_info(packing_.head.format);
        return std::max(packing_.rows_together, format.has_blocks() ? format.block.height : kBlockEdge);
    }
    Result<void> write(const LevelRows& rows) override;
    Result<void> commit() override;
    [[nodiscard]] std::size_t file_bytes() const override { return size_; }
    [[nodiscard]] std::optional<RdoReport> rdo() const override {
        return packing_.tally ? std::optional(packing_.tally->report()) : std::nullopt;
    }

private:
    const std::unique_ptr<OutputFile> file_;
    const FileLayout layout_;
    const LevelPacking packing_;
    const int first_;
    std::size_t size_;
    std::optional<ScratchFile> scratch_;
    decltype(Codec::compress) compress_ = nullptr;
    int compression_level_ = 0;
};

}  // namespace tex
