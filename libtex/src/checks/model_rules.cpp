// SPDX-License-Identifier: Apache-2.0

#include "checks/model_rules.h"

#include <algorithm>
#include <string>

#include <tex/mesh.h>

#include "checks/model_engines.h"

namespace tex::inline v1 {
namespace {

// "baseColorTexture of Leather, emissiveTexture of 3"
std::string uses_text(const Model& model, const std::vector<ImageUse>& uses) {
    constexpr std::size_t kMost = 4;
    std::string text;
    for (std::size_t k = 0; k < std::min(uses.size(), kMost); ++k) {
        const std::string& name = model.mesh.materials[static_cast<std::size_t>(uses[k].material)].name;
        text += (k == 0 ? "" : ", ") + uses[k].slot + " of " + (name.empty() ? std::to_string(uses[k].material) : name);
    }
    return uses.size() > kMost ? text + " and " + std::to_string(uses.size() - kMost) + " more" : text;
}

void check_uses(const MapInModel& in, Findings& findings) {
    if (in.map.image < 0) return;
    std::vector<ImageUse> colors, data;
    for (const ImageUse& use : in.model.images[static_cast<std::size_t>(in.map.image)].uses) {
        if (use.is_color)
            colors.push_back(use);
        else if (use.slot != "normalTexture" && use.slot != "clearcoatNormalTexture")
            data.push_back(use);
    }
    if (!colors.empty()) findings.add("N802", "it is also the " + uses_text(in.model, colors));
    if (!data.empty()) findings.add("N806", "it is also the " + uses_text(in.model, data));
}

// The parts of the material that lack the set of UVs.
void check_uv_set(const MapInModel& in, Findings& findings) {
    std::size_t without = 0, all = 0;
    std::size_t sets = 0;
    for (const MeshPart& part : in.model.mesh.parts) {
        if (!part.can_have(in.map.material)) continue;
        all += part.triangles();
        sets = std::max(sets, part.uvs.size());
        if (static_cast<std::size_t>(in.map.uv_set) >= part.uvs.size()) without += part.triangles();
    }
    if (without == 0) return;
    Finding& finding = findings.add("N803", "texCoord is " + std::to_string(in.map.uv_set) + ", and " +
                                                std::to_string(without) + " of " + std::to_string(all) +
                                                " triangles have " + (sets == 0 ? "no UVs" : "no such set"));
    finding.figure = static_cast<double>(without) / static_cast<double>(all);
    finding.unit = "share";
}

}  // namespace

void check_model_rules(const CheckContext& context, Findings& findings) {
    if (context.options.model == nullptr) return;
    const MapInModel& in = *context.options.model;
    if (context.has_vectors && context.stored.channel(Component::z) < 0) {
        findings.add("N801", "its format is " + std::string(name_of(kFormatNames, context.texture.format)) +
                                 ", which holds x and y");
    }
    check_uses(in, findings);
    check_uv_set(in, findings);
    if (!(in.map.scale > 0.0)) {
        Finding& finding = findings.add("N804", "scale is " + decimal(in.map.scale, 3));
        finding.figure = in.map.scale;
        finding.unit = "ratio";
    }
    if (in.map.is_double_sided && context.options.mesh != nullptr && context.options.mesh->selected.has_tangents)
        findings.add("N805", "doubleSided is true, and the mesh has TANGENT");
    check_engines_with_model(context, findings);
}

}  // namespace tex::inline v1
