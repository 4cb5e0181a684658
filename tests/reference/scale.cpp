// SPDX-License-Identifier: Apache-2.0

#include "reference/scale.h"

#include <algorithm>
#include <cmath>

namespace tex::reference {

Vector scaled(Vector n, double scale, ScaleMode mode) {
    const double x = scale * n.x;
    const double y = scale * n.y;
    if (mode == ScaleMode::slope) return normalised({x, y, std::max(n.z, 0.0)});
    return normalised({x, y, std::sqrt(1.0 - std::clamp(x * x + y * y, 0.0, 1.0))});
}

}  // namespace tex::reference
