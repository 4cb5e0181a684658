// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <string>
#include <utility>

#include "mesh/meshopt.h"
#include "mesh/mikktspace.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

Result<std::vector<Float4>> tangents_of(const MeshPart& part, TangentMethod method, int uv_set,
                                        const Execution& execution) {
    switch (method) {
        case TangentMethod::mikktspace: return mikktspace_tangents(part, uv_set, execution);
        case TangentMethod::meshopt: return meshopt_tangents(part, uv_set, execution);
    }
    return Error{ErrorCode::bad_option, {}, "unknown method"};
}

}  // namespace

Result<std::vector<Float4>> make_tangents(const MeshPart& part, TangentMethod method, int uv_set,
                                          const Execution& execution) {
    return no_throw([&]() -> Result<std::vector<Float4>> {
        if (auto sound = check_part(part); !sound) return sound.error();
        if (part.normals.empty()) return Error{ErrorCode::bad_option, {}, "the mesh has no normals"};
        if (uv_set < 0 || static_cast<std::size_t>(uv_set) >= part.uvs.size()) {
            return Error{
                ErrorCode::bad_option,
                {},
                "the mesh has no UV set " + std::to_string(uv_set) + ": it has " + std::to_string(part.uvs.size())};
        }
        auto tangents = tangents_of(part, method, uv_set, execution);
        // Both methods take v to point up.
        if (tangents && part.v_axis == YAxis::down) {
            for (Float4& t : *tangents) t.w = -t.w;
        }
        return tangents;
    });
}

Result<std::vector<Float4>> stored_tangents(const MeshPart& part) {
    return no_throw([&]() -> Result<std::vector<Float4>> {
        if (part.tangents.empty()) return Error{ErrorCode::bad_option, {}, "the mesh has no tangents"};
        std::vector<Float4> corners;
        corners.reserve(part.indices.size());
        for (const std::uint32_t v : part.indices) corners.push_back(part.tangents[v]);
        return corners;
    });
}

}  // namespace tex::inline v1
