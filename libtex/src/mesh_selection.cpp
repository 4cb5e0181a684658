// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "mesh/part_names.h"
#include "mesh/shown_parts.h"
#include "mesh/uv_tiles.h"
#include "rows/usable.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

Error unfit(std::string reason, ErrorDetail detail = ErrorDetail::none) {
    return {ErrorCode::bad_option, {}, std::move(reason), detail};
}

std::string quoted(const std::string& name) { return '"' + name + '"'; }

// The first names of a list, for a message.
std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 8;
    std::string text;
    for (std::size_t k = 0; k < std::min(kMost, names.size()); ++k) text += (k == 0 ? "" : ", ") + names[k];
    if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
    return text;
}

std::string material_name(const Mesh& mesh, int material) {
    if (material < 0 || static_cast<std::size_t>(material) >= mesh.materials.size()) return "no material";
    const std::string& name = mesh.materials[static_cast<std::size_t>(material)].name;
    return name.empty() ? std::to_string(material) : quoted(name);
}

std::string plain_material_name(const Mesh& mesh, int material) {
    const bool exists = material >= 0 && static_cast<std::size_t>(material) < mesh.materials.size();
    return exists ? mesh.materials[static_cast<std::size_t>(material)].name : std::string();
}

Result<int> material_called(const Mesh& mesh, const std::string& text) {
    for (std::size_t k = 0; k < mesh.materials.size(); ++k) {
        if (mesh.materials[k].name == text) return static_cast<int>(k);
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error == std::errc() && end == text.data() + text.size() && index < mesh.materials.size())
        return static_cast<int>(index);
    std::vector<std::string> names;
    for (std::size_t k = 0; k < mesh.materials.size(); ++k) names.push_back(material_name(mesh, static_cast<int>(k)));
    return unfit("has no material " + quoted(text) + (names.empty() ? "" : "; it has " + listed(names)));
}

Result<const MeshNode*> node_called(const Mesh& mesh, const std::string& name) {
    const MeshNode* found = nullptr;
    std::vector<std::string> names;
    for (const MeshNode& node : mesh.nodes) {
        names.push_back(quoted(node.name));
        if (node.name != name) continue;
        if (found != nullptr) return unfit("has several nodes called " + quoted(name));
        found = &node;
    }
    if (found == nullptr)
        return unfit("has no node " + quoted(name) + " with a mesh" +
                     (names.empty() ? "" : "; it has " + listed(names)));
    return found;
}

// The parts that are chosen, and what they have in common.
struct Choice {
    std::vector<const MeshPart*> parts;
    int material = -1;  // that the parts are to have
    const MeshNode* node = nullptr;
    int uv_set = 0;
    TangentSource source = TangentSource::mikktspace;
    bool has_normal_map = false, has_tangents = false;
    bool in_scene = false;
    UvTransform transform;
    std::vector<std::string> remarks;
};

Result<void> choose_parts(const Mesh& mesh, const MeshSelection& selection, Choice& choice) {
    int material = -1;
    if (!selection.material.empty()) {
        const auto called = material_called(mesh, selection.material);
        if (!called) return called.error();
        material = *called;
    }
    choice.in_scene = selection.in_scene && selection.node.empty();
    if (!selection.node.empty()) {
        const auto called = node_called(mesh, selection.node);
        if (!called) return called.error();
        choice.node = *called;
    }
    for (const MeshPart& part : mesh.parts) {
        if (!selection.material.empty() && !part.can_have(material)) continue;
        if (selection.primitive && part.primitive != *selection.primitive) continue;
        if (choice.node != nullptr && part.mesh != choice.node->mesh) continue;
        choice.parts.push_back(&part);
    }
    if (choice.parts.empty()) {
        const bool by_material = !selection.material.empty() && !selection.primitive && selection.node.empty();
        return unfit(by_material ? "has no triangles with the material " + material_name(mesh, material)
                                 : "has no part with this material, primitive and node");
    }
    choice.material = selection.material.empty() ? choice.parts.front()->material : material;
    if (!selection.material.empty()) return {};
    std::vector<std::string> names;
    for (const MeshPart* part : choice.parts) {
        std::string name = material_name(mesh, part->material);
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    }
    if (names.size() > 1)
        return unfit("has " + std::to_string(names.size()) + " materials: " + listed(names),
                     ErrorDetail::several_materials);
    return {};
}

// Parts without the set of UVs show no map: bakers and engines pass over them if there are others.
Result<void> leave_out_parts_without_uvs(Choice& choice) {
    const auto set = static_cast<std::size_t>(choice.uv_set);
    const auto has_set = [&](const MeshPart* part) { return choice.uv_set >= 0 && set < part->uvs.size(); };
    if (std::none_of(choice.parts.begin(), choice.parts.end(), has_set)) {
        const MeshPart& part = *choice.parts.front();
        const std::string name = part.name.empty() ? "" : quoted(part.name) + " ";
        if (part.uvs.empty()) return unfit(name + "has no UVs, which say where the map is", ErrorDetail::no_uvs);
        return unfit(name + "has no UV set " + std::to_string(choice.uv_set) + "; the last one is " +
                     std::to_string(part.uvs.size() - 1));
    }
    std::size_t without = 0;
    for (const MeshPart* part : choice.parts) without += has_set(part) ? 0 : part->triangles();
    std::erase_if(choice.parts, [&](const MeshPart* part) { return !has_set(part); });
    if (without > 0) {
        choice.remarks.push_back(std::to_string(without) + (without == 1 ? " triangle has" : " triangles have") +
                                 (choice.uv_set == 0 ? " no UVs" : " no UV set " + std::to_string(choice.uv_set)) +
                                 " and shows no map");
        if (without > 1) choice.remarks.back().replace(choice.remarks.back().rfind("shows"), 5, "show");
    }
    return {};
}

void choose_uvs(const Mesh& mesh, const MeshSelection& selection, Choice& choice) {
    const int material = choice.material;
    if (material < 0 || static_cast<std::size_t>(material) >= mesh.materials.size()) {
        choice.uv_set = selection.uv_set.value_or(0);
        choice.transform = selection.uv_transform.value_or(UvTransform{});
        return;
    }
    const MeshMaterial& of = mesh.materials[static_cast<std::size_t>(material)];
    choice.has_normal_map = of.has_normal_map;
    choice.uv_set = selection.uv_set.value_or(of.uv_set);
    const bool same_set = choice.uv_set == of.uv_set;
    choice.transform = selection.uv_transform.value_or(same_set ? of.uv_transform : UvTransform{});
    if (of.mixed_transforms && !selection.uv_transform) {
        choice.remarks.push_back("material " + material_name(mesh, material) +
                                 " has no normal map, and its textures move UVs in several ways "
                                 "(KHR_texture_transform); the map is put on the UVs as they are stored");
    }
}

// Faces of OBJ without normals are a part of their own.
Error without_normals(const Choice& choice, const MeshPart& part, const std::string& name) {
    std::size_t without = 0, with = 0;  // triangles
    for (const MeshPart* other : choice.parts)
        if (other->mesh == part.mesh) (other->normals.empty() ? without : with) += other->triangles();
    const std::string some = std::to_string(without) + " of " + std::to_string(without + with) + " triangles with ";
    return unfit(name + "has " + (with > 0 ? some + "corners that have no normal" : "no normals") +
                 ", which tangent space needs");
}

Result<void> choose_attributes(const Mesh& mesh, const MeshSelection& selection, Choice& choice) {
    choice.remarks = mesh.remarks;
    choose_uvs(mesh, selection, choice);
    if (const auto left = leave_out_parts_without_uvs(choice); !left) return left.error();
    bool all_have_tangents = true;
    for (const MeshPart* part : choice.parts) {
        const std::string name = part->name.empty() ? "" : quoted(part->name) + " ";
        if (part->normals.empty()) return without_normals(choice, *part, name);
        if (part->tangents.empty()) {
            all_have_tangents = false;
            if (selection.tangents == TangentSource::file)
                return unfit(name + "has no tangents; make them", ErrorDetail::no_tangents);
        }
    }
    choice.has_tangents = all_have_tangents;
    const bool stored = all_have_tangents && !selection.uv_set;
    choice.source = selection.tangents.value_or(stored ? TangentSource::file : TangentSource::mikktspace);
    return {};
}

Result<std::vector<Float4>> tangents_of(const MeshPart& part, const Choice& choice, const Execution& execution) {
    if (choice.source == TangentSource::file) return stored_tangents(part);
    const bool is_meshopt = choice.source == TangentSource::meshopt;
    return make_tangents(part, is_meshopt ? TangentMethod::meshopt : TangentMethod::mikktspace, choice.uv_set,
                         execution);
}

// The part as the node places it. A node may mirror a part, so each corner becomes a vertex with its own tangent.
Result<MeshPart> placed(const MeshPart& part, std::vector<Float4> tangents, const MeshNode& node) {
    MeshPart corners;
    corners.v_axis = part.v_axis;
    corners.uvs.resize(part.uvs.size());
    for (const std::uint32_t v : part.indices) {
        corners.indices.push_back(static_cast<std::uint32_t>(corners.positions.size()));
        corners.positions.push_back(part.positions[v]);
        corners.normals.push_back(part.normals[v]);
        for (std::size_t k = 0; k < part.uvs.size(); ++k) corners.uvs[k].push_back(part.uvs[k][v]);
    }
    corners.quads = part.quads;
    corners.tangents = std::move(tangents);
    return in_scene(std::move(corners), node);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

void join(SelectedPart& joined, const MeshPart& part, int uv_set, const std::vector<Float4>& tangents) {
    const auto first = static_cast<std::uint32_t>(joined.part.positions.size());
    append(joined.part.positions, part.positions);
    append(joined.part.normals, part.normals);
    append(joined.part.uvs.front(), part.uvs[static_cast<std::size_t>(uv_set)]);
    const auto triangle = static_cast<std::uint32_t>(joined.part.triangles());
    for (const std::uint32_t v : part.indices) joined.part.indices.push_back(first + v);
    for (const std::uint32_t t : part.quads) joined.part.quads.push_back(triangle + t);
    append(joined.tangents, tangents);
}

// The first node that shows the part, or null.
const MeshNode* node_of(const Mesh& mesh, const MeshPart& part) {
    const auto shows = [&](const MeshNode& node) { return node.mesh == part.mesh; };
    const auto found = std::find_if(mesh.nodes.begin(), mesh.nodes.end(), shows);
    return found == mesh.nodes.end() ? nullptr : &*found;
}

Result<SelectedPart> joined_parts(const Mesh& mesh, const Choice& choice, const Execution& execution) {
    std::size_t triangles = 0, vertices = 0;
    for (const MeshPart* part : choice.parts) {
        triangles += part->triangles();
        vertices += part->positions.size();
    }
    if (triangles > kMaxTriangles || vertices > UINT32_MAX)
        return Error{ErrorCode::unsupported, {}, "has more than 2^28 triangles with this material"};
    SelectedPart joined;
    joined.source = choice.source;
    joined.has_normal_map = choice.has_normal_map;
    joined.has_tangents = choice.has_tangents;
    joined.part.v_axis = choice.parts.front()->v_axis;
    joined.part.uvs.resize(1);
    joined.has_transform = !(choice.transform == UvTransform{});
    joined.remarks = choice.remarks;
    for (const MeshPart* stored : choice.parts) {
        std::optional<MeshPart> moved;
        if (joined.has_transform) {
            auto done = with_moved_uvs(*stored, choice.uv_set, choice.transform);
            if (!done) return done.error();
            moved = std::move(*done);
        }
        const MeshPart* const part = moved ? &*moved : stored;
        auto tangents = tangents_of(*part, choice, execution);
        if (!tangents) return tangents.error();
        const MeshNode* const node = choice.in_scene ? node_of(mesh, *part) : choice.node;
        joined.pieces.push_back(SelectedPiece{node != nullptr && !node->name.empty() ? node->name : part->name,
                                              plain_material_name(mesh, choice.material), joined.part.triangles()});
        if (node == nullptr) {
            join(joined, *part, choice.uv_set, *tangents);
            continue;
        }
        const auto in_place = placed(*part, std::move(*tangents), *node);
        if (!in_place) return in_place.error();
        const auto turned = stored_tangents(*in_place);
        if (!turned) return turned.error();
        join(joined, *in_place, choice.uv_set, *turned);
    }
    return joined;
}

// Drops those without triangles.
void drop_empty(std::vector<SelectedPiece>& pieces, std::size_t triangles) {
    for (std::size_t k = pieces.size(); k-- > 0;) {
        const std::size_t end = k + 1 < pieces.size() ? pieces[k + 1].triangle : triangles;
        if (pieces[k].triangle == end) pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
    }
}

}  // namespace

Result<SelectedPart> select_part(const Mesh& mesh, const MeshSelection& selection, const Execution& execution) {
    return no_throw([&]() -> Result<SelectedPart> {
        Choice choice;
        if (const auto chosen = choose_parts(mesh, selection, choice); !chosen) return chosen.error();
        if (const auto chosen = choose_attributes(mesh, selection, choice); !chosen) return chosen.error();
        return joined_parts(mesh, choice, execution);
    });
}

Result<std::vector<MeshPart>> parts_in_scene(Mesh mesh, std::size_t most) {
    return no_throw([&]() -> Result<std::vector<MeshPart>> {
        if (mesh.nodes.empty()) return std::move(mesh.parts);
        const ShownParts shown(mesh);
        if (auto fits = shown.check(most); !fits) return fits.error();
        return copies_of_shown(mesh, shown);
    });
}

Result<SceneParts> places_in_scene(Mesh mesh, std::size_t most) {
    return no_throw([&]() -> Result<SceneParts> {
        if (mesh.nodes.empty()) return SceneParts{std::move(mesh.parts), {}};
        const ShownParts shown(mesh);
        return places_of_shown(mesh, shown, most);
    });
}

Result<SelectedPart> in_tile(const SelectedPart& selected, int tile) {
    return no_throw([&]() -> Result<SelectedPart> {
        if (auto sound = check_part(selected.part); !sound) return sound.error();
        if (tile < 1001) return bad_option("tile: must be 1001 or more");
        SelectedPart cut = selected;
        MeshPart& part = cut.part;
        std::vector<std::uint32_t> kept;  // triangles
        std::vector<std::uint32_t>& rest = cut.rest.indices;
        for (std::size_t t = 0; t < selected.part.triangles(); ++t) {
            if (tile_of(selected.part, t) != tile) {
                rest.insert(rest.end(), &selected.part.indices[3 * t], &selected.part.indices[3 * t] + 3);
                continue;
            }
            std::copy_n(&selected.part.indices[3 * t], 3, &part.indices[3 * kept.size()]);
            std::copy_n(&selected.tangents[3 * t], 3, &cut.tangents[3 * kept.size()]);
            kept.push_back(static_cast<std::uint32_t>(t));
        }
        if (kept.empty()) return unfit("has no triangle in UDIM tile " + std::to_string(tile));
        if (!rest.empty()) cut.rest.positions = part.positions;
        if (!rest.empty()) cut.rest.normals = part.normals;
        part.indices.resize(3 * kept.size());
        cut.tangents.resize(3 * kept.size());
        for (SelectedPiece& piece : cut.pieces) {
            const auto first = std::lower_bound(kept.begin(), kept.end(), piece.triangle);
            piece.triangle = static_cast<std::size_t>(first - kept.begin());
        }
        drop_empty(cut.pieces, kept.size());
        part.quads.clear();
        for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
            const std::vector<std::uint32_t>& quads = selected.part.quads;
            if (kept[k + 1] == kept[k] + 1 && std::binary_search(quads.begin(), quads.end(), kept[k]))
                part.quads.push_back(static_cast<std::uint32_t>(k));
        }
        return cut;
    });
}

Result<UvTiles> tiles_of(const SelectedPart& selected) {
    return no_throw([&]() -> Result<UvTiles> {
        if (auto sound = check_part(selected.part); !sound) return sound.error();
        UvTiles found;
        std::set<int> tiles;
        for (std::size_t t = 0; t < selected.part.triangles(); ++t) {
            const int tile = tile_of(selected.part, t);
            if (tile == 0) {
                ++found.outside;
                continue;
            }
            tiles.insert(tile);
            if (leaves_tile(selected.part, t, tile)) ++found.crossing;
        }
        found.tiles.assign(tiles.begin(), tiles.end());
        return found;
    });
}

MatchedNames match_names(const std::vector<std::string>& low, const std::vector<std::string>& high) {
    std::map<std::string, int> numbers;
    MatchedNames matched;
    matched.low = numbered_names(low, PartSide::low, numbers);
    matched.high = numbered_names(high, PartSide::high, numbers);
    matched.lone_low = lone_names(low, matched.low, matched.high);
    matched.lone_high = lone_names(high, matched.high, matched.low);
    return matched;
}

}  // namespace tex::inline v1
