// SPDX-License-Identifier: Apache-2.0

#include "tree/manifest.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "cli/glob.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/toml.h"
#include "options/toml_bounds.h"
#include "tasks/grid.h"
#include "tree/beside.h"

namespace tex::cli {
namespace {

TextPosition place_of(const toml::source_region& source) {
    return {static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

// What [defaults] holds.
struct Defaults {
    std::string out_dir;
    std::string name = "{dir}/{stem}";
    std::vector<OutputSettings> outputs;
    Settings check;
    std::map<std::string, Settings> commands;
};

class ManifestReader {
public:
    ManifestReader(const std::string& path, const std::vector<std::string>& commands)
        : path_(path), commands_(commands) {}

    Manifest read(const toml::table& table);

private:
    [[noreturn]] void fail(const toml::node& node, const std::string& reason) const {
        fail_at(path_, place_of(node.source()), reason);
    }
    void check_keys(const toml::table& table, const std::vector<std::string>& known) const;
    [[nodiscard]] std::string string_of(const toml::node& node, const std::string& what) const;
    [[nodiscard]] std::string folder_of(const toml::node& node) const;
    [[nodiscard]] std::vector<std::string> patterns_of(const toml::node& node, const std::string& what) const;
    [[nodiscard]] const toml::table& table_of(const toml::node& node, const std::string& what) const;
    [[nodiscard]] const toml::array& array_of(const toml::node& node, const std::string& what) const;
    [[nodiscard]] int number_of(const toml::node& node, const std::string& what) const;
    [[nodiscard]] std::string value_of(const std::string& key, const toml::node& node) const;
    [[nodiscard]] OptionSetting setting_of(const toml::key& key, const toml::node& node) const;
    [[nodiscard]] Settings settings_of(const toml::table& table) const;
    [[nodiscard]] std::vector<OutputSettings> outputs_of(const toml::node& node) const;
    [[nodiscard]] StepSettings step_of(const toml::node& node) const;
    void read_defaults(const toml::table& table);
    [[nodiscard]] RuleSettings rule_of(const toml::table& table) const;

    const std::string& path_;
    const std::vector<std::string>& commands_;
    Defaults defaults_;
};

void ManifestReader::check_keys(const toml::table& table, const std::vector<std::string>& known) const {
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        fail_at(path_, place_of(key.source()),
                fmt::format("unknown key '{}'{}", printable(name), did_you_mean(name, known)));
    }
}

std::string ManifestReader::string_of(const toml::node& node, const std::string& what) const {
    if (!node.is_string() || node.as_string()->get().empty()) fail(node, what + " must be a string that is not empty");
    if (node.as_string()->get().find('\0') != std::string::npos) fail(node, what + " holds a NUL character");
    return node.as_string()->get();
}

// The value of out-dir.
std::string ManifestReader::folder_of(const toml::node& node) const {
    std::string folder = string_of(node, "out-dir");
    const std::filesystem::path path(folder);
    if (path.has_root_path() && !path.is_absolute()) {  // on Windows: "/art", "C:art"
        fail(node, fmt::format("out-dir: {} depends on the current drive or its current folder; name the drive and the "
                               "whole path",
                               printable(folder)));
    }
    if (*path.lexically_normal().begin() == "..") {
        fail(node, fmt::format("out-dir: {} leads out of the folder of the manifest; --root sets another folder, and "
                               "an absolute path is not bound to it",
                               printable(folder)));
    }
    return folder;
}

const toml::table& ManifestReader::table_of(const toml::node& node, const std::string& what) const {
    if (!node.is_table()) fail(node, what + " must be a table");
    return *node.as_table();
}

const toml::array& ManifestReader::array_of(const toml::node& node, const std::string& what) const {
    if (!node.is_array()) fail(node, what + " must be a list");
    return *node.as_array();
}

int ManifestReader::number_of(const toml::node& node, const std::string& what) const {
    if (!node.is_integer() || node.as_integer()->get() < 1 || node.as_integer()->get() > 1000000)
        fail(node, what + " must be a number of at least 1");
    return static_cast<int>(node.as_integer()->get());
}

// One pattern or a list of them, checked.
std::vector<std::string> ManifestReader::patterns_of(const toml::node& node, const std::string& what) const {
    std::vector<std::string> patterns;
    const auto add = [&](const toml::node& item) {
        patterns.push_back(string_of(item, what));
        try {
            if (what == "unless") {
                check_beside(patterns.back());
                return;
            }
            const Glob checked(what == "match" && has_grid(patterns.back()) ? grid_glob(patterns.back())
                                                                            : patterns.back());
        } catch (const UsageError& error) {
            fail(item, error.what());
        }
    };
    if (!node.is_array()) {
        add(node);
    } else {
        for (const toml::node& item : *node.as_array()) add(item);
    }
    return patterns;
}

// A value as it would be typed on a command line.
std::string ManifestReader::value_of(const std::string& key, const toml::node& node) const {
    if (node.is_string()) return string_of(node, printable(key));
    if (node.is_integer()) return fmt::format("{}", node.as_integer()->get());
    if (node.is_floating_point()) {
        const double value = node.as_floating_point()->get();
        if (!std::isfinite(value)) fail(node, printable(key) + " must be a finite number");
        return fmt::format("{}", value);
    }
    fail(node, printable(key) + " must be a string, a number, true, false or a list of strings and numbers");
}

OptionSetting ManifestReader::setting_of(const toml::key& key, const toml::node& node) const {
    OptionSetting setting;
    setting.key = key.str();
    setting.place = place_of(key.source());
    if (node.is_boolean()) {
        setting.is_flag = true;
        setting.is_on = node.as_boolean()->get();
    } else if (node.is_array()) {
        setting.is_list = true;
        for (const toml::node& item : *node.as_array()) setting.values.push_back(value_of(setting.key, item));
        if (setting.values.empty()) fail(node, printable(setting.key) + " is an empty list");
    } else {
        setting.values.push_back(value_of(setting.key, node));
    }
    return setting;
}

Settings ManifestReader::settings_of(const toml::table& table) const {
    Settings settings;
    for (const auto& [key, node] : table) settings.push_back(setting_of(key, node));
    std::sort(settings.begin(), settings.end(),
              [](const OptionSetting& a, const OptionSetting& b) { return a.key < b.key; });
    return settings;
}

std::vector<OutputSettings> ManifestReader::outputs_of(const toml::node& node) const {
    std::vector<OutputSettings> outputs;
    for (const toml::node& item : array_of(node, "outputs")) {
        const toml::table& table = table_of(item, "each of outputs");
        OutputSettings output;
        output.place = place_of(item.source());
        for (const auto& [key, value] : table) {
            if (key.str() == "name") {
                output.name = string_of(value, "name");
            } else {
                output.settings.push_back(setting_of(key, value));
            }
        }
        outputs.push_back(std::move(output));
    }
    if (outputs.empty()) fail(node, "outputs is an empty list");
    return outputs;
}

StepSettings ManifestReader::step_of(const toml::node& node) const {
    const toml::table& table = table_of(node, "each of steps");
    if (table.size() != 1) fail(node, "a step holds one command, such as { bake = {} }");
    check_keys(table, commands_);
    const auto only = table.begin();
    const toml::key& key = only->first;
    const toml::node& value = only->second;
    StepSettings step;
    step.command = key.str();
    step.place = place_of(key.source());
    step.settings = settings_of(table_of(value, step.command));
    const auto found = defaults_.commands.find(step.command);
    if (found == defaults_.commands.end()) return step;
    for (const OptionSetting& setting : found->second) {
        const bool is_set = std::any_of(step.settings.begin(), step.settings.end(),
                                        [&](const OptionSetting& own) { return own.key == setting.key; });
        if (!is_set) step.settings.push_back(setting);
    }
    std::sort(step.settings.begin(), step.settings.end(),
              [](const OptionSetting& a, const OptionSetting& b) { return a.key < b.key; });
    return step;
}

void ManifestReader::read_defaults(const toml::table& table) {
    std::vector<std::string> known = {"out-dir", "name", "outputs", "check"};
    known.insert(known.end(), commands_.begin(), commands_.end());
    check_keys(table, known);
    for (const auto& [key, node] : table) {
        if (key.str() == "out-dir") {
            defaults_.out_dir = folder_of(node);
        } else if (key.str() == "name") {
            defaults_.name = string_of(node, "name");
        } else if (key.str() == "outputs") {
            defaults_.outputs = outputs_of(node);
        } else if (key.str() == "check") {
            defaults_.check = settings_of(table_of(node, "check"));
        } else {
            Settings& settings = defaults_.commands[std::string(key.str())] =
                settings_of(table_of(node, std::string(key.str())));
            for (OptionSetting& setting : settings) setting.is_default = true;
        }
    }
}

RuleSettings ManifestReader::rule_of(const toml::table& table) const {
    check_keys(table, {"match", "exclude", "unless", "name", "out-dir", "steps", "outputs", "check"});
    RuleSettings rule;
    rule.place = place_of(table.source());
    const toml::node* match = table.get("match");
    if (match == nullptr) fail(table, "the rule has no match: match = \"art/**/*_h.png\"");
    rule.match = patterns_of(*match, "match");
    if (rule.match.empty()) fail(*match, "match is an empty list");
    if (const toml::node* node = table.get("exclude")) rule.exclude = patterns_of(*node, "exclude");
    if (const toml::node* node = table.get("unless")) rule.unless = patterns_of(*node, "unless");
    rule.out_dir = defaults_.out_dir;
    if (const toml::node* node = table.get("out-dir")) rule.out_dir = folder_of(*node);
    const toml::node* steps = table.get("steps");
    if (steps == nullptr) fail(table, "the rule has no steps: steps = [ { bake = {} } ]");
    for (const toml::node& step : array_of(*steps, "steps")) rule.steps.push_back(step_of(step));
    if (rule.steps.empty()) fail(*steps, "steps is an empty list");
    rule.outputs = defaults_.outputs;
    if (const toml::node* node = table.get("outputs")) rule.outputs = outputs_of(*node);
    if (rule.outputs.empty()) rule.outputs.push_back({{}, {}, rule.place});
    std::string name = defaults_.name;
    if (const toml::node* node = table.get("name")) name = string_of(*node, "name");
    for (OutputSettings& output : rule.outputs) {
        if (output.name.empty()) output.name = name;
    }
    rule.check = defaults_.check;
    if (const toml::node* node = table.get("check")) rule.check = settings_of(table_of(*node, "check"));
    return rule;
}

Manifest ManifestReader::read(const toml::table& table) {
    check_keys(table, {"version", "output-version", "defaults", "rule"});
    Manifest manifest;
    manifest.path = path_;
    const toml::node* version = table.get("version");
    if (version == nullptr) fail_at(path_, {}, "no version; this program reads version = 1");
    if (!version->is_integer() || version->as_integer()->get() != 1)
        fail(*version, "an unknown version; this program reads version = 1");
    if (const toml::node* node = table.get("output-version"))
        manifest.output_version = number_of(*node, "output-version");
    if (const toml::node* node = table.get("defaults")) read_defaults(table_of(*node, "defaults"));
    const toml::node* rules = table.get("rule");
    if (rules == nullptr) fail_at(path_, {}, "no rule; a rule begins with [[rule]]");
    for (const toml::node& rule : array_of(*rules, "rule, which begins with [[rule]],"))
        manifest.rules.push_back(rule_of(table_of(rule, "rule")));
    if (manifest.rules.empty()) fail(*rules, "no rule; a rule begins with [[rule]]");
    return manifest;
}

}  // namespace

void fail_at(const std::string& path, const TextPosition& place, const std::string& reason) {
    throw UsageError(fmt::format("{}: line {}, column {}: {}", printable(path), place.line, place.column, reason));
}

Manifest parse_manifest(const std::string& path, const std::string& text, const std::vector<std::string>& commands) {
    check_toml_bounds(path, text);
    try {
        const toml::table table = toml::parse(ascii_outside_strings(text));
        return ManifestReader(path, commands).read(table);
    } catch (const toml::parse_error& error) {
        fail_at(path, place_of(error.source()), printable(error.description()));
    } catch (const BrokenToml&) {
        throw UsageError(fmt::format("{}: this is not TOML", printable(path)));
    }
}

}  // namespace tex::cli
