// SPDX-License-Identifier: Apache-2.0
// height_fields.h: the fields of height.h.

#pragma once

#include <tex/height.h>

#include "fields/field.h"

namespace tex::inline v1 {

template <Of<HeightOptions> O, class F>
void each_field(O& o, F& f) {
    f("channel", o.channel, kHeightChannelNames);
    f("channel_name", o.channel_name);
    f("no_data", o.no_data);
    f("fill_invalid", o.fill_invalid);
    f("invert", o.invert);
    f("deband", o.deband, kDebandNames);
    f("blur_sigma", o.blur_sigma, Range{0.0, 256.0});
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
}

template <Of<ColorOptions> O, class F>
void each_field(O& o, F& f) {
    f("space", o.space);
    f("config", o.config);
}

}  // namespace tex::inline v1
