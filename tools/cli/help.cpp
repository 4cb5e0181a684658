// SPDX-License-Identifier: Apache-2.0

#include "cli/help.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/text.h"

namespace tex::cli {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kColumn = 26;  // the column where explanations begin

std::vector<std::string> groups_in_order(const Command& command) {
    std::vector<std::string> groups;
    for (const Row& row : command.rows()) {
        if (std::find(groups.begin(), groups.end(), row.group) == groups.end()) groups.push_back(row.group);
    }
    std::stable_partition(groups.begin(), groups.end(), [](const std::string& group) { return group != kHelpGroup; });
    return groups;
}

// "  -o, --output FILE"; rows without a short name are indented to line up.
std::string left_column(const Row& row) {
    std::string left = (row.names.size() > 1 ? "  " : "      ") + join(row.names);
    if (!row.value.empty()) left += " " + row.value;
    return left;
}

std::string explanation(const Row& row) {
    std::string text = row.help;
    if (!row.words.empty()) {
        std::vector<std::string> names = names_of(row.words);
        bool listed = false;
        for (std::string& name : names) {
            if (name != row.preset) continue;
            name += " (default)";
            listed = true;
        }
        text += ": " + join(names);
        if (listed) return text;
    }
    if (!row.preset.empty()) text += fmt::format(" (default: {})", row.preset);
    return text;
}

void add_entry(std::string& out, const std::string& left, const std::string& right) {
    std::string line = left;
    for (const std::string& piece : wrapped(right, kWidth - kColumn)) {
        if (line.size() + 2 > kColumn) {  // too long: the explanation starts on a new line
            out += line + "\n";
            line.clear();
        }
        line.resize(kColumn, ' ');
        out += line + piece + "\n";
        line.clear();
    }
}

}  // namespace

std::string help_text(const Command& command) {
    std::string out;
    for (std::size_t k = 0; k < command.usages().size(); ++k) {
        out += fmt::format("{}{} [OPTIONS] {}\n", k == 0 ? "Usage: " : "       ", command.name(), command.usages()[k]);
    }
    out += "\n";
    for (const std::string& line : wrapped(command.summary(), kWidth)) out += line + "\n";
    for (const std::string& group : groups_in_order(command)) {
        out += fmt::format("\n{}:\n", group);
        if (group == groups_in_order(command).front())
            add_entry(out, "  " + command.input().name, command.input().meaning);
        if (group == groups_in_order(command).front())
            add_entry(out, "  @FILE", "more arguments, one a line or separated by NUL; @- is standard input");
        for (const Row& row : command.rows()) {
            if (row.group == group && !row.hidden) add_entry(out, left_column(row), explanation(row));
        }
    }
    out += "\nExamples:\n";
    for (const Example& example : command.examples()) {
        out += fmt::format("  {}\n      {}\n", example.line, join(wrapped(example.meaning, kWidth - 6), "\n      "));
    }
    out += "\nExit status:\n";
    for (const Named<ExitCode>& row : kExitCodeNames) {
        if (row.value == ExitCode::findings && !command.finds()) continue;
        add_entry(out, fmt::format("  {}", row.name), std::string(row.meaning));
    }
    out += fmt::format("\nSee {}(1) for the details and normal-maps(7) for the conventions.\n", command.name());
    return out;
}

std::string option_list(const Command& command) {
    std::string out;
    for (const Row& row : command.rows()) {
        if (row.hidden) continue;
        out += fmt::format("{}\t{}\t{}\t{}\n", join(row.names, ","), row.value, row.preset,
                           join(names_of(row.words), ","));
    }
    return out;
}

}  // namespace tex::cli
