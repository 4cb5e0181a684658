// SPDX-License-Identifier: Apache-2.0
// surface/debander.cpp finds the steps and the heights.

#include <tex/deband.h>

#include <cassert>

#include "surface/debander.h"
#include "threads/guard.h"

namespace tex {

Result<DebandReport> deband(HeightField& field, Deband when, const Execution& execution) {
    assert(!field.height.empty() && field.height.extent().width <= kMaxExtent);
    assert(field.height.extent().height <= kMaxExtent);
    return guarded([&] { return deband_heights(field.height, field.wrap_x, field.wrap_y, when, execution, {}); });
}

}  // namespace tex
