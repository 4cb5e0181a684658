// SPDX-License-Identifier: Apache-2.0
// mesh_fields.h: the fields of mesh.h and transfer.h.

#pragma once

#include <tex/transfer.h>

#include "fields/field.h"

namespace tex::inline v1 {

template <Of<ConvertOptions> O, class F>
void each_field(O& o, F& f) {
    f("padding", o.padding, kNotNegative);
    f("subsamples", o.subsamples, Range{1, kMaxSubsamples});
}

template <Of<TransferOptions> O, class F>
void each_field(O& o, F& f) {
    f("rays", o.rays, kRayModeNames);
    f("front", o.front);
    f("back", o.back);
    f("hit", o.hit, kHitChoiceNames);
    f("backfaces", o.backfaces);
    f("straight_angle", o.straight_angle, Range{0.0, 180.0});
    f("straight_width", o.straight_width);
    f("padding", o.padding, kNotNegative);
    f("subsamples", o.subsamples, Range{1, kMaxSubsamples});
    f("object", o.object);
    f("heights", o.heights);
    f("positions", o.positions);
    f("occlusion", o.occlusion);
    f("bent", o.bent);
    f("thickness", o.thickness);
    f("vertex_colors", o.vertex_colors);
    f("rays_per_hit", o.rays_per_hit, Range{1, kMaxRaysPerHit});
    f("occlusion_distance", o.occlusion_distance);
}

}  // namespace tex::inline v1
