// SPDX-License-Identifier: Apache-2.0
// words.h: names and numbers in text, as the headers of elevation grids and the names of files have them. Nothing here
// depends on the locale.

#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tex::inline v1 {

inline bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// A to Z become a to z; all other bytes stay.
std::string in_lower_case(std::string_view text);

// Whether a path ends with this extension, in any case: ".hgt", in lower case.
bool has_extension(std::string_view path, std::string_view extension);

// A decimal number, with an exponent or not; "nan" and "inf" are numbers. Nothing if the text is not one, or if it is
// beyond the range of a double.
std::optional<double> number_in(std::string_view text);
// A whole number; "12.0" is one, because some programs write counts so.
std::optional<long long> whole_number_in(std::string_view text);

// The nearest float; infinite where there is none.
float float_of(double value);

}  // namespace tex::inline v1
