// SPDX-License-Identifier: Apache-2.0
// mip.h: mip chains of normal maps, renormalised.

#pragma once

#include <tex/execution.h>
#include <tex/mip_chain.h>
#include <tex/mip_options.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// Builds the chain. Each level is filtered from the previous level before that one is normalised, so that a level is
// the true average of the base level. The stored vector is
//
//     normalize(lerp(normalize(average), (0, 0, 1), t))
//
// A z below 0 (from filters with negative lobes) becomes 0 first, unless any_z is set, and a vector shorter than 1e-6
// becomes (0, 0, 1). The base level is stored as given: t is 0 there. With
// options.max_side, levels[0] may be a smaller level.
//
// Errors: bad_option (the map has no texels; as validate(options)), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<MipChain> build_mip_chain(NormalMap base, const MipOptions& options = {},
                                               const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
