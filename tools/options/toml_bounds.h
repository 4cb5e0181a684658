// SPDX-License-Identifier: Apache-2.0
// toml_bounds.h: what a TOML file may be at most, before a parser sees it.
//
// toml++ builds and frees its tree by recursion, one call for each level: a million dotted keys, in a file of a
// megabyte, use up its stack.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tex::cli {

inline constexpr std::size_t kMostTomlBytes = std::size_t{1} << 20;
inline constexpr int kMostTomlLevels = 64;

// Throws UsageError, with `path` and the line, if the text is longer than kMostTomlBytes or if one statement nests
// deeper than kMostTomlLevels: each dot of a key or of a table's name counts, each array and each inline table. (So the
// tree of what passes has at most twice as many levels: those of a table's name and those of a key in it.) Whether the
// text is TOML is left to the parser.
void check_toml_bounds(const std::string& path, std::string_view text);

}  // namespace tex::cli
