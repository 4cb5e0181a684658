// SPDX-License-Identifier: Apache-2.0

#include "mesh/frames.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tex::inline v1 {

Result<void> check_space(const TangentSpace& space) {
    if (space.part.normals.empty()) return Error{ErrorCode::bad_option, {}, "the mesh has no normals"};
    if (space.uv_set < 0 || static_cast<std::size_t>(space.uv_set) >= space.part.uvs.size())
        return Error{ErrorCode::bad_option, {}, "the mesh has no UV set " + std::to_string(space.uv_set)};
    if (space.tangents.size() != space.part.indices.size())
        return Error{ErrorCode::bad_option, {}, "the mesh has not one tangent for each corner"};
    return {};
}

bool same_vectors(Decoder a, Decoder b) { return decoder_kind(a) == decoder_kind(b); }

inline void CornerFrames::set(std::size_t k, const Float3& n, const Float4& t) {
    normals_[k] = normalized(vector_of(n));
    tangents_[k] = normalized(vector_of(Float3{t.x, t.y, t.z}));
    signs_[k] = t.w < 0.0f ? -1.0 : 1.0;
    bitangents_[k] = signs_[k] * cross(normals_[k], tangents_[k]);
    if (decoder_kind(decoder_) == DecoderKind::normalized) bitangents_[k] = normalized(bitangents_[k]);
}

CornerFrames::CornerFrames(const TangentSpace& space, std::size_t triangle) : decoder_(space.decoder) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t corner = 3 * triangle + k;
        set(k, space.part.normals[space.part.indices[corner]], space.tangents[corner]);
    }
}

CornerFrames::CornerFrames(const std::array<Float3, 3>& normals, const std::array<Float4, 3>& tangents, Decoder decoder)
    : decoder_(decoder) {
    for (std::size_t k = 0; k < 3; ++k) set(k, normals[k], tangents[k]);
}

Frame CornerFrames::at(const std::array<double, 3>& weights) const {
    const Vector3 t = mix(tangents_, weights), n = mix(normals_, weights);
    switch (decoder_kind(decoder_)) {
        case DecoderKind::per_vertex: return {t, mix(bitangents_, weights), n};
        case DecoderKind::normalized: return {normalized(t), normalized(mix(bitangents_, weights)), normalized(n)};
        case DecoderKind::per_fragment: break;
    }
    const double sign = weights[0] * signs_[0] + weights[1] * signs_[1] + weights[2] * signs_[2];
    return {t, (sign < 0.0 ? -1.0 : 1.0) * cross(n, t), n};
}

FrameCorners CornerFrames::corners() const {
    FrameCorners corners{};
    copy_to(tangents_, corners.tangents);
    copy_to(bitangents_, corners.bitangents);
    copy_to(normals_, corners.normals);
    std::copy(signs_.begin(), signs_.end(), corners.signs);
    corners.kind = decoder_kind(decoder_);
    return corners;
}

Vector3 read_texel(Decoder decoder, Vector3 t) {
    if (!rebuilds_z(decoder)) return t;
    return {t.x, t.y, std::sqrt(std::max(0.0, 1.0 - t.x * t.x - t.y * t.y))};
}

Vector3 decode(const Frame& frame, Vector3 t) {
    const Vector3 n = t.x * frame.t + t.y * frame.b + t.z * frame.n;
    if (dot(n, n) > 1e-30) return normalized(n);
    return dot(frame.n, frame.n) > 1e-30 ? normalized(frame.n) : Vector3{0.0, 0.0, 1.0};
}

std::optional<Vector3> encode(const Frame& frame, Vector3 n) {
    const Vector3 r0 = cross(frame.b, frame.n), r1 = cross(frame.n, frame.t), r2 = cross(frame.t, frame.b);
    const double volume = dot(frame.t, r0);
    // Below a millionth of a cube with such edges, t would consist of rounding errors.
    const double cube = dot(frame.t, frame.t) * dot(frame.b, frame.b) * dot(frame.n, frame.n);
    if (!(volume * volume > 1e-12 * cube)) return std::nullopt;
    const double s = volume < 0.0 ? -1.0 : 1.0;
    const Vector3 t{s * dot(n, r0), s * dot(n, r1), s * dot(n, r2)};
    if (!(dot(t, t) > 0.0)) return std::nullopt;  // n has no length
    return (1.0 / std::sqrt(dot(t, t))) * t;
}

}  // namespace tex::inline v1
