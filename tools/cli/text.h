// SPDX-License-Identifier: Apache-2.0
// text.h: text for users: nearest names, lists, line breaks, and text that is safe to print.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tex::cli {

// The candidate that `word` was probably meant to be. This is the candidate at the smallest edit distance (insertion,
// deletion, substitution, transposition of neighbours), if that distance is at most a third of the longer word's
// length, where pieces that both words begin or end with ("--mip-") do not count; else a candidate that begins with
// `word`; else empty.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

// "; did you mean X?" for the nearest candidate, or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

// A to Z become a to z; all else stays.
[[nodiscard]] std::string lower_case(std::string text);

// "a, b, c".
[[nodiscard]] std::string join(const std::vector<std::string>& words, std::string_view between = ", ");

// The entries of a list: its lines, without the empty ones, or, if the list contains a NUL, what is before each NUL.
[[nodiscard]] std::vector<std::string> list_of(std::string_view text);

// Returns `text` with control characters (including U+0080 to U+009F), invisible format characters (such as U+202E,
// which reverses the direction of the text after it) and bytes that are not UTF-8 written as \xNN. So a file name
// cannot break a line, control the terminal or look like another name.
[[nodiscard]] std::string printable(std::string_view text);

// `word` as one word of a command line, quoted if a shell needs that. Bytes that printable() escapes are written in
// $'...', which bash, zsh and ksh understand.
[[nodiscard]] std::string shell_word(const std::string& word);

// The name of a file as one word of a command line. A name that begins with a hyphen is not
// an option, and one that begins with @ no list of arguments.
[[nodiscard]] std::string shell_file(const std::string& name);

// `text` broken at blanks into lines of at most `width` characters. A longer word gets its own line.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t width);

}  // namespace tex::cli
