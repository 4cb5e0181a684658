// SPDX-License-Identifier: Apache-2.0

#include "options/rules.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "options/files.h"
#include "tasks/folders.h"

namespace tex::cli {
namespace {

const Rule& parse_rule(const std::string& name) {
    if (const Rule* rule = find_rule(name)) return *rule;
    std::vector<std::string> names;
    for (const Rule& rule : rules()) names.emplace_back(rule.name);
    throw UsageError(fmt::format("there is no rule '{}'{}", name, did_you_mean(name, names)));
}

void require(Requirements& requirements, const std::string& text) {
    if (const auto added = add_common_requirement(requirements, text); !added) throw UsageError(added.error().reason);
}

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

void RuleOptions::add(Command& command) {
    command.group("Rules");
    command
        .option("--require", "KEY[=VALUE]", "demand something of every file",
                [this](const std::string& text) {
                    require(given_.require, text);
                    required_.push_back(text);
                })
        .often(1, "demand format=bc5, mips=full, y=up ... of every file")
        .repeatable = true;
    Option& row = command.option(
        "--for", "ENGINE[,ENGINE]", "demand what engines read, and their direction of green",
        [this](const std::string& text) {
            engines_ = parse_engines(text);
            for (const Engine* const engine : engines_) {
                if (engine->y != engines_.front()->y)
                    throw UsageError(fmt::format("{} and {} read green the other way round: check a file for one",
                                                 engines_.front()->name, engine->name));
            }
        });
    row.often(1, "demand what an engine reads: unity, unreal, godot ...").words = engine_words();
    row.words.pop_back();  // list
    row.completes = Completes::words;
    const auto name_into = [](std::vector<std::string>& names) {
        return [&names](const std::string& text) {
            static_cast<void>(parse_rule(text));
            names.push_back(text);
        };
    };
    Option& layout = command.option("--swizzle", "S", "which channels hold x and y: labpbr, rg, dxt5nm ..., or ag",
                                    [this](const std::string& text) {
                                        swizzle_ = parse_swizzle(text);
                                        given_.occlusion_in_blue = has_occlusion_in_blue(text);
                                    });
    layout.words = swizzle_words();
    layout.preset = "auto";
    layout.completes = Completes::words;
    add_length_in(command, length_in_);
    command.option("--enable", "ID", "check a rule (id or name) that is off by default", name_into(given_.enable))
        .repeatable = true;
    command.option("--disable", "ID", "do not check a rule", name_into(given_.disable))
        .often(1, "do not check a rule")
        .repeatable = true;
    command
        .option("--severity", "ID=SEVERITY", "make a rule an error, a warning or a note",
                [this](const std::string& text) {
                    const auto [name, severity] = cut(text, '=');
                    static_cast<void>(parse_rule(name));
                    given_.severity.emplace_back(name, parse_word(severity, kSeverityNames));
                })
        .repeatable = true;
    command.text(config_, "--config", "FILE", "read requirements, rules and severities from a TOML file")
        .often(1, "read requirements and rules from a TOML file")
        .completes = Completes::files;
    Option& root =
        command.text(root_, "--root", "DIR", "the folder that patterns in the file of --config are relative to");
    root.completes = Completes::directories;
    root.preset = "that of the file";
    command.check([this] {
        if (!root_.empty() && config_.empty())
            throw UsageError("--root needs --config, whose patterns are relative to it");
    });
    command
        .choice(least_failing_, "--fail-on", "SEVERITY", kSeverityNames,
                "the lowest severity that makes the command fail (exit 1)")
        .often(1, "what makes the command fail: error, warning or note");
    command
        .text(height_file_, "--height", "FILE",
              "the height map that the (single) input was made from: check that it matches")
        .completes = Completes::files;
    command
        .text(occlusion_file_, "--occlusion", "FILE",
              "the occlusion beside the (single) input, in red or grey: check that it follows the normals")
        .completes = Completes::files;
    command.flag(list_, "--list", "list all rules and exit");
    command.option("--explain", "ID", "explain one rule and exit",
                   [this](const std::string& text) { explain_ = &parse_rule(text); });
}

// The words of the file come first, so that those of the command line override them.
Demands RuleOptions::merged(const CheckSettings& settings, const Command& command) const {
    Demands demands{settings.options, settings.fail_on.value_or(least_failing_)};
    CheckOptions& checks = demands.checks;
    for (const std::string& text : required_) require(checks.require, text);
    for (const Engine* const engine : engines_) {
        checks.require.engines.push_back(needs_of(*engine));
        if (!checks.require.y) checks.require.y = engine->y;
    }
    checks.any_length = checks.any_length || length_in_;
    if (swizzle_) {
        checks.swizzle = *swizzle_;
        checks.occlusion_in_blue = given_.occlusion_in_blue;
    }
    append(checks.enable, given_.enable);
    append(checks.severity, given_.severity);
    // A rule may appear with its id in one place and with its name in the other.
    for (const std::string& name : given_.enable) {
        std::erase_if(checks.disable, [&](const std::string& other) { return find_rule(other) == find_rule(name); });
    }
    append(checks.disable, given_.disable);
    if (command.given("--fail-on")) demands.fail_on = least_failing_;
    return demands;
}

Result<void> RuleOptions::merge_config(const Command& command) {
    CheckConfig config;
    if (!config_.empty()) {
        auto read = read_check_config(config_);
        if (!read) return read.error();
        config = std::move(*read);
    }
    demands_ = merged(config.settings, command);
    for (const CheckRule& rule : config.rules) of_rules_.push_back(merged(rule.settings, command));
    file_rules_ = std::move(config.rules);
    return {};
}

std::size_t RuleOptions::rule_of(const std::string& path) const {
    if (file_rules_.empty() || path == "-") return file_rules_.size();
    const auto name = path_below(root_.empty() ? slashed(std::filesystem::path(config_).parent_path()) : root_, path);
    const auto rule = std::find_if(file_rules_.begin(), file_rules_.end(),
                                   [&](const CheckRule& candidate) { return name && candidate.takes(*name); });
    return static_cast<std::size_t>(rule - file_rules_.begin());
}

const Demands& RuleOptions::demands_of(const std::string& path) const {
    const std::size_t rule = rule_of(path);
    return rule < of_rules_.size() ? of_rules_[rule] : demands_;
}

std::vector<std::string> RuleOptions::idle_rules(const std::vector<Task>& tasks) const {
    std::vector<std::string> sentences;
    std::vector<bool> used(file_rules_.size() + 1);
    for (const Task& task : tasks) used[rule_of(task.input)] = true;
    for (std::size_t k = 0; k < file_rules_.size(); ++k) {
        if (used[k]) continue;
        std::vector<std::string> patterns;
        for (const Glob& glob : file_rules_[k].match) patterns.push_back(printable(glob.text()));
        sentences.push_back(fmt::format(
            "{}: line {}: no file that is checked is of this rule ({}), which is relative to {}", printable(config_),
            file_rules_[k].line, join(patterns, ", "),
            root_.empty() ? "the folder of the configuration; --root names another" : "--root " + printable(root_)));
    }
    return sentences;
}

Result<void> RuleOptions::read(const Command& command, const std::vector<Task>& tasks, const ReadOptions& read) {
    if (auto merged = merge_config(command); !merged) return merged;
    for (const auto& [option, file] : {std::pair("--height", &height_file_), {"--occlusion", &occlusion_file_}}) {
        if (!file->empty() && tasks.size() != 1) throw UsageError(fmt::format("{} goes with a single file", option));
    }
    if (!height_file_.empty()) {
        if (auto done = read_height(read); !done) return done;
    }
    return occlusion_file_.empty() ? Result<void>() : read_occlusion(read);
}

Result<void> RuleOptions::read_height(const ReadOptions& read) {
    const auto image = read_image(height_file_, read);
    if (!image) return image.error();
    auto field = height_field(*image, {});
    if (!field) return field.error().of(height_file_);
    height_ = std::move(*field);
    demands_.checks.height = &*height_;
    for (Demands& demands : of_rules_) demands.checks.height = &*height_;
    return {};
}

// Occlusion is in red, as glTF has it, or in the one channel of a grey picture.
Result<void> RuleOptions::read_occlusion(const ReadOptions& read) {
    auto image = read_image(occlusion_file_, read);
    if (!image) return image.error();
    const auto red = std::find(image->names.begin(), image->names.end(), "R");
    const auto channel = red == image->names.end() ? 0 : red - image->names.begin();
    occlusion_ = std::move(image->planes[static_cast<std::size_t>(channel)]);
    demands_.checks.occlusion = &occlusion_;
    for (Demands& demands : of_rules_) demands.checks.occlusion = &occlusion_;
    return {};
}

}  // namespace tex::cli
