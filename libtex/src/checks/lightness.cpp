// SPDX-License-Identifier: Apache-2.0

#include "checks/lightness.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tex::inline v1 {

std::array<double, 3> with_lightness(const std::array<double, 3>& color, double by) {
    const auto [least, most] = std::minmax({color[0], color[1], color[2]});
    // The chroma that a lightness leaves room for: none at black and white.
    const auto room = [](double lightness) { return 1.0 - std::abs(2.0 * lightness - 1.0); };
    const double before = 0.5 * (least + most), after = std::clamp(by * before, 0.0, 1.0);
    const double chroma = room(before) > 0.0 ? room(after) / room(before) : 0.0;
    std::array<double, 3> made{};
    for (std::size_t k = 0; k < 3; ++k) made[k] = std::clamp(after + chroma * (color[k] - before), 0.0, 1.0);
    return made;
}

}  // namespace tex::inline v1
