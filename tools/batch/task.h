// SPDX-License-Identifier: Apache-2.0
// task.h: one output of a command, and the files that it is made of.

#pragma once

#include <string>
#include <vector>

#include <tex/container.h>

namespace tex::cli {

// Names of outputs hold kLevelMark (name_pattern.h) if each level has its own file.
struct Task {
    std::string input;
    std::string output;  // empty for commands that write nothing for each input
    Container container = Container::dds;
    std::vector<std::string> joined = {};        // the inputs after the first one that go into the same output
    std::vector<std::string> shared = {};        // files that options name, which every output is made of
    std::vector<std::string> own = {};           // files that options name for this output alone
    std::vector<std::string> more_outputs = {};  // outputs beside the first one

    // The inputs without the files of options.
    [[nodiscard]] std::vector<std::string> inputs() const {
        std::vector<std::string> all = {input};
        all.insert(all.end(), joined.begin(), joined.end());
        return all;
    }
    // Every file that is read, but for the first input.
    [[nodiscard]] std::vector<std::string> prerequisites() const {
        std::vector<std::string> all = joined;
        all.insert(all.end(), shared.begin(), shared.end());
        all.insert(all.end(), own.begin(), own.end());
        return all;
    }
    [[nodiscard]] std::vector<std::string> outputs() const {
        std::vector<std::string> all = {output};
        all.insert(all.end(), more_outputs.begin(), more_outputs.end());
        return all;
    }
};

}  // namespace tex::cli
