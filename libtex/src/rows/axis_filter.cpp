// SPDX-License-Identifier: Apache-2.0

#include "rows/axis_filter.h"

#include <algorithm>
#include <cmath>

#include "kernels/mip.h"
#include "rows/border.h"
#include "rows/math.h"

namespace tex {
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
    std::vector<double> weights;

    [[nodiscard]] int end() const { return first + static_cast<int>(weights.size()); }
};

// In integers, so that areas are exact: texel i of m covers [i n, (i + 1) n), and texel s of n covers [s m, (s + 1) m).
Footprint box_footprint(int i, int n, int m) {
    const std::int64_t begin = std::int64_t{i} * n;
    const std::int64_t end = begin + n;
    Footprint footprint{static_cast<int>(begin / m), {}};
    for (std::int64_t s = begin / m; s * m < end; ++s) {
        footprint.weights.push_back(static_cast<double>(std::min(end, (s + 1) * m) - std::max(begin, s * m)));
    }
    return footprint;
}

Footprint sampled_footprint(MipFilter filter, int i, int n, int m) {
    const double scale = static_cast<double>(n) / m;
    const double centre = (i + 0.5) * scale - 0.5;  // texel centres of the larger level are integers
    const double reach = radius_of(filter) * scale;
    const int first = static_cast<int>(std::floor(centre - reach)) + 1;
    const int end = static_cast<int>(std::ceil(centre + reach));
    Footprint footprint{first, {}};
    for (int s = first; s < end; ++s) footprint.weights.push_back(value_at(filter, (s - centre) / scale));
    return footprint;
}

Footprint footprint_of(MipFilter filter, int i, int n, int m) {
    if (n == 1) return {0, {1.0}};
    Footprint footprint = filter == MipFilter::box ? box_footprint(i, n, m) : sampled_footprint(filter, i, n, m);
    double sum = 0.0;
    for (const double w : footprint.weights) sum += w;
    for (double& w : footprint.weights) w /= sum;
    return footprint;
}

}  // namespace

AxisFilter make_axis_filter(MipFilter filter, int n) {
    const int m = std::max(1, n / 2);
    AxisFilter axis;
    axis.even = n % 2 == 0;
    axis.stride = aligned_count(m);
    std::vector<Footprint> footprints;
    for (int i = 0; i < m; ++i) {
        if (axis.even && i > 0) {
            footprints.push_back(footprints.back());
        } else {
            footprints.push_back(footprint_of(filter, i, n, m));
            footprints.back().first -= 2 * i;
        }
    }
    const auto begins_before = [](const Footprint& a, const Footprint& b) { return a.first < b.first; };
    const auto ends_before = [](const Footprint& a, const Footprint& b) { return a.end() < b.end(); };
    axis.first = std::min_element(footprints.begin(), footprints.end(), begins_before)->first;
    axis.taps = std::max_element(footprints.begin(), footprints.end(), ends_before)->end() - axis.first;

    axis.weights.resize(static_cast<std::size_t>(axis.stride * axis.taps), 0.0f);
    for (int i = 0; i < m; ++i) {
        const Footprint& footprint = footprints[static_cast<std::size_t>(i)];
        float* weight = axis.weights.data() + (footprint.first - axis.first) * axis.stride + i;
        for (const double w : footprint.weights) {
            *weight = static_cast<float>(w);
            weight += axis.stride;
        }
    }
    return axis;
}

RowFilter::RowFilter(const AxisFilter& filter, Wrap wrap, int width)
    : filter_(filter), wrap_(wrap), width_(width), count_(std::max(1, width / 2)), before_(std::max(0, -filter.first)),
      after_(std::max(0, 2 * (count_ - 1) + filter.first + filter.taps - width)), lead_(aligned_count(before_)),
      pairs_(count_ + filter.taps / 2),
      row_(Extent{lead_ + std::max(width + after_, 2 * aligned_count(pairs_)), 1}, 0.0f),
      halves_(Extent{aligned_count(pairs_) + aligned_count(filter.taps), 2}) {
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

}  // namespace tex
