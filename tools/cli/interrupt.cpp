// SPDX-License-Identifier: Apache-2.0

#include "cli/interrupt.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

#include <tex/container.h>

namespace tex::cli {
namespace {

std::atomic<int> g_signal{0};  // lock-free, so a signal handler may use it
static_assert(std::atomic<int>::is_always_lock_free);
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr unsigned kPatience = 1;  // seconds

extern "C" void on_signal(int signal) {
    if (g_signal != 0) end_by_signal(signal);
    g_signal = signal;
    alarm(kPatience);
}

extern "C" void on_alarm(int) { end_by_signal(g_signal); }

}  // namespace

void catch_signals() {
    for (const int signal : kSignals) {
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_IGN) continue;  // nohup, or a shell that put us in the background
        struct sigaction action {};
        action.sa_handler = on_signal;
        sigaction(signal, &action, nullptr);  // no SA_RESTART: a blocked read returns
    }
    struct sigaction action {};
    action.sa_handler = on_alarm;
    sigaction(SIGALRM, &action, nullptr);
}

int caught_signal() { return g_signal; }

void end_by_signal(int signal) {
    // Only functions that a signal handler may call: both handlers come here. Threads may be anywhere, so nothing
    // unwinds. (A wait that can be cancelled would serve decoders that hang, but neither a file system that is slow nor
    // a second signal.)
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

}  // namespace tex::cli
