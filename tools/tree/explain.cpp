// SPDX-License-Identifier: Apache-2.0

#include "tree/explain.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <variant>

#include <fmt/format.h>
#include <tex/format.h>
#include <tex/pipeline.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tasks/engines.h"
#include "tasks/job.h"
#include "tasks/name_pattern.h"
#include "tree/tree_files.h"

namespace tex::cli {
namespace {

const OptionSetting* find_setting(const Settings& settings, const std::string& key) {
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const OptionSetting& setting) { return setting.key == key; });
    return found == settings.end() ? nullptr : &*found;
}

std::string value_text(const OptionSetting& setting) {
    return setting.is_flag ? (setting.is_on ? "true" : "false") : join(setting.values, ", ");
}

// Whether the step sets an option that is used instead of this one.
bool has_rival(const StepSettings& step, const Option& row) {
    return std::any_of(row.rivals.begin(), row.rivals.end(), [&](const std::string& rival) {
        return find_setting(step.settings, rival.substr(2)) != nullptr;
    });
}

// The number of levels, in the words of --mips.
std::string levels_text(const Step& step) {
    const auto words = [](int levels) {
        return levels == 0 ? std::string("all") : levels == 1 ? std::string("none") : std::to_string(levels);
    };
    if (const auto* bake = std::get_if<BakeFileOptions>(&step)) return words(bake->mip.levels);
    if (const auto* blend = std::get_if<BlendFileOptions>(&step)) return words(blend->mip.levels);
    const auto& pack = std::get<PackFileOptions>(step);
    return pack.mip ? words(pack.mip->levels) : "keep";
}

// How a step packs what it has read, for an input of this kind.
PackOptions packing_of(const Step& step, const SourceInfo& input) {
    if (const auto* bake = std::get_if<BakeFileOptions>(&step)) return bake->pack;
    if (const auto* pack = std::get_if<PackFileOptions>(&step)) return pack->pack(input);
    return std::get<BlendFileOptions>(step).pack(input);
}

// The values of options that the manifest leaves to the command, from those that the run uses: what --for decides, and
// the file type. Where they depend on the input, the words of the default are right.
std::map<std::string, std::string> decided_values(Converter& converter, const Task& task, Console& console) {
    const ReadOptions read;
    const WriteOptions write;
    Job job(task, console, read, write, 1, [](double, const std::string&) { return true; });
    const std::optional<Step> step = converter.step(job);
    if (!step) return {};
    SourceInfo one, other;
    one.swizzle = kSwizzleXyz;
    one.y_known = other.y_known = true;
    other.format = Format::bc5_unorm;
    other.swizzle = kSwizzleXy;
    other.y_axis = YAxis::down;
    const PackOptions a = packing_of(*step, one), b = packing_of(*step, other);
    std::map<std::string, std::string> values;
    if (a.encoding == b.encoding) values["format"] = name_of(kEncodingNames, a.encoding);
    if (a.y_axis == b.y_axis) values["y"] = name_of(kYAxisNames, a.y_axis);
    values["effort"] = name_of(kEffortNames, a.effort);
    values["mips"] = levels_text(*step);
    return values;
}

// Whose choice a value is.
std::string chosen_by(const std::string& key, const Converter& converter, const Task& task, const Command& command) {
    const bool by_engine = task.engine != nullptr && ((key == "format" && !converter.output.format) ||
                                                      (key == "y" && !converter.output.y) || key == "mips");
    if (by_engine) return fmt::format("for = {}", task.engine->name);
    return fmt::format(
        "default of {}{}", command.name(),
        key == "format" || key == "mips" ? fmt::format(" for {}", extension_of(task.container)) : std::string());
}

// A command and the task of an output, whose values settings_text() prints.
struct Decided {
    Converter& converter;
    Task task;
    Console& console;
};

// One line for each option of a step that has a value.
std::string settings_text(const StepSettings& step, const OutputSettings* output, const Command& command,
                          const Decided* decided) {
    const std::map<std::string, std::string> values =
        decided == nullptr ? std::map<std::string, std::string>()
                           : decided_values(decided->converter, decided->task, decided->console);
    std::string text;
    for (const Option& row : command.options()) {
        if (row.hidden || row.group == kHelpGroup || row.group == "Files" || row.group == "Terrains" ||
            row.group == "Running")
            continue;
        const std::string key = row.name().substr(2);
        const OptionSetting* setting = output == nullptr ? nullptr : find_setting(output->settings, key);
        const char* from = "outputs, ";
        if (setting == nullptr) {
            setting = find_setting(step.settings, key);
            from = setting != nullptr && setting->is_default ? "[defaults], " : "";
        }
        if (setting != nullptr) {
            text += fmt::format("    {} = {}  ({}line {})\n", key, printable(value_text(*setting)), from,
                                setting->place.line);
        } else if (const auto value = values.find(key); value != values.end()) {
            text += fmt::format("    {} = {}  ({})\n", key, value->second,
                                chosen_by(key, decided->converter, decided->task, command));
        } else if (!row.preset.empty() && (output != nullptr || row.group != "Output") && !has_rival(step, row)) {
            text += fmt::format("    {} = {}  (default of {})\n", key, row.preset, command.name());
        }
    }
    return text;
}

// By which rules the file is read, and for how many textures.
std::string readers_text(const std::string& name, const std::vector<Recipe>& recipes, const WorkList& work) {
    std::string text;
    for (std::size_t k = 0; k < recipes.size(); ++k) {
        const std::vector<std::string>& files = recipes[k].files();
        const auto is_it = [&](const std::string& file) {
            return slashed(std::filesystem::path(file).lexically_normal()) == name;
        };
        const bool is_for_all = std::any_of(files.begin(), files.end(), is_it);
        const auto count = std::count_if(work.tasks.begin(), work.tasks.end(), [&](const BuildTask& task) {
            if (task.recipe != k || is_for_all) return task.recipe == k;
            const auto own = recipes[k].own_files(task.input, recipes[k].path_to(task.input));
            return std::any_of(own.begin(), own.end(), is_it);
        });
        if (!is_for_all && count == 0) continue;
        text += fmt::format("{}: read by rule {} (line {}) for {} texture{}, match {}\n", printable(name),
                            recipes[k].number(), recipes[k].rule().place.line, count, count == 1 ? "" : "s",
                            printable(join(recipes[k].rule().match)));
    }
    return text;
}

std::string task_text(const BuildTask& task, const Recipe& recipe, Console& console) {
    const RuleSettings& rule = recipe.rule();
    std::string text = fmt::format("{}: rule {} (line {}), match {}\n", printable(task.input), recipe.number(),
                                   rule.place.line, printable(join(rule.match)));
    if (!task.refusal.empty()) text += "  cannot be made: " + task.refusal + "\n";
    for (std::size_t k = 0; k + 1 < rule.steps.size(); ++k) {
        text += fmt::format("  {}:\n", rule.steps[k].command);
        text += settings_text(rule.steps[k], nullptr, recipe.table_of(rule.steps[k].command), nullptr);
    }
    for (const std::string& needed : recipe.files()) text += fmt::format("  reads {}\n", printable(needed));
    for (const std::string& needed : recipe.own_files(task.input, recipe.path_to(task.input)))
        text += fmt::format("  reads {}\n", printable(needed));
    for (std::size_t k = 0; k < task.outputs.size(); ++k) {
        text += fmt::format("  {} for {}:\n", rule.steps.back().command, printable(with_level(task.outputs[k], 0)));
        const ReadyCommand& last = recipe.outputs()[k].last;
        const std::string name = recipe.output_name(task.input, k);
        const Decided decided{*last.converter,
                              recipe.before().empty()
                                  ? recipe.first_task(*last.converter, recipe.path_to(task.input), name)
                                  : last.converter->task_for("between.exr", name, task.input),
                              console};
        text +=
            settings_text(rule.steps.back(), &rule.outputs[k], recipe.table_of(rule.steps.back().command), &decided);
        text += "  the same by hand:\n";
        for (const std::string& line : recipe.command_lines(task.input, k)) text += "    " + line + "\n";
    }
    return text;
}

}  // namespace

std::string explanation_of(const std::string& file, const std::vector<Recipe>& recipes, const WorkList& work,
                           Console& console) {
    const std::string name = slashed(std::filesystem::path(file).lexically_normal());
    const auto task = std::find_if(work.tasks.begin(), work.tasks.end(), [&](const BuildTask& candidate) {
        if (candidate.input == name) return true;
        const std::vector<std::string> files = files_of(candidate, recipes[candidate.recipe]);
        return std::find(files.begin(), files.end(), name) != files.end();
    });
    std::string text;
    if (task != work.tasks.end()) text = task_text(*task, recipes[task->recipe], console);
    text += readers_text(name, recipes, work);
    if (text.empty()) throw UsageError(fmt::format("--explain: no rule matches, makes or reads {}", printable(name)));
    return text;
}

}  // namespace tex::cli
