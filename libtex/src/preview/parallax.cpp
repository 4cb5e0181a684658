// SPDX-License-Identifier: Apache-2.0

#include "preview/parallax.h"

#include <algorithm>

namespace tex::inline v1::render {

Vec2 parallax_offset(const Parallax& parallax, const Relief& relief, Vec2 uv, const Footprint& footprint, Vec3 view,
                     int anisotropy) {
    const double amount = parallax.amount, limit = parallax.limit;
    // At a grazing angle the quotient overflows to infinity, which the clamp handles. Only 0 / 0 must be avoided.
    const double z = std::max(view.z, 1e-12);
    const auto offset_at = [&](double t) {
        const double rise = amount * (t - 0.5);
        return Vec2{std::clamp(rise * view.x / z, -limit, limit), std::clamp(rise * view.y / z, -limit, limit)};
    };
    const auto height_at = [&](Vec2 place) {
        return sample(relief.heights, place, footprint, anisotropy)[0] / relief.white;
    };
    if (parallax.steps <= 0) return offset_at(height_at(uv));

    double above = 1.0 - height_at(uv + offset_at(1.0));  // height of the ray above the map at the last step
    double last = 1.0;
    for (int k = 1; above > 0.0 && k <= parallax.steps; ++k) {
        const double t = 1.0 - static_cast<double>(k) / parallax.steps;
        const double now = t - height_at(uv + offset_at(t));
        if (now <= 0.0) return offset_at(last + (t - last) * (above / (above - now)));
        above = now;
        last = t;
    }
    return offset_at(last);
}

}  // namespace tex::inline v1::render
