// SPDX-License-Identifier: Apache-2.0
// Edges, memory and threads; kernels/bake.cpp computes. Strips of rows run in parallel; inside a strip rows
// go from top to bottom through a window of as many rows as the gradient kernel is high.

#include <tex/bake.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include "base/blur.h"
#include "base/border.h"
#include "base/guard.h"
#include "base/math.h"
#include "base/parallel.h"
#include "kernels/bake.h"

namespace tex {
namespace {

// A gradient as one-sided weights: derivative[k - 1] is d at +k (at -k its negative), smoothing[k] is s at
// +k and -k.
struct Gradient {
    int radius = 1;
    std::vector<float> derivative;
    std::vector<float> smoothing;
};

Gradient gaussian_gradient(double sigma) {
    Gradient gradient{0, {}, gaussian_weights(sigma)};
    gradient.radius = static_cast<int>(gradient.smoothing.size()) - 1;
    std::vector<double> derivative;
    double moment = 0.0;  // what the derivative makes of a plane of slope 1
    for (int k = 1; k <= gradient.radius; ++k) {
        // g relative to g(1): the factor cancels, and g(1) itself is too small for a double where sigma is
        // small.
        derivative.push_back(k * math::exp(-0.5 * (k * k - 1) / (sigma * sigma)));
        moment += 2.0 * k * derivative.back();
    }
    for (const double d : derivative) gradient.derivative.push_back(static_cast<float>(d / moment));
    return gradient;
}

Gradient gradient_weights(const BakeOptions& options) {
    switch (options.kernel) {
        case GradientKernel::forward: break;  // not symmetric: see bake_differences
        case GradientKernel::central: break;
        case GradientKernel::sobel: return {1, {0.5f}, {0.5f, 0.25f}};
        case GradientKernel::scharr: return {1, {0.5f}, {0.625f, 0.1875f}};
        case GradientKernel::prewitt: return {1, {0.5f}, {1.0f / 3.0f, 1.0f / 3.0f}};
        case GradientKernel::sobel5: return {2, {0.25f, 0.125f}, {0.375f, 0.25f, 0.0625f}};
        case GradientKernel::gaussian: return gaussian_gradient(static_cast<double>(options.gaussian_sigma));
    }
    return {1, {0.5f}, {1.0f, 0.0f}};
}

// The rows of a map from `begin` to `end`, computed by one thread.
struct Strip {
    int begin;
    int end;
};

NormalRow row_of(NormalMap& map, int j) { return {map.x.row(j), map.y.row(j), map.z.row(j)}; }

// An axis of one texel has slope 0.
float bumpiness(float value, int texels) { return texels > 1 ? value : 0.0f; }

// Forward and central: the difference of two texels, nothing in between.
void bake_differences(const HeightField& field, bool forward, Strip strip, NormalMap& map) {
    const Extent extent = field.height.extent();
    const float step = forward ? 1.0f : 0.5f;
    const float scale_x = step * bumpiness(field.bumpiness_x, extent.width);
    const float scale_y = step * bumpiness(field.bumpiness_y, extent.height);
    HeightRows rows(field.height.view(), field.wrap_x, field.wrap_y, 1, 3);
    rows.fetch(strip.begin - 1);
    rows.fetch(strip.begin);
    for (int j = strip.begin; j < strip.end; ++j) {
        rows.fetch(j + 1);
        const float* row = rows.row(j);
        const float* left = forward ? row : row - 1;
        const float* down = forward ? row : rows.row(j + 1);
        normals_by_difference(left, row + 1, down, rows.row(j - 1), scale_x, scale_y, extent.width,
                              row_of(map, j));
    }
}

// All others. Two ways through the window of rows: the derivative along the row is smoothed down the
// column, the derivative down the column is smoothed along the row.
void bake_smoothed(const HeightField& field, const Gradient& gradient, Strip strip, NormalMap& map) {
    const Extent extent = field.height.extent();
    const float scale_x = bumpiness(field.bumpiness_x, extent.width);
    const float scale_y = bumpiness(field.bumpiness_y, extent.height);
    const int radius = gradient.radius;
    const int window = 2 * radius + 1;
    HeightRows rows(field.height.view(), field.wrap_x, field.wrap_y, radius, window);
    const int lead = rows.lead();
    Plane<float> du(Extent{extent.width, window});
    Plane<float> dv(Extent{lead + extent.width + lead, 1});
    std::vector<const float*> window_rows(static_cast<std::size_t>(window)),
        window_du(static_cast<std::size_t>(window));
    for (int j = strip.begin - radius; j < strip.end + radius; ++j) {
        derive_row(rows.fetch(j), gradient.derivative.data(), radius, extent.width,
                   du.row(wrap_around(j, window)));
        const int centre = j - radius;  // the row whose window is complete now
        if (centre < strip.begin) continue;
        for (int k = 0; k < window; ++k) {
            window_rows[static_cast<std::size_t>(k)] = rows.row(centre - radius + k) - lead;
            window_du[static_cast<std::size_t>(k)] = du.row(wrap_around(centre - radius + k, window));
        }
        derive_column(window_rows.data(), gradient.derivative.data(), radius, lead + extent.width + radius,
                      dv.row(0));
        normals_by_smoothing(window_du.data(), dv.row(0) + lead, gradient.smoothing.data(), radius, scale_x,
                             scale_y, extent.width, row_of(map, centre));
    }
}

// Rows in a strip: enough texels to be worth a thread's while, and several times the rows that strips
// compute twice.
int strip_rows(int width, int overlap) {
    constexpr int kTexels = 1 << 17;
    return std::max({1, kTexels / width, 4 * overlap});
}

}  // namespace

Result<NormalMap> bake(const HeightField& field, const BakeOptions& options, const Execution& execution) {
    const Extent extent = field.height.extent();
    assert(extent.width >= 1 && extent.width <= kMaxExtent && extent.height >= 1 &&
           extent.height <= kMaxExtent);
    assert(std::isfinite(field.bumpiness_x) && std::isfinite(field.bumpiness_y));
    assert(options.kernel != GradientKernel::gaussian ||
           (options.gaussian_sigma > 0.0f && options.gaussian_sigma <= kMaxGaussianSigma));
    return guarded([&]() -> Result<NormalMap> {
        NormalMap map(extent);
        const Gradient gradient = gradient_weights(options);
        const bool forward = options.kernel == GradientKernel::forward;
        const bool plain = forward || options.kernel == GradientKernel::central;
        const auto body = [&](int begin, int end) {
            if (plain) {
                bake_differences(field, forward, {begin, end}, map);
            } else {
                bake_smoothed(field, gradient, {begin, end}, map);
            }
        };
        const auto done =
            parallel_for(execution, extent.height, strip_rows(extent.width, 2 * gradient.radius), body);
        if (!done) return done.error();
        return map;
    });
}

SlopeRange slope_range(const NormalMap& map, const Execution& execution) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const Extent extent = map.extent();
    SlopeBounds all{kInfinity, -kInfinity, kInfinity, -kInfinity};
    std::mutex merging;
    const auto body = [&](int begin, int end) {
        SlopeBounds bounds{kInfinity, -kInfinity, kInfinity, -kInfinity};
        for (int j = begin; j < end; ++j) {
            widen_slope_bounds(map.x.row(j), map.y.row(j), map.z.row(j), extent.width, bounds);
        }
        // Least and greatest do not depend on the order of the threads.
        const std::lock_guard lock(merging);
        all = {std::min(all.min_x, bounds.min_x), std::max(all.max_x, bounds.max_x),
               std::min(all.min_y, bounds.min_y), std::max(all.max_y, bounds.max_y)};
    };
    const Execution silent{execution.threads, {}};
    const auto done = parallel_for(silent, extent.height, strip_rows(extent.width, 1), body);
    if (!done) body(0, extent.height);
    return {all.min_x, all.max_x, all.min_y, all.max_y};
}

}  // namespace tex
