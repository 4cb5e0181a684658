// SPDX-License-Identifier: Apache-2.0
// queue.h: hands tasks to workers: the largest first, those that need others after them, and only as many at once as
// memory allows.

#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace tex::cli {

struct QueuedTask {
    std::int64_t cost = 0;    // tasks of higher cost come first
    std::int64_t memory = 0;  // bytes while the task runs
    std::vector<std::size_t> needs;
};

// Any thread may call take(), finish() and stop().
class TaskQueue {
public:
    // `memory` bounds the sum over running tasks. A task that needs more runs alone. The needs form no cycle.
    TaskQueue(std::vector<QueuedTask> tasks, std::int64_t memory);

    // Waits for a task that can start. Returns nothing when there is no further one.
    [[nodiscard]] std::optional<std::size_t> take();
    void finish(std::size_t task);
    // Makes all calls of take() return nothing.
    void stop();

private:
    using Ready = std::set<std::pair<std::int64_t, std::size_t>>;  // (-cost, task)

    [[nodiscard]] Ready::iterator startable();

    std::mutex mutex_;
    std::condition_variable changed_;
    const std::vector<QueuedTask> tasks_;
    std::vector<std::vector<std::size_t>> waiting_;  // the tasks that wait for each task
    std::vector<std::size_t> missing_;               // how many needs of each task are not finished
    Ready ready_;
    const std::int64_t memory_;
    std::int64_t used_ = 0;
    std::size_t running_ = 0;
    std::size_t left_ = 0;  // tasks that have not been taken
    bool stopped_ = false;
};

}  // namespace tex::cli
