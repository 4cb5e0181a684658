// SPDX-License-Identifier: Apache-2.0
// rules.h: the table of rules, see check.h.

#pragma once

#include <tex/check.h>

namespace tex::inline v1 {

// The rule `id`, which is in the table.
const Rule& rule(std::string_view id);

// Whether the list `ids`, separated by blanks, contains `id`.
bool has_id(std::string_view ids, std::string_view id);

}  // namespace tex::inline v1
