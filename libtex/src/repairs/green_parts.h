// SPDX-License-Identifier: Apache-2.0
// green_parts.h: the part of a map in which green points the other way, if a straight line divides it from the rest.

#pragma once

#include <vector>

#include <tex/check.h>

#include "checks/stored.h"

namespace tex::inline v1 {

// The parts that may have been inverted, at most one beside a column and one below or above a row. `few` are the
// regions of the direction that fewer regions have (N402).
[[nodiscard]] std::vector<Region> green_parts(const Stored& stored, const std::vector<Region>& few);

// The other side of the line beside a part.
[[nodiscard]] Region rest_of(const Region& part, Extent extent);

}  // namespace tex::inline v1
