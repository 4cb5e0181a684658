// SPDX-License-Identifier: Apache-2.0

#include "checks/seam.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tex::inline v1 {
namespace {

constexpr int kLeastLines = 8;
constexpr double kLeastStep = 1.0 / 255.0;  // half a code

// The mean step between the last line and the first, divided by nearly the largest of the mean steps inside, because
// the map's own lines (joints between bricks) are not seams.
double ratio_of(const Stored& stored, bool columns) {
    const Extent extent = stored.extent();
    const int lines = columns ? extent.width : extent.height;
    const int length = columns ? extent.height : extent.width;
    if (lines < kLeastLines) return 0.0;
    double worst = 0.0;
    for (const Component component : {Component::x, Component::y}) {
        const int channel = stored.channel(component);
        std::vector<double> steps(static_cast<std::size_t>(lines));
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const int ni = columns ? (i + 1) % extent.width : i, nj = columns ? j : (j + 1) % extent.height;
                const double step =
                    std::abs(static_cast<double>(stored.component(channel, ni, nj)) - stored.component(channel, i, j));
                if (step <= 2.0) steps[static_cast<std::size_t>(columns ? i : j)] += step / length;  // false for NaN
            }
        }
        const double border = steps.back();
        steps.pop_back();
        const auto rank = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) * 98 / 100);
        std::nth_element(steps.begin(), rank, steps.end());
        worst = std::max(worst, border / std::max(*rank, kLeastStep));
    }
    return worst;
}

}  // namespace

Seam measure_seam(const Stored& stored) { return {ratio_of(stored, true), ratio_of(stored, false)}; }

}  // namespace tex::inline v1
