// SPDX-License-Identifier: Apache-2.0
// A recipe for people: its settings by their names, and the command lines that do its work.

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "tasks/name_pattern.h"
#include "tree/recipe.h"

namespace tex::cli {

NamedValues Recipe::named_settings(const ReadyCommand& last, const Task& task) const {
    NamedValues named;
    std::vector<std::string> steps;
    for (std::size_t k = 0; k < rule_.steps.size(); ++k) {
        const std::string& step = rule_.steps[k].command;
        const auto earlier = std::count(steps.begin(), steps.end(), step);
        const std::string prefix = earlier == 0 ? step : fmt::format("{} {}", step, earlier + 1);
        steps.push_back(step);
        for (const std::string& argument : k < before_.size() ? before_[k].arguments : last.arguments) {
            const auto [option, value] = cut(argument, '=');
            const std::string name = prefix + " " + option.substr(2);
            const std::string shown = argument.size() > option.size() ? value : "true";
            if (!named.empty() && named.back().first == name) {
                named.back().second += ", " + shown;
            } else {
                named.emplace_back(name, shown);
            }
        }
    }
    named.emplace_back("steps", join(steps, ", "));
    named.emplace_back("type", name_of(kContainerNames, task.container));
    named.emplace_back("levels", has_level(task.output) ? "a file for each" : "in one file");
    for (const OptionSetting& setting : rule_.check)
        named.emplace_back("check." + setting.key, join(setting.values, ", "));
    return named;
}

std::vector<std::string> Recipe::command_lines(const std::string& input, std::size_t index) const {
    for (const std::string& grid : grids_) {  // one command makes all tiles
        if (input != grid && place_in_grid(grid, input)) return command_lines(grid, index);
    }
    std::vector<std::string> lines;
    std::string from = input;
    std::map<std::string, std::string> further;
    if (!outputs_[index].last.writes.empty()) std::ignore = files_of(input, index, &further);
    for (std::size_t k = 0; k < rule_.steps.size(); ++k) {
        const bool is_last = k + 1 == rule_.steps.size();
        const ReadyCommand& command = is_last ? outputs_[index].last : before_[k];
        const std::string to = is_last ? output_name(input, index) : fmt::format("step{}.exr", k + 1);
        std::string line =
            fmt::format("{} {} -o {}", command.program->command.name(), shell_file(from), shell_file(to));
        for (const std::string& argument : command.arguments) {
            const auto [name, value] = cut(argument, '=');
            const auto file = further.find(name);
            line += fmt::format(" {}", name);
            if (is_last && file != further.end())
                line += " " + shell_file(written_name(file->second));
            else if (argument.size() > name.size())
                line += " " + shell_word(std::string(value));
        }
        lines.push_back(line + (is_last ? "" : fmt::format(" --format {}", format_between(command.arguments))));
        from = to;
    }
    return lines;
}

}  // namespace tex::cli
