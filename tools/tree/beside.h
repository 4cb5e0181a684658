// SPDX-License-Identifier: Apache-2.0
// beside.h: files whose presence makes a rule leave an input alone: unless = "{dir}/{stem:-_Height}_Normal.*".

#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tex::cli {

// Throws UsageError if this is no such pattern: a name as of outputs, of {dir}, {stem} and {ext}, in whose last part *
// and ? may stand for any characters and for one.
void check_beside(const std::string& pattern);

// Looks into folders, each of which is read once.
class FilesBeside {
public:
    // Names are relative to `root` (empty: the working directory).
    explicit FilesBeside(std::string root) : root_(std::move(root)) {}

    // Whether there is a file, other than `input` and those of `made`, with a name that the pattern gives for `input`.
    [[nodiscard]] bool has(const std::string& pattern, const std::string& input, const std::vector<std::string>& made);

private:
    [[nodiscard]] const std::vector<std::string>& names_in(const std::string& folder);

    std::string root_;
    std::map<std::string, std::vector<std::string>> names_;  // by folder
};

}  // namespace tex::cli
