// SPDX-License-Identifier: Apache-2.0
// run.h: the option group that controls how a command runs: threads, messages, limits.

#pragma once

#include <tex/file.h>
#include <tex/types.h>

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

    // The Execution for the part of a run whose progress goes from `from` to `to`. `words` appear beside the bar.
    [[nodiscard]] Execution step(Console& console, double from, double to, const std::string& words) const;
};

}  // namespace tex::cli
