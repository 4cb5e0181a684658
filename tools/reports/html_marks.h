// SPDX-License-Identifier: Apache-2.0
// html_marks.h: where on a map a finding is, as a picture over the lit map, and in words.

#pragma once

#include <string>

#include <tex/check.h>

namespace tex::cli {

// The longest side of the pictures in a page with `files` files, which keeps the page small; 0: no such pictures.
[[nodiscard]] int marks_side(std::size_t files);

// A figure with the texels that spoke for the finding and those that its rule left out, or the sentence that no texel
// spoke alone; empty if the rule is about no texels. `of` is the map's title. The page puts the map below the picture.
// Errors: out_of_memory.
[[nodiscard]] Result<std::string> marks_html(const Finding& finding, const std::string& of);

// Whether HTML has such a figure.
[[nodiscard]] bool has_marks(const std::string& html);

}  // namespace tex::cli
