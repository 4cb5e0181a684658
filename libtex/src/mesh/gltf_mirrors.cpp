// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_mirrors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <set>
#include <tuple>
#include <utility>

#include "mesh/glb.h"
#include "mesh/gltf_arrays.h"
#include "mesh/gltf_corners.h"
#include "mesh/gltf_node_signs.h"
#include "mesh/gltf_views.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {
namespace {

constexpr std::array kNodeKeys = {"name", "mesh", "translation", "rotation", "scale", "matrix", "weights", "extras"};

// Whether more than its mesh stands where the node is.
bool holds_more(JsonValue node) {
    for (const std::string& key : node.keys()) {
        if (std::find(kNodeKeys.begin(), kNodeKeys.end(), key) == kNodeKeys.end()) return true;
    }
    return false;
}

std::int64_t mode_of(JsonValue primitive) {
    return primitive["mode"].is_null() ? 4 : primitive["mode"].count().value_or(-1);
}

// Corners of triangles, of which the second and third change places.
template <class T>
void turn_over(std::vector<T>& corners) {
    for (std::size_t k = 2; k < corners.size(); k += 3) std::swap(corners[k - 1], corners[k]);
}

class GltfMirrors {
public:
    GltfMirrors(JsonValue root, JsonNode& text, GltfBuffers& buffers, GltfViews& views, bool has_binary)
        : root_(root), text_(text), buffers_(buffers), arrays_(root, text, views, has_binary) {}

    // Whether there is something to do for these tangents.
    bool find(const std::vector<ModelTangents>& tangents);
    Result<void> change();
    [[nodiscard]] std::vector<ModelTangents> turned(const std::vector<ModelTangents>& tangents) const;
    [[nodiscard]] int applied() const { return applied_; }
    [[nodiscard]] int left() const { return left_; }

private:
    struct Mirrored {
        std::vector<std::size_t> nodes;
        std::size_t shown = 0;   // by how many nodes
        std::int64_t copy = -1;  // the mesh that is mirrored, if others show it as it is
    };
    // What an accessor becomes, and how many of those who use it in the file want that.
    struct Change {
        GltfArrays::Array array;
        std::size_t own = 0;
    };

    [[nodiscard]] bool is_compressed(std::int64_t mesh) const;
    [[nodiscard]] bool can_change(std::size_t node) const;
    Result<void> change_primitive(JsonValue primitive, JsonNode& node, bool is_copy);
    Result<void> change_vectors(JsonValue accessor, const std::string& key, bool is_target, Change& change);
    Result<void> change_corners(JsonValue primitive, std::size_t vertices, Change& change);

    JsonValue root_;
    JsonNode& text_;
    GltfBuffers& buffers_;
    GltfArrays arrays_;
    AnimatedNodes animated_;
    std::map<std::int64_t, Mirrored> meshes_;
    std::map<std::pair<std::int64_t, std::string>, Change> vectors_;                 // of an accessor, for this use
    std::map<std::tuple<std::int64_t, std::int64_t, std::size_t>, Change> corners_;  // accessor, mode, vertices
    int applied_ = 0, left_ = 0;
};

// Such meshes get no tangents.
bool GltfMirrors::is_compressed(std::int64_t mesh) const {
    const JsonValue primitives = root_["meshes"][static_cast<std::size_t>(mesh)]["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        if (!primitives[p]["extensions"]["KHR_draco_mesh_compression"].is_null()) return true;
    }
    return false;
}

bool GltfMirrors::can_change(std::size_t node) const {
    return root_["nodes"][node]["extensions"]["EXT_mesh_gpu_instancing"].is_null() &&
           animated_.pointed_at.count(static_cast<std::int64_t>(node)) == 0;
}

bool GltfMirrors::find(const std::vector<ModelTangents>& tangents) {
    std::set<std::int64_t> wanted;
    for (const ModelTangents& each : tangents) wanted.insert(each.mesh);
    const JsonValue nodes = root_["nodes"];
    const std::vector<bool> is_mirrored = mirrored_nodes(root_);
    animated_ = animated_nodes(root_);
    std::map<std::int64_t, std::size_t> shown;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const auto mesh = nodes[n]["mesh"].count();
        if (!mesh || wanted.count(*mesh) == 0 || is_compressed(*mesh)) continue;
        ++shown[*mesh];
        if (!is_mirrored[n] || !nodes[n]["skin"].is_null()) continue;
        if (can_change(n))
            meshes_[*mesh].nodes.push_back(n);
        else
            ++left_;
    }
    for (auto& [mesh, mirrored] : meshes_) mirrored.shown = shown[mesh];
    return !meshes_.empty() || left_ > 0;
}

// A vector without its w, or a tangent with it, for which a mirror turns the bitangent over, too.
Result<void> GltfMirrors::change_vectors(JsonValue accessor, const std::string& key, bool is_target, Change& change) {
    const auto values = buffers_.accessor(accessor);
    if (!values) return values.error();
    const bool has_w = key == "TANGENT" && !is_target;
    if ((*values)->components != (has_w ? 4 : 3)) return bad_gltf("the accessor of " + key + " is damaged");
    std::array<float, 3> low{}, high{};
    change.array.count = (*values)->count;
    for (std::size_t k = 0; k < (*values)->count; ++k) {
        for (int c = 0; c < (*values)->components; ++c) {
            const float value = (*values)->number(k, c);
            const float turned = value != 0.0f && (c == 0 || c == 3) ? -value : value;
            put_number(change.array.bytes, std::bit_cast<std::uint32_t>(turned));
            if (c == 3) continue;
            const auto at = static_cast<std::size_t>(c);
            low[at] = k == 0 ? turned : std::min(low[at], turned);
            high[at] = k == 0 ? turned : std::max(high[at], turned);
        }
    }
    std::string text;
    text_.member("accessors")->element(static_cast<std::size_t>(*accessor.count()))->write(text);
    JsonNode made(std::move(text));
    made.set("componentType", "5126");
    made.remove("normalized");
    made.remove("min");
    made.remove("max");
    const auto list = [](const std::array<float, 3>& v) {
        const auto number = [](float value) { return json_number(static_cast<double>(value)); };
        return '[' + number(v[0]) + ',' + number(v[1]) + ',' + number(v[2]) + ']';
    };
    if (key == "POSITION") {
        made.set("min", list(low));
        made.set("max", list(high));
    }
    made.write(change.array.text);
    change.array.like = *accessor.count();
    return {};
}

Result<void> GltfMirrors::change_corners(JsonValue primitive, std::size_t vertices, Change& change) {
    const JsonValue index = primitive["indices"];
    std::vector<std::uint32_t> corners;
    if (index.is_null()) {
        for (std::size_t k = 0; k < vertices; ++k) corners.push_back(static_cast<std::uint32_t>(k));
    } else {
        const auto indices = buffers_.accessor(index);
        if (!indices) return indices.error();
        const int type = (*indices)->type;
        if (type != 5121 && type != 5123 && type != 5125) return bad_gltf("indices are damaged");
        for (std::size_t k = 0; k < (*indices)->count; ++k) corners.push_back((*indices)->integer(k));
        change.array.like = index.count().value_or(-1);
    }
    corners = triangles_of(std::move(corners), mode_of(primitive));
    turn_over(corners);
    GltfArrays::set_indices(change.array, corners, vertices);
    return {};
}

Result<void> GltfMirrors::change_primitive(JsonValue primitive, JsonNode& node, bool is_copy) {
    const auto positions = buffers_.accessor(primitive["attributes"]["POSITION"]);
    if (!positions) return positions.error();
    const auto buffer = arrays_.buffer_for(primitive);
    if (!buffer) return buffer.error();
    Result<void> result;
    visit_attributes(primitive, [&](const std::string& key, JsonValue accessor, int target) {
        if (!result || (key != "POSITION" && key != "NORMAL" && key != "TANGENT")) return;
        const auto number = accessor.count();
        if (!number) {
            result = bad_gltf("the accessor of " + key + " is damaged");
            return;
        }
        const auto [change, is_new] = vectors_.try_emplace({*number, key + (target < 0 ? "" : "+")});
        if (is_new) {
            change->second.array.buffer = *buffer;
            result = change_vectors(accessor, key, target >= 0, change->second);
        }
        change->second.array.uses.push_back({attributes_node(node, target), key});
        if (!is_copy) ++change->second.own;
    });
    const std::int64_t mode = mode_of(primitive);
    if (!result || mode < 4 || mode > 6) return result;
    const std::size_t vertices = (*positions)->count;
    const std::int64_t index = primitive["indices"].is_null() ? -1 : primitive["indices"].count().value_or(-1);
    const auto [change, is_new] = corners_.try_emplace({index, mode, vertices});
    if (is_new) {
        change->second.array.buffer = *buffer;
        if (auto changed = change_corners(primitive, vertices, change->second); !changed) return changed;
    }
    change->second.array.uses.push_back({&node, "indices"});
    if (!is_copy) ++change->second.own;
    if (mode != 4) node.set("mode", "4");
    return {};
}

Result<void> GltfMirrors::change() {
    for (auto& [mesh, mirrored] : meshes_) {
        JsonNode& meshes = *text_.member("meshes");
        const bool is_copy = mirrored.shown != mirrored.nodes.size();
        std::size_t number = static_cast<std::size_t>(mesh);
        if (is_copy) {
            std::string copy;
            meshes.element(number)->write(copy);
            number = meshes.size();
            mirrored.copy = static_cast<std::int64_t>(number);
            meshes.append(std::move(copy));
        }
        const JsonValue primitives = root_["meshes"][static_cast<std::size_t>(mesh)]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            JsonNode& node = *meshes.element(number)->member("primitives")->element(p);
            if (auto changed = change_primitive(primitives[p], node, is_copy); !changed) return changed;
        }
        for (const std::size_t n : mirrored.nodes) {
            const JsonValue node = root_["nodes"][n];
            JsonNode& text = *text_.member("nodes")->element(n);
            if (holds_more(node) || animated_.scaled.count(static_cast<std::int64_t>(n)) > 0) {
                show_in_child(root_, n, text_, static_cast<std::int64_t>(number));
            } else {
                if (is_copy) text.set("mesh", std::to_string(number));
                turn_x_over(node, text);
            }
            ++applied_;
        }
    }
    const auto take = [this](Change& change) {
        GltfArrays::Array& array = change.array;
        array.is_in_place = array.like >= 0 && arrays_.uses(array.like) == change.own;
        arrays_.add(std::move(array));
    };
    for (auto& [key, change] : vectors_) take(change);
    for (auto& [key, change] : corners_) take(change);
    arrays_.place();
    return {};
}

std::vector<ModelTangents> GltfMirrors::turned(const std::vector<ModelTangents>& tangents) const {
    std::vector<ModelTangents> all;
    for (const ModelTangents& each : tangents) {
        const auto found = meshes_.find(each.mesh);
        if (found == meshes_.end() || found->second.copy >= 0) all.push_back(each);
        if (found == meshes_.end()) continue;
        ModelTangents made = each;
        if (found->second.copy >= 0) made.mesh = static_cast<int>(found->second.copy);
        turn_over(made.tangents);
        for (Float4& t : made.tangents) t = {t.x == 0.0f ? t.x : -t.x, t.y, t.z, -t.w};
        all.push_back(std::move(made));
    }
    return all;
}

}  // namespace

Result<std::optional<UnmirroredGltf>> apply_mirrors(std::span<const std::byte> file, const GltfChunks& chunks,
                                                    JsonValue root, const LoadBeside& load,
                                                    const std::vector<ModelTangents>& tangents) {
    if (tangents.empty()) return std::optional<UnmirroredGltf>{};
    JsonText text(chunks.json);
    GltfBuffers buffers(root, chunks.json.size(), chunks.binary, load);
    GltfViews views(root);
    GltfMirrors mirrors(root, text.root(), buffers, views, !chunks.binary.empty());
    if (!mirrors.find(tangents)) return std::optional<UnmirroredGltf>{};
    UnmirroredGltf made;
    if (auto changed = mirrors.change(); !changed) return changed.error();
    auto finished = finish_buffers(root, text.root(), views, chunks.binary, load);
    if (!finished) return finished.error();
    for (ChangedBuffer& buffer : finished->files)
        made.files.emplace(*path_of_uri(*root["buffers"][buffer.index]["uri"].text()), std::move(buffer.bytes));
    auto bytes = with_chunks(file, chunks, text.text(), finished->binary);
    if (!bytes) return bytes.error();
    made.bytes = std::move(*bytes);
    made.tangents = mirrors.turned(tangents);
    made.applied = mirrors.applied();
    made.left = mirrors.left();
    return std::optional(std::move(made));
}

}  // namespace tex::inline v1
