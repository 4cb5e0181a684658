// SPDX-License-Identifier: Apache-2.0
// json_text.h: a JSON text that changes in some places and keeps its bytes everywhere else: white space, the order of
// keys, the way numbers are written.

#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tex::inline v1 {

// A value in the text. Objects and arrays are taken apart when something in them is asked for.
class JsonNode {
public:
    explicit JsonNode(std::string_view text);  // which must outlive it
    explicit JsonNode(std::string text);
    ~JsonNode();
    JsonNode(const JsonNode&) = delete;
    JsonNode& operator=(const JsonNode&) = delete;

    // Null if there is none. Of equal keys, the last one counts, as for JsonValue.
    [[nodiscard]] JsonNode* member(std::string_view key);
    [[nodiscard]] JsonNode* element(std::size_t index);
    // The number of members or elements.
    [[nodiscard]] std::size_t size();

    // Text must be JSON. What is added is set apart as the member or element before it is.
    void replace(std::string text);
    void set(std::string_view key, std::string text);  // replaces the member, or adds it
    void append(std::string text);                     // to an array
    void remove(std::string_view key);                 // of an object; nothing if it is missing
    void remove_element(std::size_t index);

    void write(std::string& out) const;

private:
    struct Item;
    void open();
    void add(std::string key, std::string text);
    void erase(std::size_t index);
    [[nodiscard]] Item* find(std::string_view key);

    std::string own_;  // a text that replaces that of the file
    std::string_view text_;
    bool is_open_ = false;
    std::vector<std::unique_ptr<Item>> items_;
    std::string_view blank_;  // between the brackets, if there is no item
};

class JsonText {
public:
    // Precondition: JsonDocument::parse(text) succeeds. The text must outlive this.
    explicit JsonText(std::string_view text);

    [[nodiscard]] JsonNode& root() { return *root_; }
    [[nodiscard]] std::string text() const;

private:
    std::string_view before_, after_;  // the root: white space, a byte order mark
    std::unique_ptr<JsonNode> root_;
};

// The text as JSON, in quotation marks.
std::string json_string(std::string_view text);
// The shortest text of a finite number.
std::string json_number(double value);

}  // namespace tex::inline v1
