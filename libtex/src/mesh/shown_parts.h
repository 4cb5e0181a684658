// SPDX-License-Identifier: Apache-2.0
// shown_parts.h: which nodes show a part, and how many triangles that makes.

#pragma once

#include <cstddef>
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

private:
    const Mesh& mesh_;
    std::map<int, std::vector<const MeshNode*>> nodes_;  // of each mesh that has any
    std::vector<const MeshNode*> none_;
};

}  // namespace tex::inline v1
