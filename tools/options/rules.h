// SPDX-License-Identifier: Apache-2.0
// rules.h: the option group that selects which rules are checked, and how severe their findings are.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/check.h>
#include <tex/height.h>

#include "cli/command.h"
#include "options/check_config.h"
#include "options/normals.h"
#include "tasks/engines.h"
#include "tasks/task.h"

namespace tex::cli {

// What is demanded of a file.
struct Demands {
    CheckOptions checks;
    Severity fail_on = Severity::error;

    [[nodiscard]] bool fails(const Finding& finding) const { return finding.severity >= fail_on; }
};

// --require, --for, --swizzle, --length-in, --enable, --disable, --severity, --config, --root, --fail-on, --height,
// --occlusion, --list, --explain.
class RuleOptions {
public:
    void add(Command& command);

    [[nodiscard]] const std::string& config() const { return config_; }
    [[nodiscard]] const std::string& height_file() const { return height_file_; }
    [[nodiscard]] const std::string& occlusion_file() const { return occlusion_file_; }
    [[nodiscard]] bool list() const { return list_; }
    [[nodiscard]] const Rule* explain() const { return explain_; }  // or null

    // Reads the files that the options name. Throws UsageError if they do not fit the tasks; returns an error if a file
    // cannot be read.
    [[nodiscard]] Result<void> read(const Command& command, const std::vector<Task>& tasks, const ReadOptions& read);

    // The options and the configuration together, for a file that no [[rule]] of the configuration matches. Valid after
    // read().
    [[nodiscard]] const Demands& demands() const { return demands_; }
    // The demands on the file `path`.
    [[nodiscard]] const Demands& demands_of(const std::string& path) const;
    // A sentence for each rule of the configuration that matches none of these files. Valid after read().
    [[nodiscard]] std::vector<std::string> idle_rules(const std::vector<Task>& tasks) const;

private:
    // The place in file_rules_ of the rule for the file `path`; their number if there is none.
    [[nodiscard]] std::size_t rule_of(const std::string& path) const;
    [[nodiscard]] Result<void> read_height(const ReadOptions& read);
    [[nodiscard]] Result<void> read_occlusion(const ReadOptions& read);
    [[nodiscard]] Result<void> merge_config(const Command& command);
    [[nodiscard]] Demands merged(const CheckSettings& settings, const Command& command) const;

    CheckOptions given_;                  // from the command line, without `require`
    std::vector<std::string> required_;   // --require
    std::vector<const Engine*> engines_;  // --for
    std::optional<LengthIn> length_in_;
    std::optional<std::optional<Swizzle>> swizzle_;      // --swizzle; of "auto", nothing
    std::string config_, height_file_, occlusion_file_;  // paths, or empty
    std::string root_;                          // that patterns of the configuration are relative to; empty: its folder
    Severity least_failing_ = Severity::error;  // --fail-on
    bool list_ = false;
    const Rule* explain_ = nullptr;

    Demands demands_;
    std::vector<CheckRule> file_rules_;  // of the configuration
    std::vector<Demands> of_rules_;      // for each of them
    std::optional<HeightField> height_;
    Plane<float> occlusion_;
};

}  // namespace tex::cli
