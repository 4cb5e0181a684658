// SPDX-License-Identifier: Apache-2.0
// part_names.h: what names of parts of low and high meshes have in common: match_names() of tex/mesh.h.

#pragma once

#include <map>
#include <string>
#include <vector>

namespace tex::inline v1 {

enum class PartSide { low, high };

// The numbers that the stems of the names have in `numbers`, or get. A stem is the name in lower case, without the last
// mark of its side and what follows it.
std::vector<int> numbered_names(const std::vector<std::string>& names, PartSide side,
                                std::map<std::string, int>& numbers);

// The names, each once, whose numbers are none of `others`. `own` are their numbers.
std::vector<std::string> lone_names(const std::vector<std::string>& names, const std::vector<int>& own,
                                    const std::vector<int>& others);

}  // namespace tex::inline v1
