// SPDX-License-Identifier: Apache-2.0

#include "tree/queue.h"

#include <algorithm>

namespace tex::cli {

TaskQueue::TaskQueue(std::vector<QueuedTask> tasks, std::int64_t memory)
    : tasks_(std::move(tasks)), waiting_(tasks_.size()), missing_(tasks_.size()), memory_(memory),
      left_(tasks_.size()) {
    for (std::size_t k = 0; k < tasks_.size(); ++k) {
        missing_[k] = tasks_[k].needs.size();
        for (const std::size_t needed : tasks_[k].needs) waiting_[needed].push_back(k);
        if (missing_[k] == 0) ready_.emplace(-tasks_[k].cost, k);
    }
}

TaskQueue::Ready::iterator TaskQueue::startable() {
    return std::find_if(ready_.begin(), ready_.end(), [this](const auto& entry) {
        return running_ == 0 || used_ + tasks_[entry.second].memory <= memory_;
    });
}

std::optional<std::size_t> TaskQueue::take() {
    std::unique_lock lock(mutex_);
    auto found = ready_.end();
    changed_.wait(lock, [&] { return stopped_ || left_ == 0 || (found = startable()) != ready_.end(); });
    if (stopped_ || left_ == 0) return std::nullopt;
    const std::size_t task = found->second;
    ready_.erase(found);
    used_ += tasks_[task].memory;
    ++running_;
    if (--left_ == 0) changed_.notify_all();
    return task;
}

void TaskQueue::finish(std::size_t task) {
    const std::lock_guard lock(mutex_);
    used_ -= tasks_[task].memory;
    --running_;
    for (const std::size_t other : waiting_[task]) {
        if (--missing_[other] == 0) ready_.emplace(-tasks_[other].cost, other);
    }
    changed_.notify_all();
}

void TaskQueue::stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
}

}  // namespace tex::cli
