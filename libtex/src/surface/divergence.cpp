// SPDX-License-Identifier: Apache-2.0

#include "surface/divergence.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "kernels/height_field.h"
#include "kernels/slopes.h"
#include "rows/border.h"

namespace tex::inline v1 {
namespace {

// Forward differences have no slope beyond the border: settle_border() makes it 0 in the texel that it wraps around to.
Wrap continuation(const Gradient& gradient, Wrap wrap) {
    return gradient.forward || wrap == Wrap::repeat ? Wrap::repeat : Wrap::mirror;
}

// -1 if a mirrored axis of n texels is seen from behind at index i, else 1.
float side_of(Wrap continued, int i, int n) {
    return continued == Wrap::mirror && wrap_around(i, 2 * n) >= n ? -1.0f : 1.0f;
}

// The slope of a ramp of slope 1 on a mirrored axis of n texels, in the first texels from the border.
WorkingVector<float> mirrored_ramp(const Gradient& gradient, int n) {
    WorkingVector<float> slopes;
    if (gradient.forward) return slopes;
    for (int i = 0; i < std::min(gradient.radius, n); ++i) {
        float slope = 0.0f;
        for (int k = 1; k <= gradient.radius; ++k) {
            const float weight = gradient.is_difference() ? 0.5f : gradient.derivative[static_cast<std::size_t>(k - 1)];
            const int rise = border_index(Wrap::mirror, i + k, n) - border_index(Wrap::mirror, i - k, n);
            slope += weight * static_cast<float>(rise);
        }
        slopes.push_back(slope);
    }
    return slopes;
}

void scale_row(float factor, int count, float* values) { shift_and_scale(0.0f, factor, count, values); }

}  // namespace

DivergenceRows::DivergenceRows(Extent extent, SlopesOf slopes, const Gradient& gradient, SurfaceAxis x, SurfaceAxis y)
    : extent_(extent), slopes_(std::move(slopes)), gradient_(gradient), x_(x), y_(y), radius_(gradient.radius),
      lead_(aligned_count(gradient.radius)), p_(Extent{2 * lead_ + extent.width, 2 * radius_ + 1}, 0.0f),
      q_(p_.extent(), 0.0f), beside_(Extent{2 * lead_ + extent.width, 3}, 0.0f),
      window_(static_cast<std::size_t>(2 * radius_ + 1)), ramp_x_(mirrored_ramp(gradient, extent.width)),
      ramp_y_(mirrored_ramp(gradient, extent.height)) {}

// The slopes of row `source` as those of an axis that repeats or is mirrored.
void DivergenceRows::settle_border(int source, float* p, float* q) {
    const int width = extent_.width, height = extent_.height;
    if (gradient_.forward) {
        // bake() looks to the right and upwards.
        if (x_.wrap == Wrap::clamp && width > 1) p[width - 2] = 0.5f * (p[width - 2] + p[width - 1]);
        if (x_.wrap != Wrap::repeat) p[width - 1] = 0.0f;
        if (y_.wrap == Wrap::clamp && source == 1) {
            slopes_(0, beside_.row(0), beside_.row(1));
            weighted_sum(q, 0.5f, beside_.row(1), 0.5f, width, q);
        }
        if (y_.wrap != Wrap::repeat && source == 0) scale_row(0.0f, width, q);
        return;
    }
    if (x_.wrap == Wrap::clamp) {
        for (int i = 0; i < static_cast<int>(ramp_x_.size()); ++i) {
            p[i] *= ramp_x_[static_cast<std::size_t>(i)];
            if (2 * i < width - 1) p[width - 1 - i] *= ramp_x_[static_cast<std::size_t>(i)];
        }
    }
    if (y_.wrap != Wrap::clamp) return;
    const auto from_border = static_cast<std::size_t>(std::min(source, height - 1 - source));
    if (from_border < ramp_y_.size()) scale_row(ramp_y_[from_border], width, q);
}

void DivergenceRows::extend(float* p, float* q) const {
    const int width = extent_.width;
    const Wrap continued = continuation(gradient_, x_.wrap);
    for (int k = 1; k <= radius_; ++k) {
        for (const int i : {-k, width - 1 + k}) {
            const int at = border_index(continued, i, width);
            p[i] = side_of(continued, i, width) * p[at];
            q[i] = q[at];
        }
    }
}

void DivergenceRows::fetch(int j) {
    const Wrap continued = continuation(gradient_, y_.wrap);
    const int slot = wrap_around(j, 2 * radius_ + 1);
    float* const p = p_.row(slot) + lead_;
    float* const q = q_.row(slot) + lead_;
    const int source = border_index(continued, j, extent_.height);
    slopes_(source, p, q);
    settle_border(source, p, q);
    if (side_of(continued, j, extent_.height) < 0.0f) scale_row(-1.0f, extent_.width, q);
    extend(p, q);
}

void DivergenceRows::make(int j, float* out) {
    if (!begun_) next_ = j - radius_;
    begun_ = true;
    for (; next_ <= j + radius_; ++next_) fetch(next_);
    const int width = extent_.width, window = 2 * radius_ + 1;
    const auto row_of = [&](Plane<float>& plane, int k) { return plane.row(wrap_around(j + k, window)) + lead_; };
    const float* const p = row_of(p_, 0);
    if (gradient_.forward) {
        sum_differences(p - 1, p, x_.ratio, row_of(q_, 1), row_of(q_, 0), y_.ratio, width, out);
        return;
    }
    if (gradient_.is_difference()) {
        sum_differences(p - 1, p + 1, 0.5f * x_.ratio, row_of(q_, 1), row_of(q_, -1), 0.5f * y_.ratio, width, out);
        return;
    }
    // The smoothing is its own transpose; the derivative changes its sign.
    const int padded = lead_ + width + radius_;
    auto place = window_.begin();
    for (int k = -radius_; k <= radius_; ++k) *place++ = row_of(p_, k) - lead_;
    smooth_column(window_.data(), gradient_.smoothing.data(), radius_, padded, beside_.row(0));
    derive_row(beside_.row(0) + lead_, gradient_.derivative.data(), radius_, width, beside_.row(2));
    place = window_.begin();
    for (int k = -radius_; k <= radius_; ++k) *place++ = row_of(q_, k) - lead_;
    derive_column(window_.data(), gradient_.derivative.data(), radius_, padded, beside_.row(0));
    smooth_row(beside_.row(0) + lead_, gradient_.smoothing.data(), radius_, width, beside_.row(1));
    weighted_sum(beside_.row(2), -x_.ratio, beside_.row(1), -y_.ratio, width, out);
}

}  // namespace tex::inline v1
