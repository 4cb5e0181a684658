// SPDX-License-Identifier: Apache-2.0
// json_line.h: one line of a plan or a report. Names of files are bytes: a name that is not UTF-8 is written as
// {"hex": "..."} instead of a string.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cli/json.h"
#include "tree/sha256.h"

namespace tex::cli {

[[nodiscard]] Json name_json(const std::string& name);
[[nodiscard]] Json names_json(const std::vector<std::string>& names);

// The members of an object. Every function throws a UsageError, "PATH: line L: REASON", if the text is not what it
// should be.
class JsonLine {
public:
    JsonLine(std::string path, std::size_t number, std::string_view text);

    [[nodiscard]] bool has(const char* key) const { return object_.contains(key); }
    [[nodiscard]] std::int64_t number(const char* key, std::int64_t least, std::int64_t greatest) const;
    // Fit to be printed: control characters are escaped.
    [[nodiscard]] std::string text(const char* key) const;
    [[nodiscard]] std::string name(const char* key) const;
    [[nodiscard]] std::vector<std::string> names(const char* key) const;
    [[nodiscard]] Digest digest(const char* key) const;
    // The objects of an array.
    [[nodiscard]] std::vector<JsonLine> objects(const char* key) const;
    [[noreturn]] void fail(const std::string& reason) const;

private:
    JsonLine(const JsonLine& whole, Json part) : path_(whole.path_), number_(whole.number_), object_(std::move(part)) {}
    [[nodiscard]] const Json& member(const char* key) const;
    [[nodiscard]] std::string as_name(const Json& value, const char* key) const;

    std::string path_;
    std::size_t number_;
    Json object_;
};

}  // namespace tex::cli
