// SPDX-License-Identifier: Apache-2.0

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <limits>

#include "reader.h"

namespace tex::reader {
namespace {

// Lowers a limit for good. Returns what then applies.
template <class Resource>
rlim_t limit(Resource what, std::int64_t value) {
    rlimit now{};
    if (getrlimit(what, &now) != 0) return RLIM_INFINITY;
    const rlim_t lowest = std::min(now.rlim_max, static_cast<rlim_t>(value));
    const rlimit limits{lowest, lowest};
    setrlimit(what, &limits);
    return lowest;
}

rlim_t highest = RLIM_INFINITY;  // the result of memory_limit()

}  // namespace

void limit_process(const Task& task) {
    static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));  // a result that is too large is then an error of pwrite()
    end_with_parent();
    if (getppid() != task.parent) _exit(1);  // it ended before this call
    constexpr int kDescriptors = 64;
#ifndef TEX_READER_SHADOW
    highest = limit(RLIMIT_AS, task.memory);
#endif
    highest = std::min(highest, limit(RLIMIT_FSIZE, task.memory));
    limit(RLIMIT_CPU, task.seconds + 1);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_NOFILE, kDescriptors);
}

std::int64_t memory_limit() {
    return static_cast<std::int64_t>(std::min<rlim_t>(highest, std::numeric_limits<std::int64_t>::max()));
}

}  // namespace tex::reader
