// SPDX-License-Identifier: Apache-2.0

#include "surface/poisson.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "kernels/fourier.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr int kHalf = kGroup / 2;

double square(double value) { return value * value; }

// |d(w)| of a gradient at the frequency w.
double slope_response(const Gradient& gradient, double w) {
    if (gradient.forward) return 2.0 * math::sin(w / 2.0);
    if (gradient.is_difference()) return math::sin(w);
    double sum = 0.0;
    for (std::size_t k = 0; k < gradient.derivative.size(); ++k)
        sum += 2.0 * static_cast<double>(gradient.derivative[k]) * math::sin(static_cast<double>(k + 1) * w);
    return sum;
}

double smooth_response(const Gradient& gradient, double w) {
    if (gradient.is_difference()) return 1.0;
    auto sum = static_cast<double>(gradient.smoothing[0]);
    for (std::size_t k = 1; k < gradient.smoothing.size(); ++k)
        sum += 2.0 * static_cast<double>(gradient.smoothing[k]) * math::cos(static_cast<double>(k) * w);
    return sum;
}

}  // namespace

PoissonSolver::PoissonSolver(const Gradient& gradient, const AxisOperator& x, const AxisOperator& y,
                             float least_response)
    : x_(x.texels, x.is_mirrored), y_(y.texels, y.is_mirrored), x_responses_(responses_of(gradient, x, x_)),
      y_responses_(responses_of(gradient, y, y_)),
      scale_(static_cast<float>(1.0 / (static_cast<double>(x.texels) * y.texels))),
      least_(least_response * least_response) {}

PoissonSolver::Responses PoissonSolver::responses_of(const Gradient& gradient, const AxisOperator& axis,
                                                     const AxisTransform& transform) {
    const int groups = (axis.texels + kGroup - 1) / kGroup;
    const auto padded = static_cast<std::size_t>(groups) * kGroup;
    Responses responses{WorkingVector<float>(padded), WorkingVector<float>(padded), WorkingVector<float>(padded)};
    const auto ratio = static_cast<double>(axis.ratio);
    for (int k = 0; k < axis.texels; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const double w = transform.frequency(k);
        responses.slope[at] = static_cast<float>(square(ratio * slope_response(gradient, w)));
        responses.smooth[at] = static_cast<float>(square(smooth_response(gradient, w)));
        responses.ideal[at] = static_cast<float>(square(2.0 * ratio * math::sin(w / 2.0)));
    }
    return responses;
}

// Transforms rows [first, first + kGroup). Rows below the last one count as 0.
void PoissonSolver::transform_rows(Plane<float>& plane, int first, bool inverse) const {
    const int width = plane.extent().width;
    const int count = std::min(kGroup, plane.extent().height - first);
    Groups data = groups_of(x_.buffer_length());
    Groups scratch = groups_of(x_.buffer_length());
    float* rows[kGroup];
    for (int r = 0; r < count; ++r) rows[r] = plane.row(first + r);
    if (count < kGroup)
        std::memset(data.row(0), 0, static_cast<std::size_t>(x_.buffer_length()) * kGroup * sizeof(float));
    for (int i = 0; i < width; ++i) {
        const int from = inverse ? i : x_.order()[static_cast<std::size_t>(i)];
        for (int r = 0; r < count; ++r) data.row(i)[r] = rows[r][from];
    }
    if (inverse)
        x_.inverse(data, scratch);
    else
        x_.forward(data, scratch);
    const int exchange = inverse && x_.swaps_halves() ? kHalf : 0;
    for (int i = 0; i < width; ++i) {
        const int to = inverse ? x_.order()[static_cast<std::size_t>(i)] : i;
        for (int r = 0; r < count; ++r) rows[r][to] = data.row(i)[r ^ exchange];
    }
}

// Transforms columns [first, first + kGroup), divides their coefficients and transforms them back.
void PoissonSolver::solve_columns(Plane<float>& plane, int first) const {
    const int height = plane.extent().height;
    constexpr std::size_t kBytes = kGroup * sizeof(float);
    Groups data = groups_of(y_.buffer_length());
    Groups scratch = groups_of(y_.buffer_length());
    // Columns beyond the last one count as 0. They share complex numbers with others, which they would round otherwise.
    const auto texels = static_cast<std::size_t>(std::min(kGroup, plane.extent().width - first));
    for (int j = 0; j < height; ++j) {
        std::memcpy(data.row(j), plane.row(y_.order()[static_cast<std::size_t>(j)]) + first, texels * sizeof(float));
        std::memset(data.row(j) + texels, 0, kBytes - texels * sizeof(float));
    }
    y_.forward(data, scratch);
    for (int j = 0; j < height; ++j) {
        const auto at = static_cast<std::size_t>(j);
        const SpectrumRow row = {x_responses_.slope.data() + first,
                                 x_responses_.smooth.data() + first,
                                 x_responses_.ideal.data() + first,
                                 y_responses_.slope[at],
                                 y_responses_.smooth[at],
                                 y_responses_.ideal[at],
                                 least_,
                                 scale_};
        divide_spectrum(row, kGroup, data.row(j));
    }
    y_.inverse(data, scratch);
    constexpr std::size_t kHalfBytes = kBytes / 2;
    const int exchange = y_.swaps_halves() ? kHalf : 0;
    for (int j = 0; j < height; ++j) {
        float* const to = plane.row(y_.order()[static_cast<std::size_t>(j)]) + first;
        std::memcpy(to, data.row(j) + exchange, kHalfBytes);
        std::memcpy(to + kHalf, data.row(j) + (kHalf - exchange), kHalfBytes);
    }
}

Result<void> PoissonSolver::solve(Plane<float>& b, const Execution& execution, ProgressSpan span) const {
    const double third = (span.to - span.from) / 3.0;
    const auto groups = [](int texels) { return (texels + kGroup - 1) / kGroup; };
    const auto rows = [&](bool inverse) {
        return [this, &b, inverse](int begin, int end) {
            for (int g = begin; g < end; ++g) transform_rows(b, g * kGroup, inverse);
        };
    };
    const auto columns = [&](int begin, int end) {
        for (int g = begin; g < end; ++g) solve_columns(b, g * kGroup);
    };
    const Extent extent = b.extent();
    const double first = span.from + third, second = span.to - third;
    auto done = parallel_for(execution, groups(extent.height), 1, rows(false), {span.from, first});
    if (done) done = parallel_for(execution, groups(extent.width), 1, columns, {first, second});
    if (done) done = parallel_for(execution, groups(extent.height), 1, rows(true), {second, span.to});
    return done;
}

}  // namespace tex::inline v1
