// SPDX-License-Identifier: Apache-2.0

#include "surface/integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/bake.h"
#include "kernels/slopes.h"
#include "kernels/stored.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {
namespace {

float larger_bumpiness(const IntegrateOptions& options) {
    return std::max(std::abs(options.bumpiness_x), std::abs(options.bumpiness_y));
}

SurfaceAxis axis_of(Wrap wrap, float bumpiness, float larger, int texels) {
    return {wrap, texels > 1 ? bumpiness / larger : 0.0f};
}

AxisOperator operator_of(const SurfaceAxis& axis, int texels) {
    return {texels, axis.wrap != Wrap::repeat, axis.ratio};
}

float settled_response(const IntegrateOptions& options) {
    return options.least_response > 0.0f ? options.least_response : least_response_of(options.bake.kernel);
}

struct Bounds {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
};

Bounds bounds_of(const Plane<float>& plane) {
    Bounds bounds;
    for (int j = 0; j < plane.extent().height; ++j)
        widen_range(plane.row(j), plane.extent().width, bounds.low, bounds.high);
    return bounds;
}

}  // namespace

Integrator::Integrator(const NormalMap& map, const IntegrateOptions& options)
    : map_(map), options_(options), extent_(map.extent()), gradient_(gradient_of(options.bake)),
      x_(axis_of(options.wrap_x, options.bumpiness_x, larger_bumpiness(options), extent_.width)),
      y_(axis_of(options.wrap_y, options.bumpiness_y, larger_bumpiness(options), extent_.height)),
      solver_(gradient_, operator_of(x_, extent_.width), operator_of(y_, extent_.height), settled_response(options)) {
    head_ = {x_.ratio, y_.ratio, options.wrap_x, options.wrap_y};
}

Result<Integrator::Count> Integrator::count(const Execution& execution) const {
    const int rows = strip_rows(extent_.width, 0);
    WorkingVector<Count> counts(static_cast<std::size_t>((extent_.height + rows - 1) / rows));
    const auto body = [&](int begin, int end) {
        Count& count = counts[static_cast<std::size_t>(begin / rows)];
        for (int j = begin; j < end; ++j) {
            count.unused +=
                count_without_slope({map_.x.row(j), map_.y.row(j), map_.z.row(j)}, options_.least_z, extent_.width);
            count.behind += count_below(map_.z.row(j), 0.0f, extent_.width);
        }
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, extent_.height, rows, body); !done) return done.error();
    Count all;
    for (const Count& count : counts) {
        all.unused += count.unused;
        all.behind += count.behind;
    }
    return all;
}

Result<void> Integrator::divergence(const SlopesOf& slopes, Plane<float>& out, const Execution& execution,
                                    ProgressSpan span) const {
    const auto body = [&](int begin, int end) {
        DivergenceRows rows(extent_, slopes, gradient_, x_, y_);
        for (int j = begin; j < end; ++j) rows.make(j, out.row(j));
    };
    return parallel_for(execution, extent_.height, strip_rows(extent_.width, 2 * gradient_.radius), body, span);
}

// Whether one solution is exact where every slope is known: see divergence.h.
bool Integrator::is_exact() const {
    const bool clamps_x = x_.wrap == Wrap::clamp && extent_.width > 1;
    const bool clamps_y = y_.wrap == Wrap::clamp && extent_.height > 1;
    return gradient_.is_difference() || (!clamps_x && !clamps_y);
}

Result<Plane<float>> Integrator::heights(std::int64_t unused, const Execution& execution, ProgressSpan span,
                                         int& steps) const {
    Plane<float> heights(extent_);
    const bool once = unused == 0 && is_exact();
    const double first = once ? span.to : span.from + 0.2 * (span.to - span.from);
    const double made = span.from + 0.25 * (first - span.from);
    const auto slopes = [this](int j, float* p, float* q) {
        slopes_of_normals({map_.x.row(j), map_.y.row(j), map_.z.row(j)}, options_.least_z, extent_.width, p, q);
    };
    if (auto done = divergence(slopes, heights, execution, {span.from, made}); !done) return done.error();
    if (auto done = solver_.solve(heights, execution, {made, first}); !done) return done.error();
    ++steps;
    if (once) return heights;
    if (auto done = refine(heights, execution, {first, span.to}, steps); !done) return done.error();
    return heights;
}

// The slopes that the map has beyond those of `heights`; 0 where they are unknown.
Result<void> Integrator::excess(const Plane<float>& heights, Plane<float>& p, Plane<float>& q,
                                const Execution& execution) const {
    const auto row_of = [&heights](int j) { return heights.row(j); };
    const auto body = [&](int begin, int end) {
        BakeRows rows(extent_, row_of, gradient_, head_, begin);
        NormalMap made(Extent{extent_.width, 1});
        const NormalRow row = {made.x.row(0), made.y.row(0), made.z.row(0)};
        for (int j = begin; j < end; ++j) {
            rows.bake(j, row);
            excess_slopes({map_.x.row(j), map_.y.row(j), map_.z.row(j)}, row, options_.least_z, extent_.width, p.row(j),
                          q.row(j));
        }
    };
    const Execution silent = execution.quiet();
    return parallel_for(silent, extent_.height, strip_rows(extent_.width, 2 * gradient_.radius), body);
}

// Solves for what the slopes of `heights` lack, again and again. Each solution removes what the equation sees of it.
// Most often the rest falls by a constant factor; kernels that blur much may see it wrongly at clamped borders, and
// then the last good heights remain.
Result<void> Integrator::refine(Plane<float>& heights, const Execution& execution, ProgressSpan span,
                                int& steps) const {
    constexpr float kEnough = 1e-5f, kLeast = 0.1f;
    Plane<float> p(extent_), q(extent_), change(extent_);
    // Two references, for which std::function needs no memory.
    const auto slopes = [&p, &q](int j, float* to_p, float* to_q) {
        std::copy_n(p.row(j), p.extent().width, to_p);
        std::copy_n(q.row(j), q.extent().width, to_q);
    };
    const Execution silent = execution.quiet();
    const double share = (span.to - span.from) / std::max(1, options_.most_steps);
    float last = std::numeric_limits<float>::max();
    float relax = 1.0f;
    for (; steps < options_.most_steps; ++steps) {
        if (auto done = excess(heights, p, q, execution); !done) return done;
        const double from = span.from + share * steps;
        if (auto done = divergence(slopes, change, silent, {}); !done) return done;
        if (auto done = solver_.solve(change, execution, {from, from + share}); !done) return done;
        const Bounds changed = bounds_of(change);
        const float now = changed.high - changed.low;
        if (!(now < last)) relax *= 0.5f;
        if (relax < kLeast) break;
        last = now;
        for (int j = 0; j < extent_.height; ++j)
            weighted_sum(heights.row(j), 1.0f, change.row(j), relax, extent_.width, heights.row(j));
        const Bounds all = bounds_of(heights);
        if (now <= kEnough * (all.high - all.low)) break;
    }
    return {};
}

bool is_unusable(const Integrator::Count& count, Extent extent) {
    return count.behind > extent.texels() / 16 || count.unused == extent.texels();
}

Result<float> settle_heights(Plane<float>& heights, float larger, const Execution& execution) {
    const Extent extent = heights.extent();
    const Bounds bounds = bounds_of(heights);
    const float highest = (bounds.high - bounds.low) * (1.0f / larger);
    if (!(std::isfinite(highest) && highest >= 0.0f))  // a height that is NaN makes all of them NaN
        return Error{ErrorCode::bad_data, {}, "the heights do not fit floats: slopes are too steep"};
    const auto body = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) shift_and_scale(bounds.low, 1.0f / larger, extent.width, heights.row(j));
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, extent.height, strip_rows(extent.width, 0), body); !done) return done.error();
    return highest;
}

}  // namespace tex::inline v1
