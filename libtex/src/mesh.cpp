// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <cmath>
#include <utility>

#include "mesh/vectors.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

Error bad(std::string reason) { return {ErrorCode::bad_data, {}, std::move(reason)}; }

// Checks that an attribute has an element for every vertex, or is absent, and that its numbers are finite.
template <class T>
Result<void> check_attribute(const std::vector<T>& values, std::size_t vertices, const std::string& what) {
    if (values.empty()) return {};
    if (values.size() != vertices) {
        return bad(what + "s: " + std::to_string(values.size()) + " for " + std::to_string(vertices) + " vertices");
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (!is_finite(values[k])) return bad(what + " " + std::to_string(k) + " is not a finite number");
    }
    return {};
}

// A 3x3 matrix of doubles, in rows.
struct Linear {
    double m[3][3];

    [[nodiscard]] double cofactor(int i, int j) const {
        const int r0 = (i + 1) % 3, r1 = (i + 2) % 3, c0 = (j + 1) % 3, c1 = (j + 2) % 3;
        return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
    }
    [[nodiscard]] double determinant() const {
        return m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    }
};

struct Double3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

Double3 times(const Linear& a, Float3 v) {
    const auto x = static_cast<double>(v.x), y = static_cast<double>(v.y), z = static_cast<double>(v.z);
    return {a.m[0][0] * x + a.m[0][1] * y + a.m[0][2] * z, a.m[1][0] * x + a.m[1][1] * y + a.m[1][2] * z,
            a.m[2][0] * x + a.m[2][1] * y + a.m[2][2] * z};
}

Float3 rounded(Double3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

// A vector without length stays as it is.
Float3 unit(Double3 v) {
    const double n = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return n > 0.0 ? rounded({v.x / n, v.y / n, v.z / n}) : rounded(v);
}

Result<void> transform(MeshPart& part, const MeshNode& node) {
    const std::array<double, 12>& a = node.to_scene;
    const Linear linear{{{a[0], a[1], a[2]}, {a[4], a[5], a[6]}, {a[8], a[9], a[10]}}};
    const double determinant = linear.determinant();
    if (!std::isfinite(determinant) || determinant == 0.0)
        return bad("node \"" + node.name + "\": its matrix is not invertible");
    const double sign = determinant < 0.0 ? -1.0 : 1.0;
    Linear normals{};  // the inverse transpose, without the factor 1 / |determinant|, which normalising removes
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) normals.m[i][j] = sign * linear.cofactor(i, j);
    }
    for (Float3& p : part.positions) {
        const Double3 moved = times(linear, p);
        p = rounded({moved.x + a[3], moved.y + a[7], moved.z + a[11]});
        if (!is_finite(p)) return bad("node \"" + node.name + "\": its matrix makes infinite coordinates");
    }
    for (Float3& n : part.normals) {
        n = unit(times(normals, n));
        if (!is_finite(n)) return bad("node \"" + node.name + "\": its matrix makes infinite normals");
    }
    for (Float4& t : part.tangents) {
        const Float3 turned = unit(times(linear, {t.x, t.y, t.z}));
        if (!is_finite(turned)) return bad("node \"" + node.name + "\": its matrix makes infinite tangents");
        t = {turned.x, turned.y, turned.z, static_cast<float>(sign) * t.w};
    }
    if (determinant < 0.0) {
        part.quads.clear();
        for (std::size_t k = 0; k < part.indices.size(); k += 3) std::swap(part.indices[k + 1], part.indices[k + 2]);
    }
    return {};
}

}  // namespace

Result<void> check_part(const MeshPart& part) {
    return no_throw([&]() -> Result<void> {
        const std::size_t vertices = part.positions.size();
        if (part.indices.empty()) return bad("has no triangles");
        if (part.indices.size() % 3 != 0) {
            return bad("has " + std::to_string(part.indices.size()) + " corners, which are not whole triangles");
        }
        if (part.triangles() > kMaxTriangles) return bad("has more than 2^28 triangles");
        if (auto checked = check_attribute(part.positions, vertices, "position"); !checked) return checked;
        if (auto checked = check_attribute(part.normals, vertices, "normal"); !checked) return checked;
        if (auto checked = check_attribute(part.tangents, vertices, "tangent"); !checked) return checked;
        if (auto checked = check_attribute(part.colors, vertices, "color"); !checked) return checked;
        for (const std::vector<Float2>& set : part.uvs) {
            if (set.empty()) return bad("a set of UVs is empty");
            if (auto checked = check_attribute(set, vertices, "UV"); !checked) return checked;
        }
        for (std::size_t k = 0; k < part.indices.size(); ++k) {
            if (part.indices[k] >= vertices) {
                return bad("index " + std::to_string(part.indices[k]) + " of triangle " + std::to_string(k / 3) +
                           " is out of range: there are " + std::to_string(vertices) + " vertices");
            }
        }
        for (std::size_t k = 0; k < part.quads.size(); ++k) {
            if (part.quads[k] + std::size_t{1} >= part.triangles() || (k > 0 && part.quads[k] <= part.quads[k - 1]))
                return bad("quad " + std::to_string(k) + " is not of two triangles after those before it");
        }
        return {};
    });
}

Result<MeshPart> in_scene(MeshPart part, const MeshNode& node) {
    return no_throw([&]() -> Result<MeshPart> {
        if (auto sound = check_part(part); !sound) return sound.error();
        if (const auto done = transform(part, node); !done) return done.error();
        return std::move(part);
    });
}

}  // namespace tex::inline v1
