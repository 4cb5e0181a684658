// SPDX-License-Identifier: Apache-2.0
// compare.h: the angles between two normal maps, in degrees.

#pragma once

#include <tex/angular_error.h>
#include <tex/execution.h>
#include <tex/image.h>
#include <tex/mesh.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

struct Comparison {
    AngularError error;
    Plane<float> degrees;  // the angle of each texel
};

// Compares two maps of unit vectors, texel by texel:
//
//     angle = 2 asin(|a - b| / 2)
//
// This is accurate near 0, unlike acos(dot(a, b)): in float, acos returns no angle between 0 and 0.02 degrees. Here
// equal vectors are exactly 0 degrees apart. The error is below 0.0001 degrees up to 170 degrees, and below 0.03
// degrees beyond.
//
// Errors: bad_option (the maps have no texels, or different extents), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const Execution& execution = {});

// The same of the texels that the triangles of a mesh cover in the set of UVs `uv_set`, as convert.h says which these
// are. What is between the charts of a map is never seen, and two bakers fill it differently. The other texels have an
// angle of 0 in Comparison::degrees and do not count in Comparison::error.
//
// Errors: also bad_data (check_part(part) fails), bad_option (there is no such set of UVs; no triangle covers a texel),
// unsupported (UVs, as in convert.h).
[[nodiscard]] Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const MeshPart& part, int uv_set = 0,
                                         const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
