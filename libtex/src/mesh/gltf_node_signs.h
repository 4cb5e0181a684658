// SPDX-License-Identifier: Apache-2.0
// gltf_node_signs.h: which nodes of a glTF file mirror what they show, and what else moves them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "mesh/json.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {

// For each node: whether its determinant is negative in the scene.
std::vector<bool> mirrored_nodes(JsonValue root);

// What animations change.
struct AnimatedNodes {
    std::set<std::int64_t> scaled;      // by the path "scale",
    std::set<std::int64_t> pointed_at;  // by KHR_animation_pointer
};
AnimatedNodes animated_nodes(JsonValue root);

// Turns the x of what the node shows over. Precondition: it has no children.
void turn_x_over(JsonValue node, JsonNode& text);
// Lets a new node show the mesh, a child of this one that mirrors it in x. Animations of weights follow.
void show_in_child(JsonValue root, std::size_t node, JsonNode& text, std::int64_t mesh);

}  // namespace tex::inline v1
