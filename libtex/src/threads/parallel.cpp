// SPDX-License-Identifier: Apache-2.0

#include "threads/parallel.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <new>
#include <stdexcept>

#include <tbb/global_control.h>
#include <tbb/info.h>

#include "memory/lent_memory.h"
#include "threads/fork_join.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Counts finished pieces and reports progress, one thread at a time; remembers a request to stop.
class Ticker {
public:
    Ticker(const Execution& execution, int pieces, ProgressSpan span)
        : execution_(execution), pieces_(pieces), span_(span) {}

    [[nodiscard]] bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
    void fail_memory() {
        out_of_memory_.store(true, std::memory_order_relaxed);
        stopped_.store(true, std::memory_order_relaxed);
    }
    void tick() {
        const int done = done_.fetch_add(1, std::memory_order_relaxed) + 1;
        if (!execution_.progress) return;
        // If another thread is reporting, this one does not wait: the next tick reports the progress of both.
        const std::unique_lock lock(reporting_, std::try_to_lock);
        if (lock.owns_lock()) report(done);
    }
    // After the last tick, which another thread's report may have kept from being reported.
    void finish() {
        if (execution_.progress && !stopped()) report(done_);
    }
    [[nodiscard]] Result<void> result() const {
        if (out_of_memory_) return out_of_memory_error();
        if (stopped_) return Error{ErrorCode::cancelled, {}, "cancelled"};
        return {};
    }

private:
    void report(int done) {
        if (done <= reported_) return;
        reported_ = done;
        const double fraction = span_.from + (span_.to - span_.from) * done / pieces_;
        if (!execution_.progress(fraction)) stopped_.store(true, std::memory_order_relaxed);
    }

    const Execution& execution_;
    const int pieces_;
    const ProgressSpan span_;
    std::atomic<int> done_{0};
    std::atomic<bool> stopped_{false};
    std::atomic<bool> out_of_memory_{false};
    std::mutex reporting_;
    int reported_ = 0;
};

}  // namespace

Execution part_of(const Execution& execution, double from, double to) {
    if (!execution.progress) return execution;
    Execution part = execution.quiet();
    part.progress = [&execution, from, to](double done) { return execution.progress(from + (to - from) * done); };
    return part;
}

int thread_count(const Execution& execution) {
    return execution.threads > 0 ? execution.threads : std::max(1, tbb::info::default_concurrency());
}

Result<void> parallel_for(const Execution& execution, int count, int grain, const LoopBody& body, ProgressSpan span) {
    grain = std::max(1, grain);
    const int pieces = (count + grain - 1) / grain;
    Ticker ticker(execution, pieces, span);
    const auto run = [&](int piece) {
        if (ticker.stopped()) return;
        const RowAllocation own(execution.allocate);
        try {
            const int begin = piece * grain;
            body(begin, std::min(count, begin + grain));
        } catch (const std::bad_alloc&) {
            ticker.fail_memory();
            return;
        }
        ticker.tick();
    };
    int threads = std::min(thread_count(execution), pieces);
    if (threads > 1 && execution.parallel) {
        execution.parallel(pieces, run);
        ticker.finish();
        return ticker.result();
    }
    // TBB prints a warning to stderr if an arena requests more threads than are allowed (by default, one for each
    // processor). One thread needs no TBB.
    if (threads > 1) {
        const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
        threads = std::min(threads, static_cast<int>(allowed));
    }
    if (threads <= 1) {
        for (int piece = 0; piece < pieces; ++piece) run(piece);
    } else {
        try {
            fork_join(threads, pieces, run);
        } catch (const std::runtime_error&) {
            return no_threads_error();
        }
    }
    ticker.finish();
    return ticker.result();
}

}  // namespace tex::inline v1
