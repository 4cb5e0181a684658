// SPDX-License-Identifier: Apache-2.0
// toml_bounds.h: limits of a TOML file, checked before a parser sees it.
//
// toml++ builds and frees its tree by recursion, with one call for each level. A file of one megabyte with a million
// dotted keys uses up the stack.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <tex/types.h>

namespace tex::cli {

inline constexpr std::size_t kMostTomlBytes = std::size_t{1} << 20;
inline constexpr int kMostTomlLevels = 64;

// The text of a TOML file; "-" is standard input. Reads no more than the limit. Throws UsageError if there is more.
// Errors: io.
[[nodiscard]] Result<std::string> read_toml_file(const std::string& path);

// Throws UsageError, with `path` and the line, if the text is longer than kMostTomlBytes or if a statement nests deeper
// than kMostTomlLevels. Each dot of a key or of a table's name counts as one level, and so does each array and each
// inline table. (So an accepted file gives a tree of at most twice as many levels: those of a table's name and those of
// a key in it.) This function does not check that the text is TOML; the parser does.
void check_toml_bounds(const std::string& path, std::string_view text);

// The text without a byte order mark at its beginning, and with a question mark instead of each byte outside strings
// and comments that is not ASCII: the behaviour of toml++ 3.3 is undefined for such letters there, and no key may have
// one.
[[nodiscard]] std::string ascii_outside_strings(std::string_view text);

}  // namespace tex::cli
