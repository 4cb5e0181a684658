// SPDX-License-Identifier: Apache-2.0
// placed_map.h: a whole map, with the levels that its place on a result needs.

#pragma once

#include <tex/execution.h>
#include <tex/result.h>

#include "rows/blend_rows.h"

namespace tex {

// Makes the levels that are needed if the chain, which must outlive the result, has none but its base level. May throw
// std::bad_alloc. Errors: out_of_memory.
Result<PlacedMap> place_chain(MipChain& chain, const UvMap& map, Wrap wrap_x, Wrap wrap_y, const Execution& execution);

}  // namespace tex
