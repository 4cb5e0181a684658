// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_picture_slots.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include <tex/mesh.h>

#include "mesh/gltf.h"
#include "mesh/gltf_images.h"

namespace tex::inline v1 {
namespace {

Error bad_picture(std::string reason) { return {ErrorCode::bad_option, {}, std::move(reason)}; }

SlotKind kind_of(NormalSlot slot) { return slot == NormalSlot::normal ? SlotKind::normal : SlotKind::clearcoat_normal; }

std::optional<SlotKind> kind_of(const GltfSlot& slot) {
    if (const auto normal = normal_slot(slot)) return kind_of(*normal);
    if (!slot.extension.empty()) return std::nullopt;
    if (slot.name == "occlusionTexture") return SlotKind::occlusion;
    if (slot.name == "metallicRoughnessTexture") return SlotKind::roughness;
    return std::nullopt;
}

std::vector<SlotKind> kinds_of(PictureUse use, const ModelMap& map) {
    if (use == PictureUse::occlusion) return {SlotKind::occlusion};
    if (use == PictureUse::orm) return {SlotKind::roughness, SlotKind::occlusion};
    return {kind_of(map.slot)};
}

Result<void> check_pictures(const std::vector<ModelPicture>& pictures) {
    for (const ModelPicture& picture : pictures) {
        if (picture.maps.empty()) return bad_picture("a picture is for no map");
        if (picture.container != Container::png && picture.container != Container::jpeg &&
            picture.container != Container::webp && picture.container != Container::ktx2)
            return bad_picture("a picture of a model is PNG, JPEG, WebP or KTX2");
        for (const ModelMap& map : picture.maps) {
            if (picture.use == PictureUse::normals && map.image < 0 &&
                (!picture.sets_slots || map.slot != NormalSlot::normal))
                return bad_picture("the map of material " + std::to_string(map.material) + " has no image");
        }
    }
    return {};
}

}  // namespace

Result<std::vector<PictureSlot>> picture_slots(JsonValue root, const std::vector<ModelPicture>& pictures) {
    if (auto sound = check_pictures(pictures); !sound) return sound.error();
    std::vector<PictureSlot> all;
    const auto image_of = [&](const PictureSlot& each) { return image_of_texture(root, each.slot.texture); };
    struct Want {
        int picture;
        const ModelMap* map;
        bool is_found = false;
    };
    std::map<std::pair<int, SlotKind>, Want> wanted;
    for (std::size_t p = 0; p < pictures.size(); ++p) {
        for (const ModelMap& map : pictures[p].maps) {
            for (const SlotKind kind : kinds_of(pictures[p].use, map)) {
                if (!wanted.emplace(std::pair(map.material, kind), Want{static_cast<int>(p), &map}).second)
                    return bad_picture("two pictures are for one map of material " + std::to_string(map.material));
            }
        }
    }
    const JsonValue materials = root["materials"];
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const auto slots = slots_of(materials[m]);
        if (!slots) return bad_gltf("material " + std::to_string(m) + ": " + slots.error().reason);
        for (const GltfSlot& found : *slots) {
            all.push_back({m, found, kNobody});
            const auto kind = kind_of(found);
            const auto want = kind ? wanted.find({static_cast<int>(m), *kind}) : wanted.end();
            if (want == wanted.end()) continue;
            const bool is_normal = *kind == SlotKind::normal || *kind == SlotKind::clearcoat_normal;
            if (is_normal && image_of(all.back()) != want->second.map->image) continue;
            all.back().picture = want->second.picture;
            all.back().map = want->second.map;
            all.back().kind = *kind;
            want->second.is_found = true;
        }
        for (const auto& [kind, name] :
             {std::pair(SlotKind::normal, "normalTexture"), std::pair(SlotKind::occlusion, "occlusionTexture")}) {
            const auto none = wanted.find({static_cast<int>(m), kind});
            if (none == wanted.end() || none->second.is_found) continue;
            if (kind == SlotKind::normal && none->second.map->image >= 0) continue;
            GltfSlot added;
            added.name = name;
            added.texture = -1;
            all.push_back({m, added, none->second.picture, none->second.map, kind});
            none->second.is_found = true;
        }
    }
    for (const auto& [map, want] : wanted) {
        if (!want.is_found) return bad_picture("material " + std::to_string(map.first) + " has no such map");
    }
    return all;
}

}  // namespace tex::inline v1
