// SPDX-License-Identifier: Apache-2.0
// blend.h: detail normals blended over base normals.

#pragma once

#include <vector>

#include <tex/blend_options.h>
#include <tex/execution.h>
#include <tex/mip_chain.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// Blends layers over a base, one after the other.
//
// Maps are sampled as on a GPU: bilinearly between texel centres and, if they shrink, trilinearly between mip levels.
// The level is log2 of the number of map texels along one texel of the result (the larger of both directions), in steps
// of 1/256. If a chain has one level, the other levels are made as needed (box filter, averages of vectors); if it has
// more but too few, the last one is used. Sampled vectors are normalised, then scaled, rotated and blended.
//
// The result has the data beside the normals of the base (NormalMap::blue, alpha, length), sampled as its normals are;
// levels that are made hold the means.
//
// The result is one level. Build its mip levels from it; do not blend level by level.
//
// Precondition: masks are finite.
// Errors: bad_option (a chain has no level, or levels of other extents than those of level_extent(); as validate()),
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<NormalMap> blend(MipChain base, std::vector<Layer> layers, const BlendOptions& options = {},
                                      const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
