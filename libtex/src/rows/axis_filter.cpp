// SPDX-License-Identifier: Apache-2.0

#include "rows/axis_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/mip.h"
#include "rows/border.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// The modified Bessel function of the first kind, order 0: the sum of ((x/2)^k / k!)^2.
double bessel_i0(double x) {
    double term = 1.0;
    double sum = 1.0;
    for (int k = 1; term > 1e-17 * sum; ++k) {
        const double factor = x / (2.0 * k);
        term *= factor * factor;
        sum += term;
    }
    return sum;
}

double kaiser(double x) {
    constexpr double kRadius = 3.0, kAlpha = 4.0;
    static const double kPeak = bessel_i0(kAlpha);
    const double t = x / kRadius;
    return math::sinc(x) * bessel_i0(kAlpha * std::sqrt(std::max(0.0, 1.0 - t * t))) / kPeak;
}

// The cubic filters of Mitchell and Netravali, Reconstruction Filters in Computer Graphics, 1988.
double cubic(double x, double b, double c) {
    const double a = std::abs(x);
    if (a < 1.0) return ((12 - 9 * b - 6 * c) * a * a * a - (18 - 12 * b - 6 * c) * a * a + (6 - 2 * b)) / 6;
    return ((-b - 6 * c) * a * a * a + (6 * b + 30 * c) * a * a - (12 * b + 48 * c) * a + (8 * b + 24 * c)) / 6;
}

int radius_of(MipFilter filter) {
    switch (filter) {
        case MipFilter::box: break;
        case MipFilter::triangle: return 1;
        case MipFilter::mitchell:
        case MipFilter::catmull_rom: return 2;
        case MipFilter::kaiser:
        case MipFilter::lanczos3: return 3;
    }
    return 0;
}

double value_at(MipFilter filter, double x) {
    if (std::abs(x) >= radius_of(filter)) return 0.0;
    switch (filter) {
        case MipFilter::box: break;
        case MipFilter::triangle: return 1.0 - std::abs(x);
        case MipFilter::kaiser: return kaiser(x);
        case MipFilter::mitchell: return cubic(x, 1.0 / 3.0, 1.0 / 3.0);
        case MipFilter::catmull_rom: return cubic(x, 0.0, 0.5);
        case MipFilter::lanczos3: return math::sinc(x) * math::sinc(x / 3.0);
    }
    return 0.0;
}

// The weights that the texels from `first` on have in one texel of the smaller level.
struct Footprint {
    int first = 0;
    int count = 0;
    std::array<double, kMostTaps> weights = {};

    void add(double weight) { weights[static_cast<std::size_t>(count++)] = weight; }
    [[nodiscard]] int end() const { return first + count; }
};

// In integers, so that areas are exact: texel i of m covers [i n, (i + 1) n), and texel s of n covers [s m, (s + 1) m).
Footprint box_footprint(int i, int n, int m) {
    const std::int64_t begin = std::int64_t{i} * n;
    const std::int64_t end = begin + n;
    Footprint footprint{static_cast<int>(begin / m)};
    for (std::int64_t s = begin / m; s * m < end; ++s) {
        footprint.add(static_cast<double>(std::min(end, (s + 1) * m) - std::max(begin, s * m)));
    }
    return footprint;
}

Footprint sampled_footprint(MipFilter filter, int i, int n, int m) {
    const double scale = static_cast<double>(n) / m;
    const double centre = (i + 0.5) * scale - 0.5;  // texel centres of the larger level are integers
    const double reach = radius_of(filter) * scale;
    const int first = static_cast<int>(std::floor(centre - reach)) + 1;
    const int end = static_cast<int>(std::ceil(centre + reach));
    Footprint footprint{first};
    for (int s = first; s < end; ++s) footprint.add(value_at(filter, (s - centre) / scale));
    return footprint;
}

Footprint footprint_of(MipFilter filter, int i, int n, int m) {
    if (n == 1) return {0, 1, {1.0}};
    Footprint footprint = filter == MipFilter::box ? box_footprint(i, n, m) : sampled_footprint(filter, i, n, m);
    double sum = 0.0;
    for (int k = 0; k < footprint.count; ++k) sum += footprint.weights[static_cast<std::size_t>(k)];
    for (double& w : footprint.weights) w /= sum;
    return footprint;
}

}  // namespace

int most_taps(MipFilter filter, int n) {
    if (n == 1) return 1;
    if (filter == MipFilter::box) return n % 2 == 0 ? 2 : 4;
    // The footprint of one texel, and where those of two odd texels begin.
    const double scale = static_cast<double>(n) / (n / 2);
    return static_cast<int>(std::ceil(2.0 * radius_of(filter) * scale)) + 2;
}

AxisFilter make_axis_filter(MipFilter filter, int n) {
    const int m = std::max(1, n / 2);
    AxisFilter axis;
    axis.even = n % 2 == 0;
    axis.stride = aligned_count(m);
    // The footprint as seen from texel 2 i. Even sizes give all texels the same one.
    const auto seen = [filter, n, m, even = axis.even](int i) {
        Footprint footprint = footprint_of(filter, even ? 0 : i, n, m);
        footprint.first -= even ? 0 : 2 * i;
        return footprint;
    };
    Footprint footprint = seen(0);
    axis.first = footprint.first;
    int end = footprint.end();
    for (int i = 1; i < m && !axis.even; ++i) {
        footprint = seen(i);
        axis.first = std::min(axis.first, footprint.first);
        end = std::max(end, footprint.end());
    }
    axis.taps = end - axis.first;

    axis.weights.resize(static_cast<std::size_t>(axis.stride * axis.taps), 0.0f);
    for (int i = 0; i < m; ++i) {
        if (!axis.even) footprint = seen(i);
        float* weight = axis.weights.data() + (footprint.first - axis.first) * axis.stride + i;
        for (int k = 0; k < footprint.count; ++k, weight += axis.stride)
            *weight = static_cast<float>(footprint.weights[static_cast<std::size_t>(k)]);
    }
    return axis;
}

RowFilter::RowFilter(const AxisFilter& filter, Wrap wrap, int width)
    : filter_(filter), wrap_(wrap), width_(width), count_(std::max(1, width / 2)), before_(std::max(0, -filter.first)),
      after_(std::max(0, 2 * (count_ - 1) + filter.first + filter.taps - width)), lead_(aligned_count(before_)),
      pairs_(count_ + filter.taps / 2),
      row_(Extent{lead_ + std::max(width + after_, 2 * aligned_count(pairs_)), 1}, 0.0f),
      halves_(Extent{aligned_count(pairs_) + aligned_count(filter.taps), 2}) {
    weights_.reserve(static_cast<std::size_t>(filter.taps));
    for (int k = 0; k < filter.taps; ++k) weights_.push_back(filter.weight(k, 0));
}

void RowFilter::run(float* out) {
    float* row = this->row();
    for (int k = 1; k <= before_; ++k) row[-k] = row[border_index(wrap_, -k, width_)];
    for (int k = 0; k < after_; ++k) row[width_ + k] = row[border_index(wrap_, width_ + k, width_)];
    float* even = halves_.row(0);
    float* odd = halves_.row(1);
    split_row(row + filter_.first, pairs_, even, odd);
    if (filter_.even) {
        filter_columns_evenly(even, odd, weights_.data(), filter_.taps, count_, out);
    } else {
        filter_columns(even, odd, filter_.weights.data(), filter_.stride, filter_.taps, count_, out);
    }
}

}  // namespace tex::inline v1
