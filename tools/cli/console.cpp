// SPDX-License-Identifier: Apache-2.0

#include "cli/console.h"

#include <algorithm>
#include <cerrno>

#include <fmt/format.h>

#include "cli/text.h"
#include "files/system_error.h"

namespace tex::cli {
namespace {

constexpr std::string_view kClearLine = "\r\x1b[K";

}  // namespace

void Console::message_of(std::string_view label, std::string_view color, std::string_view message) {
    const std::string marked =
        host_.err_has_color() ? fmt::format("\x1b[1;{}m{}:\x1b[0m", color, label) : fmt::format("{}:", label);
    const std::lock_guard lock(mutex_);
    host_.write_err(
        fmt::format("{}{}: {} {}\n", bar_is_drawn_ ? kClearLine : "", program_, marked, printable(message)));
    bar_is_drawn_ = false;
}

void Console::warning(std::string_view message) {
    if (!quiet_) message_of("warning", "33", message);
}

ExitCode Console::print(std::string_view text) {
    clear_progress();
    if (host_.write_out(text)) return ExitCode::done;
    const int reason = errno;
    if (reason != EPIPE) error("standard output: " + system_reason(reason));
    return ExitCode::io;
}

void Console::draw_progress(double fraction, std::string_view words) {
    constexpr int kCells = 30;
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (quiet_ || now - last_drawn_ < std::chrono::milliseconds(100)) return;
    const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kCells);
    host_.write_err(fmt::format("{}[{:#<{}}{:.<{}}] {:3.0f} % {}", kClearLine, "", full, "", kCells - full,
                                fraction * 100.0, printable(words.substr(0, 40))));
    bar_is_drawn_ = true;
    last_drawn_ = now;
}

void Console::clear_progress() {
    const std::lock_guard lock(mutex_);
    if (bar_is_drawn_) host_.write_err(kClearLine);
    bar_is_drawn_ = false;
}

}  // namespace tex::cli
