// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_child.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "formats/reader/reader_spawn.h"

namespace tex::inline v1 {
namespace {

Ending collect(pid_t child) {
    kill(-child, SIGKILL);  // no effect on a process that has ended; ends a process that only closed its pipe
    int status = 0;
    pid_t got = -1;
    do {
        got = waitpid(child, &status, 0);
    } while (got < 0 && errno == EINTR);
    if (got != child) return {};
    return {WIFSIGNALED(status) ? WTERMSIG(status) : 0, WIFEXITED(status) ? WEXITSTATUS(status) : 0};
}

}  // namespace

ReaderChild::ReaderChild(ReaderChild&& other) noexcept : id_(std::exchange(other.id_, -1)) {}

ReaderChild& ReaderChild::operator=(ReaderChild&& other) noexcept {
    if (this != &other) {
        end();
        id_ = std::exchange(other.id_, -1);
    }
    return *this;
}

ReaderChild::~ReaderChild() { end(); }

Ending ReaderChild::end() {
    const pid_t id = std::exchange(id_, -1);
    return id > 0 ? collect(id) : Ending{};
}

int start_reader(const std::string& program, const ReaderJob& job, int progress, const ReaderLimits& limits,
                 ReaderChild& child) {
    const int descriptors[] = {job.result, job.input, progress};
    pid_t id = -1;
    const int failed =
        spawn_reader(program,
                     {job.verb, job.format, std::to_string(limits.max_texels), std::to_string(limits.memory),
                      std::to_string(limits.seconds), std::to_string(getpid())},
                     descriptors, id);
    if (failed == 0) child = ReaderChild(id);
    return failed;
}

}  // namespace tex::inline v1
