// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_node_signs.h"

#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace tex::inline v1 {
namespace {

double number_or(JsonValue value, double otherwise) { return value.number().value_or(otherwise); }

bool mirrors(JsonValue node) {
    const JsonValue matrix = node["matrix"];
    std::array<double, 9> m{};
    for (std::size_t k = 0; k < 9; ++k) m[k] = number_or(matrix[k / 3 * 4 + k % 3], 0.0);
    if (!matrix.is_null()) {
        return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                   m[2] * (m[3] * m[7] - m[4] * m[6]) <
               0.0;
    }
    double product = 1.0;
    for (std::size_t k = 0; k < 3; ++k) product *= number_or(node["scale"][k], 1.0) < 0.0 ? -1.0 : 1.0;
    return product < 0.0;
}

// The node of "/nodes/3/scale".
std::optional<std::int64_t> pointed_node(JsonValue target) {
    const auto pointer = target["extensions"]["KHR_animation_pointer"]["pointer"].text();
    constexpr std::string_view kNodes = "/nodes/";
    if (!pointer || !pointer->starts_with(kNodes)) return std::nullopt;
    return std::strtoll(pointer->c_str() + kNodes.size(), nullptr, 10);
}

template <class Use>
void visit_channels(JsonValue root, const Use& use) {
    const JsonValue animations = root["animations"];
    for (std::size_t a = 0; a < animations.size(); ++a) {
        const JsonValue channels = animations[a]["channels"];
        for (std::size_t c = 0; c < channels.size(); ++c) use(a, c, channels[c]["target"]);
    }
}

}  // namespace

std::vector<bool> mirrored_nodes(JsonValue root) {
    const JsonValue nodes = root["nodes"];
    const std::size_t count = nodes.size();
    std::vector<bool> is_child(count), is_known(count), result(count);
    const auto visit_children = [&](std::size_t node, const auto& use) {
        const JsonValue children = nodes[node]["children"];
        for (std::size_t k = 0; k < children.size(); ++k) {
            const auto child = children[k].count();
            if (child && static_cast<std::size_t>(*child) < count) use(static_cast<std::size_t>(*child));
        }
    };
    for (std::size_t n = 0; n < count; ++n) visit_children(n, [&](std::size_t child) { is_child[child] = true; });
    std::vector<std::size_t> waiting;
    for (std::size_t n = 0; n < count; ++n) {
        if (is_child[n]) continue;
        result[n] = mirrors(nodes[n]);
        is_known[n] = true;
        waiting.push_back(n);
    }
    while (!waiting.empty()) {
        const std::size_t node = waiting.back();
        waiting.pop_back();
        visit_children(node, [&](std::size_t child) {
            if (is_known[child]) return;  // a damaged file may name it twice
            is_known[child] = true;
            result[child] = result[node] != mirrors(nodes[child]);
            waiting.push_back(child);
        });
    }
    return result;
}

AnimatedNodes animated_nodes(JsonValue root) {
    AnimatedNodes all;
    visit_channels(root, [&](std::size_t, std::size_t, JsonValue target) {
        if (const auto node = pointed_node(target)) all.pointed_at.insert(*node);
        if (target["path"].text() == "scale") all.scaled.insert(target["node"].count().value_or(-1));
    });
    return all;
}

void turn_x_over(JsonValue node, JsonNode& text) {
    const JsonValue matrix = node["matrix"];
    const bool is_matrix = !matrix.is_null();
    const JsonValue values = is_matrix ? matrix : node["scale"];
    std::string list;
    for (std::size_t k = 0; k < (is_matrix ? 16U : 3U); ++k) {
        const double value = number_or(values[k], 1.0);
        const bool turns = value != 0.0 && k < (is_matrix ? 3U : 1U);  // and no -0
        list += (k == 0 ? "" : ",") + json_number(turns ? -value : value);
    }
    if (list == "1,1,1")
        text.remove("scale");
    else
        text.set(is_matrix ? "matrix" : "scale", '[' + list + ']');
}

void show_in_child(JsonValue root, std::size_t node, JsonNode& text, std::int64_t mesh) {
    JsonNode& nodes = *text.member("nodes");
    const std::string number = std::to_string(nodes.size());
    JsonNode& parent = *nodes.element(node);
    std::string child = "{\"mesh\":" + std::to_string(mesh) + ",\"scale\":[-1,1,1]";
    if (JsonNode* const weights = parent.member("weights")) {
        child += ",\"weights\":";
        weights->write(child);
        parent.remove("weights");
    }
    parent.remove("mesh");
    if (parent.member("children") == nullptr) parent.set("children", "[]");
    parent.member("children")->append(number);
    nodes.append(child + "}");
    visit_channels(root, [&](std::size_t a, std::size_t c, JsonValue target) {
        if (target["path"].text() != "weights" || target["node"].count() != static_cast<std::int64_t>(node)) return;
        text.member("animations")->element(a)->member("channels")->element(c)->member("target")->set("node", number);
    });
}

}  // namespace tex::inline v1
