// SPDX-License-Identifier: Apache-2.0
// docs.h: the comments of libtex's headers, which docstrings.py takes from them when the module is built.

#pragma once

#include <string_view>

namespace tex::python {

struct HeaderComment {
    const char* function;
    const char* header;  // "bake.h"
    const char* text;    // without the slashes
};

// The comment of a function, or null.
[[nodiscard]] const HeaderComment* header_comment(std::string_view function);

}  // namespace tex::python
