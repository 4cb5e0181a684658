// SPDX-License-Identifier: Apache-2.0

#include "mesh/json_text.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <nlohmann/json.hpp>

namespace tex::inline v1 {

// A member or an element, with the white space around it.
struct JsonNode::Item {
    Item(std::string_view space, std::string its_key, std::string_view value)
        : before(space), key(std::move(its_key)), node(value) {}
    Item(std::string_view space, std::string its_key, std::string value)
        : before(space), key(std::move(its_key)), node(std::move(value)) {}

    std::string before;
    std::string key;  // from its quotation mark to the value; empty in an array
    JsonNode node;
    std::string after;
};

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::size_t skip_blanks(std::string_view text, std::size_t at) {
    return std::min(text.find_first_not_of(kBlanks, at), text.size());
}

// The end of the string that begins at `at`.
std::size_t end_of_string(std::string_view text, std::size_t at) {
    for (++at; at < text.size() && text[at] != '"'; ++at) {
        if (text[at] == '\\') ++at;
    }
    return std::min(at + 1, text.size());
}

// The end of the value that begins at `at`.
std::size_t end_of_value(std::string_view text, std::size_t at) {
    if (at < text.size() && text[at] == '"') return end_of_string(text, at);
    int depth = 0;
    while (at < text.size()) {
        const char c = text[at];
        const bool closes = c == ']' || c == '}';
        if (depth == 0 && (closes || c == ',' || kBlanks.find(c) != std::string_view::npos)) return at;
        if (c == '"') {
            at = end_of_string(text, at);
            continue;
        }
        ++at;
        if (c == '[' || c == '{') ++depth;
        if (closes && --depth == 0) return at;
    }
    return at;
}

// Whether the text of a key, which begins with its quotation mark, is `key`.
bool is_key(std::string_view text, std::string_view key) {
    const std::string_view quoted = text.substr(0, end_of_string(text, 0));
    if (quoted.find('\\') == std::string_view::npos) return quoted.substr(1, quoted.size() - 2) == key;
    const auto parsed = nlohmann::json::parse(quoted, nullptr, false);
    return parsed.is_string() && parsed.get_ref<const std::string&>() == key;
}

}  // namespace

JsonNode::JsonNode(std::string_view text) : text_(text) {}
JsonNode::JsonNode(std::string text) : own_(std::move(text)), text_(own_) {}
JsonNode::~JsonNode() = default;

void JsonNode::open() {
    if (is_open_) return;
    is_open_ = true;
    if (text_.empty() || (text_.front() != '{' && text_.front() != '[')) return;
    const bool is_object = text_.front() == '{';
    for (std::size_t at = 1; at < text_.size();) {
        const std::size_t first = skip_blanks(text_, at);
        const std::string_view space = text_.substr(at, first - at);
        if (first >= text_.size() || text_[first] == ']' || text_[first] == '}') {
            blank_ = space;
            return;
        }
        std::size_t value = first;
        if (is_object) value = skip_blanks(text_, skip_blanks(text_, end_of_string(text_, first)) + 1);
        const std::size_t end = end_of_value(text_, value);
        const std::size_t next = skip_blanks(text_, end);
        items_.push_back(std::make_unique<Item>(space, std::string(text_.substr(first, value - first)),
                                                text_.substr(value, end - value)));
        items_.back()->after = text_.substr(end, next - end);
        if (next >= text_.size() || text_[next] != ',') return;
        at = next + 1;
    }
}

JsonNode::Item* JsonNode::find(std::string_view key) {
    open();
    for (std::size_t k = items_.size(); k-- > 0;) {
        if (!items_[k]->key.empty() && is_key(items_[k]->key, key)) return items_[k].get();
    }
    return nullptr;
}

JsonNode* JsonNode::member(std::string_view key) {
    Item* const item = find(key);
    return item == nullptr ? nullptr : &item->node;
}

JsonNode* JsonNode::element(std::size_t index) {
    open();
    return index < items_.size() ? &items_[index]->node : nullptr;
}

std::size_t JsonNode::size() {
    open();
    return items_.size();
}

void JsonNode::replace(std::string text) {
    items_.clear();
    is_open_ = false;
    own_ = std::move(text);
    text_ = own_;
}

void JsonNode::add(std::string key, std::string text) {
    open();
    std::string_view space;
    std::string after;
    if (!items_.empty()) {
        space = items_.back()->before;
        std::swap(after, items_.back()->after);
        if (!key.empty()) {  // as much white space around the colon
            const std::string& last = items_.back()->key;
            key += last.substr(end_of_string(last, 0));
        }
    } else if (!key.empty()) {
        key += ':';
    }
    items_.push_back(std::make_unique<Item>(space, std::move(key), std::move(text)));
    items_.back()->after = std::move(after);
}

void JsonNode::set(std::string_view key, std::string text) {
    Item* const item = find(key);
    item == nullptr ? add(json_string(key), std::move(text)) : item->node.replace(std::move(text));
}

void JsonNode::append(std::string text) { add({}, std::move(text)); }

void JsonNode::erase(std::size_t index) {
    const bool is_last = index + 1 == items_.size();
    if (is_last && index > 0) items_[index - 1]->after = items_[index]->after;
    items_.erase(items_.begin() + static_cast<std::ptrdiff_t>(index));
}

void JsonNode::remove(std::string_view key) {
    open();
    for (std::size_t k = items_.size(); k-- > 0;) {
        if (!items_[k]->key.empty() && is_key(items_[k]->key, key)) erase(k);
    }
}

void JsonNode::remove_element(std::size_t index) {
    open();
    if (index < items_.size()) erase(index);
}

void JsonNode::write(std::string& out) const {
    const bool has_parts = is_open_ && !text_.empty() && (text_.front() == '{' || text_.front() == '[');
    if (!has_parts) {
        out += text_;
        return;
    }
    out += text_.front();
    if (items_.empty()) out += blank_;
    for (std::size_t k = 0; k < items_.size(); ++k) {
        const Item& item = *items_[k];
        if (k > 0) out += ',';
        out += item.before;
        out += item.key;
        item.node.write(out);
        out += item.after;
    }
    out += text_.front() == '{' ? '}' : ']';
}

JsonText::JsonText(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    const std::size_t first = skip_blanks(text, text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    const std::size_t end = end_of_value(text, first);
    before_ = text.substr(0, first);
    root_ = std::make_unique<JsonNode>(text.substr(first, end - first));
    after_ = text.substr(end);
}

std::string JsonText::text() const {
    std::string out(before_);
    root_->write(out);
    return out += after_;
}

std::string json_number(double value) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string json_string(std::string_view text) {
    return nlohmann::json(std::string(text)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace tex::inline v1
