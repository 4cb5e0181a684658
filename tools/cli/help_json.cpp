// SPDX-License-Identifier: Apache-2.0

#include "cli/help_json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/json.h"
#include "cli/usage_error.h"

namespace tex::cli {
namespace {

// What the option's parser asks for, whatever parts its value has.
std::optional<AskedNumber> asked_by(const Option& row) {
    for (const char* const text : {"0", "0,0", "0,0,0", "0x0", "0/0"}) {
        const auto asked = asked_number([&] { row.take(text); });
        if (asked) return asked;
    }
    return std::nullopt;
}

// Whether a value has, or may have, several parts: "X[,Y]", "WxH", "I/N".
bool has_parts(const std::string& value) {
    return value.find(',') != std::string::npos || value.find('/') != std::string::npos || value == "WxH" ||
           value.find("[x") != std::string::npos || value == "LIST";
}

bool reads_names(const Option& row) {
    const auto names = [&](const char* word) { return row.value.find(word) != std::string::npos; };
    if (!row.words.empty()) return false;
    return row.completes == Completes::files || row.completes == Completes::directories || names("FILE") ||
           names("DIR") || names("PATTERN");
}

// Whether the option takes this text.
bool takes(const Option& row, const std::string& text) {
    try {
        row.take(text);
    } catch (const UsageError&) {
        return false;
    }
    return true;
}

std::string type_of(const Option& row, const std::optional<AskedNumber>& asked) {
    if (row.value.empty()) return "flag";
    if (asked && row.completes == Completes::files) return "text";  // a number or a file
    if (!row.words.empty() && !asked && !has_parts(row.value)) return takes(row, "0") ? "text" : "word";
    if (row.completes == Completes::directories || row.value == "DIR") return "folder";
    if (reads_names(row)) return row.value == "FILE" || row.completes == Completes::files ? "file" : "text";
    if (!asked) return "text";
    if (has_parts(row.value)) return asked->kind == AskedNumber::Kind::integer ? "integers" : "numbers";
    switch (asked->kind) {
        case AskedNumber::Kind::integer: return "integer";
        case AskedNumber::Kind::count: return "count";
        case AskedNumber::Kind::number: break;
    }
    return "number";
}

Json number_json(const AskedNumber& asked, double value) {
    if (asked.kind == AskedNumber::Kind::number) return static_cast<float>(value);
    return static_cast<std::int64_t>(value);
}

void add_range(Json& json, const AskedNumber& asked) {
    const Range& range = asked.range;
    const bool whole = asked.kind != AskedNumber::Kind::number;
    if (std::isfinite(range.least))
        json[range.least_too ? "minimum" : "exclusiveMinimum"] = number_json(asked, range.least);
    const bool unlimited = whole && range.greatest >= static_cast<double>(std::numeric_limits<int>::max());
    if (std::isfinite(range.greatest) && !unlimited) json["maximum"] = number_json(asked, range.greatest);
}

// The default, as a value where it is one. Otherwise it is a clause, or depends on the file.
void add_default(Json& json, const Option& row, const std::string& type, const std::optional<AskedNumber>& asked) {
    if (type == "flag") json["default"] = false;
    if (row.preset.empty()) return;
    const std::vector<std::string> names = names_of(row.words);
    const bool is_word = std::find(names.begin(), names.end(), row.preset) != names.end();
    if (!is_word && (type == "integer" || type == "number")) {
        try {
            json["default"] = number_json(*asked, parse_double(row.preset));
            return;
        } catch (const UsageError&) {
        }
    }
    const bool is_value = is_word || (type != "word" && type != "integer" && type != "number" &&
                                      row.preset.find(' ') == std::string::npos);
    json[is_value ? "default" : "default_text"] = row.preset;
}

Json words_json(const Option& row) {
    Json words = Json::array();
    for (const Word& word : row.words) {
        words.push_back({{"word", word.name}});
        if (!word.meaning.empty()) words.back()["text"] = word.meaning;
    }
    return words;
}

Json option_json(const Option& row) {
    std::optional<AskedNumber> asked;
    if (!row.value.empty() && !reads_names(row)) asked = asked_by(row);
    const std::string type = type_of(row, asked);
    Json json = {{"names", row.names}, {"type", type}};
    if (!row.value.empty()) json["value"] = row.value;
    if (asked) add_range(json, *asked);
    if (!row.words.empty()) json["words"] = words_json(row);
    add_default(json, row, type, asked);
    if (row.repeatable && !row.value.empty()) json["repeatable"] = true;
    if (row.writes) json["writes"] = true;
    json["group"] = row.group;
    json["text"] = row.help;
    return json;
}

}  // namespace

std::string help_json(const Command& command) {
    Json json = {{"program", command.name()}, {"version", TEX_VERSION}, {"text", command.summary()}};
    json["usage"] = Json::array();
    for (const std::string& usage : command.usages()) json["usage"].push_back(command.name() + " [OPTIONS] " + usage);
    json["input"] = {{"value", command.input().name}, {"text", command.input().meaning}};
    json["options"] = Json::array();
    for (const Option& row : command.options()) {
        if (!row.hidden) json["options"].push_back(option_json(row));
    }
    json["examples"] = Json::array();
    for (const Example& example : command.examples())
        json["examples"].push_back({{"line", example.line}, {"text", example.meaning}});
    json["exit_status"] = Json::array();
    for (const Named<ExitCode>& row : kExitCodeNames) {
        if (row.value == ExitCode::findings && !command.finds()) continue;
        json["exit_status"].push_back({{"status", static_cast<int>(row.value)}, {"text", row.meaning}});
    }
    return to_report_line(json);
}

}  // namespace tex::cli
