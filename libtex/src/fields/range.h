// SPDX-License-Identifier: Apache-2.0
// range.h: the numbers that an option accepts, and how an error states them.

#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

namespace tex::inline v1 {

// From least to greatest. `least` itself is accepted only if `least_too`.
struct Range {
    double least = -std::numeric_limits<double>::infinity();
    double greatest = std::numeric_limits<double>::infinity();
    bool least_too = true;
    bool of_magnitude = false;  // the range is that of the absolute value; `least` is 0 or more
    bool or_zero = false;       // 0 is accepted, too
    const char* zero = "";      // what 0 means, if it is a word: "for all"
};

inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), false};
inline constexpr Range kNotNegative{0.0};
inline constexpr Range kAtLeastOne{1.0};

// The least interval that holds all accepted values.
[[nodiscard]] constexpr Range interval_of(const Range& range) {
    Range interval{range.least, range.greatest, range.least_too};
    if (range.of_magnitude) interval = {-range.greatest, range.greatest};
    if (range.or_zero && interval.least > 0.0) interval = {0.0, range.greatest};
    return interval;
}

// Whether the range accepts a value: never NaN, and no infinity. A float is compared with the ends as floats.
template <class T>
[[nodiscard]] bool contains(const Range& range, T value) {
    using Compared = std::conditional_t<std::is_same_v<T, float>, float, double>;
    if (!std::isfinite(static_cast<double>(value))) return false;
    if (range.or_zero && value == T{}) return true;
    const auto least = static_cast<Compared>(range.least), greatest = static_cast<Compared>(range.greatest);
    const Compared compared =
        range.of_magnitude ? std::abs(static_cast<Compared>(value)) : static_cast<Compared>(value);
    return (range.least_too ? compared >= least : compared > least) && compared <= greatest;
}

// At most this many digits, without zeros at the end: "0.3333".
inline std::string rounded_text(double value, int digits) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr};
}

// The shortest text, without the padding of exponents: "1e6".
inline std::string number_text(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    std::string text(buffer, end);
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return text;
    std::size_t digits = e + 1;
    if (text[digits] == '+') text.erase(digits, 1);
    if (text[digits] == '-') ++digits;
    while (digits + 1 < text.size() && text[digits] == '0') text.erase(digits, 1);
    return text;
}

// What must be true of a value: "must be above 0 and at most 64".
[[nodiscard]] inline std::string requirement(const Range& range) {
    const bool has_least = std::isfinite(range.least) && !(range.of_magnitude && range.least == 0.0);
    const bool has_greatest = std::isfinite(range.greatest);
    std::string text = "must be ";
    if (has_least && has_greatest) {
        text += range.least_too ? "from " + number_text(range.least) + " to "
                                : "above " + number_text(range.least) + " and at most ";
        text += number_text(range.greatest);
    } else if (has_least) {
        text += range.least_too ? number_text(range.least) + (*range.zero != '\0' ? "" : " or more")
                                : "above " + number_text(range.least);
        if (*range.zero != '\0') text += std::string(", ") + range.zero + ", or more";
    } else if (has_greatest) {
        text += "at most " + number_text(range.greatest);
    } else {
        text += "finite";
    }
    if (range.of_magnitude) text += " in magnitude";
    if (range.or_zero) text += ", or 0";
    return text;
}

}  // namespace tex::inline v1
