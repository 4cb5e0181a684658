// SPDX-License-Identifier: Apache-2.0

#include "formats/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace tex::inline v1 {

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
    return lower;
}

bool has_extension(std::string_view path, std::string_view extension) {
    return path.size() >= extension.size() && in_lower_case(path.substr(path.size() - extension.size())) == extension;
}

std::optional<double> number_in(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars() knows no plus
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) return std::nullopt;
    return value;
}

std::optional<long long> whole_number_in(std::string_view text) {
    constexpr double kMost = 9007199254740992.0;  // 2^53: above it, a double may not be the number that was written
    const std::optional<double> value = number_in(text);
    if (!value || !(std::abs(*value) < kMost) || *value != std::floor(*value)) return std::nullopt;
    return static_cast<long long>(*value);
}

float float_of(double value) {
    if (std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()) || std::isnan(value))
        return static_cast<float>(value);
    // The largest doubles that still round down to the largest float.
    constexpr double kHalfStep = 0x1.ffffffp127;
    const float most =
        std::abs(value) < kHalfStep ? std::numeric_limits<float>::max() : std::numeric_limits<float>::infinity();
    return value < 0.0 ? -most : most;
}

}  // namespace tex::inline v1
