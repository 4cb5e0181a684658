// SPDX-License-Identifier: Apache-2.0

#include "stream/occluded_heights.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <tex/surface.h>

#include "rows/blur.h"
#include "rows/extra_rows.h"
#include "surface/nearest.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

bool is_extra(const ExtraInputs& inputs) {
    return extras_with([&](Extra extra) { return inputs[extra] && inputs[extra]->occlusion; }) != ExtraSet();
}

// Blurs the heights as the bake does, which sees holes filled; the holes stay.
Result<void> blur(Plane<float>& heights, const HeightFieldHead& head, double sigma, const Execution& execution) {
    const Extent extent = heights.extent();
    Plane<float> solid = heights.clone();  // the heights may be those that will be baked
    const auto is_hole = [](float height) { return std::isnan(height); };
    bool has_holes = false;
    for (int j = 0; j < extent.height; ++j) {
        const float* const row = heights.row(j);
        has_holes = has_holes || std::any_of(row, row + extent.width, is_hole);
    }
    if (has_holes) {
        auto filled = fill_from_nearest(solid.view(), head.wrap_x, head.wrap_y, execution.quiet(), {});
        if (!filled) return filled;
    }
    const auto weights = gaussian_weights(sigma);
    Plane<float> across(extent);
    blur_across(solid.view(), weights, head.wrap_x, 0, extent.height, across);
    blur_down(across.view(), weights, head.wrap_y, 0, extent.height, solid);
    if (!has_holes) {
        heights = std::move(solid);
        return {};
    }
    for (int j = 0; j < extent.height; ++j) {
        float* const row = heights.row(j);
        std::transform(row, row + extent.width, solid.row(j), row,
                       [](float old, float blurred) { return std::isnan(old) ? old : blurred; });
    }
    return {};
}

}  // namespace

bool wants_occlusion(const BakeFileOptions& options) { return options.occlusion || is_extra(options.others); }

Result<OcclusionMaps> occluded_heights(Plane<float> heights, const HeightFieldHead& head,
                                       const BakeFileOptions& options, const Execution& execution) {
    if (options.heights.blur_sigma > 0.0f) {
        auto blurred = blur(heights, head, static_cast<double>(options.heights.blur_sigma), execution);
        if (!blurred) return blurred.error();
    }
    OcclusionOptions with = options.occlusion.value_or(OcclusionOptions());
    with.occlusion = with.occlusion || is_extra(options.others);
    const HeightField field{std::move(heights), head.bumpiness_x, head.bumpiness_y,
                            head.wrap_x,        head.wrap_y,      head.ground};
    return occlusion(field, with, options.bake, execution);
}

ExtraInputs with_occlusion(const ExtraInputs& inputs, const OcclusionMaps& maps) {
    ExtraInputs with = inputs;
    for (const Extra extra : kExtras) {
        if (!with[extra] || !with[extra]->occlusion) continue;
        with[extra]->occlusion = false;
        with[extra]->map = [&maps]() -> Result<Plane<float>> { return maps.occlusion.clone(); };
    }
    return with;
}

}  // namespace tex::inline v1
