// SPDX-License-Identifier: Apache-2.0

#include "mesh/json.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace tex::inline v1 {
namespace {

using nlohmann::json;

const json& value_of(const void* value) { return *static_cast<const json*>(value); }

JsonValue view_of(const json& value) { return value.is_null() ? JsonValue() : JsonValue(&value); }

// The greatest number of brackets that are open at once, outside of strings.
int depth_of(std::string_view text) {
    int depth = 0, greatest = 0;
    bool quoted = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (quoted) {
            if (c == '\\') ++k;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            greatest = std::max(greatest, ++depth);
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return greatest;
}

}  // namespace

Result<JsonDocument> JsonDocument::parse(std::string_view text) {
    if (text.size() > kMaxJsonBytes)
        return Error{ErrorCode::unsupported, {}, "its JSON is longer than " + std::to_string(kMaxJsonBytes) + " bytes"};
    if (depth_of(text) > kMaxJsonDepth) {
        return Error{
            ErrorCode::bad_data, {}, "its JSON is nested deeper than " + std::to_string(kMaxJsonDepth) + " levels"};
    }
    json parsed = json::parse(text, nullptr, false);
    if (parsed.is_discarded()) return Error{ErrorCode::bad_data, {}, "its JSON is damaged or truncated"};
    JsonDocument document;
    document.document_ = std::make_shared<const json>(std::move(parsed));
    return document;
}

bool JsonValue::is_array() const { return value_ != nullptr && value_of(value_).is_array(); }
bool JsonValue::is_object() const { return value_ != nullptr && value_of(value_).is_object(); }

JsonValue JsonValue::operator[](std::string_view key) const {
    if (!is_object()) return {};
    const json& object = value_of(value_);
    const auto found = object.find(std::string(key));
    return found == object.end() ? JsonValue() : view_of(*found);
}

JsonValue JsonValue::operator[](std::size_t index) const {
    return index < size() ? view_of(value_of(value_)[index]) : JsonValue();
}

std::size_t JsonValue::size() const { return is_array() ? value_of(value_).size() : 0; }

std::vector<std::string> JsonValue::keys() const {
    std::vector<std::string> keys;
    if (!is_object()) return keys;
    for (const auto& item : value_of(value_).items()) keys.push_back(item.key());
    return keys;
}

std::optional<std::string> JsonValue::text() const {
    if (value_ == nullptr || !value_of(value_).is_string()) return std::nullopt;
    return value_of(value_).get_ref<const std::string&>();
}

std::optional<double> JsonValue::number() const {
    if (value_ == nullptr || !value_of(value_).is_number()) return std::nullopt;
    return value_of(value_).get<double>();
}

std::optional<bool> JsonValue::boolean() const {
    if (value_ == nullptr || !value_of(value_).is_boolean()) return std::nullopt;
    return value_of(value_).get<bool>();
}

std::optional<std::int64_t> JsonValue::count() const {
    const std::optional<double> value = number();
    if (!value || !(*value >= 0.0 && *value <= 0x1p53) || std::floor(*value) != *value) return std::nullopt;
    return static_cast<std::int64_t>(*value);
}

}  // namespace tex::inline v1
