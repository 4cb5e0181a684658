// SPDX-License-Identifier: Apache-2.0
// surface/debander.cpp finds the steps and the heights.

#include <tex/height.h>

#include <utility>

#include "rows/usable.h"
#include "surface/debander.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {

Result<DebandedField> deband(HeightField field, Deband when, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<DebandedField> {
        const auto usable = first_error(
            check_usable(field.height.extent(), "the height field"), check_known("when", kDebandNames, when),
            check_known("wrap_x", kWrapNames, field.wrap_x), check_known("wrap_y", kWrapNames, field.wrap_y));
        if (!usable) return usable.error();
        auto report = deband_heights(field.height, field.wrap_x, field.wrap_y, when, execution, {});
        if (!report) return report.error();
        return DebandedField{std::move(field), *report};
    });
}

}  // namespace tex::inline v1
