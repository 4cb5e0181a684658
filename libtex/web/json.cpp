// SPDX-License-Identifier: Apache-2.0

#include "json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>

namespace tex::web {
namespace {

constexpr int kMaxDepth = 64;

void write_string(std::string_view text, std::string& out) {
    constexpr char kDigits[] = "0123456789abcdef";
    out += '"';
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            out += "\\u00";
            out += kDigits[c >> 4];
            out += kDigits[c & 15];
        } else {
            out += c;
        }
    }
    out += '"';
}

void append_utf8(std::uint32_t code, std::string& out) {
    const auto tail = [&](int shift) { out += static_cast<char>(0x80 | (code >> shift & 0x3f)); };
    if (code < 0x80) {
        out += static_cast<char>(code);
    } else if (code < 0x800) {
        out += static_cast<char>(0xc0 | code >> 6);
        tail(0);
    } else if (code < 0x10000) {
        out += static_cast<char>(0xe0 | code >> 12);
        tail(6);
        tail(0);
    } else {
        out += static_cast<char>(0xf0 | code >> 18);
        tail(12);
        tail(6);
        tail(0);
    }
}

}  // namespace

// Each function reads what begins at the next character, and is false if it is something else.
struct Json::Parser {
    std::string_view left;
    int depth = 0;

    void skip_blanks() { left.remove_prefix(std::min(left.find_first_not_of(" \t\r\n"), left.size())); }
    bool take(std::string_view token) {
        if (!left.starts_with(token)) return false;
        left.remove_prefix(token.size());
        return true;
    }

    bool unit(std::uint32_t& code) {  // the digits after \u
        if (left.size() < 4) return false;
        const auto end = std::from_chars(left.data(), left.data() + 4, code, 16);
        if (end.ptr != left.data() + 4) return false;
        left.remove_prefix(4);
        return true;
    }
    bool escape(std::string& out) {
        constexpr std::string_view kLetters = "\"\\/bfnrt", kMeant = "\"\\/\b\f\n\r\t";
        if (left.empty()) return false;
        const char letter = left.front();
        left.remove_prefix(1);
        if (letter != 'u') {
            const std::size_t at = kLetters.find(letter);
            if (at == std::string_view::npos) return false;
            out += kMeant[at];
            return true;
        }
        constexpr std::uint32_t kReplacement = 0xfffd;
        std::uint32_t code = 0, low = 0;
        if (!unit(code)) return false;
        if (code >= 0xd800 && code < 0xe000) {  // a surrogate, of which only a pair is a character
            const std::string_view after = left;
            const bool pair = code < 0xdc00 && take("\\u") && unit(low) && low >= 0xdc00 && low < 0xe000;
            if (!pair) left = after;
            code = pair ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : kReplacement;
        }
        append_utf8(code, out);
        return true;
    }
    bool string(std::string& out) {
        if (!take("\"")) return false;
        while (!left.empty()) {
            const char c = left.front();
            left.remove_prefix(1);
            if (c == '"') return true;
            if (c != '\\') {
                out += c;
            } else if (!escape(out)) {
                return false;
            }
        }
        return false;
    }

    // The elements of a list or the members of an object.
    bool items(Json& out, std::string_view end) {
        skip_blanks();
        if (take(end)) return true;
        do {
            skip_blanks();
            if (out.is_object()) {
                if (!string(out.keys_.emplace_back())) return false;
                skip_blanks();
                if (!take(":")) return false;
            }
            if (!value(out.elements_.emplace_back())) return false;
            skip_blanks();
        } while (take(","));
        return take(end);
    }
    bool value(Json& out) {
        skip_blanks();
        if (left.starts_with("\"")) {
            out.kind_ = Kind::string;
            return string(out.text_);
        }
        if (left.starts_with("[") || left.starts_with("{")) {
            if (depth == kMaxDepth) return false;
            ++depth;
            const bool list = left.front() == '[';
            left.remove_prefix(1);
            out.kind_ = list ? Kind::list : Kind::object;
            const bool sound = items(out, list ? "]" : "}");
            --depth;
            return sound;
        }
        if (take("null")) return true;
        const bool is_true = take("true");
        if (is_true || take("false")) {
            out = Json(is_true);
            return true;
        }
        const std::string_view digits = left.substr(left.starts_with("-") ? 1 : 0);
        if (digits.empty() || digits.front() < '0' || digits.front() > '9') return false;
        double number = 0.0;
        const auto end = std::from_chars(left.data(), left.data() + left.size(), number);
        if (end.ec != std::errc{}) return false;
        left.remove_prefix(static_cast<std::size_t>(end.ptr - left.data()));
        out = Json(number);
        return true;
    }
};

Json::Json(std::initializer_list<std::pair<const char*, Json>> members) : kind_(Kind::object) {
    for (const auto& [key, value] : members) set(key, value);
}

Json Json::list(std::vector<Json> elements) {
    Json json;
    json.kind_ = Kind::list;
    json.elements_ = std::move(elements);
    return json;
}

std::optional<Json> Json::parse(std::string_view text) {
    Parser parser{text};
    Json json;
    if (!parser.value(json)) return std::nullopt;
    parser.skip_blanks();
    if (!parser.left.empty()) return std::nullopt;
    return json;
}

std::string Json::dump() const {
    std::string out;
    write(out);
    return out;
}

void Json::write(std::string& out) const {
    switch (kind_) {
        case Kind::null: out += "null"; break;
        case Kind::boolean: out += boolean() ? "true" : "false"; break;
        case Kind::number: {
            char digits[32];
            const auto end = std::to_chars(digits, digits + sizeof digits, number_).ptr;
            out += std::isfinite(number_) ? std::string_view(digits, static_cast<std::size_t>(end - digits)) : "null";
            break;
        }
        case Kind::string: write_string(text_, out); break;
        case Kind::list:
        case Kind::object:
            out += is_list() ? '[' : '{';
            for (std::size_t k = 0; k < elements_.size(); ++k) {
                if (k > 0) out += ',';
                if (is_object()) {
                    write_string(keys_[k], out);
                    out += ':';
                }
                elements_[k].write(out);
            }
            out += is_list() ? ']' : '}';
            break;
    }
}

const Json* Json::find(std::string_view key) const {
    const auto found = std::find(keys_.begin(), keys_.end(), key);
    return found == keys_.end() ? nullptr : &elements_[static_cast<std::size_t>(found - keys_.begin())];
}

void Json::set(std::string key, Json value) {
    keys_.push_back(std::move(key));
    elements_.push_back(std::move(value));
}

}  // namespace tex::web
