// SPDX-License-Identifier: Apache-2.0
// fork_join.h: a loop on TBB's threads, whose order the thread sanitizer understands.
//
// TBB's library is not compiled with the sanitizer, which so cannot see that a body begins after its loop does and ends
// before it, and takes every use of what a body wrote for a race. Here it is told. (What TBB's headers and the lambda below do
// among themselves is in tests/tsan.supp.)

#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace tex {

#if defined(__SANITIZE_THREAD__)
inline char fork_moment = 0;
inline char join_moment = 0;
inline void happens_before(char& moment) { __tsan_release(&moment); }
inline void happens_after(char& moment) { __tsan_acquire(&moment); }
#else
inline constexpr char fork_moment = 0;
inline constexpr char join_moment = 0;
inline void happens_before(char) {}
inline void happens_after(char) {}
#endif

// Calls body(k) for every k in [0, count), on up to `threads` threads, begun about in order; returns when all of them have returned.
// Precondition: 2 <= threads <= what tbb::global_control allows (TBB would warn on stderr).
template <class Body>
void fork_join(int threads, int count, const Body& body) {
    happens_before(fork_moment);
    tbb::task_arena(threads).execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<int>(0, count, 1),
            [&](const tbb::blocked_range<int>& range) {
                happens_after(fork_moment);
                for (int k = range.begin(); k < range.end(); ++k) body(k);
                happens_before(join_moment);
            },
            tbb::simple_partitioner());
    });
    happens_after(join_moment);
}

}  // namespace tex
