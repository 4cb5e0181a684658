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

bool is_tangent(const std::string& key, int target) { return target < 0 && key == kTangent; }

// MikkTSpace has none for triangles without an area in UV, of which a map shows nothing. glTF wants a length of 1.
Float4 with_length(const Float4& tangent) {
    const bool is_none = tangent.x == 0.0f && tangent.y == 0.0f && tangent.z == 0.0f;
    return is_none ? Float4{1.0f, 0.0f, 0.0f, tangent.w < 0.0f ? -1.0f : 1.0f} : tangent;
}

// What tells vertices apart: the accessors of all attributes but the tangents.
std::string key_of(JsonValue primitive) {
    std::string text;
    visit_attributes(primitive, [&](const std::string& key, JsonValue accessor, int target) {
        if (!is_tangent(key, target))
            text += std::to_string(target) + ' ' + key + ' ' + std::to_string(*accessor.count()) + '\n';
    });
    return text;
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
    for (const ModelTangents& each : tangents) {
        if (auto added = add(each); !added) return added;
    }
    for (const auto& [key, vertices] : vertices_) {
        if (auto collected = collect(vertices); !collected) return collected;
    }
    arrays_.place();
    return {};
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
        const auto buffer = arrays_.buffer_for(primitive);
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
        const std::uint32_t vertex = vertex_for(vertices, member.corners[c], with_length(tangents.tangents[c]));
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

Result<void> GltfTangents::collect(const Vertices& vertices) {
    if (vertices.members.empty()) return {};
    const auto buffer = arrays_.buffer_for(vertices.members.front().primitive);
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
    array.is_in_place = array.like >= 0 && arrays_.uses(array.like) == own;
    for (const Float4& t : vertices.tangents) {
        for (const float value : {t.x, t.y, t.z, t.w}) put_number(array.bytes, std::bit_cast<std::uint32_t>(value));
    }
    arrays_.add(std::move(array));
}

void GltfTangents::collect_indices(const Vertices& vertices, const Member& member, std::size_t buffer) {
    Array array;
    array.buffer = buffer;
    array.like = member.primitive["indices"].count().value_or(-1);
    array.is_in_place = array.like >= 0 && arrays_.uses(array.like) == 1;
    array.uses.push_back({member.node, "indices"});
    GltfArrays::set_indices(array, member.corners, vertices.tangents.size());
    if (member.mode != 4) member.node->set("mode", "4");
    arrays_.add(std::move(array));
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
            Old& old = all[*accessor.count()];
            old.accessor = accessor;
            old.uses.push_back({attributes_node(*member.node, target), key});
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
        array.is_in_place = arrays_.uses(number) == old.uses.size();
        array.uses = std::move(old.uses);
        array.bytes.resize(array.count * stride);
        for (std::size_t k = 0; k < array.count; ++k) {
            const std::size_t from = k < vertices.count ? k : vertices.copies[k - vertices.count];
            (*values)->copy(from, array.bytes.data() + k * stride);
        }
        text_.member("accessors")->element(static_cast<std::size_t>(number))->write(array.text);
        arrays_.add(std::move(array));
    }
    return {};
}

}  // namespace tex::inline v1
