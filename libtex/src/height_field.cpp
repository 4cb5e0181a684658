// SPDX-License-Identifier: Apache-2.0
// Puts the steps in order; rows/height_source.cpp chooses the plane with the heights, kernels/height_field.cpp
// computes.

#include <tex/height.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "fields/field_check.h"
#include "fields/height_fields.h"
#include "rows/blur.h"
#include "rows/ground.h"
#include "rows/height_bytes.h"
#include "rows/height_source.h"
#include "rows/usable.h"
#include "surface/debander.h"
#include "surface/nearest.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// The number of rows of an extent that are worth a thread.
int rows_per_strip(Extent extent) { return std::max(1, (1 << 16) / extent.width); }

// Finds the first texel that is NaN. Precondition: there is one.
std::pair<int, int> first_invalid(const Plane<float>& heights) {
    for (int j = 0;; ++j) {
        const float* row = heights.row(j);
        const float* end = row + heights.extent().width;
        const float* found = std::find_if(row, end, [](float h) { return std::isnan(h); });
        if (found != end) return {static_cast<int>(found - row), j};
    }
}

// Flat texels stay flat even under the greatest strength: infinity times their difference, 0, would be NaN.
float finite(double strength) {
    constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
    return static_cast<float>(std::clamp(strength, -kMost, kMost));
}

// Blurs along the rows, then down the columns.
Result<void> blur(HeightField& field, double sigma, const Execution& execution, ProgressSpan span) {
    const Extent extent = field.height.extent();
    const auto weights = gaussian_weights(sigma);
    const int strip = rows_per_strip(extent);
    const double half = (span.from + span.to) / 2;
    Plane<float> across(extent);
    const auto rows = [&](int begin, int end) {
        blur_across(field.height.view(), weights, field.wrap_x, begin, end, across);
    };
    if (auto done = parallel_for(execution, extent.height, strip, rows, {span.from, half}); !done) return done;
    const auto columns = [&](int begin, int end) {
        blur_down(across.view(), weights, field.wrap_y, begin, end, field.height);
    };
    const int radius = static_cast<int>(weights.size()) - 1;
    return parallel_for(execution, extent.height, std::max(strip, radius), columns, {half, span.to});
}

}  // namespace

Result<Strength> strength_from_world(Extent extent, double range, double width, double height) {
    if (!std::isfinite(range)) return bad_option("range: must be finite");
    if (!(width > 0.0 && std::isfinite(width))) return bad_option("width: must be above 0");
    if (!(height >= 0.0 && std::isfinite(height))) return bad_option("height: must be at least 0");
    const double x = range * extent.width / width;
    const double y = height > 0.0 ? range * extent.height / height : x;
    return Strength{finite(x), finite(y)};
}

Result<Strength> strength_from_uv(Extent extent, double r) {
    if (!std::isfinite(r)) return bad_option("r: must be finite");
    const float strength = finite(r * extent.width);
    return Strength{strength, strength};
}

Result<void> validate(const HeightOptions& options) { return check_fields(options); }

Result<PictureHeights> height_field(const Image& image, const HeightOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<PictureHeights> {
        if (auto usable = check_usable(image); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        const PictureFacts facts = facts_of(image);
        const Result<HeightSource> source = find_height_source(facts, options);
        if (!source) return source.error();
        const Result<HeightOptions> with = with_no_data(options, facts, *source, nullptr);
        if (!with) return with.error();
        const Extent extent = image.extent();
        HeightField field{Plane<float>(extent), 1.0f, 1.0f, options.wrap_x, options.wrap_y};
        // Progress: the steps before are fast compared with debanding, filling and blurring.
        const bool debands = options.deband != Deband::off;
        const double taken = debands || options.fill_invalid || options.blur_sigma > 0.0f ? 0.2 : 1.0;
        const double filled = options.blur_sigma > 0.0f ? 0.5 : 1.0;
        const double smoothed = !debands ? taken : options.fill_invalid ? 0.4 : filled;

        std::atomic<std::int64_t> luma_texels{0}, invalid_texels{0}, implausible_texels{0};
        std::atomic<std::int64_t> red_steps{0}, green_steps{0};
        const auto take = [&](int begin, int end) {
            HeightCounts all;
            for (int j = begin; j < end; ++j) all += take_heights(image, *source, *with, j, field.height.row(j));
            luma_texels += all.luma;
            invalid_texels += all.invalid;
            implausible_texels += all.implausible;
            red_steps += all.red_steps;
            green_steps += all.green_steps;
        };
        if (auto done = parallel_for(execution, extent.height, rows_per_strip(extent), take, {0.0, taken}); !done)
            return done.error();

        HeightCounts found;
        found.red_steps = red_steps;
        found.green_steps = green_steps;
        if (auto exchanged = exchanged_bytes(found, source->mixture)) return *exchanged;
        if (invalid_texels > 0 && (!options.fill_invalid || invalid_texels == extent.texels())) {
            const auto [column, row] = first_invalid(field.height);
            return invalid_heights(invalid_texels, column, row, extent, *with);
        }
        const auto deband =
            deband_heights(field.height, options.wrap_x, options.wrap_y, options.deband, execution, {taken, smoothed});
        if (!deband) return deband.error();
        if (invalid_texels > 0) {
            auto done =
                fill_from_nearest(field.height.view(), options.wrap_x, options.wrap_y, execution, {smoothed, filled});
            if (!done) return done.error();
        }
        if (options.blur_sigma > 0.0f) {
            auto done = blur(field, static_cast<double>(options.blur_sigma), execution, {filled, 1.0});
            if (!done) return done.error();
        }
        if (have_unit(facts, *source)) field.ground = image.ground;
        PictureHeights heights{std::move(field),
                               {luma_texels, invalid_texels, *deband, implausible_texels, image.stored, image.remark}};
        heights.report.ground = heights.ground;
        if (have_unit(facts, *source)) heights.report.ground_remark = image.ground_remark;
        return heights;
    });
}

}  // namespace tex::inline v1
