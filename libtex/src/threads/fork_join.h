// SPDX-License-Identifier: Apache-2.0
// fork_join.h: a loop on TBB's threads that the thread sanitizer understands.
//
// TBB's library is not compiled with the sanitizer. The sanitizer therefore cannot see that the bodies of a loop begin
// after the loop does and end before it, and reports every use of what a body wrote as a race. The annotations here
// state that order. (tests/tsan.supp covers what TBB's headers and the lambda below do among themselves.)

#pragma once

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <tex/types.h>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace tex::inline v1 {

#if defined(__SANITIZE_THREAD__)
inline char fork_moment = 0;
inline char join_moment = 0;
inline void happens_before(char& moment) { __tsan_release(&moment); }
inline void happens_after(char& moment) { __tsan_acquire(&moment); }
// The threads of a group count down in it when they have finished, after their bodies.
inline void happens_after(tbb::task_group& group) {
    for (std::size_t k = 0; k < sizeof(group); k += 8) __tsan_acquire(reinterpret_cast<char*>(&group) + k);
}
#else
inline constexpr char fork_moment = 0;
inline constexpr char join_moment = 0;
inline void happens_before(char) {}
inline void happens_after(char) {}
inline void happens_after(const tbb::task_group&) {}
#endif

// The Error if fork_join() throws std::runtime_error, which comes from TBB: threads that could be started a moment ago
// can no longer be started.
inline Error no_threads_error() { return {ErrorCode::out_of_memory, {}, "the system refuses threads"}; }

// Whether the system lets this process start `count` more threads, all at once. If TBB is refused a thread, it throws,
// and its count of threads is wrong from then on. So this function tries to start the threads first, each time that
// `count` exceeds the greatest number that has succeeded.
inline bool threads_can_start(int count) {
    static std::mutex mutex;
    static int most = 0;  // the greatest number that has succeeded
    const std::lock_guard lock(mutex);
    if (count <= most) return true;
    constexpr std::size_t kStack = std::size_t{4} << 20;  // the stack size that TBB uses
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, kStack);
    std::mutex together;  // locked until all threads have started
    together.lock();
    const auto wait = [](void* held) -> void* {
        static_cast<std::mutex*>(held)->lock();
        static_cast<std::mutex*>(held)->unlock();
        return nullptr;
    };
    std::vector<pthread_t> threads(static_cast<std::size_t>(count));
    std::size_t started = 0;
    while (started < threads.size() && pthread_create(&threads[started], &attributes, wait, &together) == 0) ++started;
    together.unlock();
    for (std::size_t k = 0; k < started; ++k) pthread_join(threads[k], nullptr);
    pthread_attr_destroy(&attributes);
    if (started == threads.size()) most = count;
    return started == threads.size();
}

// Calls body(k) for every k in [0, count), on up to `threads` threads, started in order, and returns when all calls
// have returned. If the system refuses threads, the calls run one after the other on this thread. Precondition: 2 <=
// threads <= what tbb::global_control allows (TBB would print a warning to stderr).
template <class Body>
void fork_join(int threads, int count, const Body& body) {
    const auto allowed =
        static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    if (!threads_can_start(std::max(threads, allowed) - 1)) {
        for (int k = 0; k < count; ++k) body(k);
        return;
    }
    std::atomic<int> next{0};
    const auto work = [&] {
        happens_after(fork_moment);
        for (int k = next.fetch_add(1); k < count; k = next.fetch_add(1)) body(k);
        happens_before(join_moment);
    };
    tbb::task_arena(threads).execute([&] {
        // Inside the arena: if run() throws, the group's destructor waits for tasks that only threads of the arena run.
        tbb::task_group group;
        happens_before(fork_moment);
        for (int k = 1; k < std::min(threads, count); ++k) group.run(work);
        group.run_and_wait(work);
        happens_after(group);
    });
    happens_after(join_moment);
}

}  // namespace tex::inline v1
