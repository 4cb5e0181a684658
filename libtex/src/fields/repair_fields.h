// SPDX-License-Identifier: Apache-2.0
// repair_fields.h: the fields of repair.h.

#pragma once

#include <tex/repair.h>

#include "fields/field.h"
#include "fields/mip_fields.h"
#include "fields/pack_fields.h"

namespace tex::inline v1 {

template <Of<RepairOptions> O, class F>
void each_field(O& o, F& f) {
    f("likely", o.likely);
    f("only", o.only);
    f("skip", o.skip);
    f("mirrored", o.mirrored, kMirroredChannelNames);
    f("turned", o.turned, kTurnedPictureNames);
    f("bumpiness", o.bumpiness, Range{.least = 1e-20, .greatest = 1e20, .of_magnitude = true});
    f("effort", o.effort, kEffortNames);
    f("mip", o.mip);
}

}  // namespace tex::inline v1
