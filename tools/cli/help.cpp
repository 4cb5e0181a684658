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
    for (const Option& row : command.options()) {
        if (std::find(groups.begin(), groups.end(), row.group) == groups.end()) groups.push_back(row.group);
    }
    std::stable_partition(groups.begin(), groups.end(), [](const std::string& group) { return group != kHelpGroup; });
    return groups;
}

// "  -o, --output FILE"; rows without a short name are indented to line up.
std::string left_column(const Option& row, const std::string& value) {
    std::string left = (row.names.size() > 1 ? "  " : "      ") + join(row.names);
    if (!value.empty()) left += " " + value;
    return left;
}

// Without what may follow the value: "FILE" of "FILE[:CHANNEL]".
std::string brief_left(const Option& row) { return left_column(row, row.value.substr(0, row.value.find('['))); }

std::string explanation(const Option& row) {
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

// "Usage: ..." of the first `most` forms.
std::string usage_text(const Command& command, std::size_t most) {
    std::string out;
    for (std::size_t k = 0; k < std::min(most, command.usages().size()); ++k)
        out += fmt::format("{}{} [OPTIONS] {}\n", k == 0 ? "Usage: " : "       ", command.name(), command.usages()[k]);
    return out;
}

std::string summary_text(const Command& command) { return join(wrapped(command.summary(), kWidth), "\n") + "\n"; }

std::string example_text(const Example& example) {
    return fmt::format("  {}\n      {}\n", example.line, join(wrapped(example.meaning, kWidth - 6), "\n      "));
}

// The rows with the least ranks, in the order of the table.
std::vector<const Option*> most_used(const Command& command) {
    constexpr std::size_t kMost = 8;
    std::vector<const Option*> by_rank, rows;
    for (const Option& row : command.options()) {
        if (row.rank != 0) by_rank.push_back(&row);
    }
    std::stable_sort(by_rank.begin(), by_rank.end(),
                     [](const Option* a, const Option* b) { return a->rank < b->rank; });
    if (by_rank.size() > kMost) by_rank.resize(kMost);
    for (const Option& row : command.options()) {
        if (std::find(by_rank.begin(), by_rank.end(), &row) != by_rank.end()) rows.push_back(&row);
    }
    return rows;
}

}  // namespace

std::string brief_help_text(const Command& command) {
    constexpr std::size_t kForms = 2, kExamples = 3;
    std::string out = fmt::format("{}\n{}\n", summary_text(command), usage_text(command, kForms));
    std::size_t column = 0;
    for (const Option* row : most_used(command)) column = std::max(column, brief_left(*row).size() + 2);
    for (const Option* row : most_used(command)) out += fmt::format("{:<{}}{}\n", brief_left(*row), column, row->brief);
    out += "\nExamples:\n";
    for (std::size_t k = 0; k < std::min(kExamples, command.examples().size()); ++k)
        out += example_text(command.examples()[k]);
    out += fmt::format("\n--help lists all options; {}(1) explains them.\n", command.name());
    return out;
}

std::string help_text(const Command& command) {
    std::string out = fmt::format("{}\n{}", usage_text(command, command.usages().size()), summary_text(command));
    for (const std::string& group : groups_in_order(command)) {
        out += fmt::format("\n{}:\n", group);
        if (group == groups_in_order(command).front())
            add_entry(out, "  " + command.input().name, command.input().meaning);
        if (group == groups_in_order(command).front())
            add_entry(out, "  @FILE", "more arguments, one a line or separated by NUL; @- is standard input");
        for (const Option& row : command.options()) {
            if (row.group == group && !row.hidden) add_entry(out, left_column(row, row.value), explanation(row));
        }
    }
    out += "\nExamples:\n";
    for (const Example& example : command.examples()) out += example_text(example);
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
    for (const Option& row : command.options()) {
        if (row.hidden) continue;
        out += fmt::format("{}\t{}\t{}\t{}\n", join(row.names, ","), row.value, row.preset,
                           join(names_of(row.words), ","));
    }
    return out;
}

}  // namespace tex::cli
