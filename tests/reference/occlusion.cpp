// SPDX-License-Identifier: Apache-2.0

#include "reference/occlusion.h"

#include <algorithm>
#include <cmath>

namespace tex::reference {
namespace {

constexpr double kPi = 3.14159265358979323846;

int wrapped(Wrap wrap, int i, int n) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, n - 1);
    const int period = wrap == Wrap::mirror ? 2 * n : n;
    const int r = ((i % period) + period) % period;
    return r < n ? r : period - 1 - r;
}

double height_at(const HeightField& field, double x, double y) {
    const Extent extent = field.height.extent();
    const double left = std::floor(x), top = std::floor(y);
    const auto at = [&](int i, int j) {
        return static_cast<double>(field.height.at(wrapped(field.wrap_x, static_cast<int>(left) + i, extent.width),
                                                   wrapped(field.wrap_y, static_cast<int>(top) + j, extent.height)));
    };
    const double u = x - left, v = y - top;
    return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
}

}  // namespace

double horizon_of(const HeightField& field, int column, int row, double x, double y, double distance) {
    const Extent extent = field.height.extent();
    const double strength = static_cast<double>(field.bumpiness_x);
    const double tall = strength / static_cast<double>(field.bumpiness_y);
    const double own = static_cast<double>(field.height.at(column, row));
    const double far = extent.width + extent.height * tall;
    double tangent = distance > 0.0 ? -1e9 : 0.0;
    for (double way = 0.25; way < far; way += 0.25) {
        const double rise = (height_at(field, column + way * x, row - way * y / tall) - own) * strength;
        tangent = std::max(tangent, rise / way - (distance > 0.0 ? way / distance : 0.0));
    }
    return tangent;
}

Sky sky_of(const HeightField& field, int column, int row, double p, double q, int directions, double distance) {
    constexpr int kAngles = 200;
    Sky sky;
    const double length = std::sqrt(1.0 + p * p + q * q);
    double sum[3] = {};
    for (int k = 0; k < directions; ++k) {
        const double turn = 2.0 * kPi * (k + 0.5) / directions, x = std::cos(turn), y = std::sin(turn);
        const double start = std::atan(horizon_of(field, column, row, x, y, distance));
        sky.sky_view += (1.0 - std::sin(std::max(start, 0.0))) / directions;
        const double step = (kPi / 2 - start) / kAngles;
        for (int a = 0; a < kAngles; ++a) {
            const double angle = start + (a + 0.5) * step, level = std::cos(angle), up = std::sin(angle);
            const double cosine = std::max(0.0, (up - (p * x + q * y) * level) / length);
            const double light = cosine * level * step * 2.0 / directions;
            sky.occlusion += light;
            sum[0] += light * level * x;
            sum[1] += light * level * y;
            sum[2] += light * up;
        }
    }
    const double norm = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int c = 0; c < 3; ++c) sky.bent[c] = sum[c] / norm;
    return sky;
}

}  // namespace tex::reference
