// SPDX-License-Identifier: Apache-2.0
// frames.h: the vectors with which an engine decodes a texel of a normal map, in double.

#pragma once

#include <array>
#include <optional>

#include <tex/mesh.h>
#include <tex/types.h>

#include "kernels/corner_vectors.h"
#include "mesh/vector3.h"

namespace tex::inline v1 {

// T', B' and N' of mesh.h. They need be neither unit nor perpendicular.
struct Frame {
    Vector3 t, b, n;
};

// The frames of a triangle, for one decoder.
class CornerFrames {
public:
    CornerFrames() = default;
    CornerFrames(const TangentSpace& space, std::size_t triangle);
    CornerFrames(const std::array<Float3, 3>& normals, const std::array<Float4, 3>& tangents, Decoder decoder);

    // At the point with these weights of the corners.
    [[nodiscard]] Frame at(const std::array<double, 3>& weights) const;
    // For encode_vectors(), which encodes at many points.
    [[nodiscard]] FrameCorners corners() const;

private:
    void set(std::size_t k, const Float3& n, const Float4& t);

    std::array<Vector3, 3> normals_, tangents_, bitangents_;
    std::array<double, 3> signs_{};
    Decoder decoder_ = Decoder::gltf;
};

// Errors: bad_option (no normals, no such set of UVs, not as many tangents as corners).
[[nodiscard]] Result<void> check_space(const TangentSpace& space);

// Whether both decoders make the same vectors.
[[nodiscard]] bool same_vectors(Decoder a, Decoder b);

// The texel t as the decoder reads it: see rebuilds_z().
[[nodiscard]] Vector3 read_texel(Decoder decoder, Vector3 t);

// n = normalize(x T' + y B' + z N'), or N' if that has no length.
[[nodiscard]] Vector3 decode(const Frame& frame, Vector3 t);

// The inverse: the t that decodes to n. Nothing if T', B' and N' lie in one plane.
[[nodiscard]] std::optional<Vector3> encode(const Frame& frame, Vector3 n);

}  // namespace tex::inline v1
