// SPDX-License-Identifier: Apache-2.0

#include "rows/bake_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rows/blur.h"
#include "rows/math.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {
namespace {

Gradient gaussian_gradient(double sigma) {
    Gradient gradient{0, {}, gaussian_weights(sigma)};
    gradient.radius = static_cast<int>(gradient.smoothing.size()) - 1;
    WorkingVector<double> derivative;
    derivative.reserve(gradient.smoothing.size());
    gradient.derivative.reserve(gradient.smoothing.size());
    double moment = 0.0;  // the response of the derivative to a plane of slope 1
    for (int k = 1; k <= gradient.radius; ++k) {
        // g relative to g(1): the factor cancels, and g(1) itself is too small for a double if sigma is small.
        derivative.push_back(k * math::exp(-0.5 * (k * k - 1) / (sigma * sigma)));
        moment += 2.0 * k * derivative.back();
    }
    for (const double d : derivative) gradient.derivative.push_back(static_cast<float>(d / moment));
    return gradient;
}

// An axis of one texel has slope 0.
float bumpiness(float value, int texels) { return texels > 1 ? value : 0.0f; }

// The factor of a difference. The smoothed kernels include it in their weights.
float step(const Gradient& gradient) { return !gradient.is_difference() || gradient.forward ? 1.0f : 0.5f; }

// What heights are multiplied by, and bumpiness divided by, so that no finite height is limited. Bumpiness above 2^40
// could make slopes of heights so small that scaling would round them. The ground multiplies it by up to 2^20.
float height_scale(const HeightFieldHead& head) {
    const float most = head.ground ? 0x1p20f : 0x1p40f;
    return std::max(std::abs(head.bumpiness_x), std::abs(head.bumpiness_y)) <= most ? kHeightScale : 1.0f;
}

}  // namespace

Gradient gradient_of(const BakeOptions& options) {
    switch (options.kernel) {
        case GradientKernel::forward: return {1, {}, {}, true};
        case GradientKernel::central: break;
        case GradientKernel::sobel: return {1, {0.5f}, {0.5f, 0.25f}};
        case GradientKernel::scharr: return {1, {0.5f}, {0.625f, 0.1875f}};
        case GradientKernel::prewitt: return {1, {0.5f}, {1.0f / 3.0f, 1.0f / 3.0f}};
        case GradientKernel::sobel5: return {2, {0.25f, 0.125f}, {0.375f, 0.25f, 0.0625f}};
        case GradientKernel::gaussian: return gaussian_gradient(static_cast<double>(options.gaussian_sigma));
    }
    return {};
}

BakeRows::BakeRows(Extent extent, RowOf heights, const Gradient& gradient, const HeightFieldHead& head, int first)
    : extent_(extent), gradient_(gradient), ground_(head.ground),
      ground_row_(head.ground_row), scale_{step(gradient) * bumpiness(head.bumpiness_x, extent.width) /
                                               height_scale(head),
                                           step(gradient) * bumpiness(head.bumpiness_y, extent.height) /
                                               height_scale(head)},
      rows_(extent, std::move(heights), head.wrap_x, head.wrap_y, gradient.radius, 2 * gradient.radius + 1,
            height_scale(head)),
      next_(first - gradient.radius) {
    if (gradient.is_difference()) return;
    const int window = 2 * gradient.radius + 1;
    du_ = Plane<float>(Extent{extent.width, window});
    dv_ = Plane<float>(Extent{rows_.lead() + extent.width + rows_.lead(), 1});
    window_rows_.resize(static_cast<std::size_t>(window));
    window_du_.resize(static_cast<std::size_t>(window));
}

void BakeRows::fetch() {
    const float* row = rows_.fetch(next_);
    if (!gradient_.is_difference()) {
        derive_row(row, gradient_.derivative.data(), gradient_.radius, extent_.width,
                   du_.row(wrap_around(next_, 2 * gradient_.radius + 1)));
    }
    ++next_;
}

// Computes what row j needs.
void BakeRows::prepare(int j) {
    const int radius = gradient_.radius;
    while (next_ <= j + radius) fetch();
    if (gradient_.is_difference()) return;
    const int window = 2 * radius + 1;
    const int lead = rows_.lead();
    for (int k = 0; k < window; ++k) {
        window_rows_[static_cast<std::size_t>(k)] = rows_.row(j - radius + k) - lead;
        window_du_[static_cast<std::size_t>(k)] = du_.row(wrap_around(j - radius + k, window));
    }
    derive_column(window_rows_.data(), gradient_.derivative.data(), radius, lead + extent_.width + radius, dv_.row(0));
}

Strength BakeRows::scale_of(int j) const {
    if (!ground_) return scale_;
    const Strength strength = strength_on_ground(*ground_, wrap_around(j, extent_.height) + ground_row_);
    return {scale_.x * strength.x, scale_.y * strength.y};
}

// Makes `count` texels of row j from `first` on. Rows of derivatives are moved on to the first texel, and back.
void BakeRows::make(int j, int first, int count, NormalRow out) {
    const Strength scale = scale_of(j);
    if (gradient_.is_difference()) {
        const float* row = rows_.row(j) + first;
        const float* left = gradient_.forward ? row : row - 1;
        const float* down = gradient_.forward ? row : rows_.row(j + 1) + first;
        normals_by_difference(left, row + 1, down, rows_.row(j - 1) + first, scale.x, scale.y, count, out);
        return;
    }
    for (const float*& row : window_du_) row += first;
    normals_by_smoothing(window_du_.data(), dv_.row(0) + rows_.lead() + first, gradient_.smoothing.data(),
                         gradient_.radius, scale.x, scale.y, count, out);
    for (const float*& row : window_du_) row -= first;
}

void BakeRows::bake(int j, NormalRow out) {
    prepare(j);
    make(j, 0, extent_.width, out);
}

void BakeRows::bake_exactly(int j, NormalRow out) {
    prepare(j);
    const int whole = extent_.width / kWhole * kWhole, rest = extent_.width - whole;
    if (whole > 0) make(j, 0, whole, out);
    if (rest == 0) return;
    float end[3][kWhole];
    make(j, whole, rest, {end[0], end[1], end[2]});
    std::copy_n(end[0], rest, out.x + whole);
    std::copy_n(end[1], rest, out.y + whole);
    std::copy_n(end[2], rest, out.z + whole);
}

}  // namespace tex::inline v1
