// SPDX-License-Identifier: Apache-2.0

#include "mesh/part_names.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace tex::inline v1 {
namespace {

using Marks = std::array<std::string_view, 4>;
constexpr Marks kLowMarks = {"low", "lowpoly", "lo", "lp"}, kHighMarks = {"high", "highpoly", "hi", "hp"};
constexpr std::string_view kSeparators = "_-. ";

// Only ASCII: names in other scripts have no case, or must be written alike.
std::string in_lower_case(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

std::string stem_of_part(const std::string& name, PartSide side) {
    const Marks& marks = side == PartSide::low ? kLowMarks : kHighMarks;
    const std::string text = in_lower_case(name);
    std::size_t end = text.size();  // of the word, from the last one to the second
    while (end > 0) {
        const std::size_t separator = text.find_last_of(kSeparators, end - 1);
        if (separator == std::string::npos || separator == 0) break;
        const std::string_view word = std::string_view(text).substr(separator + 1, end - separator - 1);
        if (std::find(marks.begin(), marks.end(), word) != marks.end()) return text.substr(0, separator);
        end = separator;
    }
    return text;
}

}  // namespace

std::vector<int> numbered_names(const std::vector<std::string>& names, PartSide side,
                                std::map<std::string, int>& numbers) {
    std::vector<int> found;
    for (const std::string& name : names)
        found.push_back(numbers.try_emplace(stem_of_part(name, side), static_cast<int>(numbers.size())).first->second);
    return found;
}

std::vector<std::string> lone_names(const std::vector<std::string>& names, const std::vector<int>& own,
                                    const std::vector<int>& others) {
    std::vector<std::string> left;
    for (std::size_t k = 0; k < names.size(); ++k) {
        const bool has_partner = std::find(others.begin(), others.end(), own[k]) != others.end();
        if (!has_partner && std::find(left.begin(), left.end(), names[k]) == left.end()) left.push_back(names[k]);
    }
    return left;
}

}  // namespace tex::inline v1
