// SPDX-License-Identifier: Apache-2.0

#include "options/check_config.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "batch/text_file.h"
#include "cli/command.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/toml.h"
#include "options/toml_bounds.h"

namespace tex::cli {
namespace {

class Reader {
public:
    Reader(const std::string& path, const toml::table& table) : path_(path), table_(table) {}

    CheckConfig read() const {
        CheckConfig config;
        const std::vector<std::string> known = {"require", "enable", "disable", "fail-on", "severity"};
        for (const auto& [key, node] : table_) {
            const std::string name(key.str());
            if (std::find(known.begin(), known.end(), name) == known.end()) {
                fail(node, fmt::format("unknown key '{}'{}", printable(name), did_you_mean(name, known)));
            }
        }
        for (const auto& [text, node] : strings("require")) {
            if (auto added = add_requirement(config.options.require, text); !added)
                fail(*node, printable(added.error().reason));
        }
        for (const auto& [text, node] : strings("enable")) config.options.enable.push_back(rule_name(text, *node));
        for (const auto& [text, node] : strings("disable")) config.options.disable.push_back(rule_name(text, *node));
        if (const toml::node* node = table_.get("fail-on")) config.fail_on = severity(*node);
        read_severities(config);
        return config;
    }

private:
    [[noreturn]] void fail(const toml::node& node, const std::string& reason) const {
        throw UsageError(fmt::format("{}: line {}: {}", printable(path_), node.source().begin.line, reason));
    }

    std::vector<std::pair<std::string, const toml::node*>> strings(const char* key) const {
        std::vector<std::pair<std::string, const toml::node*>> list;
        const toml::node* node = table_.get(key);
        if (node == nullptr) return list;
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

    void read_severities(CheckConfig& config) const {
        const toml::node* node = table_.get("severity");
        if (node == nullptr) return;
        if (!node->is_table()) fail(*node, "severity must be a table");
        for (const auto& [key, value] : *node->as_table()) {
            config.options.severity.emplace_back(rule_name(std::string(key.str()), value), severity(value));
        }
    }

    const std::string& path_;
    const toml::table& table_;
};

}  // namespace

Result<CheckConfig> read_check_config(const std::string& path) {
    const auto text = read_text_file(path);
    if (!text) return text.error();
    return parse_check_config(path, *text);
}

CheckConfig parse_check_config(const std::string& path, const std::string& text) {
    check_toml_bounds(path, text);
    // The behaviour of toml++ 3.3 is undefined for non-ASCII letters outside strings and comments. None of our keys and
    // values has such a letter. So they are replaced by question marks, which are refused like any other mistake. A
    // byte order mark may come first.
    std::string ascii = text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
    std::replace_if(
        ascii.begin(), ascii.end(), [](char c) { return static_cast<unsigned char>(c) > 0x7e; }, '?');
    try {
        const toml::table table = toml::parse(ascii);
        return Reader(path, table).read();
    } catch (const toml::parse_error& error) {
        throw UsageError(
            fmt::format("{}: line {}: {}", printable(path), error.source().begin.line, printable(error.description())));
    } catch (const BrokenToml&) {
        throw UsageError(fmt::format("{}: this is not TOML", printable(path)));
    }
}

}  // namespace tex::cli
