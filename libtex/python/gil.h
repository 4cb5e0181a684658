// SPDX-License-Identifier: Apache-2.0
// gil.h: work without the GIL, and what becomes of it when the interpreter exits.
//
// Python ends a thread that asks for the GIL during its exit, with an exception that no destructor lets through: the
// process would abort. Here such a thread waits instead, until the process is gone. And before anything of the process
// is taken down, stop_all_work() asks all work to stop and waits for it.

#pragma once

#include <atomic>

#include <pybind11/pybind11.h>

namespace tex::python {

namespace py = pybind11;

// PyEval_RestoreThread(), which does not return if the interpreter exits.
void take_gil(PyThreadState* state) noexcept;

// progress(fraction), which does not return either if the interpreter exits meanwhile. Returns null with an exception.
py::object call_with(const py::object& callable, double fraction);

// Calls a method of an object that may give up the GIL on its way, as those of NumPy's arrays do. If the interpreter
// ends meanwhile, the thread waits for ever instead of unwinding through C++. Throws py::error_already_set.
py::object call_method(py::handle object, const char* method, py::handle argument);

// While this object exists, work goes on for which an exit waits. `stop` is set if it should end early.
class Work {
public:
    explicit Work(std::atomic<bool>* stop = nullptr);
    ~Work();
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

    // It ends with the calling thread, whatever becomes of this object.
    void end_with_thread();

private:
    std::atomic<bool>* stop_;
    bool ended_ = false;
};

class WithoutGil {
public:
    WithoutGil() : state_(PyEval_SaveThread()) {}
    ~WithoutGil() { take_gil(state_); }
    WithoutGil(const WithoutGil&) = delete;
    WithoutGil& operator=(const WithoutGil&) = delete;

private:
    PyThreadState* state_;
};

// What body() returns. It takes no Execution, so nothing interrupts it.
template <class Body>
auto without_gil(const Body& body) {
    const WithoutGil released;
    const Work work;
    return body();
}

// Raises SystemExit, which ends a thread without a message, if the interpreter exits and this is another thread.
void need_interpreter();

// Lets the module atexit stop the work.
void stop_work_at_exit();

}  // namespace tex::python
