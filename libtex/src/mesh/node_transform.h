// SPDX-License-Identifier: Apache-2.0
// node_transform.h: what a node's matrix makes of the vertices of a part: in_scene() of mesh.h, one by one.

#pragma once

#include <array>
#include <string>

#include <tex/mesh.h>

namespace tex::inline v1 {

class NodeTransform {
public:
    // Errors: bad_data (the matrix is not invertible or not finite). They name the node.
    static Result<NodeTransform> make(const std::string& node, const std::array<double, 12>& to_scene);

    // Corners change places, so that triangles stay counter-clockwise.
    [[nodiscard]] bool is_mirrored() const { return sign_ < 0.0; }
    [[nodiscard]] bool is_identity() const;

    [[nodiscard]] Float3 position(Float3 p) const;
    [[nodiscard]] Float3 normal(Float3 n) const;
    [[nodiscard]] Float4 tangent(Float4 t) const;

    // Whether coordinates up to this size stay finite, for certain.
    [[nodiscard]] bool keeps_finite(double largest) const;
    // Errors: bad_data, if attributes of the part would be infinite there. Tangents are not looked at.
    [[nodiscard]] Result<void> check(const MeshPart& part, const std::string& node) const;

    using Rows = std::array<std::array<double, 3>, 3>;
    [[nodiscard]] const Rows& linear() const { return linear_; }
    [[nodiscard]] const std::array<double, 3>& shift() const { return shift_; }
    // The inverse of linear(), which may have infinite or undefined elements.
    [[nodiscard]] Rows inverse() const;

private:
    Rows linear_{}, normals_{};  // the inverse transpose, without the factor 1 / |determinant|
    std::array<double, 3> shift_{};
    double sign_ = 1.0, determinant_ = 1.0;
};

}  // namespace tex::inline v1
