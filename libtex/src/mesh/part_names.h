// SPDX-License-Identifier: Apache-2.0
// part_names.h: what names of parts of low and high meshes have in common: match_names() of tex/mesh.h.

#pragma once

#include <string>
#include <vector>

namespace tex::inline v1 {

enum class PartSide { low, high };

// The name in lower case, without the last mark of its side and what follows it.
[[nodiscard]] std::string stem_of_part(const std::string& name, PartSide side);

// The names, each once, whose numbers are none of `others`. `own` are their numbers.
std::vector<std::string> lone_names(const std::vector<std::string>& names, const std::vector<int>& own,
                                    const std::vector<int>& others);

}  // namespace tex::inline v1
