// SPDX-License-Identifier: Apache-2.0
// shown_parts.h: which nodes show a part: copies of it, or places.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <tex/mesh.h>

namespace tex::inline v1 {

// Refers to the mesh.
class ShownParts {
public:
    explicit ShownParts(const Mesh& mesh);

    // In the order of the file.
    [[nodiscard]] const std::vector<const MeshNode*>& nodes_of(const MeshPart& part) const;

    // Whether the copies that nodes make fit into this many triangles (parts_in_scene() of mesh.h). Errors:
    // unsupported.
    [[nodiscard]] Result<void> check(std::size_t most) const;
    // Whether parts that are shown more than once keep their places (places_in_scene()). Errors: unsupported, if these,
    // or else the copies, are too many.
    [[nodiscard]] Result<bool> keep_places(std::size_t most) const;

private:
    [[nodiscard]] Error too_many(std::uint64_t shown, std::uint64_t stored) const;

    const Mesh& mesh_;
    std::map<int, std::vector<const MeshNode*>> nodes_;  // of each mesh that has any
    std::vector<const MeshNode*> none_;
};

// parts_in_scene() of mesh.h, after check(), and places_in_scene(). Precondition: there are nodes.
Result<std::vector<MeshPart>> copies_of_shown(Mesh& mesh, const ShownParts& shown);
Result<SceneParts> places_of_shown(Mesh& mesh, const ShownParts& shown, std::size_t most);

}  // namespace tex::inline v1
