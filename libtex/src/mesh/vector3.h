// SPDX-License-Identifier: Apache-2.0
// vector3.h: vectors of meshes in double, in a fixed order of operations.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <tex/mesh.h>

namespace tex::inline v1 {

struct Vector3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

inline Vector3 vector_of(Float3 a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

inline Vector3 vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

inline Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector3 operator*(double s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector3 cross(Vector3 a, Vector3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A vector shorter than 1e-30 stays as it is.
inline Vector3 normalized(Vector3 v) {
    const double n = std::sqrt(dot(v, v));
    return n > 1e-30 ? (1.0 / n) * v : v;
}

inline Vector3 mix(const std::array<Vector3, 3>& v, const std::array<double, 3>& weights) {
    return weights[0] * v[0] + weights[1] * v[1] + weights[2] * v[2];
}

// The layout that kernels/corner_vectors.h wants: rows[corner][axis].
inline void copy_to(const std::array<Vector3, 3>& v, double (&rows)[3][3]) {
    for (std::size_t k = 0; k < 3; ++k) {
        rows[k][0] = v[k].x;
        rows[k][1] = v[k].y;
        rows[k][2] = v[k].z;
    }
}

}  // namespace tex::inline v1
