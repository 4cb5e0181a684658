// SPDX-License-Identifier: Apache-2.0
// html.h: escapes text and bytes for HTML.

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "cli/json.h"

namespace tex::cli {

// Text for an element or a quoted attribute. & < > " ' become character references, control characters are written as
// \xNN, and bytes that are not UTF-8 become U+FFFD. Nothing in the result can begin a tag or end an attribute.
[[nodiscard]] std::string html_text(std::string_view text);

// JSON for a script element, without any "<" that could end the element.
[[nodiscard]] std::string script_json(const Json& json);

// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

// The number of characters of so many bytes.
[[nodiscard]] constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

}  // namespace tex::cli
