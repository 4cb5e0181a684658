// SPDX-License-Identifier: Apache-2.0
// json.h: a JSON text of a stranger.
//
// nlohmann-json parses without recursion and reports errors without exceptions, but it takes any depth and 20 bytes of
// memory for each byte of text. So depth and size are limited before it starts. A JsonValue never fails: what is
// missing or of another type is null, and each reader says what it requires.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;
inline constexpr int kMaxJsonDepth = 1024;

// A value of a document, or null. Valid as long as the document exists.
class JsonValue {
public:
    JsonValue() = default;
    explicit JsonValue(const void* value) : value_(value) {}

    [[nodiscard]] bool is_null() const { return value_ == nullptr; }
    [[nodiscard]] bool is_array() const;
    [[nodiscard]] bool is_object() const;
    [[nodiscard]] JsonValue operator[](std::string_view key) const;  // of an object
    [[nodiscard]] JsonValue operator[](std::size_t index) const;     // of an array
    [[nodiscard]] std::size_t size() const;                          // of an array; 0 for all else
    [[nodiscard]] std::vector<std::string> keys() const;             // of an object, in the order of their bytes
    [[nodiscard]] std::optional<std::string> text() const;
    [[nodiscard]] std::optional<double> number() const;
    [[nodiscard]] std::optional<bool> boolean() const;
    // A whole number from 0 to 2^53.
    [[nodiscard]] std::optional<std::int64_t> count() const;

private:
    const void* value_ = nullptr;
};

class JsonDocument {
public:
    // Errors: bad_data (not JSON, nested too deeply), unsupported (too long), out_of_memory.
    static Result<JsonDocument> parse(std::string_view text);

    [[nodiscard]] JsonValue root() const { return JsonValue(document_.get()); }

private:
    JsonDocument() = default;
    std::shared_ptr<const void> document_;
};

}  // namespace tex::inline v1
