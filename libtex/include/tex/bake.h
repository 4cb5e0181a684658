// SPDX-License-Identifier: Apache-2.0
// bake.h: heights to normals.

#pragma once

#include <tex/bake_options.h>
#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// Tangent-space normals of a height field:
//
//     du = dh/dx in heights per texel, to the right        n = normalize(-bumpiness_x du, -bumpiness_y dv, 1)
//     dv = dh/dy in heights per texel, upwards
//
// (Blinn 1978; Catlike Coding, Rendering 6, 1.3.) Computed in float: slopes are exact to rounding, and lengths to 2
// units in the last place. Slopes are clamped to +-1e15, so that every finite height gives a finite unit normal with
// z > 0. Only if bumpiness is above 2^40 (or HeightOptions::blur_sigma above 0) are heights beyond +-1e34 limited to
// that first.
//
// Errors: bad_option  the field has no texels, or more than kMaxExtent in a direction; bumpiness is not finite; as
//                     validate(options)
//         bad_data    a height is NaN or infinite (height_field() replaces or refuses them)
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<NormalMap> bake(const HeightField& field, const BakeOptions& options = {},
                                     const Execution& execution = {});

// The range of slopes in a normal map: rise per texel width to the right (x) and upwards (y), -n.x / n.z and
// -n.y / n.z with z at least 1e-16 (maps that bake() did not make may have z = 0 or below). For reports: beyond +-10,
// 8 bits hold slopes badly.
struct SlopeRange {
    float min_x = 0.0f, max_x = 0.0f;
    float min_y = 0.0f, max_y = 0.0f;
};
[[nodiscard]] SlopeRange slope_range(const NormalMap& map, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
