// SPDX-License-Identifier: Apache-2.0
#include "running.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>

#include "arguments.h"

namespace tex::python {
namespace {

// What the two threads tell each other.
class News {
public:
    explicit News(bool listens) : listens_(listens) {}  // whether anyone wants the fractions

    // On the thread of the verb. Returns false if it must stop. The end waits until it was told: the verb may have no
    // other report, and a file is not yet in its place.
    bool report(double fraction) {
        if (listens_) {
            std::unique_lock lock(mutex_);
            fraction_ = fraction;
            changed_.notify_all();
            while (fraction >= 1.0 && told_ < fraction && !stop_)
                changed_.wait_for(lock, std::chrono::milliseconds(20));
        }
        return !stop_.load(std::memory_order_relaxed);
    }
    void end() {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        changed_.notify_all();
    }

    // On the caller's thread, without the GIL. Waits for the end, a fraction that was not told, or a short time, after
    // which signals are due. Returns whether the verb has ended.
    bool wait() {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::milliseconds(20),
                          [&] { return ended_ || (listens_ && fraction_ > told_ && !stop_); });
        return ended_;
    }
    // A fraction above those that were told, or nothing.
    [[nodiscard]] std::optional<double> fraction() {
        const std::lock_guard lock(mutex_);
        return fraction_ > told_ ? std::optional(fraction_) : std::nullopt;
    }
    void was_told(double fraction) {
        const std::lock_guard lock(mutex_);
        told_ = fraction;
        changed_.notify_all();
    }
    [[nodiscard]] double told() {
        const std::lock_guard lock(mutex_);
        return told_;
    }
    void stop() { stop_ = true; }
    [[nodiscard]] std::atomic<bool>& stopped() { return stop_; }

private:
    const bool listens_;
    std::mutex mutex_;
    std::condition_variable changed_;
    double fraction_ = 0.0, told_ = 0.0;
    bool ended_ = false;
    std::atomic<bool> stop_{false};
};

// False, and numpy's.
bool is_false(py::handle answer) {
    if (answer.ptr() == Py_False) return true;
    const char* const type = Py_TYPE(answer.ptr())->tp_name;
    const bool is_numpy = std::string_view(type) == "numpy.bool_" || std::string_view(type) == "numpy.bool";
    return is_numpy && PyObject_IsTrue(answer.ptr()) == 0;
}

}  // namespace

bool Running::tell(double fraction) const {
    if (progress.is_none()) return true;
    const py::object answer = call_with(progress, fraction);
    if (!answer) throw py::error_already_set();
    return !is_false(answer);
}

void Running::raise_cancelled() { raise(Error{ErrorCode::cancelled, {}, "cancelled"}); }

double Running::wait(const std::function<void(const Execution&)>& work) const {
    need_interpreter();
    need(threads >= 0, "threads", "must be 0, one for each processor, or more");
    const bool listens = !progress.is_none();
    if (listens && PyCallable_Check(progress.ptr()) == 0) raise_type("progress", "a callable or None", progress);
    if (!tell(0.0)) raise_cancelled();
    News news(listens);
    const Execution execution{threads, [&news](double fraction) { return news.report(fraction); }};
    Work known(&news.stopped());
    std::thread worker;
    try {
        worker = std::thread([&] {
            work(execution);
            known.end_with_thread();
            news.end();
        });
    } catch (const std::system_error&) {  // no thread: the verb runs here, and nothing interrupts it
        const WithoutGil released;
        news.was_told(1.0);  // nobody waits for the end
        work(execution);
        return 0.0;
    }

    std::optional<py::error_already_set> raised;
    for (bool ended = false; !ended;) {
        {
            const WithoutGil released;
            ended = news.wait();
            if (ended) worker.join();
        }
        if (news.stopped()) continue;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            const std::optional<double> fraction = news.fraction();
            if (!fraction) continue;
            if (!tell(*fraction)) news.stop();
            news.was_told(*fraction);
        } catch (const py::error_already_set& error) {
            raised.emplace(error);
            news.stop();
        }
    }
    if (raised) throw py::error_already_set(*raised);
    need_interpreter();
    return news.told();
}

}  // namespace tex::python
