// SPDX-License-Identifier: Apache-2.0

#include "mesh/shown_parts.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace tex::inline v1 {
namespace {

// A copy of a part takes at least as much memory as that of so many triangles.
constexpr std::uint64_t kLeastCopy = 16;

}  // namespace

ShownParts::ShownParts(const Mesh& mesh) : mesh_(mesh) {
    for (const MeshNode& node : mesh.nodes) nodes_[node.mesh].push_back(&node);
}

const std::vector<const MeshNode*>& ShownParts::nodes_of(const MeshPart& part) const {
    const auto found = nodes_.find(part.mesh);
    return found == nodes_.end() ? none_ : found->second;
}

// The sums fit: there are less than 2^32 triangles and nodes.
Result<void> ShownParts::check(std::size_t most) const {
    std::uint64_t stored = 0, shown = 0, size = 0;
    bool is_copied = false;
    for (const MeshPart& part : mesh_.parts) {
        const std::uint64_t times = nodes_of(part).size(), triangles = part.triangles();
        is_copied = is_copied || times > 1;
        stored += triangles;
        shown += times * triangles;
        size += times * std::max(triangles, kLeastCopy);
    }
    if (!is_copied || size <= most) return {};
    return Error{ErrorCode::unsupported,
                 {},
                 "its " + std::to_string(mesh_.nodes.size()) + " nodes make " + std::to_string(shown) +
                     " triangles of " + std::to_string(stored) + ": too many copies"};
}

}  // namespace tex::inline v1
