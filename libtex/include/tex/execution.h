// SPDX-License-Identifier: Apache-2.0
// execution.h: threads, progress and cancellation: the last argument of every verb on whole images.

#pragma once

#include <functional>

#pragma GCC visibility push(default)
namespace tex {

// How a verb runs. The result never depends on it: the bytes are the same for every number of threads.
struct Execution {
    // The largest number of threads, 1 or more; 0 means one for each processor that this process may use. If the system
    // refuses threads, the verb uses fewer, down to the caller's thread alone.
    int threads = 0;

    // Called from time to time, never from two threads at once, with the fraction done (0 to 1, not decreasing within
    // one call of a verb). If it returns false, the verb stops soon and returns ErrorCode::cancelled. May be empty.
    // Must not throw.
    std::function<bool(double fraction)> progress;
};

}  // namespace tex
#pragma GCC visibility pop
