// SPDX-License-Identifier: Apache-2.0
// repair_fixes.h: the fixes that are commands of repair-normals and convert-normals. fixes.h joins all.

#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "reports/fixes.h"

namespace tex::cli {

[[nodiscard]] bool is_any_of(std::string_view id, std::initializer_list<std::string_view> ids);

// Replaces every occurrence of a word in the pattern of a command.
void replace_word(std::string& text, std::string_view word, std::string_view by);

// The extension of a model that can be written again with another map; empty if it cannot.
[[nodiscard]] std::string type_of_model(const CheckReport& report);

// What repair-normals undoes and no other command does; none for other findings.
[[nodiscard]] std::optional<Fix> repair_fix(const Finding& finding, const CheckReport& report,
                                            const Requirements& require);

// The command that gives the parts of a model the tangents of MikkTSpace; none for other findings.
[[nodiscard]] std::optional<Fix> tangent_fix(const Finding& finding, const CheckReport& report);

}  // namespace tex::cli
