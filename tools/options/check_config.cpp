// SPDX-License-Identifier: Apache-2.0

#include "options/check_config.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/foreign_words.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "options/normals.h"
#include "options/toml.h"
#include "options/toml_bounds.h"

namespace tex::cli {
namespace {

class Reader {
public:
    explicit Reader(const std::string& path) : path_(path) {}

    CheckConfig read(const toml::table& table) const {
        CheckConfig config;
        check_keys(table, {"rule"});
        add(table, config.settings);
        const toml::node* const rules = table.get("rule");
        if (rules == nullptr) return config;
        if (!rules->is_array()) fail(*rules, "a rule begins with [[rule]]");
        for (const toml::node& node : *rules->as_array()) {
            if (!node.is_table()) fail(node, "a rule begins with [[rule]]");
            config.rules.push_back(rule(*node.as_table(), config.settings));
        }
        return config;
    }

private:
    [[noreturn]] void fail(const toml::node& node, const std::string& reason) const {
        const toml::source_position& place = node.source().begin;
        throw UsageError(fmt::format("{}: line {}, column {}: {}", printable(path_), place.line, place.column, reason));
    }

    void check_keys(const toml::table& table, const std::vector<std::string>& more) const {
        std::vector<std::string> known = {"require", "swizzle", "length-in", "enable",
                                          "disable", "fail-on", "severity"};
        known.insert(known.end(), more.begin(), more.end());
        for (const auto& [key, node] : table) {
            const std::string name(key.str());
            if (std::find(known.begin(), known.end(), name) == known.end()) {
                fail(node, fmt::format("unknown key '{}'{}", printable(name), did_you_mean(name, known)));
            }
        }
    }

    CheckRule rule(const toml::table& table, const CheckSettings& top_level) const {
        check_keys(table, {"match", "exclude"});
        if (table.get("match") == nullptr) fail(table, "a rule needs match, a pattern of files");
        CheckRule rule;
        rule.match = globs(table, "match");
        rule.exclude = globs(table, "exclude");
        rule.settings = top_level;
        rule.line = static_cast<int>(table.source().begin.line);
        add(table, rule.settings);
        return rule;
    }

    std::vector<Glob> globs(const toml::table& table, const char* key) const {
        std::vector<Glob> globs;
        for (const auto& [text, node] : strings(table, key, true)) {
            try {
                globs.emplace_back(text);
            } catch (const UsageError& error) {
                fail(*node, fmt::format("{}: {}", key, error.what()));
            }
        }
        return globs;
    }

    // Adds what the table says to the settings, and overrides them.
    void add(const toml::table& table, CheckSettings& settings) const {
        CheckOptions& options = settings.options;
        for (const auto& [text, node] : strings(table, "require")) {
            if (auto added = add_common_requirement(options.require, text); !added)
                fail(*node, printable(added.error().reason));
        }
        if (const toml::node* node = table.get("length-in")) {
            const auto found =
                node->is_string() ? find_by_name(kLengthInNames, node->as_string()->get()) : std::nullopt;
            if (!found) fail(*node, fmt::format("length-in must be {}", join(names_of(words_of(kLengthInNames)))));
            options.any_length = true;
        }
        if (const toml::node* node = table.get("swizzle")) {
            if (!node->is_string()) fail(*node, "swizzle must be a string");
            try {
                options.swizzle = parse_swizzle(node->as_string()->get());
                options.occlusion_in_blue = has_occlusion_in_blue(node->as_string()->get());
            } catch (const UsageError& error) {
                fail(*node, fmt::format("swizzle: {}", error.what()));
            }
        }
        for (const auto& [text, node] : strings(table, "enable")) {
            options.enable.push_back(rule_name(text, *node));
            std::erase_if(options.disable,
                          [&name = text](const std::string& other) { return find_rule(other) == find_rule(name); });
        }
        for (const auto& [text, node] : strings(table, "disable")) options.disable.push_back(rule_name(text, *node));
        if (const toml::node* node = table.get("fail-on")) settings.fail_on = severity(*node);
        const toml::node* const severities = table.get("severity");
        if (severities == nullptr) return;
        if (!severities->is_table()) fail(*severities, "severity must be a table");
        for (const auto& [key, value] : *severities->as_table())
            options.severity.emplace_back(rule_name(std::string(key.str()), value), severity(value));
    }

    std::vector<std::pair<std::string, const toml::node*>> strings(const toml::table& table, const char* key,
                                                                   bool may_be_one = false) const {
        std::vector<std::pair<std::string, const toml::node*>> list;
        const toml::node* node = table.get(key);
        if (node == nullptr) return list;
        if (may_be_one && node->is_string()) {
            list.emplace_back(node->as_string()->get(), node);
            return list;
        }
        if (!node->is_array()) fail(*node, fmt::format("{} must be a list of strings", key));
        for (const toml::node& item : *node->as_array()) {
            if (!item.is_string()) fail(item, fmt::format("{} must hold strings only", key));
            list.emplace_back(item.as_string()->get(), &item);
        }
        return list;
    }

    std::string rule_name(const std::string& name, const toml::node& node) const {
        if (find_rule(name) == nullptr) fail(node, fmt::format("there is no rule '{}'", printable(name)));
        return name;
    }

    Severity severity(const toml::node& node) const {
        const auto found = node.is_string() ? find_by_name(kSeverityNames, node.as_string()->get()) : std::nullopt;
        if (!found) fail(node, fmt::format("a severity must be one of {}", join(names_of(words_of(kSeverityNames)))));
        return *found;
    }

    const std::string& path_;
};

}  // namespace

bool CheckRule::takes(const std::string& path) const {
    const auto matches = [&](const Glob& glob) { return glob.matches(path); };
    return std::any_of(match.begin(), match.end(), matches) && std::none_of(exclude.begin(), exclude.end(), matches);
}

Result<CheckConfig> read_check_config(const std::string& path) {
    const auto text = read_toml_file(path);
    if (!text) return text.error();
    return parse_check_config(path, *text);
}

CheckConfig parse_check_config(const std::string& path, const std::string& text) {
    check_toml_bounds(path, text);
    try {
        const toml::table table = toml::parse(ascii_outside_strings(text));
        return Reader(path).read(table);
    } catch (const toml::parse_error& error) {
        throw UsageError(fmt::format("{}: line {}, column {}: {}", printable(path), error.source().begin.line,
                                     error.source().begin.column, printable(error.description())));
    } catch (const BrokenToml&) {
        throw UsageError(fmt::format("{}: this is not TOML", printable(path)));
    }
}

Result<void> add_common_requirement(Requirements& requirements, const std::string& text) {
    const std::size_t equal = text.find('=');
    if (equal == std::string::npos) return add_requirement(requirements, text);
    return add_requirement(requirements, text.substr(0, equal + 1) + common_word(text.substr(equal + 1)));
}

}  // namespace tex::cli
