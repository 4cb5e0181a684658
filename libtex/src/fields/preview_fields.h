// SPDX-License-Identifier: Apache-2.0
// preview_fields.h: the fields of preview.h.

#pragma once

#include <tex/preview.h>

#include "fields/field.h"

namespace tex::inline v1 {

template <Of<Light> O, class F>
void each_field(O& o, F& f) {
    f("kind", o.kind, kLightKindNames);
    f("x", o.x, Range{});
    f("y", o.y, Range{});
    f("z", o.z, Range{});
    f("color", o.color);
}

template <Of<Material> O, class F>
void each_field(O& o, F& f) {
    f("albedo", o.albedo);
    f("specular", o.specular);
    f("shininess", o.shininess, kPositive);
    f("model", o.model, kSpecularModelNames);
}

template <Of<Camera> O, class F>
void each_field(O& o, F& f) {
    f("yaw", o.yaw, Range{});
    f("pitch", o.pitch, Range{-89.0, 89.0});
    f("field_of_view", o.field_of_view, Range{0.0, 120.0});
}

template <Of<Detail> O, class F>
void each_field(O& o, F& f) {
    f("tiling", axes(o.tiling_x, o.tiling_y), Range{});
    f("offset", axes(o.offset_x, o.offset_y), Range{});
    f("scale", o.scale, Range{});
}

template <Of<Parallax> O, class F>
void each_field(O& o, F& f) {
    f("amount", o.amount, Range{});
    f("limit", o.limit, kNotNegative);
    f("steps", o.steps, Range{0, 1024});
}

template <Of<PreviewOptions> O, class F>
void each_field(O& o, F& f) {
    f("show", o.show, kShowNames);
    f("size", o.size);
    f("shape", o.shape, kShapeNames);
    f("tiles", axes(o.tiles_x, o.tiles_y), Range{1, 256});
    f("mirror", o.mirror);
    f("spin", o.spin, Range{});
    f("camera", o.camera);
    f("light", o.light);
    f("ambient", o.ambient);
    f("material", o.material);
    f("bump_scale", o.bump_scale, Range{});
    f("scale_mode", o.scale_mode, kScaleModeNames);
    f("detail", o.detail);
    f("parallax", o.parallax);
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
    f("anisotropy", o.anisotropy, Range{1, 16});
    f("maximum", o.maximum, kNotNegative);
    f("legend", o.legend);
}

}  // namespace tex::inline v1
