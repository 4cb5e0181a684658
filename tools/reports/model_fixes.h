// SPDX-License-Identifier: Apache-2.0
// model_fixes.h: what to say where several fixes concern one model. Each of them reads the model as it is, so that one
// after the other would lose what the ones before have mended.

#pragma once

#include <string>
#include <vector>

namespace tex::cli {

class ModelFixes {
public:
    // A command that mends one map of the model, which it names with --material.
    void add(const std::string& command, const std::string& material);

    // The command that mends all of them in one run, or that there is none; empty if there are not several.
    [[nodiscard]] std::string text(const std::string& model) const;

private:
    std::vector<std::string> commands_;  // no two are alike
    std::vector<std::string> whole_;     // of the whole model instead of one map, certain repairs alone
    bool is_likely_ = false;
};

}  // namespace tex::cli
