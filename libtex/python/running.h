// SPDX-License-Identifier: Apache-2.0
// running.h: runs a verb without the GIL.
//
// The verb runs on a separate thread while the caller's thread waits. The progress callback is therefore called on the
// caller's thread, one call at a time, and Ctrl-C works even if the verb reports no progress for a long time.

#pragma once

#include <functional>
#include <optional>
#include <utility>

#include <pybind11/pybind11.h>
#include <tex/types.h>

#include "errors.h"
#include "gil.h"

namespace tex::python {

// The arguments `threads` and `progress`.
struct Running {
    int threads = 0;
    py::object progress = py::none();

    // The value of the Result that body(execution) returns. An exception of the callback, or KeyboardInterrupt, cancels
    // the verb and is raised. The callback's first fraction is 0, and its last is 1 if the verb has succeeded. False is
    // an answer at any of them.
    template <class Body>
    auto run(const Body& body) {
        std::optional<decltype(body(std::declval<const Execution&>()))> result;
        const double told = wait([&](const Execution& execution) { result.emplace(body(execution)); });
        if (*result && told < 1.0 && !tell(1.0)) raise_cancelled();
        return value_of(std::move(*result));
    }

    // Calls `work` on another thread and returns when it has ended. Returns the last fraction that the callback got.
    double wait(const std::function<void(const Execution&)>& work) const;

private:
    // Whether the callback does not return False.
    [[nodiscard]] bool tell(double fraction) const;
    [[noreturn]] static void raise_cancelled();
};

template <class F>
void each_field(Running& o, F& f) {
    f("threads", o.threads);
    f("progress", o.progress, "Callable[[float], object] | None");
}

}  // namespace tex::python
