// SPDX-License-Identifier: Apache-2.0

#include "stream/strip_writer.h"

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

#include <tex/mip_chain.h>

#include "formats/codecs.h"
#include "formats/file_layout.h"
#include "formats/reader/reader.h"
#include "rows/pack_rows.h"
#include "rows/roughness_rows.h"
#include "stream/texture_writer.h"
#include "threads/guard.h"

namespace tex {
namespace {

// Writes pictures, which take their rows one after the other. Strips that come too early are packed and wait.
class PictureWriter final : public StripWriter {
public:
    PictureWriter(std::string path, std::unique_ptr<OutputFile> file, StripPacking packing, int first)
        : path_(std::move(path)), file_(std::move(file)), packing_(std::move(packing)), first_(first) {}

    Result<void> begin(const Codec& codec, const TextureHead& head) {
        Result<std::unique_ptr<RowTarget>> target =
            codec.open_target(head, [this](std::uint64_t offset, std::span<const std::byte> bytes) {
                size_ = std::max(size_, static_cast<std::size_t>(offset) + bytes.size());
                return bytes.empty() ? Result<void>() : file_->write_at(offset, bytes);
            });
        if (!target) return target.error().of(path_);
        target_ = std::move(*target);
        target_->wait_beside(path_);
        return {};
    }
    // If the target has work, several threads pack strips and do that work.
    [[nodiscard]] bool is_in_order(const Strip&) const override { return !target_->has_work(); }
    Result<void> write(Strip& strip) override;
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
    Result<void> put_in_order(int level, const Strip& strip);
    Result<void> work(std::size_t left);

    const std::string path_;
    const std::unique_ptr<OutputFile> file_;
    const StripPacking packing_;
    const int first_;   // the level with which the file begins
    std::mutex mutex_;  // guards all members below, but not the run() of work
    std::size_t size_ = 0;
    std::unique_ptr<RowTarget> target_;  // writes into the file
    std::deque<std::shared_ptr<RowWork>> ready_;
    std::map<int, Level> levels_;
};

Result<void> PictureWriter::write(Strip& strip) {
    const Result<void> done = guarded([&]() -> Result<void> {
        strip.bytes.resize(level_bytes(packing_.head.format, {strip.map.extent().width, strip.height}));
        packing_.pack(strip, strip.bytes.data());
        if (Result<void> put = put_in_order(strip.level - first_, strip); !put) return put;
        constexpr std::size_t kForTheNext = 1;
        return work(kForTheNext);
    });
    return done ? done : Result<void>(done.error().of(path_));
}

Result<void> PictureWriter::put_in_order(int index, const Strip& strip) {
    const std::lock_guard lock(mutex_);
    Level& level = levels_[index];
    if (strip.first != level.next) {
        level.waiting[strip.first] = {strip.height, strip.bytes};
        return {};
    }
    Result<void> done = put(index, strip.bytes.data(), strip.height);
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
    const Result<void> ended = guarded([&] {
        Result<void> done = work(0);
        return done ? target_->finish() : done;
    });
    return ended ? file_->commit() : Result<void>(ended.error().of(path_));
}

// Writes pictures that the reader process encodes as a whole.
class EncodedWriter final : public StripWriter {
public:
    EncodedWriter(std::string path, std::unique_ptr<OutputFile> file, StripPacking packing, ReaderPicture picture)
        : path_(std::move(path)), file_(std::move(file)), packing_(std::move(packing)), picture_(std::move(picture)) {}

    [[nodiscard]] bool is_in_order(const Strip&) const override { return false; }
    Result<void> write(Strip& strip) override {
        const Result<void> done = guarded([&] {
            strip.bytes.resize(level_bytes(packing_.head.format, {strip.map.extent().width, strip.height}));
            packing_.pack(strip, strip.bytes.data());
            return picture_.put(strip.first, strip.bytes);
        });
        return done ? done : Result<void>(done.error().of(path_));
    }
    Result<void> commit() override {
        const Result<std::vector<std::byte>> bytes = guarded([&] { return picture_.encode(); });
        if (!bytes) return bytes.error().of(path_);
        size_ = bytes->size();
        const Result<void> written = file_->write_at(0, *bytes);
        return written ? file_->commit() : written;
    }
    [[nodiscard]] std::size_t file_bytes() const override { return size_; }

private:
    const std::string path_;
    const std::unique_ptr<OutputFile> file_;
    const StripPacking packing_;
    const ReaderPicture picture_;
    std::size_t size_ = 0;
};

// Writes each level into its own file.
class LevelWriter final : public StripWriter {
public:
    explicit LevelWriter(std::vector<std::unique_ptr<StripWriter>> levels) : levels_(std::move(levels)) {}

    [[nodiscard]] bool is_in_order(const Strip& strip) const override {
        return levels_[static_cast<std::size_t>(strip.level)]->is_in_order(strip);
    }
    [[nodiscard]] int block_rows() const override { return levels_.front()->block_rows(); }
    Result<void> write(Strip& strip) override { return levels_[static_cast<std::size_t>(strip.level)]->write(strip); }
    // Commits the files one after the other and closes each before the next. If one fails, the files after it do not
    // appear.
    Result<void> commit() override {
        for (std::unique_ptr<StripWriter>& level : levels_) {
            if (Result<void> done = level->commit(); !done) return done;
            bytes_ += level->file_bytes();
            rdo_ = level->rdo();
            level.reset();
        }
        return {};
    }
    [[nodiscard]] std::size_t file_bytes() const override { return bytes_; }
    [[nodiscard]] std::optional<RdoReport> rdo() const override { return rdo_; }

private:
    std::vector<std::unique_ptr<StripWriter>> levels_;
    std::size_t bytes_ = 0;
    std::optional<RdoReport> rdo_;  // the levels share a tally
};

// Writes normals, and roughness into a second file.
class PairWriter final : public StripWriter {
public:
    PairWriter(std::unique_ptr<StripWriter> normals, std::unique_ptr<StripWriter> roughness)
        : normals_(std::move(normals)), roughness_(std::move(roughness)) {}

    [[nodiscard]] bool is_in_order(const Strip& strip) const override { return of(strip).is_in_order(strip); }
    [[nodiscard]] int block_rows() const override { return std::lcm(normals_->block_rows(), roughness_->block_rows()); }
    Result<void> write(Strip& strip) override { return of(strip).write(strip); }
    Result<void> commit() override {
        if (Result<void> done = normals_->commit(); !done) return done;
        bytes_ = normals_->file_bytes();
        rdo_ = normals_->rdo();
        normals_.reset();
        return roughness_->commit();
    }
    [[nodiscard]] std::size_t file_bytes() const override { return bytes_; }
    [[nodiscard]] std::size_t roughness_bytes() const override { return roughness_->file_bytes(); }
    [[nodiscard]] std::optional<RdoReport> rdo() const override { return rdo_; }

private:
    [[nodiscard]] StripWriter& of(const Strip& strip) const {
        return strip.content == Content::roughness ? *roughness_ : *normals_;
    }

    std::unique_ptr<StripWriter> normals_;
    const std::unique_ptr<StripWriter> roughness_;
    std::size_t bytes_ = 0;
    std::optional<RdoReport> rdo_;
};

using Opening = Result<std::unique_ptr<StripWriter>>;

// Opens one file, whose base level is level `first` of all levels.
Opening open_file(const std::string& path, Container container, const StripPacking& packing, int first, Opened when,
                  const WriteOptions& options) {
    const TextureHead& head = packing.head;
    const Codec& codec = codec_of(container);
    FileLayout layout;
    if (codec.layout != nullptr || options.zstd != 0) {
        if (const Result<void> held = check_holds(codec, head.format, options); !held) return held.error().of(path);
        layout = codec.layout(head, options);
    }
    const std::size_t bytes = codec.layout != nullptr ? layout.size : level_bytes(head.format, head.extent);
    Result<std::unique_ptr<OutputFile>> file = OutputFile::open(path, bytes, when, AtomicFileOptions::of(options));
    if (!file) return file.error();
    if (codec.open_target != nullptr) {
        auto picture = std::make_unique<PictureWriter>(path, std::move(*file), packing, first);
        if (const Result<void> begun = picture->begin(codec, head); !begun) return begun.error();
        return std::unique_ptr<StripWriter>(std::move(picture));
    }
    if (codec.layout == nullptr) {
        Result<ReaderPicture> picture = ReaderPicture::open(container, head, options);
        if (!picture) return picture.error().of(path);
        return std::unique_ptr<StripWriter>(
            std::make_unique<EncodedWriter>(path, std::move(*file), packing, std::move(*picture)));
    }
    auto texture = std::make_unique<TextureWriter>(std::move(*file), std::move(layout), packing, first);
    const Result<void> begun =
        options.zstd > 0 ? texture->begin_compressed(path, codec, options.zstd) : texture->begin();
    if (!begun) return begun.error();
    return std::unique_ptr<StripWriter>(std::move(texture));
}

}  // namespace

bool takes_any_order(Container container) { return codec_of(container).layout != nullptr; }

bool holds_levels(Container container, const LevelNames& names) { return names || can_hold_levels(container); }

StripPacking packing_of(const PackOptions& options, Extent extent, int levels) {
    const EncodingInfo encoding = encoding_info(options.encoding);
    const std::shared_ptr<RdoTally> tally = is_optimised(options) ? std::make_shared<RdoTally>() : nullptr;
    const int band_rows = rdo_band_rows(options, extent.width);
    return {{encoding.format, extent, levels, encoding.swizzle, true, options.y_axis, options.y_known},
            [options, band_rows, tally](const Strip& strip, std::byte* out) {
                pack_rows(strip.map, strip.height, options, 0, strip.height, out, band_rows, tally.get());
            },
            band_rows,
            tally};
}

StripPacking packing_of(const RoughnessFile& options, Extent extent, int levels) {
    TextureHead head{options.format, extent, levels};
    head.swizzle = kRoughnessSwizzle;
    return {head,
            [format = options.format, effort = options.effort](const Strip& strip, std::byte* out) {
                pack_roughness_rows(strip.map.x, strip.height, format, effort, 0, strip.height, out);
            },
            1, nullptr};
}

Opening StripWriter::open(const OutputNames& names, Container container, StripPacking packing,
                          const WriteOptions& options, Opened when) {
    if (!names.of_level) return open_file(names.output, container, packing, 0, when, options);
    const Extent extent = packing.head.extent;
    const int levels = std::exchange(packing.head.levels, 1);
    std::vector<std::unique_ptr<StripWriter>> files;
    for (int k = 0; k < levels; ++k) {
        packing.head.extent = level_extent(extent, k);
        Opening file = open_file(names.of_level(k), container, packing, k, k == 0 ? when : Opened::late, options);
        if (!file) return file.error();
        files.push_back(std::move(*file));
    }
    return std::unique_ptr<StripWriter>(std::make_unique<LevelWriter>(std::move(files)));
}

std::unique_ptr<StripWriter> StripWriter::pair(std::unique_ptr<StripWriter> normals,
                                               std::unique_ptr<StripWriter> roughness) {
    return std::make_unique<PairWriter>(std::move(normals), std::move(roughness));
}

}  // namespace tex
