// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <optional>
#include <utility>

#include "files/system_error.h"
#include "formats/reader/reader.h"
#include "formats/reader/reader_spawn.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

using Clock = std::chrono::steady_clock;

enum class News { strip, end, late };

// The time is up. But the caller may have begun to wait too late, after long work on rows that had already arrived. If
// the process has ended by now, that counts as its end. Anything else that it still sends does not prolong the wait.
News last_news(int progress) {
    int there = 0;
    if (ioctl(progress, FIONREAD, &there) != 0) return News::late;
    char strips[256];
    while (there > 0) {
        const ssize_t n = read(progress, strips, std::min(sizeof strips, static_cast<std::size_t>(there)));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        there -= static_cast<int>(n);
    }
    pollfd poll_for{progress, POLLIN, 0};
    const bool has_ended = poll(&poll_for, 1, 0) > 0 && (poll_for.revents & POLLHUP) != 0;
    return has_ended ? News::end : News::late;
}

// Waits for one of three events: a strip of rows is there; the socket has ended, because every process that holds it is
// gone; or the time is up.
News wait_for_news(int progress, Clock::time_point deadline) {
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) return last_news(progress);
        pollfd poll_for{progress, POLLIN, 0};
        const int ready = poll(&poll_for, 1, static_cast<int>(std::min<long long>(left + 1, 60'000)));
        if (ready < 0 && errno != EINTR) return News::late;
        if (ready <= 0) continue;
        char strips[256];
        const ssize_t n = read(progress, strips, sizeof strips);
        if (n > 0) return News::strip;
        if (n == 0) return News::end;
        if (errno != EINTR) return News::late;
    }
}

// Whether this process is limited to less memory than the reader may use. The reader inherits that limit.
bool is_short_of_memory(std::int64_t reader_memory) {
    rlimit now{};
    return getrlimit(RLIMIT_AS, &now) == 0 &&
           now.rlim_cur < static_cast<rlim_t>(std::max<std::int64_t>(reader_memory, 0));
}

// `begun`: the reader was ready to look at the file.
Error abnormal_end(const ReaderJob& job, const std::string& program, Ending ending, bool begun, bool is_short) {
    constexpr int kNotLoaded = 127;  // exit status of the dynamic loader and of shells
    const std::string signal = " (signal " + std::to_string(ending.signal) + ")";
    if (ending.signal == SIGKILL) {
        return {ErrorCode::out_of_memory, job.path, worker_of(job) + " was killed by the system: out of memory?"};
    }
    if (ending.signal != 0 && is_short) {
        return {ErrorCode::out_of_memory, job.path,
                worker_of(job) + " crashed" + signal + "; it has little memory (ulimit -v)"};
    }
    if (ending.signal != 0 && !begun) {
        return {ErrorCode::io, job.path, "the reader program " + program + " cannot be started" + signal};
    }
    if (ending.signal != 0) return {ErrorCode::bad_data, job.path, worker_of(job) + " crashed on this file" + signal};
    if (ending.status == kNotLoaded) {
        return {ErrorCode::io, job.path, "the reader program " + program + " cannot be loaded"};
    }
    if (ending.status == kNoRoom) {
        return {
            ErrorCode::out_of_memory, job.path,
            worker_of(job) + " cannot hand over its result: no memory, or a limit on the size of files (ulimit -f)"};
    }
    return {ErrorCode::bad_data, job.path,
            worker_of(job) + " ended without a result (exit status " + std::to_string(ending.status) + ")"};
}

}  // namespace

struct ReaderProcess::State {
    ReaderJob job;
    std::string program;
    int seconds = 1;
    std::int64_t memory = 0;  // bytes
    Clock::time_point deadline;
    Descriptor progress;
    ReaderChild child;
    bool has_spoken = false;  // the header is there
    bool in_time = true;
    std::optional<Ending> ending;

    [[nodiscard]] ReaderHeader read_header(bool& whole) const {
        ReaderHeader header;
        whole = read_exactly(job.result, 0, std::as_writable_bytes(std::span(&header, 1)).data(), sizeof header) &&
                header.magic == kReaderMagic;
        return header;
    }
    // Waits for the next strip; false if the process has ended.
    bool wait() {
        if (ending) return false;
        const News news = wait_for_news(progress.get(), deadline);
        has_spoken = has_spoken || news == News::strip;
        if (news == News::strip) return true;
        in_time = news == News::end;
        ending = child.end();
        return false;
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
        state->program = *program;
        state->seconds = std::max(1, options.reader_timeout);
        state->memory = options.reader_memory;
        state->deadline = Clock::now() + std::chrono::seconds(state->seconds);

        int ends[2];
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
            return system_error(job.path, errno, "a pair of sockets");
        state->progress = Descriptor(ends[0]);
        const Descriptor childs_end(ends[1]);
        const ReaderLimits limits{options.max_texels, options.reader_memory, state->seconds};
        if (const int failed = start_reader(*program, job, childs_end.get(), limits, state->child); failed != 0)
            return system_error(job.path, failed, ("the reader program " + *program + " cannot be started").c_str());
        return ReaderProcess(std::move(state));
    });
}

Result<ReaderHeader> ReaderProcess::wait_for_rows(std::uint64_t rows) {
    for (;;) {
        bool whole = false;
        const ReaderHeader header = state_->has_spoken ? state_->read_header(whole) : ReaderHeader();
        if (whole && header.rows_done >= rows) return header;
        if (!state_->wait()) return finish();
    }
}

Result<ReaderHeader> ReaderProcess::finish() {
    while (state_->wait()) {
    }
    return no_throw([&]() -> Result<ReaderHeader> {
        const ReaderJob& job = state_->job;
        if (!state_->in_time || state_->ending->signal == SIGXCPU) {
            return Error{ErrorCode::bad_data, job.path,
                         worker_of(job) + " did not end within " + std::to_string(state_->seconds) + " s"};
        }
        bool whole = false;
        const ReaderHeader header = state_->read_header(whole);
        if (whole && header.state == ReaderState::refused) return reported_error(job, header);
        if (!whole || header.state != ReaderState::done || state_->ending->signal != 0) {
            return abnormal_end(job, state_->program, *state_->ending, whole, is_short_of_memory(state_->memory));
        }
        return header;
    });
}

}  // namespace tex::inline v1
