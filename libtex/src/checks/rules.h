// SPDX-License-Identifier: Apache-2.0
// rules.h: the table of rules, see check.h.

#pragma once

#include <cassert>
#include <string_view>

#include <tex/check.h>

namespace tex::inline v1 {

// The rule `id`, which is in the table.
inline const Rule& rule(std::string_view id) {
    const Rule* found = find_rule(id);
    assert(found != nullptr);
    return *found;
}

// Whether the list `ids`, separated by blanks, contains `id`.
inline bool has_id(std::string_view ids, std::string_view id) {
    return !id.empty() && ids.find(id) != std::string_view::npos;
}

}  // namespace tex::inline v1
