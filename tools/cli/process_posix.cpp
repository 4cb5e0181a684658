// SPDX-License-Identifier: Apache-2.0

#include "cli/process.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <tex/file.h>

#include "cli/exit_code.h"
#include "cli/process_posix.h"

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

// Opens /dev/null in the wrong direction for each of the three streams that is closed. Otherwise a file that we open
// could become standard output by accident. Reading or writing such a stream then fails.
void fill_closed_streams() {
    for (int fd = 0; fd <= 2; ++fd) {
        if (fcntl(fd, F_GETFD) == -1 && errno == EBADF) {
            // open() returns the lowest free descriptor, which is `fd`.
            [[maybe_unused]] const int same = open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
        }
    }
}

std::atomic<int> g_signal{0};  // lock-free, so a signal handler may use it
static_assert(std::atomic<int>::is_always_lock_free);
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr unsigned kPatience = 1;  // seconds

// Ends the process by `signal`, as if it had never been caught. Leaves no temporary file behind, whatever other threads
// are doing.
[[noreturn]] void end_by_signal(int signal) {
    // Calls only functions that a signal handler may call, because both handlers come here. Other threads may be
    // anywhere, so the stack is not unwound. (A cancellable wait would help with decoders that hang, but not with a
    // slow file system or a second signal.)
    remove_unfinished_files();
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    sigaction(signal, &action, nullptr);
    sigset_t mask;
    sigemptyset(&mask);
    sigaddset(&mask, signal);
    pthread_sigmask(SIG_UNBLOCK, &mask, nullptr);
    static_cast<void>(raise(signal));
    _exit(128 + signal);
}

extern "C" void on_signal(int signal) {
    if (g_signal != 0) end_by_signal(signal);
    g_signal = signal;
    alarm(kPatience);
}

extern "C" void on_alarm(int) { end_by_signal(g_signal); }

// A thread that gets no memory where nobody can catch the exception: in TBB, while a thread starts. Usually, the other
// threads do its work. If the command has not ended within a second, it may wait for this thread, so the process ends
// here. The stack is not unwound, because other threads may be anywhere. Any other exception that nobody caught is a
// defect: abort().
[[noreturn]] void on_terminate() {
    static std::atomic_flag is_ending;
    try {
        if (std::current_exception() != nullptr) throw;
    } catch (const std::bad_alloc&) {
        while (is_ending.test_and_set()) pause();  // another thread ends the process
        sleep(kPatience);
        remove_unfinished_files();
        write_all(STDERR_FILENO, program_name());
        write_all(STDERR_FILENO, ": error: out of memory\n");
        _exit(static_cast<int>(ExitCode::io));
    } catch (...) {  // printed below
    }
    __gnu_cxx::__verbose_terminate_handler();
    std::abort();
}

void catch_signals() {
    for (const int signal : kSignals) {
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_IGN) continue;  // nohup, or a shell that put us in the background
        struct sigaction action {};
        action.sa_handler = on_signal;
        sigaction(signal, &action, nullptr);  // no SA_RESTART, so that a blocked read returns
    }
    struct sigaction action {};
    action.sa_handler = on_alarm;
    sigaction(SIGALRM, &action, nullptr);
}

}  // namespace

Arguments own_arguments(int argc, char** argv) { return {argv, static_cast<std::size_t>(argc)}; }

ProcessHost::ProcessHost() {
    keep_freed_memory();
    fill_closed_streams();
    static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
    static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
}

bool ProcessHost::write_out(std::string_view text) { return write_all(STDOUT_FILENO, text); }
void ProcessHost::write_err(std::string_view text) { write_all(STDERR_FILENO, text); }

bool ProcessHost::out_is_terminal() const { return isatty(STDOUT_FILENO) == 1; }

bool ProcessHost::out_is_abandoned() const {
    pollfd state{STDOUT_FILENO, POLLOUT, 0};
    return poll(&state, 1, 0) > 0 && (state.revents & POLLERR) != 0;
}

bool ProcessHost::err_is_terminal() const {
    const char* terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
}

bool ProcessHost::err_has_color() const {
    const char* no_color = std::getenv("NO_COLOR");
    return err_is_terminal() && (no_color == nullptr || *no_color == '\0');
}

void ProcessHost::begin() {
    catch_signals();
    std::set_terminate(on_terminate);
}

std::string_view ProcessHost::interruption() const {
    switch (g_signal) {
        case 0: return {};
        case SIGINT: return "SIGINT";
        case SIGTERM: return "SIGTERM";
        default: return "SIGHUP";
    }
}

void ProcessHost::end_interrupted() { end_by_signal(g_signal); }

void ProcessHost::end(ExitCode code) {
#if defined(__SANITIZE_ADDRESS__)
    std::exit(static_cast<int>(code));  // looks for leaks
#else
    _exit(static_cast<int>(code));
#endif
}

}  // namespace tex::cli
