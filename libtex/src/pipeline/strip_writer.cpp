// SPDX-License-Identifier: Apache-2.0

#include "pipeline/strip_writer.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/guard.h"
#include "base/pack_rows.h"
#include "containers/dds.h"
#include "containers/file_layout.h"
#include "containers/ktx2.h"
#include "containers/row_target.h"

namespace tex {
namespace {

// A file of at most so many bytes is put together in memory and written at once: a call of the system for each of its levels takes as long as they do.
constexpr std::size_t kWrittenAtOnce = std::size_t{1} << 18;

// DDS and KTX2: every level has its place from the start.
class TextureWriter final : public StripWriter {
public:
    TextureWriter(AtomicFile file, FileLayout layout, const PackOptions& pack)
        : file_(std::move(file)), layout_(std::move(layout)), pack_(pack),
          whole_(layout_.size <= kWrittenAtOnce ? layout_.size : 0) {}

    Result<void> begin() { return put(0, layout_.head); }
    [[nodiscard]] bool is_in_order() const override { return false; }
    Result<void> write(Strip& strip) override;
    Result<void> commit() override {
        const Result<void> written = whole_.empty() ? Result<void>() : file_.write_at(0, whole_);
        return written ? file_.commit() : written;
    }
    [[nodiscard]] std::size_t file_bytes() const override { return layout_.size; }

private:
    Result<void> put(std::uint64_t offset, std::span<const std::byte> bytes) {
        if (whole_.empty()) return file_.write_at(offset, bytes);
        std::copy(bytes.begin(), bytes.end(), whole_.begin() + static_cast<std::ptrdiff_t>(offset));
        return {};
    }

    AtomicFile file_;
    FileLayout layout_;
    PackOptions pack_;
    std::vector<std::byte> whole_;  // a small file
};

Result<void> TextureWriter::write(Strip& strip) {
    return guarded([&]() -> Result<void> {
        const Format format = encoding_info(pack_.encoding).format;
        const Extent extent{strip.map.extent().width, strip.height};
        const std::size_t size = level_bytes(format, extent);
        const std::size_t stored_size = stored_level_bytes(format, extent, layout_.rearrange);
        const bool rearranged = layout_.rearrange != Rearrange::none;
        strip.bytes.resize(size + (rearranged ? stored_size : 0));
        pack_rows(strip.map, strip.height, pack_, 0, strip.height, strip.bytes.data());
        std::span<const std::byte> stored(strip.bytes.data(), size);
        if (rearranged) {
            std::byte* target = strip.bytes.data() + size;
            rearrange_texels(format, layout_.rearrange, strip.bytes.data(), size / format_info(format).block_bytes, target);
            stored = {target, stored_size};
        }
        // Strips begin with whole rows of blocks.
        const std::size_t before = stored_level_bytes(format, {extent.width, strip.first}, layout_.rearrange);
        return put(layout_.levels[static_cast<std::size_t>(strip.level)].offset + before, stored);
    });
}

// Pictures, whose rows are compressed one after the other.
class PictureWriter final : public StripWriter {
public:
    PictureWriter(std::string path, AtomicFile file, const PackOptions& pack) : path_(std::move(path)), file_(std::move(file)), pack_(pack) {}

    Result<void> begin(Container container, const TextureHead& head) {
        Result<std::unique_ptr<RowTarget>> target =
            open_row_target(container, head, [this](std::uint64_t offset, std::span<const std::byte> bytes) {
                size_ = std::max(size_, static_cast<std::size_t>(offset) + bytes.size());
                return bytes.empty() ? Result<void>() : file_.write_at(offset, bytes);
            });
        if (!target) return target.error().of(path_);
        target_ = std::move(*target);
        return {};
    }
    [[nodiscard]] bool is_in_order() const override { return true; }
    Result<void> write(Strip& strip) override;
    Result<void> commit() override;
    [[nodiscard]] std::size_t file_bytes() const override { return size_; }

private:
    const std::string path_;
    AtomicFile file_;
    PackOptions pack_;
    std::size_t size_ = 0;
    std::unique_ptr<RowTarget> target_;  // writes into the file
};

Result<void> PictureWriter::write(Strip& strip) {
    return guarded([&]() -> Result<void> {
        strip.bytes.resize(level_bytes(encoding_info(pack_.encoding).format, {strip.map.extent().width, strip.height}));
        pack_rows(strip.map, strip.height, pack_, 0, strip.height, strip.bytes.data());
        const Result<void> put = target_->put(strip.bytes.data(), strip.height);
        return put ? put : Result<void>(put.error().of(path_));
    });
}

Result<void> PictureWriter::commit() {
    const Result<void> ended = guarded([&] { return target_->finish(); });
    return ended ? file_.commit() : Result<void>(ended.error().of(path_));
}

}  // namespace

bool is_texture(Container container) { return container == Container::dds || container == Container::ktx2; }

bool takes_strips(Container container, int levels) { return is_texture(container) || takes_rows(container, levels); }

Result<std::unique_ptr<StripWriter>> StripWriter::open(const std::string& path, Container container, Extent extent, int levels,
                                                       const PackOptions& pack, const WriteOptions& options) {
    const EncodingInfo encoding = encoding_info(pack.encoding);
    const TextureHead head{encoding.format, extent, levels, encoding.swizzle, true, pack.y_axis, true};
    Result<AtomicFile> file = AtomicFile::open(path, {options.sync, options.no_clobber});
    if (!file) return file.error();
    if (!is_texture(container)) {
        auto picture = std::make_unique<PictureWriter>(path, std::move(*file), pack);
        if (const Result<void> begun = picture->begin(container, head); !begun) return begun.error();
        return std::unique_ptr<StripWriter>(std::move(picture));
    }
    FileLayout layout = container == Container::dds ? dds_layout(head, options) : ktx2_layout(head);
    auto texture = std::make_unique<TextureWriter>(std::move(*file), std::move(layout), pack);
    if (const Result<void> begun = texture->begin(); !begun) return begun.error();
    return std::unique_ptr<StripWriter>(std::move(texture));
}

}  // namespace tex
