// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_tangents.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "mesh/gltf_corners.h"

namespace tex::inline v1 {
namespace {

constexpr const char* kTangent = "TANGENT";
constexpr const char* kDracoTriangles = "KHR_draco_mesh_compression";

bool is_same(const Float4& a, const Float4& b) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z) && bits(a.w) == bits(b.w);
}

// Calls use(key, accessor, target) for each accessor that a primitive or a morph target names; target is -1 for the
// former.
template <class Use>
void visit_attributes(JsonValue primitive, const Use& use) {
    const JsonValue attributes = primitive["attributes"], targets = primitive["targets"];
    for (const std::string& key : attributes.keys()) {
        if (attributes[key].count()) use(key, attributes[key], -1);
    }
    for (std::size_t k = 0; k < targets.size(); ++k) {
        for (const std::string& key : targets[k].keys()) {
            if (targets[k][key].count()) use(key, targets[k][key], static_cast<int>(k));
        }
    }
}

bool is_tangent(const std::string& key, int target) { return target < 0 && key == kTangent; }

// What tells vertices apart: the accessors of all attributes but the tangents.
std::string key_of(JsonValue primitive) {
    std::string text;
    visit_attributes(primitive, [&](const std::string& key, JsonValue accessor, int target) {
        if (!is_tangent(key, target))
            text += std::to_string(target) + ' ' + key + ' ' + std::to_string(*accessor.count()) + '\n';
    });
    return text;
}

template <class T>
void put(std::vector<std::byte>& bytes, T value) {
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes.push_back(static_cast<std::byte>(value >> (8 * k) & 0xff));
}

}  // namespace

Result<void> GltfTangents::charge(std::size_t count, std::size_t size) {
    // Primitives of a small file can share a large accessor.
    constexpr std::size_t kMostExpansion = 64, kMostAdded = std::size_t{64} << 20;
    const std::size_t most = kMostAdded + kMostExpansion * buffers_.bytes();
    if (charged_ > most || count > (most - charged_) / size)
        return Error{ErrorCode::unsupported, {}, "its tangents would take far more bytes than the file has"};
    charged_ += count * size;
    return {};
}

Result<void> GltfTangents::change(const std::vector<ModelTangents>& tangents) {
    count_uses();
    for (const ModelTangents& each : tangents) {
        if (auto added = add(each); !added) return added;
    }
    for (const auto& [key, vertices] : vertices_) {
        if (auto collected = collect(vertices); !collected) return collected;
    }
    for (const Array& array : arrays_) retire(array);
    for (Array& array : arrays_) place(array);
    return {};
}

void GltfTangents::count_uses() {
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

Result<void> GltfTangents::add(const ModelTangents& tangents) {
    const auto mesh = static_cast<std::size_t>(tangents.mesh), number = static_cast<std::size_t>(tangents.primitive);
    const JsonValue primitive = root_["meshes"][mesh]["primitives"][number];
    if (!primitive["extensions"][kDracoTriangles].is_null()) {
        ++compressed_;
        return {};
    }
    const auto positions = buffers_.accessor(primitive["attributes"]["POSITION"]);
    if (!positions) return positions.error();
    if (tangents.tangents.empty()) {
        const auto buffer = find_buffer(primitive);
        if (!buffer) return buffer.error();
        views_.add(*buffer, {});
        return {};
    }
    Vertices& vertices = vertices_[key_of(primitive)];
    if (vertices.members.empty()) {
        vertices.count = (*positions)->count;
        if (auto fits = charge(vertices.count, sizeof(Float4)); !fits) return fits;
        vertices.tangents.assign(vertices.count, {1.0f, 0.0f, 0.0f, 1.0f});
        vertices.is_known.assign(vertices.count, false);
    }
    Member member;
    member.primitive = primitive;
    member.node = text_.member("meshes")->element(mesh)->member("primitives")->element(number);
    if (auto read = read_corners(member, vertices.count, tangents.tangents.size()); !read) return read;
    for (std::size_t c = 0; c < member.corners.size(); ++c) {
        const std::uint32_t vertex = vertex_for(vertices, member.corners[c], tangents.tangents[c]);
        member.is_split = member.is_split || vertex != member.corners[c];
        member.corners[c] = vertex;
    }
    vertices.members.push_back(std::move(member));
    return {};
}

Result<void> GltfTangents::read_corners(Member& member, std::size_t vertices, std::size_t tangents) {
    const JsonValue index = member.primitive["indices"];
    member.mode = member.primitive["mode"].is_null() ? 4 : member.primitive["mode"].count().value_or(-1);
    const GltfAccessor* indices = nullptr;
    if (!index.is_null()) {
        const auto accessor = buffers_.accessor(index);
        if (!accessor) return accessor.error();
        indices = *accessor;
    }
    const std::size_t count = indices == nullptr ? vertices : indices->count;
    const bool has_type = indices == nullptr || indices->type == 5121 || indices->type == 5123 || indices->type == 5125;
    if (member.mode < 4 || member.mode > 6 || !has_type || corner_count(count, member.mode) != tangents)
        return Error{ErrorCode::bad_option, {}, "tangents are for other triangles than the file has"};
    std::vector<std::uint32_t> corners(count);
    for (std::size_t k = 0; k < count; ++k) {
        corners[k] = indices == nullptr ? static_cast<std::uint32_t>(k) : indices->integer(k);
        if (corners[k] >= vertices) return bad_gltf("index " + std::to_string(corners[k]) + " is out of range");
    }
    member.corners = triangles_of(std::move(corners), member.mode);
    return {};
}

// The vertex that has this tangent: the one of the file, if it has none yet, or a copy.
std::uint32_t GltfTangents::vertex_for(Vertices& vertices, std::uint32_t vertex, const Float4& tangent) {
    if (!vertices.is_known[vertex]) {
        vertices.is_known[vertex] = true;
        vertices.tangents[vertex] = tangent;
    }
    if (is_same(vertices.tangents[vertex], tangent)) return vertex;
    const auto [begin, end] = vertices.copies_of.equal_range(vertex);
    for (auto copy = begin; copy != end; ++copy) {
        if (is_same(vertices.tangents[copy->second], tangent)) return copy->second;
    }
    const auto number = static_cast<std::uint32_t>(vertices.tangents.size());
    vertices.copies.push_back(vertex);
    vertices.copies_of.emplace(vertex, number);
    vertices.tangents.push_back(tangent);
    return number;
}

// The buffer of the positions, or, if that only stands for compressed bytes, the first one that has bytes.
Result<std::size_t> GltfTangents::find_buffer(JsonValue primitive) const {
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

Result<void> GltfTangents::collect(const Vertices& vertices) {
    if (vertices.members.empty()) return {};
    const auto buffer = find_buffer(vertices.members.front().primitive);
    if (!buffer) return buffer.error();
    collect_tangents(vertices, *buffer);
    if (vertices.copies.empty()) return {};
    for (const Member& member : vertices.members) {
        if (member.is_split) collect_indices(vertices, member, *buffer);
    }
    return collect_attributes(vertices, *buffer);
}

void GltfTangents::collect_tangents(const Vertices& vertices, std::size_t buffer) {
    Array array;
    array.buffer = buffer;
    array.count = vertices.tangents.size();
    array.text = R"({"componentType":5126,"type":"VEC4"})";
    std::size_t own = 0;
    for (const Member& member : vertices.members) {
        array.uses.push_back({member.node->member("attributes"), kTangent});
        const auto old = member.primitive["attributes"][kTangent].count();
        if (old && (array.like < 0 || array.like == *old)) {
            array.like = *old;
            ++own;
        }
    }
    array.is_in_place = array.like >= 0 && uses_[array.like] == own;
    for (const Float4& t : vertices.tangents) {
        for (const float value : {t.x, t.y, t.z, t.w}) put(array.bytes, std::bit_cast<std::uint32_t>(value));
    }
    arrays_.push_back(std::move(array));
}

// Numbers below 65535 (255) fit into two bytes (one): the greatest ones mean something else in glTF.
void GltfTangents::collect_indices(const Vertices& vertices, const Member& member, std::size_t buffer) {
    Array array;
    array.buffer = buffer;
    array.is_index = true;
    array.count = member.corners.size();
    array.like = member.primitive["indices"].count().value_or(-1);
    array.is_in_place = array.like >= 0 && uses_[array.like] == 1;
    array.uses.push_back({member.node, "indices"});
    const bool is_long = vertices.tangents.size() > 65535;
    array.text = std::string(R"({"componentType":)") + (is_long ? "5125" : "5123") + R"(,"type":"SCALAR"})";
    for (const std::uint32_t corner : member.corners) {
        if (is_long)
            put(array.bytes, corner);
        else
            put(array.bytes, static_cast<std::uint16_t>(corner));
    }
    if (member.mode != 4) member.node->set("mode", "4");
    arrays_.push_back(std::move(array));
}

// All other attributes get the copies, too.
Result<void> GltfTangents::collect_attributes(const Vertices& vertices, std::size_t buffer) {
    struct Old {
        JsonValue accessor;
        std::vector<Use> uses;
    };
    std::map<std::int64_t, Old> all;
    for (const Member& member : vertices.members) {
        visit_attributes(member.primitive, [&](const std::string& key, JsonValue accessor, int target) {
            if (is_tangent(key, target)) return;
            JsonNode* const object = target < 0
                                         ? member.node->member("attributes")
                                         : member.node->member("targets")->element(static_cast<std::size_t>(target));
            Old& old = all[*accessor.count()];
            old.accessor = accessor;
            old.uses.push_back({object, key});
        });
    }
    for (auto& [number, old] : all) {
        const auto values = buffers_.accessor(old.accessor);
        if (!values) return values.error();
        if ((*values)->count != vertices.count) return bad_gltf("an attribute has another number of elements");
        const std::size_t size = (*values)->element_size(), stride = size + (4 - size % 4) % 4;
        if (auto fits = charge(vertices.tangents.size(), stride); !fits) return fits;
        Array array;
        array.buffer = buffer;
        array.count = vertices.tangents.size();
        array.stride = stride == size ? 0 : stride;
        array.like = number;
        array.is_in_place = uses_[number] == old.uses.size();
        array.uses = std::move(old.uses);
        array.bytes.resize(array.count * stride);
        for (std::size_t k = 0; k < array.count; ++k) {
            const std::size_t from = k < vertices.count ? k : vertices.copies[k - vertices.count];
            (*values)->copy(from, array.bytes.data() + k * stride);
        }
        text_.member("accessors")->element(static_cast<std::size_t>(number))->write(array.text);
        arrays_.push_back(std::move(array));
    }
    return {};
}

// Counts what views lose by accessors that move.
void GltfTangents::retire(const Array& array) {
    if (!array.is_in_place) return;
    const JsonValue old = root_["accessors"][static_cast<std::size_t>(array.like)];
    for (const JsonValue view :
         {old["bufferView"], old["sparse"]["indices"]["bufferView"], old["sparse"]["values"]["bufferView"]}) {
        if (const auto number = view.count()) ++retired_[*number];
    }
}

// A view that nothing uses any more, or a new one.
std::int64_t GltfTangents::view_for(Array& array) {
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

void GltfTangents::place(Array& array) {
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
