// SPDX-License-Identifier: Apache-2.0

#include "tree/json_line.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"

namespace tex::cli {
namespace {

bool is_utf8(const std::string& text) {
    try {
        static_cast<void>(Json(text).dump());
        return true;
    } catch (const Json::exception&) {
        return false;
    }
}

}  // namespace

Json name_json(const std::string& name) {
    if (is_utf8(name)) return name;
    std::string hex;
    for (const char c : name) hex += fmt::format("{:02x}", static_cast<unsigned char>(c));
    return {{"hex", hex}};
}

Json names_json(const std::vector<std::string>& names) {
    Json json = Json::array();
    for (const std::string& name : names) json.push_back(name_json(name));
    return json;
}

JsonLine::JsonLine(std::string path, std::size_t number, std::string_view text)
    : path_(std::move(path)), number_(number), object_(Json::parse(text, nullptr, false)) {
    if (!object_.is_object()) fail("is not a JSON object");
}

void JsonLine::fail(const std::string& reason) const {
    throw UsageError(fmt::format("{}: line {}: {}", path_, number_, reason));
}

const Json& JsonLine::member(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) fail(fmt::format("\"{}\" is missing", key));
    return *found;
}

std::int64_t JsonLine::number(const char* key, std::int64_t least, std::int64_t greatest) const {
    const Json& value = member(key);
    const bool is_large = value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX;
    if (!value.is_number_integer() || is_large || value.get<std::int64_t>() < least ||
        value.get<std::int64_t>() > greatest)
        fail(fmt::format("\"{}\" must be a whole number from {} to {}", key, least, greatest));
    return value.get<std::int64_t>();
}

std::string JsonLine::text(const char* key) const {
    const Json& value = member(key);
    if (!value.is_string()) fail(fmt::format("\"{}\" must be a string", key));
    return printable(value.get<std::string>());
}

std::string JsonLine::as_name(const Json& value, const char* key) const {
    if (value.is_string()) return value.get<std::string>();
    const auto hex = value.is_object() ? value.find("hex") : value.end();
    if (!value.is_object() || hex == value.end() || !hex->is_string()) fail(fmt::format("\"{}\" must be a name", key));
    const std::string digits = hex->get<std::string>();
    std::string name;
    for (std::size_t k = 0; k + 2 <= digits.size(); k += 2) {
        unsigned code = 0;
        const char* const at = digits.data() + k;
        if (std::from_chars(at, at + 2, code, 16).ptr != at + 2) fail(fmt::format("\"{}\" must be a name", key));
        name += static_cast<char>(code);
    }
    if (digits.size() % 2 != 0) fail(fmt::format("\"{}\" must be a name", key));
    return name;
}

std::string JsonLine::name(const char* key) const { return as_name(member(key), key); }

std::vector<std::string> JsonLine::names(const char* key) const {
    const Json& value = member(key);
    if (!value.is_array()) fail(fmt::format("\"{}\" must be a list", key));
    std::vector<std::string> names;
    for (const Json& one : value) names.push_back(as_name(one, key));
    return names;
}

Digest JsonLine::digest(const char* key) const {
    const auto digest = Digest::from_hex(text(key));
    if (!digest) fail(fmt::format("\"{}\" must be a SHA-256 sum", key));
    return *digest;
}

std::vector<JsonLine> JsonLine::objects(const char* key) const {
    const Json& value = member(key);
    if (!value.is_array()) fail(fmt::format("\"{}\" must be a list", key));
    std::vector<JsonLine> objects;
    for (const Json& one : value) {
        if (!one.is_object()) fail(fmt::format("\"{}\" must be a list of objects", key));
        objects.push_back(JsonLine(*this, one));
    }
    return objects;
}

}  // namespace tex::cli
