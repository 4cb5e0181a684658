// SPDX-License-Identifier: Apache-2.0

#include "preview/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "threads/parallel.h"

namespace tex::inline v1::render {
namespace {

// The texel at index i of an axis of n texels.
int wrapped(std::int64_t i, int n, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat: return static_cast<int>((i % n + n) % n);
        case Wrap::clamp: return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
        case Wrap::mirror: {
            const std::int64_t period = 2 * std::int64_t{n};
            const std::int64_t k = (i % period + period) % period;
            return static_cast<int>(k < n ? k : period - 1 - k);
        }
    }
    return 0;
}

// Two neighbouring texels and the weight of the second.
struct Tap {
    int first, second;
    double weight;
};

Tap tap(double position, int n, Wrap wrap) {
    // Extreme coordinates (or NaN), which no texture is tiled to, must not overflow the conversion.
    const double bounded = position > -1e9 && position < 1e9 ? position : 0.0;
    const double floor = std::floor(bounded);
    const std::int64_t i = static_cast<std::int64_t>(floor);
    return {wrapped(i, n, wrap), wrapped(i + 1, n, wrap), bounded - floor};
}

Sample bilinear(const Sampler& sampler, int level, Vec2 uv) {
    const std::vector<PlaneView<const float>>& planes = sampler.levels[static_cast<std::size_t>(level)];
    const Extent extent = planes[0].extent;
    const Tap x = tap(uv.x * extent.width - 0.5, extent.width, sampler.wrap_x);
    const Tap y = tap((1.0 - uv.y) * extent.height - 0.5, extent.height, sampler.wrap_y);
    Sample result{};
    for (std::size_t c = 0; c < planes.size(); ++c) {
        const float* upper = planes[c].row(y.first);
        const float* lower = planes[c].row(y.second);
        const double a = upper[x.first], b = upper[x.second], d = lower[x.first], e = lower[x.second];
        const double top = a + (b - a) * x.weight;
        const double bottom = d + (e - d) * x.weight;
        result[c] = top + (bottom - top) * y.weight;
    }
    return result;
}

Sample trilinear(const Sampler& sampler, double level, Vec2 uv) {
    const double last = static_cast<double>(sampler.levels.size() - 1);
    const double clamped = level > 0.0 ? std::min(level, last) : 0.0;
    const double floor = std::floor(clamped);
    const int k = static_cast<int>(floor);
    const double weight = clamped - floor;
    Sample result = bilinear(sampler, k, uv);
    if (weight > 0.0) {
        const Sample smaller = bilinear(sampler, k + 1, uv);
        for (std::size_t c = 0; c < result.size(); ++c) result[c] += (smaller[c] - result[c]) * weight;
    }
    return result;
}

// One axis of the box filter: texel i of n covers [i, i + 1) * from / n of the larger level.
struct Cover {
    int first = 0, count = 0;
    double weights[3] = {};
};

Cover cover(int i, int n, int from) {
    const double begin = static_cast<double>(i) * from / n, end = static_cast<double>(i + 1) * from / n;
    Cover result;
    result.first = static_cast<int>(begin);
    for (int k = result.first; k < from && k < end && result.count < 3; ++k) {
        const double part = std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k));
        result.weights[result.count++] = part * n / from;
    }
    return result;
}

void halve_row(PlaneView<const float> larger, int j, Plane<float>& smaller) {
    const Extent extent = smaller.extent();
    const Cover rows = cover(j, extent.height, larger.extent.height);
    for (int i = 0; i < extent.width; ++i) {
        const Cover columns = cover(i, extent.width, larger.extent.width);
        double sum = 0.0;
        for (int r = 0; r < rows.count; ++r) {
            const float* row = larger.row(rows.first + r) + columns.first;
            double across = 0.0;
            for (int c = 0; c < columns.count; ++c) across += columns.weights[c] * static_cast<double>(row[c]);
            sum += rows.weights[r] * across;
        }
        smaller.at(i, j) = static_cast<float>(sum);
    }
}

}  // namespace

Sampler sampler_of(const MipChain& chain, Wrap wrap_x, Wrap wrap_y) {
    Sampler sampler;
    for (const NormalMap& level : chain.levels)
        sampler.levels.push_back({level.x.view(), level.y.view(), level.z.view()});
    sampler.channels = 3;
    sampler.wrap_x = wrap_x;
    sampler.wrap_y = wrap_y;
    return sampler;
}

Result<Pyramid> Pyramid::build(const std::vector<PlaneView<const float>>& base, const Execution& execution) {
    Pyramid pyramid;
    pyramid.levels_.push_back(base);
    const int count = level_count(base[0].extent);
    for (int level = 1; level < count; ++level) {
        const ProgressSpan span{static_cast<double>(level - 1) / (count - 1), static_cast<double>(level) / (count - 1)};
        std::vector<PlaneView<const float>> views;
        for (const PlaneView<const float>& larger : pyramid.levels_.back()) {
            Plane<float> smaller(level_extent(larger.extent, 1));
            const auto body = [&](int begin, int end) {
                for (int j = begin; j < end; ++j) halve_row(larger, j, smaller);
            };
            // For progress, the planes of a level count as one: only the first plane reports it.
            const ProgressSpan counted = views.empty() ? span : ProgressSpan{span.to, span.to};
            const auto halved = parallel_for(execution, smaller.extent().height, 16, body, counted);
            if (!halved) return halved.error();
            views.push_back(std::as_const(smaller).view());
            pyramid.owned_.push_back(std::move(smaller));
        }
        pyramid.levels_.push_back(std::move(views));
    }
    return pyramid;
}

Sampler Pyramid::sampler(Wrap wrap_x, Wrap wrap_y) const {
    return {levels_, static_cast<int>(levels_[0].size()), wrap_x, wrap_y};
}

Sample sample(const Sampler& sampler, Vec2 uv, const Footprint& footprint, int anisotropy) {
    const double w = sampler.extent().width, h = sampler.extent().height;
    const double px = length(Vec2{footprint.dx.x * w, footprint.dx.y * h});
    const double py = length(Vec2{footprint.dy.x * w, footprint.dy.y * h});
    const double longer = std::max(px, py), shorter = std::min(px, py);
    if (!(longer > 1.0)) return trilinear(sampler, 0.0, uv);  // magnified, or the footprint is unknown

    // Slightly below the ratio, so that a footprint that is square except for rounding takes one sample.
    const double ratio = shorter > 0.0 ? longer / shorter - 1e-6 : 1e9;
    const double count = std::min(std::ceil(std::max(ratio, 1.0)), static_cast<double>(anisotropy));
    const double level = math::log(longer / count) / math::log(2.0);
    const int taps = static_cast<int>(count);
    if (taps == 1) return trilinear(sampler, level, uv);
    const Vec2 axis = px >= py ? footprint.dx : footprint.dy;
    Sample sum{};
    for (int k = 0; k < taps; ++k) {
        const Sample one = trilinear(sampler, level, uv + axis * ((k + 0.5) / count - 0.5));
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += one[c];
    }
    for (double& value : sum) value /= count;
    return sum;
}

}  // namespace tex::inline v1::render
