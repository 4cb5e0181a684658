// SPDX-License-Identifier: Apache-2.0
// child_text.h: what a part of a test says that needs a process to itself.

#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>

#include <functional>
#include <string>
#include <utility>

namespace tex {

// Runs body(fd) in a child process, which ends with the status that body returns. Returns what the child wrote to `fd`,
// and how it ended if that is not with 0. `fd` is above the descriptors that readers use.
inline std::string child_text(const std::function<int(int fd)>& body) {
    int ends[2];
    if (pipe(ends) != 0) return "no pipe";
    constexpr int kOutOfTheWay = 64;
    for (int& end : ends) {
        const int low = std::exchange(end, fcntl(end, F_DUPFD, kOutOfTheWay));
        close(low);
    }
    const pid_t child = fork();
    if (child == 0) _exit(body(ends[1]));
    close(ends[1]);
    std::string text;
    char buffer[1000];
    for (ssize_t n = 0; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;)
        text.append(buffer, static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    return status == 0 ? text : text + "ended with status " + std::to_string(status);
}

}  // namespace tex
