// SPDX-License-Identifier: Apache-2.0
// WebAssembly has streams and no signals. The signals of the process are JavaScript's (tools/web), which is asked for
// them, and which removes what a run leaves that does not end by itself.

#include "cli/process.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

// The signal that asks the run to stop; 0 without one.
extern "C" __attribute__((import_module("libtex"), import_name("signal"))) int tex_signal();

namespace tex::cli {
namespace {

constexpr int kInterrupt = 2, kTerminate = 15;

bool write_all(int fd, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(fd, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

}  // namespace

Arguments own_arguments(int argc, char** argv) { return {argv, static_cast<std::size_t>(argc)}; }

// WASI has no working directory. The C library keeps one, with which names begin.
ProcessHost::ProcessHost() {
    if (const char* const folder = std::getenv("PWD"); folder != nullptr) static_cast<void>(chdir(folder));
}

bool ProcessHost::write_out(std::string_view text) { return write_all(STDOUT_FILENO, text); }
void ProcessHost::write_err(std::string_view text) { write_all(STDERR_FILENO, text); }

bool ProcessHost::out_is_terminal() const { return isatty(STDOUT_FILENO) == 1; }
bool ProcessHost::out_is_abandoned() const { return false; }  // a write will say so

bool ProcessHost::err_is_terminal() const {
    const char* const terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
}

bool ProcessHost::err_has_color() const {
    const char* const no_color = std::getenv("NO_COLOR");
    return err_is_terminal() && (no_color == nullptr || *no_color == '\0');
}

void ProcessHost::begin() {}

std::string_view ProcessHost::interruption() const {
    switch (tex_signal()) {
        case 0: return {};
        case kInterrupt: return "SIGINT";
        case kTerminate: return "SIGTERM";
        default: return "SIGHUP";
    }
}

void ProcessHost::end_interrupted() { _Exit(128 + tex_signal()); }  // JavaScript ends by the signal

void ProcessHost::end(ExitCode code) { _Exit(static_cast<int>(code)); }

}  // namespace tex::cli
