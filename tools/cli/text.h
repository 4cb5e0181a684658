// SPDX-License-Identifier: Apache-2.0
// text.h: words for people: nearest names, lists, line breaks, and text that is safe to print.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tex::cli {

// The candidate that `word` was probably meant to be: the one at the smallest edit distance (insertion,
// deletion, substitution, transposition of neighbours), if that is at most a third of the longer word's
// length; else one that begins with `word`; else empty.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

// "; did you mean X?" for the nearest candidate, or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

// "a, b, c".
[[nodiscard]] std::string join(const std::vector<std::string>& words, std::string_view between = ", ");

// `text` with control characters (also U+0080 to U+009F), invisible format characters (U+202E, which turns the
// direction of what follows, and its kin) and bytes that are not UTF-8 written as \xNN, so that a file name can neither
// break a line, drive the terminal nor look like another one.
[[nodiscard]] std::string printable(std::string_view text);

// `text` broken at blanks into lines of at most `width` characters; longer words stand alone.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t width);

}  // namespace tex::cli
