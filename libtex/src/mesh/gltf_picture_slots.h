// SPDX-License-Identifier: Apache-2.0
// gltf_picture_slots.h: which slots of materials get the pictures of ModelChanges.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/pipeline.h>
#include <tex/types.h>

#include "mesh/gltf_materials.h"
#include "mesh/json.h"

namespace tex::inline v1 {

// What a slot holds, among those that pictures replace.
enum class SlotKind { normal, clearcoat_normal, occlusion, roughness };

// Instead of the number of a picture.
inline constexpr int kNobody = -1, kUnused = -2;

struct PictureSlot {
    std::size_t material = 0;
    GltfSlot slot;  // of which the texture is -1 if the material lacks it
    int picture = kNobody;
    const ModelMap* map = nullptr;  // that gets the picture
    SlotKind kind = SlotKind::normal;
};

// All slots that materials have, and those that they get. Errors: bad_data, bad_option as write_model().
Result<std::vector<PictureSlot>> picture_slots(JsonValue root, const std::vector<ModelPicture>& pictures);

}  // namespace tex::inline v1
