// SPDX-License-Identifier: Apache-2.0

#include "tasks/name_pattern.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <tex/types.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "files/path_names.h"

namespace tex::cli {
namespace {

constexpr std::string_view kLevelField = "{level}";

const std::vector<std::string>& known_fields() {
    static const std::vector<std::string> fields = {"dir",    "stem",   "ext",  "level",
                                                    "format", "engine", "type", "material"};
    return fields;
}

// Cuts ":-SUFFIX" off a field and returns the suffix.
std::string suffix_to_drop(std::string& field) {
    const std::size_t colon = field.find(':');
    if (colon == std::string::npos) return {};
    const std::string rest = field.substr(colon + 1);
    field.resize(colon);
    if (field != "stem" || rest.size() < 2 || rest.front() != '-') {
        throw UsageError(
            fmt::format("'{{{}:{}}}': only {{stem:-SUFFIX}} takes something off", printable(field), printable(rest)));
    }
    return rest.substr(1);
}

std::string without_suffix(const std::string& stem, const std::string& suffix) {
    return stem.size() > suffix.size() && stem.ends_with(suffix) ? stem.substr(0, stem.size() - suffix.size()) : stem;
}

const std::string& known(const std::string& value, const char* reason) {
    if (value.empty()) throw UsageError(reason);
    return value;
}

}  // namespace

NameFields name_fields(const std::string& path) {
    if (path == "-") return {".", "stdin", "", ""};
    const std::filesystem::path parts(path);
    const std::string dir = slashed(parts.parent_path());
    return {dir.empty() ? "." : dir, slashed(parts.stem()), slashed(parts.extension()), ""};
}

std::string extension_of(Container container) {
    for (const Named<Container>& row : kContainerNames) {
        if (row.value == container) return cut(row.meaning, ',').first;
    }
    return {};
}

std::string with_level(const std::string& name, int level) {
    std::string result;
    for (const char c : name) {
        if (c == kLevelMark) {
            result += std::to_string(level);
        } else {
            result += c;
        }
    }
    return result;
}

bool has_level(const std::string& name) { return name.find(kLevelMark) != std::string::npos; }

std::string written_name(std::string name) {
    if (const std::size_t at = name.find(kLevelMark); at != std::string::npos) name.replace(at, 1, kLevelField);
    return name;
}

std::string marked_name(std::string name) {
    if (const std::size_t at = name.find(kLevelField); at != std::string::npos)
        name.replace(at, kLevelField.size(), 1, kLevelMark);
    return name;
}

std::vector<std::string> with_all_levels(const std::string& name) {
    const int levels = has_level(name) ? level_count({kMaxExtent, 1}) : 1;
    std::vector<std::string> names;
    for (int level = 0; level < levels; ++level) names.push_back(with_level(name, level));
    return names;
}

NamePattern::NamePattern(std::string_view text) {
    std::string literal;
    const auto end_literal = [&] {
        if (!literal.empty()) pieces_.push_back({false, literal});
        literal.clear();
    };
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if ((c == '{' || c == '}') && k + 1 < text.size() && text[k + 1] == c) {
            literal += c;
            ++k;
        } else if (c == '}') {
            throw UsageError(fmt::format("'{}' has a }} without its {{", printable(text)));
        } else if (c == '{') {
            const std::size_t close = text.find('}', k);
            if (close == std::string_view::npos)
                throw UsageError(fmt::format("'{}' has a {{ without its }}", printable(text)));
            std::string field(text.substr(k + 1, close - k - 1));
            const std::string without = suffix_to_drop(field);
            if (std::find(known_fields().begin(), known_fields().end(), field) == known_fields().end()) {
                throw UsageError(fmt::format("a field must be one of {}, not '{}'{}", join(known_fields()),
                                             printable(field), did_you_mean(field, known_fields())));
            }
            end_literal();
            pieces_.push_back({true, field, without});
            k = close;
        } else {
            literal += c;
        }
    }
    end_literal();
}

std::string NamePattern::expand(const NameFields& fields) const {
    std::string name;
    for (const Piece& piece : pieces_) {
        if (!piece.is_field)
            name += piece.text;
        else if (piece.text == "dir")
            name += fields.dir;
        else if (piece.text == "stem")
            name += without_suffix(fields.stem, piece.without);
        else if (piece.text == "ext")
            name += fields.ext;
        else if (piece.text == "format")
            name += fields.format;
        else if (piece.text == "engine")
            name += known(fields.engine, "{engine} needs --for");
        else if (piece.text == "material")
            name += known(fields.material, "{material} needs inputs that are models");
        else if (piece.text == "type")
            name += known(fields.type, "{type} needs --for or --container");
        else
            name += kLevelMark;
    }
    return name;
}

bool NamePattern::uses(std::string_view field) const {
    return std::any_of(pieces_.begin(), pieces_.end(),
                       [&](const Piece& piece) { return piece.is_field && piece.text == field; });
}

}  // namespace tex::cli
