// SPDX-License-Identifier: Apache-2.0
// vectors.h: vectors of meshes, in float and in a fixed order of operations.
//
// The folder mesh/ holds what happens to triangles: readers of mesh files, welding, neighbours, tangents. Its rule: it
// opens no file itself (a reader is given bytes, and a function that loads a file beside the first one) and includes no
// header of a verb. Counts that a file states are checked against the bytes that it holds before memory is allocated.
// Recursion never depends on a file.

#pragma once

#include <cmath>
#include <limits>

#include <tex/mesh.h>

namespace tex::inline v1 {

inline Float3 operator+(Float3 a, Float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Float3 operator-(Float3 a, Float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Float3 operator*(float s, Float3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline float dot(Float3 a, Float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float length(Float3 a) { return std::sqrt(dot(a, a)); }
inline Float3 cross(Float3 a, Float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline bool same(Float3 a, Float3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
inline bool same(Float2 a, Float2 b) { return a.x == b.x && a.y == b.y; }

inline bool is_finite(Float2 a) { return std::isfinite(a.x) && std::isfinite(a.y); }
inline bool is_finite(Float3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline bool is_finite(Float4 a) { return is_finite(Float3{a.x, a.y, a.z}) && std::isfinite(a.w); }

}  // namespace tex::inline v1
