// SPDX-License-Identifier: Apache-2.0

#include "mesh/node_transform.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "mesh/vectors.h"

namespace tex::inline v1 {
namespace {

Error bad_node(const std::string& node, const char* what) {
    return {ErrorCode::bad_data, {}, "node \"" + node + "\": its matrix " + what};
}

double cofactor(const NodeTransform::Rows& m, std::size_t i, std::size_t j) {
    const std::size_t r0 = (i + 1) % 3, r1 = (i + 2) % 3, c0 = (j + 1) % 3, c1 = (j + 2) % 3;
    return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
}

struct Double3 {
    double x, y, z;
};

Double3 times(const NodeTransform::Rows& m, Float3 v) {
    const auto x = static_cast<double>(v.x), y = static_cast<double>(v.y), z = static_cast<double>(v.z);
    return {m[0][0] * x + m[0][1] * y + m[0][2] * z, m[1][0] * x + m[1][1] * y + m[1][2] * z,
            m[2][0] * x + m[2][1] * y + m[2][2] * z};
}

Float3 rounded(Double3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

// A vector without length stays as it is.
Float3 unit(Double3 v) {
    const double n = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return n > 0.0 ? rounded({v.x / n, v.y / n, v.z / n}) : rounded(v);
}

}  // namespace

Float3 NodeTransform::position(Float3 p) const {
    const Double3 moved = times(linear_, p);
    return rounded({moved.x + shift_[0], moved.y + shift_[1], moved.z + shift_[2]});
}

Float3 NodeTransform::normal(Float3 n) const { return unit(times(normals_, n)); }

Float4 NodeTransform::tangent(Float4 t) const {
    const Float3 turned = unit(times(linear_, {t.x, t.y, t.z}));
    return {turned.x, turned.y, turned.z, static_cast<float>(sign_) * t.w};
}

Result<NodeTransform> NodeTransform::make(const std::string& node, const std::array<double, 12>& to_scene) {
    const std::array<double, 12>& a = to_scene;
    NodeTransform made;
    Rows& m = made.linear_;
    m = {{{a[0], a[1], a[2]}, {a[4], a[5], a[6]}, {a[8], a[9], a[10]}}};
    made.shift_ = {a[3], a[7], a[11]};
    made.determinant_ = m[0][0] * cofactor(m, 0, 0) + m[0][1] * cofactor(m, 0, 1) + m[0][2] * cofactor(m, 0, 2);
    if (!std::isfinite(made.determinant_) || made.determinant_ == 0.0) return bad_node(node, "is not invertible");
    made.sign_ = made.determinant_ < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) made.normals_[i][j] = made.sign_ * cofactor(m, i, j);
    }
    return made;
}

bool NodeTransform::is_identity() const {
    const Rows one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return linear_ == one && shift_[0] == 0.0 && shift_[1] == 0.0 && shift_[2] == 0.0;
}

NodeTransform::Rows NodeTransform::inverse() const {
    Rows inverse{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) inverse[i][j] = cofactor(linear_, j, i) / determinant_;
    }
    return inverse;
}

bool NodeTransform::keeps_finite(double largest) const {
    constexpr double kMost = 1e38, kMostNormal = 1e200;  // of floats; of sums whose squares are no matter
    bool keeps = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const double sum = std::abs(linear_[i][0]) + std::abs(linear_[i][1]) + std::abs(linear_[i][2]);
        keeps = keeps && sum * largest + std::abs(shift_[i]) < kMost;
        for (const double value : normals_[i]) keeps = keeps && std::abs(value) < kMostNormal;
    }
    return keeps;
}

Result<void> NodeTransform::check(const MeshPart& part, const std::string& node) const {
    for (const Float3& p : part.positions) {
        if (!is_finite(position(p))) return bad_node(node, "makes infinite coordinates");
    }
    for (const Float3& n : part.normals) {
        if (!is_finite(normal(n))) return bad_node(node, "makes infinite normals");
    }
    return {};
}

}  // namespace tex::inline v1
