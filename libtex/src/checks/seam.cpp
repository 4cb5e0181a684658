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

SeamSteps steps_of(const Stored& stored, Component component, bool columns) {
    const Extent extent = stored.extent();
    const int lines = columns ? extent.width : extent.height;
    const int length = columns ? extent.height : extent.width;
    SeamSteps found;
    found.of_columns = columns;
    if (lines < kLeastLines) return found;
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
    found.border = steps.back();
    steps.pop_back();
    found.largest = *std::max_element(steps.begin(), steps.end());
    const auto rank = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) * 98 / 100);
    std::nth_element(steps.begin(), rank, steps.end());
    found.usual = std::max(*rank, kLeastStep);
    return found;
}

}  // namespace

double Seam::worst() const {
    double most = 0.0;
    for (const SeamSteps& each : steps) most = std::max(most, each.ratio());
    return most;
}

const SeamSteps* Seam::worst_standing_out() const {
    const SeamSteps* worst = nullptr;
    for (const SeamSteps& each : steps) {
        if (each.stands_out() && (worst == nullptr || each.ratio() > worst->ratio())) worst = &each;
    }
    return worst;
}

Seam measure_seam(const Stored& stored) {
    return {{steps_of(stored, Component::x, true), steps_of(stored, Component::y, true),
             steps_of(stored, Component::x, false), steps_of(stored, Component::y, false)}};
}

}  // namespace tex::inline v1
