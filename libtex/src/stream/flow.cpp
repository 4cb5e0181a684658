// SPDX-License-Identifier: Apache-2.0
// A task makes one strip of one stage. It waits for the strips that it needs, and, if its stage is in order, for the
// strip before it. Of the tasks that wait for nothing, those nearest to the targets are done first, so that strips are
// soon forgotten and most of them stay with one thread, and in its processor's cache. Reading comes last, with one
// exception: if rows can only be read in order, everything else waits for them, so a free thread reads first. Nothing
// is read while the targets are a few strips behind what they could have written.

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

#include "blocks/extent.h"
#include "threads/fork_join.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {

int Stage::choose_strip_rows(int texels, int together) const {
    const std::int64_t base_width = static_cast<std::int64_t>(extent_.width) << level_;
    const int rows = static_cast<int>(texels / base_width) >> level_;
    return std::max(together, rows / together * together);
}

std::unique_ptr<Strip> Stage::new_strip(int rows) const {
    auto strip = std::make_unique<Strip>();
    const Extent extent{extent_.width, rows};
    if (planes_ == 1) strip->map.x = Plane<float>(extent);
    if (planes_ > 1) strip->map = NormalMap(extent);
    if (planes_ > 3) strip->fourth = Plane<float>(extent);
    return strip;
}

class FlowRun {
public:
    FlowRun(Flow& flow, const Execution& execution, const StreamSizes& sizes);

    Result<void> run();

private:
    // The tasks of a stage, which are numbered from `first`.
    struct Line {
        Stage* stage;
        int first = 0;
        int count = 0;
        bool is_target = false;  // nothing needs its strips
        std::vector<int> ready;  // a heap: the topmost strip comes first

        [[nodiscard]] int row_of(int task) const { return stage->begin() + (task - first) * stage->strip_rows_; }
        [[nodiscard]] int rows_of(int task) const {
            return std::min(stage->strip_rows_, stage->extent().height - row_of(task));
        }
        [[nodiscard]] std::int64_t texels_of(int task) const {
            return static_cast<std::int64_t>(stage->extent().width) * rows_of(task);
        }
    };
    // What the targets can write when so many strips have been read.
    struct Due {
        int reads = 0;
        std::int64_t texels = 0;
    };

    void divide(int texels);
    void link();
    void link_after(const std::vector<std::pair<int, int>>& pairs);
    void plan_reading();
    [[nodiscard]] std::size_t line_of(int task) const;
    void make_ready(int task);
    void work();
    [[nodiscard]] std::optional<int> next_task();
    [[nodiscard]] std::optional<int> next_reading(bool in_order_only);
    int pop(Line& line);
    void do_task(int task, std::unique_lock<std::mutex>& lock);
    void complete(int task, std::shared_ptr<Strip> strip);
    void report(std::unique_lock<std::mutex>& lock);
    void fail(double place, const Error& error);

    Flow& flow_;
    const Execution& execution_;
    const bool alone_;
    const int threads_;
    std::vector<Line> lines_;
    // For each task: how many strips it still waits for; how many tasks still need its strip; the tasks that wait for
    // it; the tasks whose strips it needs.
    std::vector<int> waits_, users_;
    std::vector<int> after_begin_, after_;
    std::vector<int> before_begin_, before_;
    std::vector<Due> due_;
    std::int64_t most_due_ = 0;  // texels: if more are due, nothing is read

    std::mutex mutex_;  // guards all members below, and Stage::made_ while tasks complete
    std::condition_variable changed_;
    int busy_ = 0;     // threads at work
    int waiting_ = 0;  // threads that wait
    int left_ = 0;     // tasks
    int reads_ = 0;    // strips that were read, or are being read
    std::size_t next_due_ = 0;
    std::int64_t due_texels_ = 0, made_texels_ = 0, all_texels_ = 0;  // of the targets
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
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(thread_count(execution), static_cast<int>(allowed));
}

}  // namespace

FlowRun::FlowRun(Flow& flow, const Execution& execution, const StreamSizes& sizes)
    : flow_(flow), execution_(execution), alone_(!is_worth_threads(flow.stages_, sizes.worth_threads)),
      threads_(alone_ ? 1 : threads_of(execution)) {
    divide(alone_ ? std::min(sizes.strip_texels, sizes.strip_texels_alone) : sizes.strip_texels);
    link();
    plan_reading();
}

// Divides the stages into strips.
void FlowRun::divide(int texels) {
    int task = 0;
    for (const std::unique_ptr<Stage>& each : flow_.stages_) {
        Stage& stage = *each;
        const int rows = stage.extent().height - stage.begin();
        const int together = flow_.rows_together_;
        stage.strip_rows_ = stage.choose_strip_rows(texels, together);
        stage.held_rows_ = std::min(stage.strip_rows_, whole_blocks(rows, together));
        stage.line_ = lines_.size();
        Line line{&stage, task, (rows + stage.strip_rows_ - 1) / stage.strip_rows_, false, {}};
        stage.made_.assign(static_cast<std::size_t>(line.count), nullptr);
        line.ready.reserve(static_cast<std::size_t>(line.count));
        task += line.count;
        lines_.push_back(std::move(line));
    }
    left_ = task;
    waits_.assign(static_cast<std::size_t>(task), 0);
    users_.assign(static_cast<std::size_t>(task), 0);
}

// Finds out which task waits for which.
void FlowRun::link() {
    std::vector<std::pair<int, int>> pairs;  // a task, and one that waits for it
    for (const Line& line : lines_) {
        const Stage& stage = *line.stage;
        for (int task = line.first; task < line.first + line.count; ++task) {
            const std::size_t begin = before_.size();
            before_begin_.push_back(static_cast<int>(begin));
            const int first = line.row_of(task);
            for (const Need& need : stage.needs(first, first + line.rows_of(task))) {
                const Line& from = lines_[need.stage->line_];
                const int rows = need.stage->strip_rows_, top = need.stage->begin();
                for (int k = (need.first - top) / rows; k <= (need.end - 1 - top) / rows; ++k)
                    before_.push_back(from.first + k);
            }
            const auto mine = before_.begin() + static_cast<std::ptrdiff_t>(begin);
            std::sort(mine, before_.end());
            before_.erase(std::unique(mine, before_.end()), before_.end());
            for (std::size_t k = begin; k < before_.size(); ++k) {
                pairs.emplace_back(before_[k], task);
                ++users_[static_cast<std::size_t>(before_[k])];
            }
            if (task > line.first && stage.in_order()) pairs.emplace_back(task - 1, task);
        }
    }
    before_begin_.push_back(static_cast<int>(before_.size()));
    link_after(pairs);
    for (Line& line : lines_) {
        const auto users = users_.begin() + line.first;
        line.is_target = std::all_of(users, users + line.count, [](int count) { return count == 0; });
        for (int task = line.first; task < line.first + line.count; ++task) {
            if (waits_[static_cast<std::size_t>(task)] == 0) make_ready(task);
        }
    }
}

void FlowRun::link_after(const std::vector<std::pair<int, int>>& pairs) {
    after_begin_.assign(waits_.size() + 1, 0);
    for (const auto& [task, waiting] : pairs) {
        ++after_begin_[static_cast<std::size_t>(task) + 1];
        ++waits_[static_cast<std::size_t>(waiting)];
    }
    for (std::size_t k = 0; k + 1 < after_begin_.size(); ++k) after_begin_[k + 1] += after_begin_[k];
    after_.resize(pairs.size());
    std::vector<int> next(after_begin_.begin(), after_begin_.end() - 1);
    for (const auto& [task, waiting] : pairs)
        after_[static_cast<std::size_t>(next[static_cast<std::size_t>(task)]++)] = waiting;
}

// Finds out how much must have been read before a strip of a target can be made. Strips are read in the order of
// next_reading().
void FlowRun::plan_reading() {
    std::vector<std::pair<double, int>> order;
    for (const Line& line : lines_) {
        for (int k = 0; line.stage->reads() && k < line.count; ++k)
            order.emplace_back(static_cast<double>(k) / line.count, line.first + k);
        if (line.stage->reads() && line.count > 0) most_due_ = std::max(most_due_, line.texels_of(line.first));
    }
    most_due_ *= threads_ + 2;
    std::sort(order.begin(), order.end());
    std::vector<int> reads(waits_.size(), 0);
    for (std::size_t k = 0; k < order.size(); ++k)
        reads[static_cast<std::size_t>(order[k].second)] = static_cast<int>(k) + 1;
    for (const Line& line : lines_) {  // those that a stage needs come before it
        for (int task = line.first; task < line.first + line.count; ++task) {
            const auto index = static_cast<std::size_t>(task);
            for (int k = before_begin_[index]; k < before_begin_[index + 1]; ++k)
                reads[index] =
                    std::max(reads[index], reads[static_cast<std::size_t>(before_[static_cast<std::size_t>(k)])]);
            if (!line.is_target) continue;
            due_.push_back({reads[index], line.texels_of(task)});
            all_texels_ += line.texels_of(task);
        }
    }
    std::sort(due_.begin(), due_.end(), [](const Due& a, const Due& b) { return a.reads < b.reads; });
}

std::size_t FlowRun::line_of(int task) const {
    const auto after = std::upper_bound(lines_.begin(), lines_.end(), task,
                                        [](int wanted, const Line& line) { return wanted < line.first; });
    return static_cast<std::size_t>(after - lines_.begin()) - 1;
}

void FlowRun::make_ready(int task) {
    Line& line = lines_[line_of(task)];
    line.ready.push_back(task);
    std::push_heap(line.ready.begin(), line.ready.end(), std::greater<>());
}

int FlowRun::pop(Line& line) {
    std::pop_heap(line.ready.begin(), line.ready.end(), std::greater<>());
    const int task = line.ready.back();
    line.ready.pop_back();
    return task;
}

// Of the stages that read, the one that is farthest behind.
std::optional<int> FlowRun::next_reading(bool in_order_only) {
    Line* behind = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (Line& line : lines_) {
        if (!line.stage->reads() || line.ready.empty() || (in_order_only && !line.stage->in_order())) continue;
        const double place = static_cast<double>(line.ready.front() - line.first) / line.count;
        if (place >= least) continue;
        least = place;
        behind = &line;
    }
    if (behind == nullptr) return std::nullopt;
    ++reads_;
    for (; next_due_ < due_.size() && due_[next_due_].reads <= reads_; ++next_due_)
        due_texels_ += due_[next_due_].texels;
    return pop(*behind);
}

std::optional<int> FlowRun::next_task() {
    if (error_) return std::nullopt;
    const bool reads_on = due_texels_ - made_texels_ < most_due_;
    if (threads_ > 1 && reads_on) {
        if (const std::optional<int> reading = next_reading(true)) return reading;
    }
    for (auto line = lines_.rbegin(); line != lines_.rend(); ++line) {
        if (!line->stage->reads() && !line->ready.empty()) return pop(*line);
    }
    return reads_on || busy_ == 0 ? next_reading(false) : std::nullopt;
}

// Works until nothing is left. Waits while the remaining work depends on another thread.
void FlowRun::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        if (const std::optional<int> task = next_task()) {
            do_task(*task, lock);
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
    const Line& line = lines_[line_of(task)];
    Stage& stage = *line.stage;
    ++busy_;
    lock.unlock();
    std::shared_ptr<Strip> strip;
    const int first = line.row_of(task);
    const Result<void> done = guarded([&]() -> Result<void> {
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
    report(lock);
}

void FlowRun::complete(int task, std::shared_ptr<Strip> strip) {
    const auto index = static_cast<std::size_t>(task);
    const Line& line = lines_[line_of(task)];
    --left_;
    if (line.is_target) made_texels_ += line.texels_of(task);
    if (users_[index] > 0) line.stage->made_[static_cast<std::size_t>(task - line.first)] = std::move(strip);
    for (int k = after_begin_[index]; k < after_begin_[index + 1]; ++k) {
        const int waiting = after_[static_cast<std::size_t>(k)];
        if (--waits_[static_cast<std::size_t>(waiting)] == 0) make_ready(waiting);
    }
    for (int k = before_begin_[index]; k < before_begin_[index + 1]; ++k) {
        const int used = before_[static_cast<std::size_t>(k)];
        if (--users_[static_cast<std::size_t>(used)] > 0) continue;
        const Line& owner = lines_[line_of(used)];
        owner.stage->made_[static_cast<std::size_t>(used - owner.first)].reset();
    }
    if (waiting_ > 0) changed_.notify_all();
}

void FlowRun::fail(double place, const Error& error) {
    if (!error_ || place < error_place_) {
        error_ = error;
        error_place_ = place;
    }
    changed_.notify_all();
}

void FlowRun::report(std::unique_lock<std::mutex>& lock) {
    if (!execution_.progress) return;
    lock.unlock();
    bool goes_on = true;
    {
        const std::lock_guard one_at_a_time(reporting_);
        lock.lock();
        const double fraction = static_cast<double>(made_texels_) / static_cast<double>(all_texels_);
        lock.unlock();
        goes_on = execution_.progress(fraction);
    }
    lock.lock();
    if (!goes_on) fail(-1.0, {ErrorCode::cancelled, {}, "cancelled"});
}

Result<void> FlowRun::run() {
    try {
        if (threads_ > 1) {
            fork_join(threads_, threads_, [this](int) { work(); });
        } else {
            work();
        }
    } catch (const std::runtime_error&) {
        return no_threads_error();
    }
    if (error_) return *error_;
    for (const Line& line : lines_) {
        if (Result<void> sound = line.stage->check(); !sound) return sound;
    }
    // Rather fail than write a file with holes.
    if (left_ > 0) return Error{ErrorCode::unsupported, {}, "rows are missing: this is a bug"};
    return {};
}

Result<void> Flow::run(const Execution& execution, const StreamSizes& sizes) {
    return FlowRun(*this, execution, sizes).run();
}

}  // namespace tex
