// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_arrays.h"

#include <utility>

namespace tex::inline v1 {

JsonNode* attributes_node(JsonNode& primitive, int target) {
    return target < 0 ? primitive.member("attributes")
                      : primitive.member("targets")->element(static_cast<std::size_t>(target));
}

GltfArrays::GltfArrays(JsonValue root, JsonNode& text, GltfViews& views, bool has_binary)
    : root_(root), text_(text), views_(views), has_binary_(has_binary) {
    count_uses();
}

std::size_t GltfArrays::uses(std::int64_t accessor) const {
    const auto found = uses_.find(accessor);
    return found == uses_.end() ? 0 : found->second;
}

void GltfArrays::count_uses() {
    const auto count = [&](JsonValue value) {
        if (const auto accessor = value.count()) ++uses_[*accessor];
    };
    const JsonValue meshes = root_["meshes"], skins = root_["skins"], animations = root_["animations"];
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const JsonValue primitives = meshes[m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            count(primitives[p]["indices"]);
            visit_attributes(primitives[p], [&](const std::string&, JsonValue accessor, int) { count(accessor); });
        }
    }
    for (std::size_t k = 0; k < skins.size(); ++k) count(skins[k]["inverseBindMatrices"]);
    for (std::size_t k = 0; k < animations.size(); ++k) {
        const JsonValue samplers = animations[k]["samplers"];
        for (std::size_t s = 0; s < samplers.size(); ++s) {
            count(samplers[s]["input"]);
            count(samplers[s]["output"]);
        }
    }
}

Result<std::size_t> GltfArrays::buffer_for(JsonValue primitive) const {
    const JsonValue buffers = root_["buffers"];
    const auto has_bytes = [&](std::size_t k) {
        return k < buffers.size() && (!buffers[k]["uri"].is_null() || (k == 0 && has_binary_));
    };
    const auto accessor = primitive["attributes"]["POSITION"].count();
    const auto view = root_["accessors"][static_cast<std::size_t>(accessor.value_or(-1))]["bufferView"].count();
    if (view && has_bytes(views_.buffer_of(*view))) return views_.buffer_of(*view);
    for (std::size_t k = 0; k < buffers.size(); ++k) {
        if (has_bytes(k)) return k;
    }
    return Error{ErrorCode::unsupported, {}, "has no buffer for tangents"};
}

// Numbers below 65535 (255) fit into two bytes (one): the greatest ones mean something else in glTF.
void GltfArrays::set_indices(Array& array, const std::vector<std::uint32_t>& corners, std::size_t vertices) {
    const bool is_long = vertices > 65535;
    array.is_index = true;
    array.count = corners.size();
    array.text = std::string(R"({"componentType":)") + (is_long ? "5125" : "5123") + R"(,"type":"SCALAR"})";
    for (const std::uint32_t corner : corners) {
        if (is_long)
            put_number(array.bytes, corner);
        else
            put_number(array.bytes, static_cast<std::uint16_t>(corner));
    }
}

void GltfArrays::place() {
    for (const Array& array : arrays_) retire(array);
    for (Array& array : arrays_) place(array);
}

// Counts what views lose by accessors that move.
void GltfArrays::retire(const Array& array) {
    if (!array.is_in_place) return;
    const JsonValue old = root_["accessors"][static_cast<std::size_t>(array.like)];
    for (const JsonValue view :
         {old["bufferView"], old["sparse"]["indices"]["bufferView"], old["sparse"]["values"]["bufferView"]}) {
        if (const auto number = view.count()) ++retired_[*number];
    }
}

// A view that nothing uses any more, or a new one.
std::int64_t GltfArrays::view_for(Array& array) {
    constexpr const char* kTargets[] = {"34962", "34963"};
    const std::string target = kTargets[array.is_index ? 1 : 0];
    for (auto free = retired_.begin(); free != retired_.end(); ++free) {
        const auto [view, lost] = *free;
        const JsonValue place = root_["bufferViews"][static_cast<std::size_t>(view)];
        const bool is_aligned = place["byteOffset"].count().value_or(0) % 4 == 0;
        if (!is_aligned || views_.buffer_of(view) != array.buffer || !views_.is_own(view, lost)) continue;
        retired_.erase(free);
        views_.replace(view, array.bytes);
        JsonNode& node = *text_.member("bufferViews")->element(static_cast<std::size_t>(view));
        node.remove("byteStride");
        if (array.stride > 0) node.set("byteStride", std::to_string(array.stride));
        node.set("target", target);
        return view;
    }
    const std::string stride = array.stride > 0 ? ",\"byteStride\":" + std::to_string(array.stride) : "";
    return views_.add(array.buffer, array.bytes, stride + ",\"target\":" + target);
}

void GltfArrays::place(Array& array) {
    JsonNode text(array.text);
    text.remove("byteOffset");
    text.remove("sparse");
    text.set("bufferView", std::to_string(view_for(array)));
    text.set("count", std::to_string(array.count));
    std::string made;
    text.write(made);
    JsonNode& list = *text_.member("accessors");
    std::int64_t number = array.like;
    if (array.is_in_place) {
        list.element(static_cast<std::size_t>(number))->replace(std::move(made));
    } else {
        number = static_cast<std::int64_t>(list.size());
        list.append(std::move(made));
    }
    for (const Use& use : array.uses) use.object->set(use.key, std::to_string(number));
}

}  // namespace tex::inline v1
