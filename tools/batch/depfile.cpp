// SPDX-License-Identifier: Apache-2.0

#include "batch/depfile.h"

namespace tex::cli {
namespace {

// Make takes backslashes as they are, except before a character that they escape: there they must be doubled. A
// colon ends the targets of a rule, and a target with a % would be a pattern.
std::string escaped(const std::string& path, bool is_target) {
    std::string text;
    std::size_t backslashes = 0;  // that end `text`
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

bool is_named(const std::string& path) { return path.find('\n') == std::string::npos && path != "-"; }

void add_paths(std::string& text, const std::vector<std::string>& paths, const char* between, bool are_targets) {
    for (const std::string& path : paths) {
        if (is_named(path)) text += between + escaped(path, are_targets);
    }
}

}  // namespace

std::string depfile_text(const std::vector<Dependency>& dependencies) {
    std::string text;
    for (const Dependency& dependency : dependencies) {
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
