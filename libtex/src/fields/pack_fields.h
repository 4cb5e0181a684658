// SPDX-License-Identifier: Apache-2.0
// pack_fields.h: the fields of pack.h.

#pragma once

#include <tex/pack.h>

#include "fields/field.h"

namespace tex::inline v1 {

inline constexpr Range kDegrees{0.0, 180.0};

template <Of<RdoOptions> O, class F>
void each_field(O& o, F& f) {
    f("mean", o.mean, kDegrees);
    f("max", o.max, kDegrees);
    f("window", o.window, Range{kLeastRdoWindow, kMostRdoWindow});
}

template <Of<PackOptions> O, class F>
void each_field(O& o, F& f) {
    f("encoding", o.encoding, kEncodingNames);
    f("y_axis", o.y_axis, kYAxisNames);
    f("effort", o.effort, kEffortNames);
    f("metric", o.metric, kMetricNames);
    f("y_known", o.y_known);
    f("rdo", o.rdo);
}

template <Of<UnpackOptions> O, class F>
void each_field(O& o, F& f) {
    f("swizzle", o.swizzle);
    f("y_axis", o.y_axis, kYAxisNames);
    f("range", o.range, kValueRangeNames);
    f("snap_flat", o.snap_flat);
    f("keep_length", o.keep_length);
    f("keep_invalid", o.keep_invalid);
    f("others", o.others);
}

}  // namespace tex::inline v1
