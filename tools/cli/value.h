// SPDX-License-Identifier: Apache-2.0
// value.h: strict parsing of numbers from the command line. The whole text must be a number in C's notation (whatever
// the locale), finite and in range. Anything else throws a UsageError that quotes the text.

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/range.h"

namespace tex::cli {

[[nodiscard]] float parse_float(std::string_view text, Range range = {});
[[nodiscard]] double parse_double(std::string_view text, Range range = {});
[[nodiscard]] int parse_int(std::string_view text, int least, int greatest);
[[nodiscard]] int parse_int(std::string_view text, const Range& range);

// "N" or "WxH", from 1 to `most`: a width and a height in texels.
[[nodiscard]] std::pair<int, int> parse_pair_of_sides(std::string_view text, int most);

// A count of bytes or texels, at least 1, with an optional suffix K, M, G or T (powers of 1024, either case).
[[nodiscard]] std::int64_t parse_count(std::string_view text);
[[nodiscard]] std::string count_text(std::int64_t count);  // "4G": the shortest form

// What one of these functions accepts.
struct AskedNumber {
    enum class Kind { number, integer, count };
    Kind kind = Kind::number;
    Range range;
};

// Calls take(), and returns what the first number that it parses must be; nullopt if it parses none, or throws
// UsageError before. Nothing is parsed: take() ends there. So --help --json states the ranges that the parsers of
// options use.
[[nodiscard]] std::optional<AskedNumber> asked_number(const std::function<void()>& take);

// `text` cut at the first `separator`; the second part is empty if there is none.
[[nodiscard]] std::pair<std::string, std::string> cut(std::string_view text, char separator);
// `text` cut at every `separator`: at least one part.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

}  // namespace tex::cli
