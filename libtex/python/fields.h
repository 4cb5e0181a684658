// SPDX-License-Identifier: Apache-2.0
// fields.h: the fields of the option structures become keyword arguments, whose defaults are the structures' own. A
// structure inside another one becomes a dict. The library has the tables of its structures (libtex/src/fields); here
// are those that Python alone has, or whose fields it calls by other names.

#pragma once

#include <tex/tex.h>

#include "arguments.h"
#include "fields/bake_fields.h"
#include "fields/blend_fields.h"
#include "fields/file_fields.h"
#include "fields/height_fields.h"
#include "fields/mesh_fields.h"
#include "fields/mip_fields.h"
#include "fields/pack_fields.h"
#include "fields/preview_fields.h"
#include "fields/surface_fields.h"

namespace tex::python {

// The bumpiness and wrap of a HeightField.
struct Relief {
    std::optional<float> bumpiness_x, bumpiness_y;
    std::optional<Wrap> wrap_x, wrap_y;
};

template <class F>
void each_field(Relief& o, F& f) {
    f("bumpiness", axes(o.bumpiness_x, o.bumpiness_y));
    f("wrap", axes(o.wrap_x, o.wrap_y));
}

template <class F>
void each_rdo_field(RdoOptions& o, F& f) {
    f("rdo_mean", o.mean, kDegrees);
    f("rdo_max", o.max, kDegrees);
    f("rdo_window", o.window, Range{kLeastRdoWindow, kMostRdoWindow});
}

template <class F>
void each_field(PackOptions& o, F& f) {
    f("encoding", o.encoding);
    f("y_axis", o.y_axis);
    f("effort", o.effort);
    f("metric", o.metric);
    f("y_known", o.y_known);
    each_rdo_field(o.rdo, f);
}

template <class F>
void each_field(SourceOptions& o, F& f) {
    f("read", o.read);
    f("unpack", o.unpack);
    f("bc5_swizzle", o.bc5_swizzle);
    f("r_or_a", o.r_or_a);
    f("doubt_y", o.doubt_y);
    f("inspect", o.inspect);
    f("drop_others", o.drop_others);
    f("fill_background", o.fill_background);
    f("measure_y", o.measure_y);
    f("file_y_first", o.file_y_first);
    f("y_otherwise", o.y_otherwise);
}

// How a file is packed: what is not given follows from the file.
struct PackFields {
    std::optional<Encoding> encoding;
    std::optional<YAxis> y_axis;
    Effort effort = PackOptions().effort;
    Metric metric = PackOptions().metric;
    RdoOptions rdo;
};

template <class F>
void each_field(PackFields& o, F& f) {
    f("encoding", o.encoding);
    f("y_axis", o.y_axis);
    f("effort", o.effort);
    f("metric", o.metric);
    each_rdo_field(o.rdo, f);
}

// The fields of SourceInfo.
py::dict describe(const SourceInfo& info);

}  // namespace tex::python
