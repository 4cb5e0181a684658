// SPDX-License-Identifier: Apache-2.0
// Handles memory and threads: strips of rows run in parallel. rows/bake_rows.cpp bakes a strip from top to bottom.

#include <tex/bake.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "fields/bake_fields.h"
#include "fields/field_check.h"
#include "kernels/bake.h"
#include "rows/bake_rows.h"
#include "rows/ground.h"
#include "rows/usable.h"
#include "stream/slope_collector.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

Result<void> validate(const BakeOptions& options) {
    BakeOptions read = options;
    if (read.kernel != GradientKernel::gaussian) read.gaussian_sigma = BakeOptions().gaussian_sigma;  // not read
    return check_fields(read);
}

Result<NormalMap> bake(const HeightField& field, const BakeOptions& options, const Execution& execution) {
    const Extent extent = field.height.extent();
    return no_throw(execution, [&]() -> Result<NormalMap> {
        if (auto usable = check_usable(extent, "the height field"); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        const auto wraps = first_error(check_known("wrap_x", kWrapNames, field.wrap_x),
                                       check_known("wrap_y", kWrapNames, field.wrap_y));
        if (!wraps) return wraps.error();
        if (!std::isfinite(field.bumpiness_x) || !std::isfinite(field.bumpiness_y))
            return bad_option("bumpiness: must be finite");
        if (field.ground) {
            if (auto valid = check_ground(*field.ground); !valid) return valid.error();
        }
        NormalMap map(extent);
        const Gradient gradient = gradient_of(options);
        std::atomic<bool> finite = true;
        const auto heights = [&](int j) {
            const float* const row = field.height.row(j);
            if (!are_finite(row, extent.width)) finite = false;  // the bake reads the row next
            return row;
        };
        const HeightFieldHead head{field.bumpiness_x, field.bumpiness_y, field.wrap_x, field.wrap_y, field.ground};
        const auto body = [&](int begin, int end) {
            BakeRows rows(extent, heights, gradient, head, begin);
            for (int j = begin; j < end; ++j) rows.bake(j, {map.x.row(j), map.y.row(j), map.z.row(j)});
        };
        const auto done = parallel_for(execution, extent.height, strip_rows(extent.width, 2 * gradient.radius), body);
        if (!done) return done.error();
        if (!finite)
            return Error{ErrorCode::bad_data,
                         {},
                         "some heights are NaN or infinite; height_field() with fill_invalid replaces them"};
        return map;
    });
}

SlopeRange slope_range(const NormalMap& map, const Execution& execution) {
    const Extent extent = map.extent();
    if (extent.texels() == 0) return {};
    SlopeCollector slopes(std::numeric_limits<float>::infinity(), true);
    const auto body = [&](int begin, int end) { slopes.add(map, begin, end); };
    const Execution silent = execution.quiet();
    const auto done = parallel_for(silent, extent.height, strip_rows(extent.width, 1), body);
    if (!done) body(0, extent.height);
    return slopes.range();
}

}  // namespace tex::inline v1
