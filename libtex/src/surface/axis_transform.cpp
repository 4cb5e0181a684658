// SPDX-License-Identifier: Apache-2.0

#include "surface/axis_transform.h"

#include <cstddef>
#include <numeric>
#include <utility>

#include "rows/math.h"

namespace tex::inline v1 {

AxisTransform::AxisTransform(int texels, bool is_mirrored)
    : texels_(texels), is_mirrored_(is_mirrored), fourier_(texels), order_(static_cast<std::size_t>(texels)) {
    std::iota(order_.begin(), order_.end(), 0);
    if (!is_mirrored) return;
    // Even texels from the left, odd ones from the right (Makhoul 1980).
    for (int i = 0; i < texels; ++i) order_[static_cast<std::size_t>(i % 2 == 0 ? i / 2 : texels - 1 - i / 2)] = i;
    turns_.reserve(2 * static_cast<std::size_t>(texels));
    for (int k = 0; k < texels; ++k) {
        turns_.push_back(static_cast<float>(math::cos(frequency(k) / 2.0)));
        turns_.push_back(static_cast<float>(math::sin(frequency(k) / 2.0)));
    }
}

double AxisTransform::frequency(int k) const { return (is_mirrored_ ? 1.0 : 2.0) * math::kPi * k / texels_; }

void AxisTransform::forward(Groups& data, Groups& scratch) const {
    fourier_.run(data, scratch);
    if (is_mirrored_)
        cosine_of_fourier(data.row(0), turns_.data(), texels_, scratch.row(0));
    else
        hartley_of_fourier(data.row(0), texels_, scratch.row(0));
    std::swap(data, scratch);
}

void AxisTransform::inverse(Groups& data, Groups& scratch) const {
    if (!is_mirrored_) {
        forward(data, scratch);
        return;
    }
    fourier_of_cosine(data.row(0), turns_.data(), texels_, scratch.row(0));
    std::swap(data, scratch);
    fourier_.run(data, scratch);
}

}  // namespace tex::inline v1
