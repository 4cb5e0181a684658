// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "mesh/node_transform.h"
#include "mesh/uv_transform.h"
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
Result<void> transform(MeshPart& part, const MeshNode& node) {
    const auto placement = NodeTransform::make(node.name, node.to_scene);
    if (!placement) return placement.error();
    const auto makes_infinite = [&](const std::string& what) {
        return bad("node \"" + node.name + "\": its matrix makes infinite " + what);
    };
    for (Float3& p : part.positions) {
        p = placement->position(p);
        if (!is_finite(p)) return makes_infinite("coordinates");
    }
    for (Float3& n : part.normals) {
        n = placement->normal(n);
        if (!is_finite(n)) return makes_infinite("normals");
    }
    for (Float4& t : part.tangents) {
        t = placement->tangent(t);
        if (!is_finite(Float3{t.x, t.y, t.z})) return makes_infinite("tangents");
    }
    if (placement->is_mirrored()) {
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

Result<MeshPart> with_moved_uvs(MeshPart part, int uv_set, const UvTransform& transform) {
    return no_throw([&]() -> Result<MeshPart> {
        const auto set = static_cast<std::size_t>(uv_set);
        if (uv_set < 0 || set >= part.uvs.size())
            return Error{ErrorCode::bad_option, {}, "the part has no such set of UVs"};
        move_uvs(part.uvs[set], transform, part.v_axis);
        if (auto sound = check_part(part); !sound) return sound.error();
        return std::move(part);
    });
}

}  // namespace tex::inline v1
