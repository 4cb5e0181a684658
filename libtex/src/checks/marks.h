// SPDX-License-Identifier: Apache-2.0
// marks.h: which texels spoke for findings, and which their rules left out.

#pragma once

#include <vector>

#include <tex/check.h>

#include "checks/findings.h"

namespace tex::inline v1 {

// Gives the findings their Marks, with at most CheckOptions::marks squares on a side. Each row of marks.cpp says of a
// rule which texels speak for it; the other rules speak of regions, or of the map as a whole.
void mark_texels(const CheckContext& context, std::vector<Finding>& findings);

}  // namespace tex::inline v1
