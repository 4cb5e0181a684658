// SPDX-License-Identifier: Apache-2.0

#include "checks/model_engines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <tex/mesh.h>

#include "mesh/node_transform.h"

namespace tex::inline v1 {
namespace {

// What of a model makes engines differ.
struct ModelFacts {
    bool has_tangents = false;    // of the parts with this material, some have TANGENT,
    bool lacks_tangents = false;  // and some have none
    double mirrored = 0.0;        // share of corners without TANGENT whose UVs, with transform and node, are mirrored
    bool flips = false;           // the transform of the material mirrors UVs
    double turn = 0.0;            // and turns them, in degrees
    int uv_set = 0;
    std::string mirroring_node;  // a node that mirrors a part with this material; empty: none
};

double turn_of(const UvTransform& transform) {
    return std::abs(std::remainder(transform.rotation * 180.0 / std::numbers::pi, 360.0));
}

std::string mirroring_node(const MapInModel& in) {
    for (const MeshNode& node : in.model.mesh.nodes) {
        const auto stands_here = [&](const MeshPart& part) {
            return part.mesh == node.mesh && part.can_have(in.map.material);
        };
        if (std::none_of(in.model.mesh.parts.begin(), in.model.mesh.parts.end(), stands_here)) continue;
        const auto transform = NodeTransform::make(node.name, node.to_scene);
        if (transform && transform->is_mirrored()) return node.name.empty() ? "without a name" : node.name;
    }
    return {};
}

ModelFacts facts_of(const CheckContext& context) {
    const MapInModel& in = *context.options.model;
    ModelFacts facts;
    for (const MeshPart& part : in.model.mesh.parts) {
        if (!part.can_have(in.map.material)) continue;
        (part.tangents.empty() ? facts.lacks_tangents : facts.has_tangents) = true;
    }
    facts.flips = in.map.uv_transform.scale_x * in.map.uv_transform.scale_y < 0.0;
    facts.turn = turn_of(in.map.uv_transform);
    facts.uv_set = in.map.uv_set;
    facts.mirroring_node = mirroring_node(in);
    if (facts.has_tangents || context.options.mesh == nullptr) return facts;
    const std::vector<Float4>& tangents = context.options.mesh->selected.tangents;  // made for the moved UVs
    const auto count = std::count_if(tangents.begin(), tangents.end(), [](const Float4& t) { return t.w < 0.0f; });
    if (!tangents.empty()) facts.mirrored = static_cast<double>(count) / static_cast<double>(tangents.size());
    if (!facts.mirroring_node.empty()) facts.mirrored = 1.0 - facts.mirrored;  // the part is in the space of the mesh
    return facts;
}

constexpr double kSomeShare = 0.001, kSomeTurn = 1.0;  // degrees

// A row of the table of what is drawn, which tests/engines makes (RESULTS.md): three.js 0.187.0, Babylon.js 9.35.0,
// PlayCanvas 2.23.3, Cesium 1.145.0, filament 1.53.4, Godot 4.6.3 and Blender 5.2.2 on 30 November 2026. Babylon.js
// draws all rightly. Godot's transform is that of the base colour, which is not known here.
struct ModelKind {
    std::string_view engines;  // which draw it wrongly
    bool (*is)(const ModelFacts& facts);
    std::string (*text)(const ModelFacts& facts);
};

const ModelKind kKinds[] = {
    {"cesium", [](const ModelFacts& f) { return f.lacks_tangents && f.mirrored > kSomeShare; },
     [](const ModelFacts& f) {
         return "the mesh has no TANGENT, and " + percent(f.mirrored) +
                " of it is mirrored, where y points the other way";
     }},
    {"filament", [](const ModelFacts& f) { return f.lacks_tangents && f.flips; },
     [](const ModelFacts&) {
         return std::string(
             "the mesh has no TANGENT, and KHR_texture_transform mirrors its UVs, so y points the other way");
     }},
    {"filament", [](const ModelFacts& f) { return f.lacks_tangents && f.turn > kSomeTurn; },
     [](const ModelFacts& f) {
         return "the mesh has no TANGENT, and KHR_texture_transform turns its UVs, so vectors are turned by " +
                decimal(f.turn, 0) + " degrees";
     }},
    {"filament", [](const ModelFacts& f) { return f.lacks_tangents && f.uv_set != 0; },
     [](const ModelFacts& f) {
         return "the mesh has no TANGENT, and texCoord is " + std::to_string(f.uv_set) +
                ": its tangents are those of set 0";
     }},
    {"filament", [](const ModelFacts& f) { return f.lacks_tangents && !f.mirroring_node.empty(); },
     [](const ModelFacts& f) {
         return "the node " + f.mirroring_node + " mirrors the mesh, so y points the other way";
     }},
    {"godot", [](const ModelFacts& f) { return f.uv_set != 0; },
     [](const ModelFacts& f) {
         return "texCoord is " + std::to_string(f.uv_set) + ": the map is read with UVs of set 0";
     }},
    {"blender", [](const ModelFacts& f) { return f.flips; },
     [](const ModelFacts&) {
         return std::string(
             "tangents are made from UVs without KHR_texture_transform, which mirrors them, so y points the other way");
     }},
    {"blender", [](const ModelFacts& f) { return f.turn > kSomeTurn; },
     [](const ModelFacts& f) {
         return "tangents are made from UVs without KHR_texture_transform, so vectors are turned by " +
                decimal(f.turn, 0) + " degrees";
     }},
    {"three three-packed playcanvas filament",
     [](const ModelFacts& f) { return f.has_tangents && !f.mirroring_node.empty(); },
     [](const ModelFacts& f) {
         return "the node " + f.mirroring_node + " mirrors a mesh with TANGENT, so y points the other way";
     }},
};

bool names(std::string_view words, std::string_view word) {
    for (std::size_t begin = 0; begin < words.size();) {
        const std::size_t end = std::min(words.find(' ', begin), words.size());
        if (words.substr(begin, end - begin) == word) return true;
        begin = end + 1;
    }
    return false;
}

// "three, playcanvas and filament", without those that draw as another one does.
std::string list_of(std::string_view words) {
    std::vector<std::string_view> engines;
    for (const std::string_view engine : {"three", "babylon", "playcanvas", "cesium", "filament", "godot", "blender"}) {
        if (names(words, engine)) engines.push_back(engine);
    }
    std::string text;
    for (std::size_t k = 0; k < engines.size(); ++k)
        text += std::string(k == 0 ? "" : k + 1 == engines.size() ? " and " : ", ") + std::string(engines[k]);
    return text;
}

}  // namespace

bool misses_tangents(const CheckContext& context) {
    if (context.options.model == nullptr) return true;
    const ModelFacts facts = facts_of(context);
    return facts.mirrored > kSomeShare || facts.flips || facts.turn > kSomeTurn || facts.uv_set != 0 ||
           !facts.mirroring_node.empty();
}

void check_engines_with_model(const CheckContext& context, Findings& findings) {
    if (context.options.require.engines.empty()) return;
    const ModelFacts facts = facts_of(context);
    for (const EngineNeeds& needs : context.options.require.engines) {
        const bool is_any = needs.engine == "gltf" || needs.engine == "gltf-ktx2";
        for (const ModelKind& kind : kKinds) {
            if (!(is_any || names(kind.engines, needs.engine)) || !kind.is(facts)) continue;
            Finding& finding = findings.add(
                "N808", (is_any ? "in " + list_of(kind.engines) : "in " + needs.engine) + ": " + kind.text(facts));
            if (is_any) findings.rate(finding, Severity::warning);
        }
    }
}

}  // namespace tex::inline v1
