// SPDX-License-Identifier: Apache-2.0
// Checks the field and fills its holes for the normals; surface/horizons.cpp looks round.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <tex/surface.h>

#include "fields/field_check.h"
#include "fields/surface_fields.h"
#include "kernels/horizon.h"
#include "rows/bake_rows.h"
#include "rows/ground.h"
#include "rows/usable.h"
#include "surface/horizons.h"
#include "surface/nearest.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// Strengths of which a surface can be made: texels have a width and a height.
Result<void> check_strength(const HeightField& field) {
    if (!std::isfinite(field.bumpiness_x) || !std::isfinite(field.bumpiness_y))
        return bad_option("bumpiness: must be finite");
    const auto sign = [](float x) { return (x > 0.0f) - (x < 0.0f); };
    if (sign(field.bumpiness_x) != sign(field.bumpiness_y))
        return bad_option("bumpiness: must be above 0 along both axes, below 0 or 0: a surface has one height");
    return field.ground ? check_ground(*field.ground) : Result<void>();
}

Result<std::int64_t> count_holes(const Plane<float>& heights, const Execution& execution) {
    const Extent extent = heights.extent();
    std::atomic<std::int64_t> holes = 0;
    std::atomic<bool> are_finite = true;
    const auto body = [&](int begin, int end) {
        Plane<float> scaled({extent.width, 1});
        for (int j = begin; j < end; ++j) {
            const ScaledHeights met = scale_heights(heights.row(j), 1.0f, extent.width, scaled.row(0));
            holes += met.holes;
            if (!met.are_finite) are_finite = false;
        }
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, extent.height, rows_per_piece(extent), body); !done) return done.error();
    if (!are_finite) return Error{ErrorCode::bad_data, {}, "some heights are infinite"};
    if (holes == extent.texels()) return Error{ErrorCode::bad_data, {}, "all heights are NaN"};
    return holes.load();
}

}  // namespace

Result<void> validate(const OcclusionOptions& options) { return check_fields(options); }

Result<OcclusionMaps> occlusion(const HeightField& field, const OcclusionOptions& options, const BakeOptions& bake,
                                const Execution& execution) {
    return no_throw(execution, [&]() -> Result<OcclusionMaps> {
        const Extent extent = field.height.extent();
        const auto usable = first_error(check_usable(extent, "the height field"), validate(options), validate(bake),
                                        check_known("wrap_x", kWrapNames, field.wrap_x),
                                        check_known("wrap_y", kWrapNames, field.wrap_y), check_strength(field));
        if (!usable) return usable.error();
        const Result<std::int64_t> holes = count_holes(field.height, execution);
        if (!holes) return holes.error();
        const double filled = *holes > 0 ? 0.05 : 0.0;
        Plane<float> solid;
        if (*holes > 0) {
            solid = field.height.clone();
            auto done = fill_from_nearest(solid.view(), field.wrap_x, field.wrap_y, execution, {0.0, filled});
            if (!done) return done.error();
        }
        const Gradient gradient = gradient_of(bake);
        const HeightFieldHead head{field.bumpiness_x, field.bumpiness_y, field.wrap_x, field.wrap_y, field.ground};
        const HorizonSource source{field.height, *holes > 0 ? solid : field.height, head, gradient,
                                   middle_strength(head, extent)};
        Result<SkyMaps> sky = sky_of(source, options, execution, {filled, 1.0});
        if (!sky) return sky.error();
        OcclusionMaps maps{std::move(sky->occlusion), std::move(sky->sky_view), std::move(sky->bent), {}};
        const auto stacked = std::make_shared<Plane<float>>(std::move(sky->horizons));
        for (int k = 0; k < options.horizons; ++k) {
            maps.horizons.emplace_back(extent, stacked->stride(),
                                       std::shared_ptr<float>(stacked, stacked->row(k * extent.height)));
        }
        return maps;
    });
}

}  // namespace tex::inline v1
