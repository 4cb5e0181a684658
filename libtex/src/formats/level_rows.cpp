// SPDX-License-Identifier: Apache-2.0

#include "formats/level_rows.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "blocks/extent.h"
#include "formats/channels.h"
#include "formats/ktx2/level_inflater.h"
#include "formats/size_limits.h"
#include "kernels/decode.h"
#include "rows/decode_rows.h"

namespace tex::inline v1 {
namespace {

Result<void> read_bytes(const InputFile& file, std::uint64_t offset, std::span<std::byte> bytes) {
    const Result<std::size_t> got = file.read_at(static_cast<std::int64_t>(offset), bytes.data(), bytes.size());
    if (!got) return got.error();
    if (*got < bytes.size()) return Error{ErrorCode::bad_data, file.path(), "the file ends too early"};
    return {};
}

class LevelRows final : public RowSource {
public:
    LevelRows(const InputFile& file, std::shared_ptr<const StoredTexture> texture, std::size_t k)
        : file_(file), texture_(std::move(texture)), offset_(texture_->levels[k].offset),
          skipped_(texture_->levels[k].skipped), info_(format_info(texture_->head.format)) {
        const Extent extent = texture_->levels[k].extent;
        pitch_ = level_bytes(texture_->head.format, {extent.width, 1});
        const auto block = static_cast<std::size_t>(info_.block.height);
        describe(extent, channel_names(texture_->head), (pitch_ + block - 1) / block, info_.sample, info_.bits);
        if (const Texture& head = texture_->head; head.bumpiness_x != 0.0f)
            head_.strength = Strength{head.bumpiness_x, head.bumpiness_y};
        if (texture_->supercompression != Supercompression::none) open_inflater(texture_->levels[k]);
    }

    [[nodiscard]] int rows_together() const override { return info_.block.height; }
    [[nodiscard]] int block_rows() const override { return info_.has_blocks() ? info_.block.height : kBlockEdge; }
    [[nodiscard]] bool is_random() const override { return inflater_ == nullptr; }
    void choose_planes(const std::vector<bool>& wanted) override { wanted_ = wanted; }

    Result<void> decode(int first, int count, std::byte* rows) override;
    void store(const std::byte* rows, int first, int end, Image& image) const override;

private:
    void open_inflater(const StoredTexture::Level& place);
    // Reads rows of blocks or of texels from the file.
    [[nodiscard]] Result<void> fetch(int first, int count, std::byte* out) {
        const std::size_t pitch = stored_pitch(*texture_, extent().width);
        const std::uint64_t offset = static_cast<std::uint64_t>(first) * pitch;
        const std::span<std::byte> bytes(out, pitch * static_cast<std::size_t>(count));
        if (inflater_ == nullptr) return read_bytes(file_, offset_ + offset, bytes);
        const Result<void> done = texture_->upwards ? copy(offset, bytes) : inflater_->read(skipped_ + offset, bytes);
        return done ? done : Result<void>(done.error().of(file_.path()));
    }
    // Reads bytes of the inflated level. Rows that run upwards are read from the end, so the level is inflated once.
    [[nodiscard]] Result<void> copy(std::uint64_t offset, std::span<std::byte> bytes) {
        if (inflated_.empty()) {
            std::vector<std::byte> level(pitch_ * static_cast<std::size_t>(extent().height));
            if (Result<void> done = inflater_->read(skipped_, level); !done) return done;
            inflated_ = std::move(level);
        }
        std::copy_n(inflated_.begin() + static_cast<std::ptrdiff_t>(offset), bytes.size(), bytes.begin());
        return {};
    }
    [[nodiscard]] Result<void> convert(int first, int count, std::byte* rows) {
        std::vector<std::byte> stored(stored_pitch(*texture_, extent().width) * static_cast<std::size_t>(count));
        if (Result<void> fetched = fetch(first, count, stored.data()); !fetched) return fetched;
        convert_rows(*texture_, stored.data(), extent().width, count, rows);
        return {};
    }

    const InputFile& file_;
    const std::shared_ptr<const StoredTexture> texture_;
    const std::uint64_t offset_, skipped_;
    const FormatInfo info_;
    std::size_t pitch_ = 0;  // bytes of a row of blocks or texels, in head.format
    std::unique_ptr<LevelInflater> inflater_;
    std::vector<std::byte> inflated_;  // only if rows run upwards
    std::vector<bool> wanted_ = std::vector<bool>(4, true);
};

void LevelRows::open_inflater(const StoredTexture::Level& place) {
    inflater_ = LevelInflater::make(*texture_, fetch_from(file_), place);
}

Result<void> LevelRows::decode(int first, int count, std::byte* rows) {
    if (texture_->upwards) {
        Result<void> done;
        for (int j = 0; done && j < count; ++j) {
            done = convert(extent().height - 1 - (first + j), 1, rows + static_cast<std::size_t>(j) * pitch_);
        }
        return done;
    }
    const int block = info_.block.height;
    const int begin = first / block;
    const int units = blocks_across(first + count, block) - begin;
    return is_as_in_memory(*texture_, extent().width) ? fetch(begin, units, rows) : convert(begin, units, rows);
}

void LevelRows::store(const std::byte* rows, int first, int end, Image& image) const {
    const Format format = texture_->head.format;
    const int width = extent().width;
    for (int j = first; j < end; j += info_.block.height, rows += pitch_) {
        ChannelRows out;
        for (std::size_t c = 0; c < image.planes.size(); ++c) {
            if (wanted_[c]) out.channel[c] = image.planes[c].row(j);
        }
        decode_row(format, rows, width, out, image.planes.front().stride());
    }
}

}  // namespace

FetchBytes fetch_from(const InputFile& file) {
    return [&file](std::uint64_t offset, std::size_t count) -> Result<std::vector<std::byte>> {
        std::vector<std::byte> bytes(count);
        if (Result<void> done = read_bytes(file, offset, bytes); !done) return done.error();
        return bytes;
    };
}

std::unique_ptr<RowSource> open_level_rows(const InputFile& file, std::shared_ptr<const StoredTexture> texture,
                                           std::size_t k) {
    return std::make_unique<LevelRows>(file, std::move(texture), k);
}

}  // namespace tex::inline v1
