// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include "c/call.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// The numbers of a vertex, which need not be aligned.
template <class Vector>
std::vector<Vector> copied_attribute(const float* from, std::size_t stride, std::size_t count) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(from);
    std::vector<Vector> to(count);
    const std::size_t step = stride == 0 ? sizeof(Vector) : stride;
    for (std::size_t k = 0; k < count; ++k) std::memcpy(&to[k], bytes + k * step, sizeof(Vector));
    return to;
}

bool is_mesh(const tex_mesh& mesh) {
    if (mesh.positions == nullptr || mesh.normals == nullptr || mesh.uvs == nullptr || mesh.indices == nullptr)
        return false;
    const auto fits = [](std::size_t stride, std::size_t least) { return stride == 0 || stride >= least; };
    return fits(mesh.position_stride, sizeof(Float3)) && fits(mesh.normal_stride, sizeof(Float3)) &&
           fits(mesh.uv_stride, sizeof(Float2)) && mesh.index_count % 3 == 0;
}

int32_t code_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::bad_data: return TEX_BAD_DATA;
        case ErrorCode::bad_option: return TEX_BAD_OPTION;
        case ErrorCode::unsupported: return TEX_UNSUPPORTED;
        default: return TEX_OUT_OF_MEMORY;
    }
}

int32_t make_corner_tangents(const tex_mesh& mesh, TangentMethod method, float* out) {
    if (mesh.index_count / 3 > kMaxTriangles) return TEX_BAD_DATA;
    MeshPart part;
    part.v_axis = static_cast<YAxis>(mesh.v_axis);
    part.positions = copied_attribute<Float3>(mesh.positions, mesh.position_stride, mesh.vertices);
    part.normals = copied_attribute<Float3>(mesh.normals, mesh.normal_stride, mesh.vertices);
    part.uvs.push_back(copied_attribute<Float2>(mesh.uvs, mesh.uv_stride, mesh.vertices));
    part.indices.assign(mesh.indices, mesh.indices + mesh.index_count);
    const auto tangents = make_tangents(part, method, 0, Execution{1, {}});
    if (!tangents) return code_of(tangents.error().code);
    std::memcpy(out, tangents->data(), tangents->size() * sizeof(Float4));
    return TEX_OK;
}

}  // namespace
}  // namespace tex::inline v1

using namespace tex;

int32_t tex_tangents(const tex_mesh* mesh, int32_t method, float* tangents) {
    tex_mesh m;
    if (const int32_t error = copy_options(mesh, m); error != TEX_OK) return error;
    if (!is_mesh(m) || tangents == nullptr) return TEX_BAD_ARGUMENT;
    if (!is_one_of(method, kTangentMethodNames) || !is_one_of(m.v_axis, kYAxisNames)) return TEX_BAD_OPTION;
    try {
        return make_corner_tangents(m, static_cast<TangentMethod>(method), tangents);
    } catch (const std::bad_alloc&) {
        return TEX_OUT_OF_MEMORY;
    } catch (const std::length_error&) {
        return TEX_OUT_OF_MEMORY;
    }
}
