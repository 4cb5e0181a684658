// SPDX-License-Identifier: Apache-2.0
// Four stations: rows are read; they become floats; these become normals and mip levels; strips of these are packed and written.
// The first and the third work on one batch of rows at a time, in order, as each row builds on those before; the others on several. What can be decoded
// in any order is decoded by the second.

#include "pipeline/bake_stream.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include <tbb/global_control.h>

#include "base/conveyor.h"
#include "base/guard.h"
#include "base/parallel.h"
#include "containers/claims.h"
#include "kernels/bake.h"
#include "pipeline/height_stage.h"
#include "pipeline/level_stage.h"
#include "pipeline/strip_writer.h"
#include "pipeline/strips.h"

namespace tex {
namespace {

// Errors of reading name the file.
Error of_input(const std::string& input, const Error& error) {
    return error.file.empty() ? Error{error.code, input, error.reason} : error;
}

// Some rows on their way: as they were decoded, then the strips that they finished.
struct Batch {
    int first = 0;
    int count = 0;
    std::vector<std::byte> rows;
    Image image;                 // the same as floats
    std::optional<Error> error;  // they could not be decoded
    std::vector<std::shared_ptr<Strip>> strips;
    std::shared_ptr<Batch> self;  // while it is on its way
};

// The first error, whoever meets it.
class Failure {
public:
    [[nodiscard]] bool happened() const { return happened_.load(std::memory_order_relaxed); }
    void set(const Error& error) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = error;
        happened_ = true;
    }
    // Runs body(), a Result<void>; nothing once something has failed.
    template <class Body>
    void watch(const Body& body) {
        if (happened()) return;
        const Result<void> done = guarded(body);
        if (!done) set(done.error());
    }
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }  // after all threads have ended

private:
    std::atomic<bool> happened_{false};
    std::mutex mutex_;
    std::optional<Error> error_;
};

// The slopes of strips, in any order.
class SlopeCollector {
public:
    void add(const Strip& strip) {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        SlopeBounds bounds{kInfinity, -kInfinity, kInfinity, -kInfinity};
        for (int j = 0; j < strip.height; ++j) {
            widen_slope_bounds(strip.map.x.row(j), strip.map.y.row(j), strip.map.z.row(j), strip.map.extent().width, bounds);
        }
        const std::lock_guard lock(mutex_);
        if (!range_) range_ = SlopeRange{bounds.min_x, bounds.max_x, bounds.min_y, bounds.max_y};
        range_ = SlopeRange{std::min(range_->min_x, bounds.min_x), std::max(range_->max_x, bounds.max_x),
                            std::min(range_->min_y, bounds.min_y), std::max(range_->max_y, bounds.max_y)};
    }
    [[nodiscard]] SlopeRange range() const { return range_.value_or(SlopeRange()); }

private:
    std::mutex mutex_;
    std::optional<SlopeRange> range_;
};

class BakeStream {
public:
    BakeStream(RowSource& rows, const std::string& input, const HeightSource& source, StripWriter& writer, const BakeFileOptions& options,
               int levels, const Execution& execution, const StreamSizes& sizes)
        : rows_(rows), input_(input), writer_(writer), options_(options), execution_(execution), sizes_(sizes), strips_(rows.extent(), levels, alone() ? std::min(sizes.strip_texels, sizes.strip_texels_alone) : sizes.strip_texels),
          heights_(rows.extent(), source, options.heights, gradient_of(options.bake), slopes_of(rows.extent(), options),
                   {[this](int j) { return place(j); }, [this](int j) { finish(j); }}),
          levels_(rows.extent(), levels, heights_.start(), options.mip, strips_), batch_rows_(batch_rows(rows, strips_)) {}

    Result<void> run() {
        const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
        int threads = std::min(thread_count(execution_), static_cast<int>(allowed));
        if (alone()) threads = 1;
        convey<Batch>(threads, threads + 2, [this] { return read(); }, [this](Batch* batch) { store(*batch); },
                      [this](Batch* batch) { make(*batch); }, [this](Batch* batch) { write(*batch); });
        if (failure_.error()) return *failure_.error();
        if (const Result<void> sound = heights_.check(); !sound) return sound;
        // Better no file than one with holes.
        if (strips_.missing_rows() != 0) return Error{ErrorCode::unsupported, input_, "rows are missing: this is a bug"};
        return {};
    }

    [[nodiscard]] HeightReport heights() const { return {heights_.counts().luma, heights_.counts().invalid}; }
    [[nodiscard]] SlopeRange slopes() const { return slopes_.range(); }

private:
    static Slopes slopes_of(Extent extent, const BakeFileOptions& options) {
        const Strength strength = options.strength ? options.strength(extent) : Strength();
        return {strength.x, strength.y, options.heights.wrap_x, options.heights.wrap_y};
    }

    [[nodiscard]] bool alone() const { return rows_.extent().texels() < sizes_.worth_threads; }

    // Those of a strip, and whole groups of what the file holds together.
    static int batch_rows(const RowSource& rows, const Strips& strips) {
        const int together = rows.rows_together();
        return std::min(rows.extent().height, (strips.strip_rows(0) + together - 1) / together * together);
    }

    // The next rows; null after the last ones, or where something failed.
    Batch* read() {
        const int height = rows_.extent().height;
        Batch* next = nullptr;
        failure_.watch([&]() -> Result<void> {
            if (read_ == height) return {};
            std::shared_ptr<Batch> batch = batches_.take([this] {
                auto made = std::make_unique<Batch>();
                made->image = make_image({rows_.extent().width, batch_rows_}, rows_.names());
                made->rows.resize(rows_.row_bytes() * static_cast<std::size_t>(batch_rows_));
                return made;
            });
            batch->first = read_;
            batch->count = std::min(batch_rows_, height - read_);
            batch->error.reset();
            read_ += batch->count;
            if (!rows_.is_random()) decode(*batch);
            next = batch.get();
            next->self = std::move(batch);
            return {};
        });
        return next;
    }

    void decode(Batch& batch) {
        const Result<void> done = guarded([&] {
            Result<void> decoded = rows_.decode(batch.first, batch.count, batch.rows.data());
            if (decoded && batch.first + batch.count == rows_.extent().height) decoded = rows_.finish();
            return decoded;
        });
        if (!done) batch.error = of_input(input_, done.error());
    }

    void store(Batch& batch) {
        if (failure_.happened()) return;
        if (rows_.is_random()) decode(batch);
        if (!batch.error) rows_.store(batch.rows.data(), 0, batch.count, batch.image);
    }

    void make(Batch& batch) {
        failure_.watch([&]() -> Result<void> {
            if (batch.error) return *batch.error;  // the first of them, whatever the threads do
            for (int k = 0; k < batch.count; ++k) heights_.put(batch.image, k);
            batch.strips = strips_.take_whole();
            const double fraction = static_cast<double>(batch.first + batch.count) / rows_.extent().height;
            if (execution_.progress && !execution_.progress(fraction)) return Error{ErrorCode::cancelled, {}, "cancelled"};
            return {};
        });
    }

    NormalRow place(int j) {
        place_ = strips_.place(0, j);
        return place_.row;
    }

    void finish(int j) {
        levels_.put(j, place_.row, place_.strip);
        place_ = {};
        strips_.finish(0, j);
    }

    void write(Batch& batch) {
        for (std::shared_ptr<Strip>& strip : batch.strips) {
            failure_.watch([&] { return writer_.write(*strip); });
            if (options_.slopes && strip->level == 0 && !failure_.happened()) slopes_.add(*strip);
            strip.reset();
        }
        batch.strips.clear();
        const std::shared_ptr<Batch> done = std::move(batch.self);
    }

    RowSource& rows_;
    const std::string& input_;
    StripWriter& writer_;
    const BakeFileOptions& options_;
    const Execution& execution_;
    const StreamSizes& sizes_;
    Strips strips_;
    HeightStage heights_;
    LevelStage levels_;
    Strips::Place place_;
    Pool<Batch> batches_;
    const int batch_rows_;
    int read_ = 0;  // rows
    SlopeCollector slopes_;
    Failure failure_;
};

// An option does not fit the picture. A picture that is damaged as well is damaged first, as on the path of whole images.
Error after_all_rows(RowSource& rows, const std::string& input, const Error& error) {
    std::vector<std::byte> row(rows.row_bytes());
    Result<void> done;
    for (int j = 0; done && j < rows.extent().height; ++j) done = rows.decode(j, 1, row.data());
    if (done) done = rows.finish();
    return done ? error : of_input(input, done.error());
}

}  // namespace

Result<BakeFileReport> bake_stream(RowSource& rows, const std::string& input, const std::string& output, Container container,
                                   const BakeFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    const std::optional<Error> wrong_blur = check_blur(options.heights);
    const Result<HeightSource> source = find_height_source(rows.names(), options.heights.channel);
    if (wrong_blur || !source) return after_all_rows(rows, input, wrong_blur ? *wrong_blur : source.error());
    const int complete = level_count(rows.extent());
    BakeFileReport report;
    report.path = Path::streamed;
    report.extent = rows.extent();
    report.levels = options.mip.levels > 0 ? std::min(options.mip.levels, complete) : complete;
    Result<StripWriter> writer =
        StripWriter::open(output, container, rows.extent(), report.levels, options.pack, options.write);
    if (!writer) return writer.error();
    BakeStream stream(rows, input, *source, *writer, options, report.levels, execution, sizes);
    if (const Result<void> done = stream.run(); !done) return done.error();
    if (const Result<void> done = writer->commit(); !done) return done.error();
    report.bytes = writer->file_bytes();
    report.heights = stream.heights();
    report.slopes = stream.slopes();
    return report;
}

}  // namespace tex
