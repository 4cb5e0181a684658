// SPDX-License-Identifier: Apache-2.0
// mips.h: the option groups of borders and mip chains.

#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/height.h>
#include <tex/mip.h>

#include "cli/command.h"
#include "tasks/task.h"

namespace tex::cli {

// "W" or "WX,WY".
[[nodiscard]] std::pair<Wrap, Wrap> parse_wraps(const std::string& text);

// --wrap.
struct WrapOptions {
    Wrap x = Wrap::repeat;
    Wrap y = Wrap::repeat;

    void add(Command& command, std::string help);
};

// --mips, --max-size, --mip-filter, --mip-domain, --fade.
struct MipChainOptions {
    std::optional<int> levels;  // 0: all; none: the container's default
    bool keep = false;          // copies the levels of the source
    MipOptions mip;             // without levels and wrap, see options()

    // `with_keep`: --mips takes "keep"; `levels_default`: its default in the help.
    void add(Command& command, bool with_keep, std::string levels_default);

    // Throws UsageError if an output cannot hold the levels that the user requests.
    void check(const std::vector<Task>& tasks) const;

    // For commands that keep levels by default. Throws UsageError if an option says how to build levels although no
    // levels are built.
    void check_builds(const Command& command, const std::vector<Task>& tasks) const;

    // The number of levels of a task's output: the number that the user requests; else all levels if every level has
    // its own file; else those that the task's engine needs; else all levels in dds and ktx2, and one level in
    // pictures.
    [[nodiscard]] int levels_for(const Task& task) const;

    // Whether the levels of the source are kept because nothing else was asked for.
    [[nodiscard]] bool keeps_unasked(const Task& task) const {
        return with_keep_ && !levels && !keep && task.engine == nullptr;
    }

    // How `count` levels are built.
    [[nodiscard]] MipOptions options(int count, const WrapOptions& wrap) const;

private:
    bool with_keep_ = false;
};

}  // namespace tex::cli
