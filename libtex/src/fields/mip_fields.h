// SPDX-License-Identifier: Apache-2.0
// mip_fields.h: the fields of mip.h.

#pragma once

#include <tex/mip.h>

#include "fields/field.h"

namespace tex::inline v1 {

// The range of sides and counts for which 0 sets no limit.
inline constexpr Range kNoLimit{.least = 0.0, .zero = "for no limit"};

// The fields but for those about data beside the normals.
template <Of<MipOptions> O, class F>
void level_fields(O& o, F& f) {
    f("levels", o.levels, Range{.least = 0.0, .zero = "for all"});
    f("filter", o.filter, kMipFilterNames);
    f("domain", o.domain, kMipDomainNames);
    f("fade", o.fade);
    f("wrap", axes(o.wrap_x, o.wrap_y), kWrapNames);
    f("max_side", o.max_side, kNoLimit);
    f("any_z", o.any_z);
}

template <Of<MipOptions> O, class F>
void each_field(O& o, F& f) {
    level_fields(o, f);
    f("blue", o.blue, kExtraKindNames);
    f("alpha", o.alpha, kExtraKindNames);
    f("roughness", o.roughness, kRoughnessModelNames);
}

}  // namespace tex::inline v1
