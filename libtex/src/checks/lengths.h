// SPDX-License-Identifier: Apache-2.0
// lengths.h: how far vectors are from unit vectors once their stored values are changed.

#pragma once

#include <cmath>
#include <cstddef>

#include "checks/stored.h"

namespace tex::inline v1 {

// The channel of z, or blue where no channel was taken for z, because its values do not fit as they are stored.
inline int channel_like_z(const Stored& stored) {
    if (stored.has_z()) return stored.channel(Component::z);
    const bool is_free = stored.channel(Component::x) == 0 && stored.channel(Component::y) == 1;
    return is_free && stored.image->planes.size() >= 3 ? 2 : -1;
}

// Calls `visit` with the stored values of x, y and z of every 7th sampled texel, and its column and row.
template <class Visit>
void visit_samples(const Stored& stored, Visit&& visit) {
    constexpr int kStep = 7;
    const int channels[3] = {stored.channel(Component::x), stored.channel(Component::y), channel_like_z(stored)};
    for (const Rect& window : sample_windows(stored.extent())) {
        for (int k = 0; k < window.width * window.height; k += kStep) {
            const int i = window.x + k % window.width, j = window.y + k / window.width;
            double c[3];
            for (std::size_t n = 0; n < 3; ++n)
                c[n] = stored.image->planes[static_cast<std::size_t>(channels[n])].at(i, j);
            visit(c, i, j);
        }
    }
}

// The mean of |length - 1| over these texels, after `restore` is applied to the values.
template <class Restore>
double length_error(const Stored& stored, Restore&& restore) {
    double sum = 0.0, count = 0.0;
    visit_samples(stored, [&](const double(&c)[3], int i, int j) {
        double square = 0.0;
        for (const double value : c) {
            const double n = 2.0 * restore(value, i, j) - 1.0;
            square += n * n;
        }
        if (!(square < 100.0)) return;
        sum += std::abs(std::sqrt(square) - 1.0);
        count += 1.0;
    });
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace tex::inline v1
