// SPDX-License-Identifier: Apache-2.0
// vector.h: vectors of the preview renderer, and the angles that <cmath> would compute differently on other machines.

#pragma once

#include <cmath>

#include "rows/math.h"

namespace tex::inline v1::render {

struct Vec2 {
    double x = 0.0, y = 0.0;
};

struct Vec3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(Vec2 a, double s) { return {a.x * s, a.y * s}; }
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }

inline Vec3 times(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec2 a) { return std::sqrt(a.x * a.x + a.y * a.y); }
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }

// A vector that is shorter than 1e-6 or contains NaN becomes (0, 0, 1).
inline Vec3 normalize(Vec3 a) {
    const double n = length(a);
    return n >= 1e-6 ? a * (1.0 / n) : Vec3{0.0, 0.0, 1.0};
}

// The angle of (x, y) from the x axis, -pi to pi; 0 at the origin.
inline double angle_of(double y, double x) {
    if (x > 0.0) return math::atan(y / x);
    if (x < 0.0) return math::atan(y / x) + (y < 0.0 ? -math::kPi : math::kPi);
    return y > 0.0 ? math::kPi / 2.0 : y < 0.0 ? -math::kPi / 2.0 : 0.0;
}

inline double radians(double degrees) { return degrees * (math::kPi / 180.0); }
inline double degrees(double radians) { return radians * (180.0 / math::kPi); }

// Rotations about the vertical axis (to the right, as seen by a viewer at +z) and about the axis towards the viewer.
inline Vec3 turn_about_y(Vec3 a, double sine, double cosine) {
    return {a.x * cosine + a.z * sine, a.y, a.z * cosine - a.x * sine};
}
inline Vec3 turn_about_z(Vec3 a, double sine, double cosine) {
    return {a.x * cosine - a.y * sine, a.x * sine + a.y * cosine, a.z};
}

}  // namespace tex::inline v1::render
