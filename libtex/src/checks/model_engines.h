// SPDX-License-Identifier: Apache-2.0
// model_engines.h: what engines draw of glTF models that others draw otherwise (N808).

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Whether it shows that the mesh has no TANGENT: engines agree on models whose UVs are as the mesh stores them and not
// mirrored. True without a model, whose material and nodes are not known.
[[nodiscard]] bool misses_tangents(const CheckContext& context);

// Asks for each engine of context.options.require whether it draws the map of this model rightly.
void check_engines_with_model(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
