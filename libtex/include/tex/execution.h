// SPDX-License-Identifier: Apache-2.0
// execution.h: threads, progress and cancellation, which every whole-image verb takes as its last argument.

#pragma once

#include <functional>

#pragma GCC visibility push(default)
namespace tex {

// How a verb runs. The result never depends on it: the bytes are the same for every number of threads.
struct Execution {
    // Most threads at once, 1 or more; 0 means one for each processor that this process may use. Where
    // the system refuses threads, fewer are used, down to the caller's own.
    int threads = 0;

    // Called now and then, never from two threads at once, with the fraction done (0 to 1, not
    // decreasing within one call of a verb). Return false to cancel: the verb then stops soon and
    // returns ErrorCode::cancelled. May be empty. Must not throw.
    std::function<bool(double fraction)> progress;
};

}  // namespace tex
#pragma GCC visibility pop
