// SPDX-License-Identifier: Apache-2.0
// task_group.h: the part of oneTBB that libtex uses, for one thread: loops run where they are called.

#pragma once

#include <cstddef>
#include <utility>

namespace tbb {

class global_control {
public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t) {}
    static std::size_t active_value(parameter) { return 1; }
};

namespace info {
inline int default_concurrency() { return 1; }
}  // namespace info

class task_arena {
public:
    static constexpr int automatic = -1;
    explicit task_arena(int = automatic) {}
    template <class Body>
    auto execute(Body&& body) {
        return std::forward<Body>(body)();
    }
};

class task_group {
public:
    template <class Body>
    void run(Body&& body) {
        std::forward<Body>(body)();
    }
    template <class Body>
    void run_and_wait(Body&& body) {
        std::forward<Body>(body)();
    }
};

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
    for (Index k = first; k < last; ++k) body(k);
}

}  // namespace tbb

inline const char* TBB_runtime_version() { return "none: one thread"; }
