// SPDX-License-Identifier: Apache-2.0
// blend_fields.h: the fields of blend.h.

#pragma once

#include <tex/blend.h>

#include "fields/field.h"

namespace tex::inline v1 {

inline constexpr Range kScaleRange{.least = 0.0, .greatest = kMaxScale, .of_magnitude = true};

template <Of<Scaling> O, class F>
void each_field(O& o, F& f) {
    f("scale", o.scale, kScaleRange);
    f("mode", o.mode, kScaleModeNames);
}

template <Of<BlendOptions> O, class F>
void each_field(O& o, F& f) {
    f("mode", o.mode, kBlendModeNames);
    f("base_scale", o.base_scale, kScaleRange);
    f("scale_mode", o.scale_mode, kScaleModeNames);
    f("extent", o.extent);
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
}

// Layer and LayerFile have these fields.
template <class O, class F>
void each_placement(O& o, F& f) {
    f("scale", o.scale, kScaleRange);
    f("tiling", axes(o.tiling_x, o.tiling_y), Range{0.0, kMaxTiling, false});
    f("offset", axes(o.offset_x, o.offset_y), Range{.least = 0.0, .greatest = kMaxTiling, .of_magnitude = true});
    f("rotation", o.rotation, Range{});
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
    f("strength", o.strength, Range{0.0, 1.0});
}

template <Of<Layer> O, class F>
void each_field(O& o, F& f) {
    each_placement(o, f);
}

}  // namespace tex::inline v1
