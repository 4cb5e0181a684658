// SPDX-License-Identifier: Apache-2.0

#include "tree/recipe.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cli/foreign_words.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "tasks/model_output.h"
#include "tasks/udim.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSuffix = "-normals";
constexpr const char* kModel = "a model";
constexpr const char* kOutputGroup = "Output";
constexpr const char* kLevelsGroup = "Mip chain";
constexpr const char* kDataGroup = "Data beside the normals";

const Option* row_of(const Command& command, const std::string& key, const std::vector<std::string>& groups) {
    for (const Option& row : command.options()) {
        const bool is_in = std::find(groups.begin(), groups.end(), row.group) != groups.end();
        if (is_in && !row.hidden && row.name() == "--" + key) return &row;
    }
    return nullptr;
}

// The groups of options that a manifest can set: those that say how normals are made.
std::vector<std::string> groups_of(const Command& command) {
    std::vector<std::string> groups;
    for (const Option& row : command.options()) {
        if (row.group != kHelpGroup && row.group != "Files" && row.group != "Running") groups.push_back(row.group);
    }
    return groups;
}

// What an unknown key was probably meant to be.
std::string key_advice(const std::string& key, const std::vector<std::string>& known) {
    if (!is_foreign_option("--" + key)) return did_you_mean(key, known);
    std::string answer = foreign_option_answer("--" + key, [&known](std::string_view option) {
        return std::find(known.begin(), known.end(), option.substr(2)) != known.end();
    });
    for (std::size_t at = answer.find("--"); at != std::string::npos; at = answer.find("--")) answer.erase(at, 2);
    return answer;
}

constexpr int kAnyTile = 1001;  // to try whether options fit tiles

// Whether a value of such an option is a file: it may be a word or a number, too.
bool is_file(const std::string& value, const Option& row) {
    const std::vector<std::string> words = names_of(row.words);
    return std::find(words.begin(), words.end(), value) == words.end() &&
           value.find_first_not_of("+-.0123456789eE") != std::string::npos;
}

}  // namespace

std::vector<std::string> step_names() {
    std::vector<std::string> names;
    for (const ProgramRow& row : programs()) {
        if (row.is_step) names.emplace_back(row.name.substr(0, row.name.size() - std::string_view(kSuffix).size()));
    }
    return names;
}

const Command& ProgramPool::table_of(const std::string& step) {
    std::unique_ptr<Program>& table = tables_[step];
    const ProgramRow* const row = find_program(step + kSuffix);
    if (!table) table = row->make(*row);
    return table->command;
}

std::shared_ptr<Program>& ProgramPool::program_for(const std::string& step, const std::vector<std::string>& arguments) {
    return programs_[{step, arguments}];
}

Recipe::Recipe(const Manifest& manifest, const RuleSettings& rule, int number, const std::string& root,
               ProgramPool& pool, Console& console)
    : manifest_(manifest), rule_(rule), number_(number), root_(root), pool_(pool) {
    for (const std::string& pattern : rule.match) {
        if (has_grid(pattern)) {
            grids_.push_back(pattern);
        } else {
            match_.emplace_back(pattern);
        }
    }
    for (const std::string& pattern : grids_) match_.emplace_back(grid_glob(pattern));
    for (const std::string& pattern : rule.exclude) exclude_.emplace_back(pattern);
    check_ = std::make_unique<TextureCheck>(manifest, rule.check, console);
    for (std::size_t k = 0; k + 1 < rule.steps.size(); ++k) {
        before_.push_back(ready(rule.steps[k], nullptr, false, kBetween, console));
        check_order(rule.steps[k], before_.back(), k, console);
    }
    for (const OutputSettings& output : rule.outputs) add_output(output, console);
    check_tiles(before_.empty() ? outputs_.front().last : before_.front());
    find_files();
}

bool Recipe::matches(const std::string& input) const {
    const auto matches = [&](const Glob& glob) { return glob.matches(input); };
    const auto is_tile = [&](const std::string& grid) { return place_in_grid(grid, input).has_value(); };
    const auto end = match_.end() - static_cast<std::ptrdiff_t>(grids_.size());
    return std::any_of(match_.begin(), end, matches) || std::any_of(grids_.begin(), grids_.end(), is_tile);
}

bool Recipe::takes(const std::string& input) const { return matches(input) && !excludes(input); }

bool Recipe::excludes(const std::string& input) const {
    return std::any_of(exclude_.begin(), exclude_.end(), [&](const Glob& glob) { return glob.matches(input); });
}

void Recipe::check_tiles(const ReadyCommand& first) const {
    TextPosition place = rule_.place;
    for (const OptionSetting& setting : rule_.steps.front().settings) {
        if (setting.key == "tiles") place = setting.place;
    }
    const auto fail = [&](const char* reason) { fail_at(manifest_.path, place, reason); };
    if (first.converter->files.tiles != !grids_.empty())
        fail(grids_.empty() ? "tiles needs {x} and {y} in match, the place of a tile"
                            : "{x} and {y} in match need bake = { tiles = true }");
    if (grids_.empty()) return;
    if (grids_.size() < rule_.match.size()) fail("tiles needs {x} and {y} in each pattern of match");
    if (rule_.steps.size() > 1) fail("tiles are baked without other steps");
}

Task Recipe::first_task(const Converter& converter, const std::string& path, const std::string& out) const {
    for (const std::string& grid : grids_) {
        if (place_in_grid(path_to(grid), path)) return converter.task_for_tile(path, out, path_to(grid));
    }
    return converter.task_for(path, out);
}

void Recipe::add_option(const OptionSetting& setting, const Command& command, const std::vector<std::string>& groups,
                        std::vector<std::string>& arguments) const {
    const auto fail = [&](const std::string& reason) {
        fail_at(manifest_.path, setting.place, fmt::format("{}: {}", printable(setting.key), reason));
    };
    const Option* row = row_of(command, setting.key, groups);
    if (row == nullptr && setting.is_default && row_of(command, setting.key, groups_of(command)) != nullptr) return;
    if (row == nullptr) {
        std::vector<std::string> known;
        for (const Option& other : command.options()) {
            if (row_of(command, other.name().substr(2), groups) == &other) known.push_back(other.name().substr(2));
        }
        fail(fmt::format("{} has no such option here{}", command.name(), key_advice(setting.key, known)));
    }
    if (row->value.empty() != setting.is_flag) fail(row->value.empty() ? "must be true or false" : "needs a value");
    if (setting.is_flag) {
        if (setting.is_on) arguments.push_back(row->name());
        return;
    }
    std::vector<std::string> values = setting.values;
    if (values.size() > 1 && !row->repeatable) values = {join(values, ",")};
    for (const std::string& value : values) {
        if (row->completes == Completes::files && value == "-") fail("standard input cannot be a file of a manifest");
        arguments.push_back(fmt::format("{}={}", row->name(), value));
    }
}

// The argument as the command gets it: files are below the root.
std::string Recipe::with_root(const std::string& argument, const Command& command) const {
    const auto [name, value] = cut(argument, '=');
    const Option* const row = row_of(command, name.substr(2), groups_of(command));
    // {dir} is that of the input, which is below the root. Files to write get their places later.
    const bool is_below = !root_.empty() && row != nullptr && row->completes == Completes::files && !row->writes &&
                          is_file(value, *row) && !fs::path(value).has_root_path() && !value.starts_with("{dir}");
    return is_below ? fmt::format("{}={}/{}", name, root_, value) : argument;
}

// Floats, with alpha unless only heights without alpha come before.
std::string_view Recipe::format_between(const std::vector<std::string>& arguments) const {
    const auto has_alpha = [](const std::vector<std::string>& given) {
        return std::any_of(given.begin(), given.end(), [](const auto& one) { return one.starts_with("--alpha="); });
    };
    bool any_has = has_alpha(arguments) || rule_.steps.front().command != "bake";
    for (const ReadyCommand& command : before_) any_has = any_has || has_alpha(command.arguments);
    return name_of(kEncodingNames, any_has ? Encoding::rgba32f : Encoding::float_);
}

// The program that has read these arguments.
std::shared_ptr<Program> Recipe::parsed(const StepSettings& step, std::vector<std::string> line, const std::string& out,
                                        Console& console) const {
    // A program knows whether its outputs are models.
    std::vector<std::string> known = line;
    if (names_model(out)) known.emplace_back(kModel);
    std::shared_ptr<Program>& program = pool_.program_for(step.command, known);
    if (program) return program;
    const ProgramRow* const row = find_program(step.command + kSuffix);
    std::shared_ptr<Program> made = row->make(*row);
    line.insert(line.end(), {"-o", out, "--", "input"});
    std::vector<const char*> pointers;
    pointers.reserve(line.size());
    for (const std::string& argument : line) pointers.push_back(argument.c_str());
    made->command.forbid_answers();
    std::ignore = made->command.parse(pointers, console);
    made->command.drop_table();
    return program = std::move(made);
}

// `out` is the name of an output. Its extension says the file type; without one, it gets that of the engine, or DDS.
ReadyCommand Recipe::ready(const StepSettings& step, const OutputSettings* output, bool is_last, const std::string& out,
                           Console& console) const {
    ReadyCommand command;
    const Command& table = pool_.table_of(step.command);
    std::vector<std::string> groups = groups_of(table);
    if (!is_last) std::erase(groups, kOutputGroup);  // of data beside the normals, alpha goes along
    const auto stays_behind = [&](const OptionSetting& setting) {
        return !is_last && setting.key != "alpha" && row_of(table, setting.key, {kDataGroup}) != nullptr;
    };
    const auto overrides = [&](const std::string& key) {
        return output != nullptr && std::any_of(output->settings.begin(), output->settings.end(),
                                                [&](const OptionSetting& setting) { return setting.key == key; });
    };
    // The first of several outputs has the maps beside it.
    const bool is_first = outputs_.empty();
    for (const OptionSetting& setting : step.settings) {
        const Option* const row = row_of(table, setting.key, groups);
        const bool writes = row != nullptr && row->writes;
        if ((stays_behind(setting) || (writes && !is_last)) && !setting.is_default)
            fail_at(manifest_.path, setting.place, fmt::format("{}: only the last step can have it", setting.key));
        if (writes && !(is_last && is_first)) continue;
        if (!overrides(setting.key) && !stays_behind(setting)) add_option(setting, table, groups, command.arguments);
    }
    if (output != nullptr) {
        for (const OptionSetting& setting : output->settings)
            add_option(setting, table, {kOutputGroup, kDataGroup, kLevelsGroup}, command.arguments);
    }
    std::sort(command.arguments.begin(), command.arguments.end(),
              [](const std::string& a, const std::string& b) { return cut(a, '=').first < cut(b, '=').first; });
    std::vector<std::string> line;
    for (const std::string& argument : command.arguments) line.push_back(with_root(argument, table));
    if (!is_last) line.push_back(fmt::format("--format={}", format_between(command.arguments)));
    const auto place_of = [&](const std::string& subject) {
        for (const auto* settings : {&step.settings, output != nullptr ? &output->settings : nullptr}) {
            if (settings == nullptr) continue;
            for (const OptionSetting& setting : *settings) {
                if (subject == "--" + setting.key) return setting.place;
            }
        }
        return output != nullptr && subject == printable(out) ? output->place : step.place;
    };
    try {
        command.program = parsed(step, std::move(line), out, console);
        command.converter = dynamic_cast<Converter*>(command.program.get());
        if (fs::path(out).extension().empty())
            command.extension =
                extension_of(command.converter->output_for_task().made_container().value_or(Container::dds));
        Task task{before_.empty() ? "input" : kBetween, out + command.extension};
        task.origin = "input";
        if (has_tile(out) && command.converter->makes_tiles()) task.tile = kAnyTile;
        for (const std::string& argument : command.arguments) {
            const Option* const row = row_of(table, cut(argument, '=').first.substr(2), groups);
            if (row != nullptr && row->writes) command.writes.push_back(row->name());
        }
        task.further = trial_places(command.program->command);
        task = command.converter->task_for(std::move(task));
        if (const auto checked = command.converter->check_task(task); !checked)
            throw UsageError(checked.error().message());
    } catch (const UsageError& error) {
        fail_at(manifest_.path, place_of(error.subject()), fmt::format("{}: {}", step.command, error.what()));
    }
    return command;
}

// Whether the command can stand where it does.
void Recipe::check_order(const StepSettings& step, const ReadyCommand& command, std::size_t index,
                         Console& console) const {
    const auto fail = [&](const char* reason) {
        fail_at(manifest_.path, step.place, fmt::format("{} {}", step.command, reason));
    };
    const bool is_only = rule_.steps.size() == 1, is_last = index + 1 == rule_.steps.size();
    const Task task{"input", kBetween, Container::exr};
    const ReadOptions read;
    const WriteOptions write;
    Job job(task, console, read, write, 1, [](double, const std::string&) { return true; });
    const std::optional<Step> made = command.converter->step(job);
    if (!made && !is_only) fail("must be the only step");
    if (!made && check_->is_given()) fail("makes no normals, so check cannot be used");
    if (made && index > 0 && std::holds_alternative<BakeFileOptions>(*made)) fail("must be the first step");
    const auto* const packed = made ? std::get_if<PackFileOptions>(&*made) : nullptr;
    if (packed != nullptr && packed->mip && !is_last) fail("builds levels, so it must be the last step");
}

void Recipe::add_output(const OutputSettings& output, Console& console) {
    std::optional<NamePattern> name;
    std::string out;
    try {
        name.emplace(output.name);
        if (name->uses("type")) throw UsageError("{type} cannot be used here: the extension says the file type");
        out = name->expand({".", "name", ".png", "format", "engine"});
    } catch (const UsageError& error) {
        fail_at(manifest_.path, output.place, fmt::format("name: {}", error.what()));
    }
    if (has_tile(out) && has_level(out))
        fail_at(manifest_.path, output.place, "name: <UDIM> and {level} contradict each other");
    const bool names_engine = name->uses("engine");
    if (check_->is_given() && has_level(out))
        fail_at(manifest_.path, output.place, "check needs all levels in one file");
    check_folder(*name, out, output.place);
    ReadyCommand last_step = ready(rule_.steps.back(), &output, true, out, console);
    if (!last_step.extension.empty()) {
        name.emplace(output.name + last_step.extension);
        out += last_step.extension;
    }
    RecipeOutput made{std::move(last_step), std::move(*name), {}, {}, out, {}, output.place};
    if (names_engine && made.last.converter->output_for_task().engine == nullptr)
        fail_at(manifest_.path, output.place, "name: {engine} needs the key for");
    const std::size_t last = rule_.steps.size() - 1;
    check_order(rule_.steps.back(), made.last, last, console);
    const auto settings_of = [&](const std::string& step, const ReadyCommand& command) {
        std::string text = step + "\n";
        for (const std::string& argument : command.arguments) text += fmt::format("{} {}\n", argument.size(), argument);
        return text;
    };
    for (std::size_t k = 0; k < last; ++k) made.settings += settings_of(rule_.steps[k].command, before_[k]);
    made.settings += settings_of(rule_.steps[last].command, made.last);
    const Task task = made.last.converter->task_for("input", out);
    made.settings += fmt::format("{} {}\n", name_of(kContainerNames, task.container), has_level(out) ? "levels" : "");
    made.settings += check_->text();
    const Command& table = table_of(rule_.steps[last].command);
    for (const std::string& argument : made.last.arguments) {
        if (row_of(table, cut(argument, '=').first.substr(2), {kDataGroup}) != nullptr) made.data += argument + "\n";
    }
    made.named = named_settings(made.last, task);
    outputs_.push_back(std::move(made));
}

std::string Recipe::preset_of(const std::string& name) const {
    const std::string step = cut(name, ' ').first;
    for (std::size_t k = 0; k < rule_.steps.size(); ++k) {
        const Command& table = table_of(rule_.steps[k].command);
        const Option* const row = row_of(table, name.substr(name.rfind(' ') + 1), groups_of(table));
        if (rule_.steps[k].command == step && row != nullptr) return row->value.empty() ? "false" : row->preset;
    }
    return {};
}

}  // namespace tex::cli
