// SPDX-License-Identifier: Apache-2.0
// surface/debander.cpp finds the steps and the heights.

#include <tex/deband.h>

#include "rows/usable.h"
#include "surface/debander.h"
#include "threads/guard.h"

namespace tex {

Result<DebandReport> deband(HeightField& field, Deband when, const Execution& execution) {
    return guarded([&]() -> Result<DebandReport> {
        if (auto usable = check_usable(field.height.extent(), "the height field"); !usable) return usable.error();
        return deband_heights(field.height, field.wrap_x, field.wrap_y, when, execution, {});
    });
}

}  // namespace tex
