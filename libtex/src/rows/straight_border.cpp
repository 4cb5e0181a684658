// SPDX-License-Identifier: Apache-2.0

#include "rows/straight_border.h"

#include <algorithm>

#include "kernels/deband.h"
#include "rows/border.h"

namespace tex::inline v1 {

void continue_ends(float* row, int width, Wrap wrap) {
    const float left = row[0] - row[std::min(1, width - 1)];
    const float right = row[width - 1] - row[std::max(0, width - 2)];
    for (int k = 1; k <= kStraightApron; ++k) {
        const auto texels = static_cast<float>(k);
        const bool straight = wrap == Wrap::clamp;
        row[-k] = straight ? row[0] + texels * left : row[border_index(wrap, -k, width)];
        row[width - 1 + k] = straight ? row[width - 1] + texels * right : row[border_index(wrap, width - 1 + k, width)];
    }
}

void straight_row(const Plane<float>& plane, Wrap wrap_y, int j, float* out) {
    const auto [width, height] = plane.extent();
    const int edge = border_index(wrap_y, j, height);
    if (wrap_y != Wrap::clamp || j == edge) {
        std::copy_n(plane.row(edge), width, out);
        return;
    }
    const int inner = std::clamp(j < 0 ? 1 : height - 2, 0, height - 1);
    const auto distance = static_cast<float>(j < 0 ? -j : j - edge);
    extrapolate_row(plane.row(edge), plane.row(inner), distance, width, out);
}

}  // namespace tex::inline v1
