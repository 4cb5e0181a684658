// SPDX-License-Identifier: Apache-2.0

#include "mesh/uv_transform.h"

#include <cmath>

#include "rows/math.h"

namespace tex::inline v1 {
namespace {

struct Turn {
    double cosine = 1.0, sine = 0.0;
};

// Files round a quarter turn to 1.5707964: without its exact cosine, the edges of charts would leave the edges of
// texels.
Turn turn_of(double radians) {
    constexpr double kQuarter = 1.5707963267948966, kNear = 1e-6;
    const double quarters = radians / kQuarter, whole = std::floor(quarters + 0.5);
    if (std::abs(quarters - whole) > kNear) return {math::cos(radians), math::sin(radians)};
    const double rest = whole - 4.0 * std::floor(whole / 4.0);
    if (rest == 1.0) return {0.0, 1.0};
    if (rest == 2.0) return {-1.0, 0.0};
    return rest == 3.0 ? Turn{0.0, -1.0} : Turn{};
}

}  // namespace

void move_uvs(std::vector<Float2>& uvs, const UvTransform& transform, YAxis v_axis) {
    const Turn turn = turn_of(transform.rotation);
    const bool up = v_axis == YAxis::up;
    for (Float2& uv : uvs) {
        const double u = transform.scale_x * static_cast<double>(uv.x);
        const double v = transform.scale_y * (up ? 1.0 - static_cast<double>(uv.y) : static_cast<double>(uv.y));
        const double moved = transform.offset_y - turn.sine * u + turn.cosine * v;
        uv.x = static_cast<float>(transform.offset_x + turn.cosine * u + turn.sine * v);
        uv.y = static_cast<float>(up ? 1.0 - moved : moved);
    }
}

}  // namespace tex::inline v1
