// SPDX-License-Identifier: Apache-2.0
// On Windows, decoders run in this process, each in a thread, without restrictions and without a limit of time: there
// is nothing like seccomp, and a thread cannot be ended. Meshes and pictures of other programs are not read.

#include "formats/reader/reader_process.h"

#include <algorithm>
#include <condition_variable>
#include <future>
#include <mutex>
#include <system_error>
#include <utility>

#include "formats/reader/reader.h"
#include "formats/reader/reader_here.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

struct ReaderProcess::State {
    ReaderJob job;
    std::mutex mutex;
    std::condition_variable changed;
    bool has_ended = false;  // guarded by mutex, as are the two below
    bool failed = false;     // it ended without a result
    std::uint64_t strips = 0;
    std::future<void> work;  // its destructor waits

    void run(const ReaderLimits& limits) {
        const bool sound = read_here(job, limits, [this] {
            const std::lock_guard lock(mutex);
            ++strips;
            changed.notify_all();
        });
        const std::lock_guard lock(mutex);
        has_ended = true;
        failed = !sound;
        changed.notify_all();
    }
    [[nodiscard]] ReaderHeader read_header(bool& whole) const {
        ReaderHeader header;
        whole = read_exactly(job.result, 0, std::as_writable_bytes(std::span(&header, 1)).data(), sizeof header) &&
                header.magic == kReaderMagic;
        return header;
    }
};

ReaderProcess::ReaderProcess(std::unique_ptr<State> state) : state_(std::move(state)) {}
ReaderProcess::ReaderProcess(ReaderProcess&&) noexcept = default;
ReaderProcess& ReaderProcess::operator=(ReaderProcess&&) noexcept = default;
ReaderProcess::~ReaderProcess() = default;

Result<ReaderProcess> ReaderProcess::start(const ReaderJob& job, const ReadOptions& options) {
    return no_throw([&]() -> Result<ReaderProcess> {
        const Result<std::string> program = find_reader(options, job.program);
        if (!program) return program.error().of(job.path);
        auto state = std::make_unique<State>();
        state->job = job;
        const ReaderLimits limits{options.max_texels, options.reader_memory, std::max(1, options.reader_timeout)};
        try {
            state->work = std::async(std::launch::async, [raw = state.get(), limits] { raw->run(limits); });
        } catch (const std::system_error&) {
            return Error{ErrorCode::out_of_memory, job.path, "the system refuses a thread for the decoder"};
        }
        return ReaderProcess(std::move(state));
    });
}

Result<ReaderHeader> ReaderProcess::wait_for_rows(std::uint64_t rows) {
    for (std::uint64_t seen = 0;;) {
        {
            std::unique_lock lock(state_->mutex);
            state_->changed.wait(lock, [&] { return state_->has_ended || state_->strips > seen; });
            if (state_->has_ended) break;
            seen = state_->strips;
        }
        bool whole = false;
        const ReaderHeader header = state_->read_header(whole);
        if (whole && header.rows_done >= rows) return header;
    }
    bool whole = false;
    const ReaderHeader header = state_->read_header(whole);
    if (whole && header.rows_done >= rows) return header;
    return finish();
}

Result<ReaderHeader> ReaderProcess::finish() {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait(lock, [&] { return state_->has_ended; });
    bool whole = false;
    const ReaderHeader header = state_->read_header(whole);
    if (whole && header.state == ReaderState::refused) return reported_error(state_->job, header);
    if (whole && header.state == ReaderState::done && !state_->failed) return header;
    return Error{ErrorCode::bad_data, state_->job.path, worker_of(state_->job) + " ended without a result"};
}

Result<std::string> find_reader(const ReadOptions&, ReaderProgram program) {
    switch (program) {
        case ReaderProgram::pictures: break;
        case ReaderProgram::other_pictures:
            return Error{ErrorCode::unsupported,
                         {},
                         "files of this type are read and written by OpenImageIO, which libtex for Windows is without"};
        case ReaderProgram::meshes:
            return Error{ErrorCode::unsupported,
                         {},
                         "meshes of this type are read by Assimp and Draco, which libtex for Windows is without"};
    }
    return std::string("in this program");
}

}  // namespace tex::inline v1
