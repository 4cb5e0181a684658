// SPDX-License-Identifier: Apache-2.0
// surface_fields.h: the fields of surface.h.

#pragma once

#include <tex/surface.h>

#include "fields/bake_fields.h"
#include "fields/field.h"

namespace tex::inline v1 {

template <Of<IntegrateOptions> O, class F>
void each_field(O& o, F& f) {
    each_field(o.bake, f);
    f("bumpiness", axes(o.bumpiness_x, o.bumpiness_y), Range{.least = 1e-20, .greatest = 1e20, .of_magnitude = true});
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
    f("least_z", o.least_z, Range{0.0, 1.0, false});
    f("least_response", o.least_response, Range{.least = 1e-6, .greatest = 1.0, .or_zero = true});
    f("most_steps", o.most_steps, kAtLeastOne);
}

template <Of<CurvatureOptions> O, class F>
void each_field(O& o, F& f) {
    f("kind", o.kind, kCurvatureKindNames);
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
}

template <Of<OcclusionOptions> O, class F>
void each_field(O& o, F& f) {
    f("directions", o.directions, Range{4.0, 1024.0});
    f("distance", o.distance, kNotNegative);
    f("occlusion", o.occlusion);
    f("sky_view", o.sky_view);
    f("bent", o.bent);
    f("horizons", o.horizons, Range{.least = 4.0, .greatest = 64.0, .or_zero = true});
}

}  // namespace tex::inline v1
