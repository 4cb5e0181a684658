// SPDX-License-Identifier: Apache-2.0
// placed_map.h: a whole map, with the levels that its place on a result requires.

#pragma once

#include <tex/types.h>

#include "rows/blend_rows.h"

namespace tex::inline v1 {

// The number of levels to build, 1 if the chain has its own or needs none.
[[nodiscard]] int levels_needed(const MipChain& chain, const UvMap& map);

// A chain that has the levels which it needs, or more of them. It must outlive the returned map.
[[nodiscard]] PlacedMap placed_on(const MipChain& chain, const UvMap& map, Wrap wrap_x, Wrap wrap_y);

// Makes the levels that are needed if the chain has only its base level. The chain must outlive the returned map. May
// throw std::bad_alloc. Errors: out_of_memory.
Result<PlacedMap> place_chain(MipChain& chain, const UvMap& map, Wrap wrap_x, Wrap wrap_y, const Execution& execution);

}  // namespace tex::inline v1
