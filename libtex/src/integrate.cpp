// SPDX-License-Identifier: Apache-2.0
// Checks the map, measures what is left over, and sets the constant; surface/integrator.cpp finds the heights.

#include <tex/surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "fields/field_check.h"
#include "fields/surface_fields.h"
#include "kernels/angle.h"
#include "kernels/slopes.h"
#include "kernels/stored.h"
#include "rows/bake_rows.h"
#include "rows/usable.h"
#include "stream/angle_summary.h"
#include "surface/integrator.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

Result<void> check(const Integrator::Count& count, Extent extent) {
    const std::int64_t texels = extent.texels();
    if (!is_unusable(count, extent)) return {};
    if (count.unused != texels) {
        return Error{ErrorCode::bad_data,
                     {},
                     "z is negative in " + std::to_string(count.behind) + " of " + std::to_string(texels) +
                         " texels, as in object-space maps, which hold no slopes"};
    }
    return Error{ErrorCode::bad_data, {}, "no texel has a slope that can be used: z is 0 or not finite everywhere"};
}

// The angles between the map and the bake of the heights.
Result<void> measure_curl(const NormalMap& map, const BakeOptions& bake, Integration& result,
                          const Execution& execution, ProgressSpan span) {
    const Extent extent = map.extent();
    const HeightField& field = result.field;
    const Gradient gradient = gradient_of(bake);
    const HeightFieldHead head{field.bumpiness_x, field.bumpiness_y, field.wrap_x, field.wrap_y};
    const auto heights = [&field](int j) { return field.height.row(j); };
    result.degrees = Plane<float>(extent);
    std::vector<AngleSums> sums(static_cast<std::size_t>(extent.height));
    const auto body = [&](int begin, int end) {
        BakeRows rows(extent, heights, gradient, head, begin);
        NormalMap made(Extent{extent.width, 1});
        const NormalRow row = {made.x.row(0), made.y.row(0), made.z.row(0)};
        for (int j = begin; j < end; ++j) {
            rows.bake(j, row);
            float* const degrees = result.degrees.row(j);
            angle_row({map.x.row(j), map.y.row(j), map.z.row(j)}, row, extent.width, degrees);
            zero_without_normal({map.x.row(j), map.y.row(j), map.z.row(j)}, extent.width, degrees);
            sums[static_cast<std::size_t>(j)] = sum_angles(degrees, extent.width);
        }
    };
    const int strip = strip_rows(extent.width, 2 * gradient.radius);
    if (auto done = parallel_for(execution, extent.height, strip, body, span); !done) return done;
    auto error = summarise_angles(result.degrees, sums, 0, execution);
    if (!error) return error.error();
    result.curl = *error;
    return {};
}

}  // namespace

Result<void> validate(const IntegrateOptions& options) {
    if (auto valid = validate(options.bake); !valid) return valid;
    return check_fields(options);
}

Result<Integration> integrate(const NormalMap& map, const IntegrateOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Integration> {
        if (auto usable = check_usable(map); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        Integration result;
        result.field.bumpiness_x = options.bumpiness_x;
        result.field.bumpiness_y = options.bumpiness_y;
        result.field.wrap_x = options.wrap_x;
        result.field.wrap_y = options.wrap_y;
        result.steps = 0;
        const Integrator integrator(map, options);
        const auto count = integrator.count(execution);
        if (!count) return count.error();
        if (auto fits = check(*count, map.extent()); !fits) return fits.error();
        result.unused_texels = count->unused;
        auto heights = integrator.heights(count->unused, execution, {0.0, 0.8}, result.steps);
        if (!heights) return heights.error();
        result.field.height = std::move(*heights);
        const float larger = std::max(std::abs(options.bumpiness_x), std::abs(options.bumpiness_y));
        const auto highest = settle_heights(result.field.height, larger, execution);
        if (!highest) return highest.error();
        result.highest = *highest;
        if (auto done = measure_curl(map, options.bake, result, execution, {0.8, 1.0}); !done) return done.error();
        return result;
    });
}

void stretch_heights(Plane<float>& heights, float low, float high, const Execution& execution) {
    if (heights.empty()) return;
    const Extent extent = heights.extent();
    const float factor = high > low ? 1.0f / (high - low) : 0.0f;
    const auto body = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) shift_and_scale(low, factor, extent.width, heights.row(j));
    };
    const Execution silent = execution.quiet();
    if (!parallel_for(silent, extent.height, strip_rows(extent.width, 0), body)) body(0, extent.height);
}

}  // namespace tex::inline v1
