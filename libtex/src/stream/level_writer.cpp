// SPDX-License-Identifier: Apache-2.0

#include "stream/level_writer.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "formats/file_layout.h"
#include "formats/file_types.h"
#include "formats/reader/reader.h"
#include "rows/codecs.h"
#include "rows/pack_rows.h"
#include "stream/texture_writer.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Writes pictures, which take their rows one after the other. Strips that come too early are packed and wait.
class PictureWriter final : public LevelWriter {
public:
    PictureWriter(std::string path, std::unique_ptr<OutputFile> file, LevelPacking packing, int first)
        : path_(std::move(path)), file_(std::move(file)), packing_(std::move(packing)), first_(first) {}

    // `waits_beside`: a scratch file may be made beside the output.
    Result<void> begin(const FileType& type, const TextureHead& head, bool waits_beside) {
        Result<std::unique_ptr<RowTarget>> target =
            type.open_target(head, [this](std::uint64_t offset, std::span<const std::byte> bytes) {
                size_ = std::max(size_, static_cast<std::size_t>(offset) + bytes.size());
                return bytes.empty() ? Result<void>() : file_->write_at(offset, bytes);
            });
        if (!target) return target.error().of(path_);
        target_ = std::move(*target);
        if (waits_beside) target_->wait_beside(path_);
        return {};
    }
    // If the target has work, several threads pack strips and do that work.
    [[nodiscard]] bool is_in_order() const override { return !target_->has_work(); }
    Result<void> write(const LevelRows& rows) override;
    Result<void> commit() override;
    [[nodiscard]] std::size_t file_bytes() const override { return size_; }

private:
    struct Packed {
        int rows = 0;
        std::vector<std::byte> bytes;
    };
    struct Level {
        int next = 0;                   // the row that must come next
        std::map<int, Packed> waiting;  // keyed by first row
    };
    Result<void> put(int level, const std::byte* rows, int count) {
        levels_[level].next += count;
        return target_->put(level, rows, count);
    }
    Result<void> put_in_order(int level, const LevelRows& rows);
    Result<void> work(std::size_t left);

    const std::string path_;
    const std::unique_ptr<OutputFile> file_;
    const LevelPacking packing_;
    const int first_;   // the level with which the file begins
    std::mutex mutex_;  // guards all members below, but not the run() of work
    std::size_t size_ = 0;
    std::unique_ptr<RowTarget> target_;  // writes into the file
    std::deque<std::shared_ptr<RowWork>> ready_;
    std::map<int, Level> levels_;
};

Result<void> PictureWriter::write(const LevelRows& rows) {
    const Result<void> done = no_throw([&]() -> Result<void> {
        rows.scratch.resize(level_bytes(packing_.head.format, {rows.map.extent().width, rows.height}));
        packing_.pack(rows, rows.scratch.data(), nullptr);
        if (Result<void> put = put_in_order(rows.level - first_, rows); !put) return put;
        constexpr std::size_t kForTheNext = 1;
        return work(kForTheNext);
    });
    return done ? done : Result<void>(done.error().of(path_));
}

Result<void> PictureWriter::put_in_order(int index, const LevelRows& rows) {
    const std::lock_guard lock(mutex_);
    Level& level = levels_[index];
    if (rows.first != level.next) {
        level.waiting[rows.first] = {rows.height, rows.scratch};
        return {};
    }
    Result<void> done = put(index, rows.scratch.data(), rows.height);
    while (done && !level.waiting.empty() && level.waiting.begin()->first == level.next) {
        const Packed packed = std::move(level.waiting.extract(level.waiting.begin()).mapped());
        done = put(index, packed.bytes.data(), packed.rows);
    }
    return done;
}

// Does one piece of the target's work, and more while more than `left` pieces are left. If one thread did all that its
// strip has completed, its batch would stay on the conveyor, and the other threads would soon have to wait for it.
Result<void> PictureWriter::work(std::size_t left) {
    std::unique_lock lock(mutex_);
    for (std::size_t allowed = 0;; allowed = left) {
        while (std::shared_ptr<RowWork> found = target_->take_work()) ready_.push_back(std::move(found));
        if (ready_.size() <= allowed) return {};
        const std::shared_ptr<RowWork> work = std::move(ready_.front());
        ready_.pop_front();
        lock.unlock();
        if (Result<void> run = work->run(); !run) return run;
        lock.lock();
        if (Result<void> ended = target_->end_work(work); !ended) return ended;
    }
}

Result<void> PictureWriter::commit() {
    const Result<void> ended = no_throw([&] {
        Result<void> done = work(0);
        return done ? target_->finish() : done;
    });
    return ended ? file_->commit() : Result<void>(ended.error().of(path_));
}

// Writes pictures that the reader process encodes as a whole.
class EncodedWriter final : public LevelWriter {
public:
    EncodedWriter(std::string path, std::unique_ptr<OutputFile> file, LevelPacking packing, ReaderPicture picture)
        : path_(std::move(path)), file_(std::move(file)), packing_(std::move(packing)), picture_(std::move(picture)) {}

    [[nodiscard]] bool is_in_order() const override { return false; }
    Result<void> write(const LevelRows& rows) override {
        const Result<void> done = no_throw([&] {
            rows.scratch.resize(level_bytes(packing_.head.format, {rows.map.extent().width, rows.height}));
            packing_.pack(rows, rows.scratch.data(), nullptr);
            return picture_.put(rows.first, rows.scratch);
        });
        return done ? done : Result<void>(done.error().of(path_));
    }
    Result<void> commit() override {
        const Result<std::vector<std::byte>> bytes = no_throw([&] { return picture_.encode(); });
        if (!bytes) return bytes.error().of(path_);
        size_ = bytes->size();
        const Result<void> written = file_->write_at(0, *bytes);
        return written ? file_->commit() : written;
    }
    [[nodiscard]] std::size_t file_bytes() const override { return size_; }

private:
    const std::string path_;
    const std::unique_ptr<OutputFile> file_;
    const LevelPacking packing_;
    const ReaderPicture picture_;
    std::size_t size_ = 0;
};

}  // namespace

bool takes_any_order(Container container) { return file_type_of(container).layout != nullptr; }

LevelPacking packing_of(const PackOptions& options, ExtraSet extras, Extent extent, int levels) {
    const EncodingInfo encoding = encoding_info(options.encoding);
    const auto tallies = is_optimised(options) ? std::make_shared<RdoTallies>(levels) : nullptr;
    const int band_rows = rdo_band_rows(options, extent.width);
    const Swizzle swizzle = swizzle_with(options.encoding, extras);
    return {{encoding.format, extent, levels, swizzle, true, options.y_axis, options.y_known},
            [options, extras, extent, band_rows, tallies](const LevelRows& rows, std::byte* out, std::byte* plain) {
                RdoTally* const tally = tallies ? &tallies->of(rows.level) : nullptr;
                const RdoBands bands{band_rows, level_extent(extent, rows.level), rows.first};
                pack_rows(rows.map, extras, rows.height, options, 0, rows.height, out, bands, tally, plain);
            },
            band_rows,
            tallies};
}

LevelPacking packing_of(const ExtraFile& options, Extra extra, Extent extent, int levels) {
    TextureHead head{options.format, extent, levels};
    head.swizzle = kRoughnessSwizzle;
    return {head,
            [format = options.format, extra](const LevelRows& rows, std::byte* out, std::byte*) {
                pack_roughness_rows(rows.map[extra], rows.height, format, Effort::normal, 0, rows.height, out);
            },
            1, nullptr};
}

LevelPacking packing_of(const RoughnessFile& options, const KeptChannels* kept, Extent extent, int levels) {
    TextureHead head{*options.format, extent, levels};
    head.swizzle = kRoughnessSwizzle;
    // What UASTC holds here has no alpha, and its descriptor says so.
    const int channels = has_basis_blocks(*options.format) ? 3 : format_info(*options.format).channels;
    std::fill_n(head.swizzle.begin(), channels, Component::other);
    const auto pack = [parts = options.parts, kept, format = *options.format, effort = options.effort](
                          const LevelRows& rows, std::byte* out, std::byte*) {
        const ChannelPlanes* const beside =
            kept == nullptr ? nullptr : &kept->levels[static_cast<std::size_t>(rows.level)];
        pack_roughness_channels(rows.map.x, rows.first, rows.height, parts, beside, format, effort, out);
    };
    return {head, pack, 1, nullptr};
}

Result<std::unique_ptr<LevelWriter>> LevelWriter::open(const std::string& path, Container container,
                                                       const LevelPacking& packing, int first,
                                                       const WriteOptions& options, Opened when) {
    const TextureHead& head = packing.head;
    const FileType& type = file_type_of(container);
    FileLayout layout;
    if (type.layout != nullptr || options.zstd != 0) {
        if (const Result<void> held = check_holds(type, head.format, options); !held) return held.error().of(path);
        layout = type.layout(head, options);
    }
    const std::size_t bytes = type.layout != nullptr ? layout.size : level_bytes(head.format, head.extent);
    Result<std::unique_ptr<OutputFile>> file = OutputFile::open(path, bytes, when, AtomicFileOptions::of(options));
    if (!file) return file.error();
    if (type.open_target != nullptr) {
        auto picture = std::make_unique<PictureWriter>(path, std::move(*file), packing, first);
        if (const Result<void> begun = picture->begin(type, head, !options.into); !begun) return begun.error();
        return std::unique_ptr<LevelWriter>(std::move(picture));
    }
    if (type.layout == nullptr) {
        Result<ReaderPicture> picture = ReaderPicture::open(container, head, options);
        if (!picture) return picture.error().of(path);
        return std::unique_ptr<LevelWriter>(
            std::make_unique<EncodedWriter>(path, std::move(*file), packing, std::move(*picture)));
    }
    auto texture = std::make_unique<TextureWriter>(std::move(*file), std::move(layout), packing, first);
    const Result<void> begun = texture->begin(path, type, options.zstd);
    if (!begun) return begun.error();
    return std::unique_ptr<LevelWriter>(std::move(texture));
}

}  // namespace tex::inline v1
