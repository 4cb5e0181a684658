// SPDX-License-Identifier: Apache-2.0

#include "checks/centre.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr int kValueBins = 1024;
constexpr float kBlack = 0.01f;

double median_of(const Stored& stored, const Background* background, Component component) {
    const Plane<float>& x = stored.image->planes[static_cast<std::size_t>(stored.channel(Component::x))];
    const Plane<float>& y = stored.image->planes[static_cast<std::size_t>(stored.channel(Component::y))];
    const Plane<float>& plane = component == Component::x ? x : y;
    std::vector<std::int64_t> bins(kValueBins);
    std::int64_t count = 0;
    for (const Rect& window : sample_windows(stored.extent())) {
        for (int j = window.y; j < window.y + window.height; ++j) {
            const float *const row = plane.row(j), *const of_x = x.row(j), *const of_y = y.row(j);
            for (int i = window.x; i < window.x + window.width; ++i) {
                const float value = row[i];
                if (background != nullptr && background->holds(i, j)) continue;
                if (!(std::max(of_x[i], of_y[i]) > kBlack) || !(value >= 0.0f && value <= 1.0f)) continue;
                ++bins[static_cast<std::size_t>(value * static_cast<float>(kValueBins - 1))];
                ++count;
            }
        }
    }
    if (count == 0) return 0.5;
    std::size_t bin = 0;
    for (std::int64_t below = bins[0]; 2 * below < count; below += bins[bin]) ++bin;
    return static_cast<double>(bin) / (kValueBins - 1);
}

}  // namespace

double Centre::distance(double value) const { return std::max(std::abs(x - value), std::abs(y - value)); }

Centre measure_centre(const Stored& stored, const Background* background) {
    return {median_of(stored, background, Component::x), median_of(stored, background, Component::y)};
}

double srgb_encoded(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * math::pow(c, 1.0 / 2.4) - 0.055; }
double srgb_decoded(double c) { return c <= 0.04045 ? c / 12.92 : math::pow((c + 0.055) / 1.055, 2.4); }

}  // namespace tex::inline v1
