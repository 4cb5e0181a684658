// SPDX-License-Identifier: Apache-2.0
// A pipeline of four stages: rows are read; they become floats; the floats become normals and mip levels; strips of
// these are packed and written. The first and the third stage work on one batch of rows at a time, in order, because
// each row depends on the rows before it. The others work on several batches at once. If rows can be decoded in any
// order, the second stage decodes them.

#include "stream/row_stream.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <tbb/global_control.h>

#include "blocks/extent.h"
#include "formats/claims.h"
#include "threads/conveyor.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {

// A batch of rows on its way: first the decoded rows, then the strips that they complete.
struct Batch {
    int first = 0;
    int count = 0;
    std::vector<std::byte> rows;
    Image image;                 // the same rows as floats
    std::optional<Error> error;  // set if the rows could not be decoded
    std::vector<std::shared_ptr<Strip>> strips;
    std::shared_ptr<Batch> self;  // set while the batch is on its way
};

// Keeps the first error of any thread.
class Failure {
public:
    [[nodiscard]] bool happened() const { return happened_.load(std::memory_order_relaxed); }
    void set(const Error& error) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = error;
        happened_ = true;
    }
    // Runs body(), which returns a Result<void>, unless something has failed before.
    template <class Body>
    void watch(const Body& body) {
        if (happened()) return;
        const Result<void> done = guarded(body);
        if (!done) set(done.error());
    }
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }  // once all threads have ended

private:
    std::atomic<bool> happened_{false};
    std::mutex mutex_;
    std::optional<Error> error_;
};

}  // namespace

struct RowStream::Work {
    Work(RowSource& its_rows, const std::string& its_input, int first, int level_total, StripWriter& its_writer,
         const Execution& its_execution, const StreamSizes& sizes, Extent made)
        : rows(its_rows), input(its_input), writer(its_writer), execution(its_execution), first_level(first),
          alone(rows.extent().texels() < sizes.worth_threads),
          strip_texels(alone ? std::min(sizes.strip_texels, sizes.strip_texels_alone) : sizes.strip_texels),
          strips(made, level_total, strip_texels, writer.block_rows(), first), batch_rows(rows_of_batch(rows, strips)) {
    }

    // The rows of one strip, rounded up to whole groups of rows that the file stores together.
    static int rows_of_batch(const RowSource& rows, const Strips& strips) {
        const int together = rows.rows_together();
        return std::min(rows.extent().height, (strips.strip_rows(0) + together - 1) / together * together);
    }

    Batch* read();
    void decode(Batch& batch);
    void store(Batch& batch);
    void make(Batch& batch, NormalStage& stage);
    void write_strips(Batch& batch, bool in_order);
    void write(Batch& batch);

    RowSource& rows;
    const std::string& input;
    StripWriter& writer;
    const Execution& execution;
    const int first_level;
    const bool alone;  // one thread is enough
    const int strip_texels;
    Strips strips;
    std::optional<Strips> beside;  // strips of roughness
    LevelStage* levels = nullptr;
    RoughnessStage* roughness = nullptr;
    Strips::Place place;  // the place of the row that the stage is making
    std::function<Result<void>(Image&, int)> change;
    std::function<void(const Strip&)> seen;
    Pool<Batch> batches;
    const int batch_rows;
    int next = 0;  // the first row that has not been read
    Failure failure;
};

// Returns the next rows, or null after the last ones or after a failure.
Batch* RowStream::Work::read() {
    const int height = rows.extent().height;
    Batch* batch = nullptr;
    failure.watch([&]() -> Result<void> {
        if (next == height) return {};
        std::shared_ptr<Batch> taken = batches.take([this] {
            const int held = rows.held_rows(batch_rows);
            auto made = std::make_unique<Batch>();
            made->image = make_image({rows.extent().width, held}, rows.names());
            made->rows.resize(rows.row_bytes() * static_cast<std::size_t>(held));
            return made;
        });
        taken->first = next;
        taken->count = std::min(batch_rows, height - next);
        taken->error.reset();
        next += taken->count;
        if (!rows.is_random()) decode(*taken);
        batch = taken.get();
        batch->self = std::move(taken);
        return {};
    });
    return batch;
}

void RowStream::Work::decode(Batch& batch) {
    const Result<void> done = guarded([&] {
        Result<void> decoded = rows.decode(batch.first, batch.count, batch.rows.data());
        if (decoded && batch.first + batch.count == rows.extent().height) decoded = rows.finish();
        return decoded;
    });
    if (!done) batch.error = done.error().of(input);
}

void RowStream::Work::store(Batch& batch) {
    if (failure.happened()) return;
    if (rows.is_random()) decode(batch);
    if (batch.error) return;
    const Result<void> done = guarded([&]() -> Result<void> {
        rows.store(batch.rows.data(), 0, batch.count, batch.image);
        return change ? change(batch.image, batch.count) : Result<void>();
    });
    if (!done) batch.error = done.error();
}

void RowStream::Work::make(Batch& batch, NormalStage& stage) {
    failure.watch([&]() -> Result<void> {
        if (batch.error) return *batch.error;  // batches come in order, so this is the first error
        stage.put(batch.image, batch.count);
        batch.strips = strips.take_whole();
        if (beside) {
            std::vector<std::shared_ptr<Strip>> more = beside->take_whole();
            batch.strips.insert(batch.strips.end(), std::make_move_iterator(more.begin()),
                                std::make_move_iterator(more.end()));
        }
        write_strips(batch, true);
        const double fraction = static_cast<double>(batch.first + batch.count) / rows.extent().height;
        if (execution.progress && !execution.progress(fraction)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        return {};
    });
}

// Writes the strips that must come in order, or the other ones.
void RowStream::Work::write_strips(Batch& batch, bool in_order) {
    for (std::shared_ptr<Strip>& strip : batch.strips) {
        if (strip && strip->level < 0) strip.reset();  // of a level that the file leaves out
        if (!strip || writer.is_in_order(*strip) != in_order) continue;
        failure.watch([&]() -> Result<void> {
            if (Result<void> written = writer.write(*strip); !written) return written;
            if (seen) seen(*strip);
            return {};
        });
        strip.reset();
    }
}

void RowStream::Work::write(Batch& batch) {
    write_strips(batch, false);
    batch.strips.clear();
    const std::shared_ptr<Batch> done = std::move(batch.self);
}

RowStream::RowStream(RowSource& rows, const std::string& input, int first, int levels, StripWriter& writer,
                     const Execution& execution, const StreamSizes& sizes, std::optional<Extent> made)
    : work_(
          std::make_unique<Work>(rows, input, first, levels, writer, execution, sizes, made.value_or(rows.extent()))) {}

RowStream::~RowStream() = default;

Strips& RowStream::strips() { return work_->strips; }

Strips& RowStream::roughness_strips(int levels) {
    return work_->beside.emplace(work_->rows.extent(), levels, work_->strip_texels, work_->writer.block_rows(),
                                 work_->first_level, Content::roughness);
}

void RowStream::convert(std::function<Result<void>(Image&, int)> change) { work_->change = std::move(change); }

void RowStream::watch(std::function<void(const Strip&)> seen) { work_->seen = std::move(seen); }

NormalSink RowStream::sink() {
    Work* const work = work_.get();
    const auto place = [work](int j) {
        work->place = work->strips.place(0, j);
        return work->place.row;
    };
    const auto finish = [work](int j) {
        work->levels->put(j, work->place.row, work->place.strip);
        if (work->roughness != nullptr) work->roughness->put(j, work->place.row, work->place.strip);
        work->place = {};
        work->strips.finish(0, j);
    };
    return {place, finish};
}

Result<void> RowStream::run(NormalStage& stage, LevelStage& levels, RoughnessStage* roughness) {
    Work& work = *work_;
    work.levels = &levels;
    work.roughness = roughness;
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const int threads = work.alone ? 1 : std::min(thread_count(work.execution), static_cast<int>(allowed));
    try {
        convey<Batch>(
            threads, threads + 2, work.rows.is_random(), [&] { return work.read(); },
            [&](Batch* batch) { work.store(*batch); }, [&](Batch* batch) { work.make(*batch, stage); },
            [&](Batch* batch) { work.write(*batch); });
    } catch (const std::runtime_error&) {
        return no_threads_error();
    }
    if (work.failure.error()) return *work.failure.error();
    if (Result<void> sound = stage.check(); !sound) return sound;
    // Rather fail than write a file with holes.
    if (work.strips.missing_rows() != 0 || (work.beside && work.beside->missing_rows() != 0))
        return Error{ErrorCode::unsupported, work.input, "rows are missing: this is a bug"};
    return {};
}

Error after_all_rows(RowSource& rows, const std::string& input, const Error& error) {
    const Result<void> read = rows.visit(input, [](const Image&, int, int) { return Result<void>(); });
    return read ? error : read.error();
}

}  // namespace tex
