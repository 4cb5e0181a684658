// SPDX-License-Identifier: Apache-2.0
// outcome.h: whether a step of a repair did what it was for.

#pragma once

#include <string_view>

#include <tex/check.h>
#include <tex/repair.h>
#include <tex/types.h>

namespace tex::inline v1 {

// The first finding of a rule, or null.
[[nodiscard]] const Finding* find_finding(const CheckReport& report, std::string_view id);

// Whether the finding is gone, and not merely left out because another one explains it. What a picture seems to be
// changes with every step. `figure` is what the finding measured.
[[nodiscard]] bool is_gone(const CheckReport& report, const RepairStep& step, double figure);

// Whether a step of this kind undoes what happened to normals. Vectors can be made unit, and turned, in any picture.
[[nodiscard]] bool proves(RepairKind kind);

// Whether a step takes a curve back. A second one would undo the first, or explain what the first got wrong.
[[nodiscard]] bool takes_curve_back(RepairKind kind);

// The angle between the normals of both base levels; 0 if one has none.
[[nodiscard]] Result<double> mean_change(const Texture& before, const Texture& after, const Execution& execution);

}  // namespace tex::inline v1
