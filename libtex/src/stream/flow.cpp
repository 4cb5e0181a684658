// SPDX-License-Identifier: Apache-2.0
// Of the tasks that wait for nothing, those nearest to the targets are done first, so that strips are soon forgotten
// and most of them stay with one thread, and in its processor's cache. Reading comes last, with one exception: if rows
// can only be read in order, everything else waits for them, so a free thread reads first. Nothing is read while the
// oldest strip that a target could have written is a few strips old.

#include "stream/flow.h"

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>

#include <tbb/global_control.h>

#include "stream/flow_plan.h"
#include "threads/fork_join.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

class FlowRun {
public:
    FlowRun(Flow& flow, const Execution& execution, const StreamSizes& sizes);

    Result<void> run();

private:
    using Line = FlowPlan::Line;

    void make_ready(int task);
    void work();
    [[nodiscard]] Line* next_line();
    [[nodiscard]] Line* next_reading(bool in_order_only);
    int take(Line& line);
    void do_task(int task, std::unique_lock<std::mutex>& lock);
    void complete(int task, std::shared_ptr<Strip> strip);
    void report(std::unique_lock<std::mutex>& lock);
    void fail(double place, const Error& error);

    Flow& flow_;
    const Execution& execution_;
    const bool alone_;
    const int threads_;
    std::mutex mutex_;  // guards all members below, and Stage::made_ while tasks complete
    FlowPlan plan_;
    const std::int64_t most_due_;  // texels: if more are due, nothing is read
    std::condition_variable changed_;
    int busy_ = 0;     // threads at work
    int waiting_ = 0;  // threads that wait
    int left_;         // tasks
    int reads_ = 0;    // strips that were read, or are being read
    // What is due: everything before next_due_ can be done, everything before oldest_due_ is done.
    std::size_t next_due_ = 0, oldest_due_ = 0;
    std::int64_t due_texels_ = 0;   // between the two
    std::int64_t made_texels_ = 0;  // of all targets
    std::optional<Error> error_;
    double error_place_ = 0.0;

    std::mutex reporting_;
};

namespace {

bool is_worth_threads(const std::vector<std::unique_ptr<Stage>>& stages, std::int64_t least) {
    return std::any_of(stages.begin(), stages.end(),
                       [least](const auto& stage) { return stage->extent().texels() >= least; });
}

int threads_of(const Execution& execution) {
    if (execution.parallel) return thread_count(execution);
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(thread_count(execution), static_cast<int>(allowed));
}

}  // namespace

FlowRun::FlowRun(Flow& flow, const Execution& execution, const StreamSizes& sizes)
    : flow_(flow), execution_(execution), alone_(!is_worth_threads(flow.stages_, sizes.worth_threads)),
      threads_(alone_ ? 1 : threads_of(execution)),
      plan_(flow.stages_, alone_ ? std::min(sizes.strip_texels, sizes.strip_texels_alone) : sizes.strip_texels,
            flow.rows_together_),
      most_due_(plan_.strip_texels * (threads_ + 2)), left_(plan_.tasks()) {
    for (int task = 0; task < plan_.tasks(); ++task) {
        if (plan_.waits[static_cast<std::size_t>(task)] == 0) make_ready(task);
    }
}

void FlowRun::make_ready(int task) {
    Line& line = plan_.lines[plan_.line_of(task)];
    line.ready.push_back(task);
    std::push_heap(line.ready.begin(), line.ready.end(), std::greater<>());
}

// The stage that reads and is farthest behind. Null if none can.
FlowRun::Line* FlowRun::next_reading(bool in_order_only) {
    Line* behind = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (Line& line : plan_.lines) {
        if (!line.stage->reads() || line.ready.empty() || (in_order_only && !line.stage->in_order())) continue;
        const double place = static_cast<double>(line.ready.front() - line.first) / line.count;
        if (place >= least) continue;
        least = place;
        behind = &line;
    }
    return behind;
}

// The line whose first task is done next. Null if all tasks wait for others.
FlowRun::Line* FlowRun::next_line() {
    if (error_) return nullptr;
    const bool reads_on = due_texels_ < most_due_;
    if (threads_ > 1 && reads_on) {
        if (Line* const reading = next_reading(true)) return reading;
    }
    for (auto line = plan_.lines.rbegin(); line != plan_.lines.rend(); ++line) {
        if (!line->stage->reads() && !line->ready.empty()) return &*line;
    }
    return reads_on || busy_ == 0 ? next_reading(false) : nullptr;
}

int FlowRun::take(Line& line) {
    std::pop_heap(line.ready.begin(), line.ready.end(), std::greater<>());
    const int task = line.ready.back();
    line.ready.pop_back();
    ++busy_;
    if (!line.stage->reads()) return task;
    ++reads_;
    for (; next_due_ < plan_.due.size() && plan_.due[next_due_].reads <= reads_; ++next_due_)
        due_texels_ += plan_.due[next_due_].texels;
    return task;
}

// Works until nothing is left. Waits while the remaining work depends on another thread. Whoever takes a task wakes one
// more thread if there is another one, so that threads without work sleep: if rows can only be read in order, most do,
// and waking all of them for each strip would disturb the one that reads.
void FlowRun::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        if (Line* const line = next_line()) {
            do_task(take(*line), lock);
        } else if (busy_ == 0) {
            changed_.notify_all();
            return;
        } else {
            ++waiting_;
            changed_.wait(lock);
            --waiting_;
        }
    }
}

void FlowRun::do_task(int task, std::unique_lock<std::mutex>& lock) {
    const Line& line = plan_.lines[plan_.line_of(task)];
    Stage& stage = *line.stage;
    const bool wakes = waiting_ > 0 && next_line() != nullptr;
    lock.unlock();
    if (wakes) changed_.notify_one();
    std::shared_ptr<Strip> strip;
    const int first = line.row_of(task);
    const Result<void> done = no_throw([&]() -> Result<void> {
        if (flow_.only_counts_ && !stage.counts()) return {};
        strip = stage.pool_.take([&stage] { return stage.new_strip(stage.held_rows_); });
        strip->first = first;
        strip->height = line.rows_of(task);
        return stage.make(*strip);
    });
    lock.lock();
    --busy_;
    if (!done) return fail(static_cast<double>(first) / stage.extent().height, done.error());
    complete(task, std::move(strip));
    if (line.is_target || stage.reads()) report(lock);
}

void FlowRun::complete(int task, std::shared_ptr<Strip> strip) {
    const auto index = static_cast<std::size_t>(task);
    const Line& line = plan_.lines[plan_.line_of(task)];
    --left_;
    if (line.is_target) {
        made_texels_ += line.texels_of(task);
        plan_.due[static_cast<std::size_t>(plan_.due_of[index])].is_done = true;
        for (; oldest_due_ < next_due_ && plan_.due[oldest_due_].is_done; ++oldest_due_)
            due_texels_ -= plan_.due[oldest_due_].texels;
    }
    if (plan_.users[index] > 0) line.stage->made_[static_cast<std::size_t>(task - line.first)] = std::move(strip);
    for (const int waiting : plan_.after(task)) {
        if (--plan_.waits[static_cast<std::size_t>(waiting)] == 0) make_ready(waiting);
    }
    for (const int used : plan_.before(task)) {
        if (--plan_.users[static_cast<std::size_t>(used)] > 0) continue;
        const Line& owner = plan_.lines[plan_.line_of(used)];
        owner.stage->made_[static_cast<std::size_t>(used - owner.first)].reset();
    }
}

void FlowRun::fail(double place, const Error& error) {
    if (!error_ || place < error_place_) {
        error_ = error;
        error_place_ = place;
    }
    changed_.notify_all();
}

// One thread at a time reports, and none after an error.
void FlowRun::report(std::unique_lock<std::mutex>& lock) {
    if (!execution_.progress) return;
    lock.unlock();
    const std::lock_guard one_at_a_time(reporting_);
    lock.lock();
    if (error_) return;
    const double fraction = static_cast<double>(made_texels_) / static_cast<double>(plan_.target_texels);
    lock.unlock();
    const bool goes_on = execution_.progress(fraction);
    lock.lock();
    if (!goes_on) fail(-1.0, {ErrorCode::cancelled, {}, "cancelled"});
}

Result<void> FlowRun::run() {
    try {
        if (threads_ > 1) {
            const auto worker = [this](int) { work(); };
            if (execution_.parallel) {
                execution_.parallel(threads_, worker);
            } else {
                fork_join(threads_, threads_, worker);
            }
        } else {
            work();
        }
    } catch (const std::runtime_error&) {
        return no_threads_error();
    }
    if (error_) return *error_;
    for (const Line& line : plan_.lines) {
        if (Result<void> sound = line.stage->check(); !sound) return sound;
    }
    // Rather fail than write a file with holes.
    if (left_ > 0) return Error{ErrorCode::unsupported, {}, "rows are missing: this is a bug"};
    return {};
}

Result<void> Flow::run(const Execution& execution, const StreamSizes& sizes) {
    return FlowRun(*this, execution, sizes).run();
}

}  // namespace tex::inline v1
