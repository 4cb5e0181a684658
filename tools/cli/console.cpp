// SPDX-License-Identifier: Apache-2.0

#include "cli/console.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include <fmt/format.h>

#include "cli/stream.h"
#include "cli/text.h"

namespace tex::cli {
namespace {

struct Console {
    std::mutex mutex;
    std::string program;
    bool quiet = false;
    bool bar_is_drawn = false;
    std::chrono::steady_clock::time_point last_drawn;
};

Console& console() {
    static Console instance;
    return instance;
}

constexpr std::string_view kClearLine = "\r\x1b[K";

void print_message(std::string_view kind, std::string_view color, std::string_view message) {
    Console& state = console();
    const std::string marked =
        stderr_has_color() ? fmt::format("\x1b[1;{}m{}:\x1b[0m", color, kind) : fmt::format("{}:", kind);
    const std::lock_guard lock(state.mutex);
    write_stderr(
        fmt::format("{}{}: {} {}\n", state.bar_is_drawn ? kClearLine : "", state.program, marked, printable(message)));
    state.bar_is_drawn = false;
}

}  // namespace

void set_program(std::string name) { console().program = std::move(name); }
void set_quiet() { console().quiet = true; }

void print_error(std::string_view message) { print_message("error", "31", message); }

void print_warning(std::string_view message) {
    if (!console().quiet) print_message("warning", "33", message);
}

void draw_progress(double fraction, std::string_view words) {
    constexpr int kCells = 30;
    Console& state = console();
    const std::lock_guard lock(state.mutex);
    const auto now = std::chrono::steady_clock::now();
    if (state.quiet || now - state.last_drawn < std::chrono::milliseconds(100)) return;
    const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kCells);
    write_stderr(fmt::format("{}[{:#<{}}{:.<{}}] {:3.0f} % {}", kClearLine, "", full, "", kCells - full,
                             fraction * 100.0, printable(words.substr(0, 40))));
    state.bar_is_drawn = true;
    state.last_drawn = now;
}

void clear_progress() {
    Console& state = console();
    const std::lock_guard lock(state.mutex);
    if (state.bar_is_drawn) write_stderr(kClearLine);
    state.bar_is_drawn = false;
}

}  // namespace tex::cli
