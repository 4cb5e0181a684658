// SPDX-License-Identifier: Apache-2.0

#include "mesh/shown_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "mesh/node_transform.h"

namespace tex::inline v1 {
namespace {

// A copy of a part takes at least as much memory as that of so many triangles.
constexpr std::uint64_t kLeastCopy = 16;

double largest_coordinate(const MeshPart& part) {
    float largest = 0.0f;
    for (const Float3& p : part.positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return static_cast<double>(largest);
}

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
    return too_many(shown, stored);
}

Result<bool> ShownParts::keep_places(std::size_t most) const {
    std::uint64_t stored = 0, shown = 0, size = 0, places = 0;
    for (const MeshPart& part : mesh_.parts) {
        const std::uint64_t times = nodes_of(part).size(), triangles = part.triangles();
        if (times < 2) continue;
        stored += triangles;
        shown += times * triangles;
        size += times * std::max(triangles, kLeastCopy);
        places += times;
    }
    const bool keeps = shown >= kFewCopied;
    if ((keeps ? kLeastCopy * places : size) > most) return too_many(shown, stored);
    return keeps;
}

Error ShownParts::too_many(std::uint64_t shown, std::uint64_t stored) const {
    return {ErrorCode::unsupported,
            {},
            "its " + std::to_string(mesh_.nodes.size()) + " nodes make " + std::to_string(shown) + " triangles of " +
                std::to_string(stored) + ": too many copies"};
}

Result<std::vector<MeshPart>> copies_of_shown(Mesh& mesh, const ShownParts& shown) {
    std::vector<MeshPart> parts;
    for (MeshPart& part : mesh.parts) {
        const std::vector<const MeshNode*>& nodes = shown.nodes_of(part);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            auto in_place = in_scene(k + 1 < nodes.size() ? MeshPart(part) : std::move(part), *nodes[k]);
            if (!in_place) return in_place.error();
            if (!nodes[k]->name.empty()) in_place->name = nodes[k]->name;
            parts.push_back(std::move(*in_place));
        }
    }
    if (parts.empty()) return Error{ErrorCode::bad_data, {}, "its scene shows no mesh"};
    return parts;
}

Result<SceneParts> places_of_shown(Mesh& mesh, const ShownParts& shown, std::size_t most) {
    const auto keeps = shown.keep_places(most);
    if (!keeps) return keeps.error();
    SceneParts scene;
    if (!*keeps) {
        auto copies = copies_of_shown(mesh, shown);
        if (!copies) return copies.error();
        scene.parts = std::move(*copies);
        return scene;
    }
    for (MeshPart& part : mesh.parts) {
        const std::vector<const MeshNode*>& nodes = shown.nodes_of(part);
        if (nodes.empty()) continue;
        if (auto sound = check_part(part); !sound) return sound.error();
        const double largest = largest_coordinate(part);
        for (const MeshNode* node : nodes) {
            const auto placement = NodeTransform::make(node->name, node->to_scene);
            if (!placement) return placement.error();
            if (!placement->keeps_finite(largest)) {
                if (auto fits = placement->check(part, node->name); !fits) return fits.error();
            }
            PartPlace place{scene.parts.size(), node->name.empty() ? part.name : node->name, node->to_scene};
            if (nodes.size() == 1) place.to_scene = PartPlace{}.to_scene;
            scene.places.push_back(std::move(place));
        }
        if (nodes.size() > 1) {
            scene.parts.push_back(std::move(part));
            continue;
        }
        auto moved = in_scene(std::move(part), *nodes.front());
        if (!moved) return moved.error();
        scene.parts.push_back(std::move(*moved));
    }
    return scene;
}

}  // namespace tex::inline v1
