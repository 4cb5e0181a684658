// SPDX-License-Identifier: Apache-2.0
// console.h: what one run of a program prints. Results go to standard output. Errors, warnings and the progress bar go
// to standard error; messages must not break the bar.
//
// Any thread may call any of these functions.

#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string_view>

#include "cli/exit_code.h"
#include "cli/host.h"

namespace tex::cli {

class Console {
public:
    // Messages begin with `program`. Both must outlive this.
    Console(std::string_view program, Host& host) : program_(program), host_(host) {}

    // Suppresses warnings and progress from now on. Errors are always printed.
    void be_quiet() { quiet_ = true; }

    // Prints "bake-normals: error: MESSAGE". Control characters in the message are escaped, so it stays on one line.
    void error(std::string_view message) { message_of("error", "31", message); }
    void warning(std::string_view message);

    // Prints a result. If that fails, returns ExitCode::io and prints a message, unless the reader has closed the pipe.
    [[nodiscard]] ExitCode print(std::string_view text);

    // Draws the progress bar, at most ten times a second. `fraction` is 0 to 1; `words` are a few words beside the bar.
    void draw_progress(double fraction, std::string_view words);
    void clear_progress();

    [[nodiscard]] Host& host() const { return host_; }

private:
    void message_of(std::string_view label, std::string_view color, std::string_view message);

    std::string_view program_;
    Host& host_;
    std::mutex mutex_;
    std::atomic<bool> quiet_{false};
    bool bar_is_drawn_ = false;
    std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace tex::cli
