// SPDX-License-Identifier: Apache-2.0

#include "tasks/depfile.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "tasks/task.h"

namespace tex::cli {
namespace {

// Make takes backslashes literally, except before a character that they escape; there they must be doubled. A colon
// ends the targets of a rule, and a % would turn a target into a pattern.
std::string escaped(const std::string& path, bool is_target) {
    std::string text;
    std::size_t backslashes = 0;  // at the end of `text`
    for (const char c : path) {
        if (c == '$') {
            text += "$$";
        } else if (c == ' ' || c == '\t' || c == '#' || c == ':' || (c == '%' && is_target)) {
            text.append(backslashes, '\\').append("\\").push_back(c);
        } else {
            text += c;
        }
        backslashes = c == '\\' ? backslashes + 1 : 0;
    }
    return text;
}

bool has_no_spelling(const std::string& path) { return path.find('\n') != std::string::npos; }
constexpr const char* kNoSpelling = "a depfile cannot hold a name with a line feed";

void add_paths(std::string& text, const std::vector<std::string>& paths, const char* between, bool are_targets) {
    for (const std::string& path : paths) {
        if (path != "-") text += between + escaped(path, are_targets);
    }
}

}  // namespace

void check_depfile_names(const std::vector<Task>& tasks) {
    for (const Task& task : tasks) {
        std::vector<std::string> paths = task.outputs();
        for (const std::string& input : task.inputs()) paths.push_back(input);
        for (const std::string& file : task.prerequisites()) paths.push_back(file);
        const auto bad = std::find_if(paths.begin(), paths.end(), has_no_spelling);
        if (bad != paths.end()) throw UsageError("--depfile", fmt::format("{}: {}", printable(*bad), kNoSpelling));
    }
}

Result<std::string> depfile_text(const std::vector<Dependency>& dependencies) {
    std::string text;
    for (const Dependency& dependency : dependencies) {
        for (const std::vector<std::string>* paths : {&dependency.outputs, &dependency.inputs}) {
            const auto refused = std::find_if(paths->begin(), paths->end(), has_no_spelling);
            if (refused != paths->end()) return Error{ErrorCode::unsupported, *refused, kNoSpelling};
        }
        std::string targets;
        add_paths(targets, dependency.outputs, " ", true);
        if (targets.empty()) continue;
        text += targets.substr(1) + ":";
        add_paths(text, dependency.inputs, " \\\n  ", false);
        text += "\n";
    }
    return text;
}

}  // namespace tex::cli
