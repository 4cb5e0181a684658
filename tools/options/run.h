// SPDX-License-Identifier: Apache-2.0
// run.h: the option group of how a command runs: threads, messages, limits.

#pragma once

#include <tex/execution.h>
#include <tex/image_io.h>

#include "cli/command.h"

namespace tex::cli {

enum class ShowProgress { automatic, always, never };

inline constexpr Named<ShowProgress> kShowProgressNames[] = {
    {ShowProgress::automatic, "auto", "on a terminal"},
    {ShowProgress::always, "always", "even if standard error is not a terminal"},
    {ShowProgress::never, "never", "not at all"},
};

struct RunOptions {
    int threads = Execution{}.threads;
    bool json = false;
    bool quiet = false;
    ShowProgress progress = ShowProgress::automatic;
    ReadOptions read;

    void add(Command& command);
    [[nodiscard]] bool shows_progress(const Host& host) const;

    // How the part of a run from `from` to `to` of its progress runs; `words` stand beside the bar.
    [[nodiscard]] Execution step(Console& console, double from, double to, const std::string& words) const;
};

}  // namespace tex::cli
