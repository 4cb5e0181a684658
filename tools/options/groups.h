// SPDX-License-Identifier: Apache-2.0
// groups.h: option groups that several commands share, each defined once.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/height_field.h>
#include <tex/mip.h>

#include "batch/files.h"
#include "cli/command.h"

namespace tex::cli {

// --wrap W or WX,WY.
struct WrapOptions {
    Wrap x = Wrap::repeat;
    Wrap y = Wrap::repeat;

    void add(Command& command, std::string help);
};

// --mips, --mip-filter, --mip-domain, --fade.
struct MipChainOptions {
    std::optional<int> levels;  // 0 is all; none: what the container suggests
    bool keep = false;          // the levels of the source as they are
    MipOptions mip;

    // Whether --mips takes "keep", and what stands in the help for its default.
    void add(Command& command, bool with_keep, std::string levels_default);

    // Throws UsageError where levels were asked for that an output cannot hold.
    void check(const std::vector<Task>& tasks) const;

    // For commands that keep levels by default: throws UsageError where an option says how to build levels
    // that are not built.
    void check_builds(const Command& command) const;

    // The levels of a task's output where the user said nothing: all in dds and ktx2 and where every level
    // has a file of its own, one in pictures.
    [[nodiscard]] int levels_for(const Task& task) const;
};

}  // namespace tex::cli
