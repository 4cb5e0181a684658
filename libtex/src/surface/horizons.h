// SPDX-License-Identifier: Apache-2.0
// horizons.h: what the horizons of a field of heights leave open, in all directions: sweeps over the field in its two
// orientations, one after the other, so that only one of them is in memory.

#pragma once

#include <tex/surface.h>

#include "rows/bake_rows.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

// A field of heights, as occlusion() takes it.
struct HorizonSource {
    const Plane<float>& heights;  // NaN: a hole
    const Plane<float>& solid;    // the same without holes, for normals
    const HeightFieldHead& head;
    const Gradient& gradient;
    Strength strength;  // of horizons; both numbers are 0, or above 0, or below
};

// What OcclusionMaps holds; the planes of horizons lie one below the other.
struct SkyMaps {
    Plane<float> occlusion, sky_view;
    NormalMap bent;
    Plane<float> horizons;
};

// Errors: cancelled, out_of_memory. May throw std::bad_alloc. With execution.threads == 1, all memory is that of planes
// and WorkingVectors.
Result<SkyMaps> sky_of(const HorizonSource& source, const OcclusionOptions& options, const Execution& execution,
                       ProgressSpan span);

}  // namespace tex::inline v1
