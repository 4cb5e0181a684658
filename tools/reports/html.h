// SPDX-License-Identifier: Apache-2.0
// html.h: text and bytes as HTML takes them.

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "reports/json.h"

namespace tex::cli {

// Text for an element or a quoted attribute: & < > " ' are references, control characters are written as \xNN, and what
// is not UTF-8 becomes U+FFFD. Nothing in it can begin a tag or end an attribute.
[[nodiscard]] std::string html_text(std::string_view text);

// JSON for a script element: no "<" in it could end the element.
[[nodiscard]] std::string script_json(const Json& json);

// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace tex::cli
