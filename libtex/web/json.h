// SPDX-License-Identifier: Apache-2.0
// json.h: as much of JSON as a call and its answer need. nlohmann-json, which reads models elsewhere, would be a tenth
// of the module.

#pragma once

#include <concepts>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tex::web {

class Json {
public:
    Json() = default;  // null
    Json(bool value) : kind_(Kind::boolean), number_(value ? 1.0 : 0.0) {}
    template <class T>
    requires(std::is_arithmetic_v<T> && !std::same_as<T, bool>) Json(T value)
        : kind_(Kind::number), number_(static_cast<double>(value)) {}
    Json(std::string text) : kind_(Kind::string), text_(std::move(text)) {}
    Json(std::string_view text) : Json(std::string(text)) {}
    Json(const char* text) : Json(std::string(text)) {}
    Json(std::initializer_list<std::pair<const char*, Json>> members);
    static Json list(std::vector<Json> elements = {});

    // Nothing if the text is not JSON, or is nested deeper than any call.
    static std::optional<Json> parse(std::string_view text);
    // Numbers that are not finite become null.
    [[nodiscard]] std::string dump() const;

    [[nodiscard]] bool is_null() const { return kind_ == Kind::null; }
    [[nodiscard]] bool is_boolean() const { return kind_ == Kind::boolean; }
    [[nodiscard]] bool is_number() const { return kind_ == Kind::number; }
    [[nodiscard]] bool is_string() const { return kind_ == Kind::string; }
    [[nodiscard]] bool is_list() const { return kind_ == Kind::list; }
    [[nodiscard]] bool is_object() const { return kind_ == Kind::object; }

    // Values of another kind give false, 0 or nothing.
    [[nodiscard]] bool boolean() const { return is_boolean() && number_ != 0.0; }
    [[nodiscard]] double number() const { return is_number() ? number_ : 0.0; }
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] const std::vector<Json>& elements() const { return elements_; }  // the values of an object, too
    [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
    [[nodiscard]] const Json* find(std::string_view key) const;  // of an object; null if there is none

    void set(std::string key, Json value);  // adds a member
    void append(Json element) { elements_.push_back(std::move(element)); }

private:
    enum class Kind { null, boolean, number, string, list, object };
    struct Parser;
    void write(std::string& out) const;

    Kind kind_ = Kind::null;
    double number_ = 0.0;
    std::string text_;
    std::vector<Json> elements_;
    std::vector<std::string> keys_;  // of an object: one for each element
};

}  // namespace tex::web
