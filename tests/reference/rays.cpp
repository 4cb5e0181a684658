// SPDX-License-Identifier: Apache-2.0

#include "reference/rays.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tex::reference {
namespace {

Point moved(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

using Long = std::array<long double, 3>;

Long widened(const Point& p) { return {p[0], p[1], p[2]}; }
Long apart(const Long& a, const Long& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Long cross(const Long& a, const Long& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double dot(const Long& a, const Long& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void keep(PlainHit& best, const PlainHit& hit) {
    if (!best.found || hit.t < best.t) best = hit;
}

}  // namespace

PlainHit first_hit(const std::vector<PlainTriangle>& triangles, const Point& origin, const Point& direction,
                   double length, int facing) {
    std::size_t z = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        if (std::abs(direction[k]) > std::abs(direction[z])) z = k;
    }
    std::size_t x = (z + 1) % 3, y = (x + 1) % 3;
    if (direction[z] < 0.0) std::swap(x, y);
    const double sx = direction[x] / direction[z], sy = direction[y] / direction[z], sz = 1.0 / direction[z];
    PlainHit best;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const Point a = moved(triangles[k][0], origin), b = moved(triangles[k][1], origin),
                    c = moved(triangles[k][2], origin);
        const double ax = a[x] - sx * a[z], ay = a[y] - sy * a[z], bx = b[x] - sx * b[z], by = b[y] - sy * b[z],
                     cx = c[x] - sx * c[z], cy = c[y] - sy * c[z];
        const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
        const bool front = u >= 0.0 && v >= 0.0 && w >= 0.0, back = u <= 0.0 && v <= 0.0 && w <= 0.0;
        if (!(facing > 0 ? front : facing < 0 ? back : front || back)) continue;
        const double area = u + v + w;
        if (area == 0.0) continue;
        const double t = (u * (sz * a[z]) + v * (sz * b[z]) + w * (sz * c[z])) / area;
        if (!(t >= 0.0 && t <= length)) continue;
        keep(best, {true, t, {u / area, v / area, w / area}, static_cast<std::uint32_t>(k)});
    }
    return best;
}

PlainHit clear_hit(const std::vector<PlainTriangle>& triangles, const Point& origin, const Point& direction,
                   double length, int facing, double margin) {
    PlainHit best;
    const Long d = widened(direction);
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const Long a = apart(widened(triangles[k][0]), widened(origin)),
                   b = apart(widened(triangles[k][1]), widened(origin)),
                   c = apart(widened(triangles[k][2]), widened(origin));
        // Seen counter-clockwise, all are negative.
        const long double u = dot(d, cross(b, c)), v = dot(d, cross(c, a)), w = dot(d, cross(a, b));
        const long double area = u + v + w;
        if (area == 0.0L || (facing > 0 && area > 0.0L) || (facing < 0 && area < 0.0L)) continue;
        if (std::min({u / area, v / area, w / area}) < static_cast<long double>(margin)) continue;
        const Long normal = cross(apart(b, a), apart(c, a));
        const auto t = static_cast<double>(dot(normal, a) / dot(normal, d));
        if (!(t >= 0.0 && t <= length)) continue;
        keep(best, {true,
                    t,
                    {static_cast<double>(u / area), static_cast<double>(v / area), static_cast<double>(w / area)},
                    static_cast<std::uint32_t>(k)});
    }
    return best;
}

double nearest_squared(const std::vector<PlainTriangle>& triangles, const Point& p) {
    double best = INFINITY;
    for (const PlainTriangle& triangle : triangles) {
        double v = 1.0 / 3.0, w = 1.0 / 3.0, step = 1.0 / 3.0, least = INFINITY;
        for (int round = 0; round < 60; ++round, step *= 0.7) {
            double next_v = v, next_w = w;
            for (int i = -2; i <= 2; ++i) {
                for (int j = -2; j <= 2; ++j) {
                    double tv = std::max(0.0, v + i * step), tw = std::max(0.0, w + j * step);
                    const double sum = std::max(1.0, tv + tw);
                    tv /= sum;
                    tw /= sum;
                    double squared = 0.0;
                    for (std::size_t k = 0; k < 3; ++k) {
                        const double at =
                            (1.0 - tv - tw) * triangle[0][k] + tv * triangle[1][k] + tw * triangle[2][k] - p[k];
                        squared += at * at;
                    }
                    if (squared >= least) continue;
                    least = squared;
                    next_v = tv;
                    next_w = tw;
                }
            }
            v = next_v;
            w = next_w;
        }
        best = std::min(best, least);
    }
    return best;
}

}  // namespace tex::reference
