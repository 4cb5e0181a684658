// SPDX-License-Identifier: Apache-2.0

#include "cli/stream.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "cli/console.h"
#include "files/system_error.h"

namespace tex::cli {
namespace {

bool write_all(int fd, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(fd, text.data(), text.size());
        if (written >= 0) {
            text.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno == EAGAIN) {
            pollfd ready{fd, POLLOUT, 0};
            poll(&ready, 1, -1);
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

// Before the libraries' constructors, which end with abort() where they get no memory, and before the standard library
// has set memory for exceptions aside (without which throwing one ends with abort(), too): a command that cannot have
// even this much says so.
void check_memory(int, char** argv, char**) {
    constexpr std::size_t kStart = std::size_t{4} << 20;
    // Not through the C library: libraries that put calls of their own before it are not ready.
    const long memory = syscall(SYS_mmap, 0L, kStart, long{PROT_NONE}, long{MAP_PRIVATE | MAP_ANONYMOUS}, -1L, 0L);
    if (memory != -1) {
        syscall(SYS_munmap, memory, kStart);
        return;
    }
    const char* const slash = std::strrchr(argv[0], '/');
    write_all(STDERR_FILENO, slash == nullptr ? argv[0] : slash + 1);
    write_all(STDERR_FILENO, ": error: out of memory\n");
    _exit(static_cast<int>(ExitCode::io));
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const g_check_memory)(int, char**, char**) = check_memory;

}  // namespace

void secure_streams() {
    for (int fd = 0; fd <= 2; ++fd) {
        if (fcntl(fd, F_GETFD) == -1 && errno == EBADF) {
            // The lowest free descriptor is this one.
            [[maybe_unused]] const int same = open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
        }
    }
    static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
    static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
}

bool write_stdout(std::string_view text) { return write_all(STDOUT_FILENO, text); }

ExitCode print(std::string_view text) {
    if (write_stdout(text)) return ExitCode::done;
    const int reason = errno;
    if (reason != EPIPE) print_error("standard output: " + system_reason(reason));
    return ExitCode::io;
}

void write_stderr(std::string_view text) { write_all(STDERR_FILENO, text); }

bool stdout_is_abandoned() {
    pollfd state{STDOUT_FILENO, POLLOUT, 0};
    return poll(&state, 1, 0) > 0 && (state.revents & POLLERR) != 0;
}

bool stdout_is_terminal() { return isatty(STDOUT_FILENO) == 1; }

bool stderr_is_terminal() {
    const char* terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
}

bool stderr_has_color() {
    const char* no_color = std::getenv("NO_COLOR");
    return stderr_is_terminal() && (no_color == nullptr || *no_color == '\0');
}

}  // namespace tex::cli
