// SPDX-License-Identifier: Apache-2.0
#include "running.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#include "arguments.h"

namespace tex::python {
namespace {

// What the two threads tell each other.
class News {
public:
    explicit News(bool listens) : listens_(listens) {}  // whether anyone wants the fractions

    // On the thread of the verb. Returns false if it must stop.
    bool report(double fraction) {
        if (listens_) {
            const std::lock_guard lock(mutex_);
            fraction_ = fraction;
            changed_.notify_one();
        }
        return !stop_.load(std::memory_order_relaxed);
    }
    void end() {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        changed_.notify_one();
    }

    // On the caller's thread, without the GIL. Waits for the end, a fraction above `told`, or a short time, after which
    // signals are due. Returns whether the verb has ended.
    bool wait(double told) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::milliseconds(20),
                          [&] { return ended_ || (listens_ && fraction_ > told && !stop_); });
        return ended_;
    }
    [[nodiscard]] double fraction() {
        const std::lock_guard lock(mutex_);
        return fraction_;
    }
    void stop() { stop_ = true; }
    [[nodiscard]] bool stopped() const { return stop_; }

private:
    const bool listens_;
    std::mutex mutex_;
    std::condition_variable changed_;
    double fraction_ = -1.0;
    bool ended_ = false;
    std::atomic<bool> stop_{false};
};

}  // namespace

double Running::wait(const std::function<void(const Execution&)>& work) const {
    need(threads >= 0, "threads", "must be 0, one for each processor, or more");
    const bool listens = !progress.is_none();
    if (listens && PyCallable_Check(progress.ptr()) == 0) raise_type("progress", "a callable or None", progress);
    News news(listens);
    const Execution execution{threads, [&news](double fraction) { return news.report(fraction); }};
    std::thread worker;
    try {
        worker = std::thread([&] {
            work(execution);
            news.end();
        });
    } catch (const std::system_error&) {  // no thread: the verb runs here, and nothing interrupts it
        py::gil_scoped_release release;
        work(execution);
        return 0.0;
    }

    std::optional<py::error_already_set> raised;
    double told = -1.0;
    const auto tell = [&] {
        const double fraction = news.fraction();
        if (!listens || fraction <= told) return;
        told = fraction;
        if (progress(fraction).ptr() == Py_False) news.stop();
    };
    for (bool ended = false; !ended;) {
        {
            py::gil_scoped_release release;
            ended = news.wait(told);
            if (ended) worker.join();
        }
        if (news.stopped()) continue;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            tell();
        } catch (const py::error_already_set& error) {
            raised.emplace(error);
            news.stop();
        }
    }
    if (raised) throw py::error_already_set(*raised);
    return told;
}

}  // namespace tex::python
