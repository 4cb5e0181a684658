// SPDX-License-Identifier: Apache-2.0

#include "reports/html.h"

#include <cstdint>

#include "cli/text.h"

namespace tex::cli {

std::string html_text(std::string_view text) {
    std::string html;
    for (const char c : printable(text)) {
        switch (c) {
            case '&': html += "&amp;"; break;
            case '<': html += "&lt;"; break;
            case '>': html += "&gt;"; break;
            case '"': html += "&quot;"; break;
            case '\'': html += "&#39;"; break;
            default: html += c; break;
        }
    }
    return html;
}

std::string script_json(const Json& json) {
    std::string script;
    for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
        script += c == '<' ? std::string("\\u003c") : std::string(1, c);
    }
    return script;
}

std::string base64(std::span<const std::byte> bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const auto byte = [&](std::size_t n) {
            return k + n < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k + n]) : 0u;
        };
        const std::uint32_t bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (std::size_t n = 0; n < 4; ++n) {
            text += k + n > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * n) & 63];
        }
    }
    return text;
}

}  // namespace tex::cli
