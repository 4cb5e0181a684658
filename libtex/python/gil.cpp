// SPDX-License-Identifier: Apache-2.0
#include "gil.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include <cxxabi.h>

namespace tex::python {
namespace {

// Work that takes no Execution may wait for something else, such as a FIFO.
constexpr std::chrono::seconds kLongestExit{10};

// All work of this process.
struct Works {
    std::mutex mutex;
    std::condition_variable ended;
    std::vector<std::atomic<bool>*> stops;  // null for work that cannot be stopped
    bool exiting = false;
    std::thread::id exits;  // the thread that runs the exit
};

Works& works() {
    static auto* const all = new Works;  // outlives static objects
    return *all;
}

[[noreturn]] void wait_for_ever() {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

void stop_all_work() {
    const WithoutGil released;
    Works& all = works();
    std::unique_lock lock(all.mutex);
    all.exiting = true;
    all.exits = std::this_thread::get_id();
    for (std::atomic<bool>* const stop : all.stops) {
        if (stop != nullptr) stop->store(true);
    }
    all.ended.wait_for(lock, kLongestExit, [&all] { return all.stops.empty(); });
}

}  // namespace

void take_gil(PyThreadState* state) noexcept {
    try {
        PyEval_RestoreThread(state);
    } catch (abi::__forced_unwind&) {  // pthread_exit()
        wait_for_ever();
    }
}

py::object call_with(const py::object& callable, double fraction) {
    // Plain pointers, because destructors would run without the GIL.
    PyObject* const argument = PyFloat_FromDouble(fraction);
    PyObject* answer = nullptr;
    try {
        if (argument != nullptr) answer = PyObject_CallOneArg(callable.ptr(), argument);
    } catch (abi::__forced_unwind&) {
        wait_for_ever();
    }
    Py_XDECREF(argument);
    return py::reinterpret_steal<py::object>(answer);
}

py::object call_method(py::handle object, const char* method, py::handle argument) {
    PyObject* const name = PyUnicode_FromString(method);
    PyObject* answer = nullptr;
    try {
        if (name != nullptr) answer = PyObject_CallMethodOneArg(object.ptr(), name, argument.ptr());
    } catch (abi::__forced_unwind&) {
        wait_for_ever();
    }
    Py_XDECREF(name);
    if (answer == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::object>(answer);
}

Work::Work(std::atomic<bool>* stop) : stop_(stop) {
    Works& all = works();
    const std::lock_guard lock(all.mutex);
    all.stops.push_back(stop_);
    if (stop_ != nullptr && all.exiting && all.exits != std::this_thread::get_id()) stop_->store(true);
}

Work::~Work() {
    if (ended_) return;
    Works& all = works();
    const std::lock_guard lock(all.mutex);
    all.stops.erase(std::find(all.stops.begin(), all.stops.end(), stop_));
    all.ended.notify_all();
}

void Work::end_with_thread() {
    Works& all = works();
    std::unique_lock lock(all.mutex);
    ended_ = true;
    all.stops.erase(std::find(all.stops.begin(), all.stops.end(), stop_));
    std::notify_all_at_thread_exit(all.ended, std::move(lock));
}

void need_interpreter() {
    Works& all = works();
    {
        const std::lock_guard lock(all.mutex);
        if (!all.exiting || all.exits == std::this_thread::get_id()) return;
    }
    PyErr_SetNone(PyExc_SystemExit);
    throw py::error_already_set();
}

void stop_work_at_exit() {
    py::module_::import("atexit").attr("register")(py::cpp_function(&stop_all_work));
    // A child has no thread but its own, and maybe a lock that another one held.
    py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                           py::cpp_function([] { new (&works()) Works; }));
}

}  // namespace tex::python
