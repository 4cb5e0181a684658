// SPDX-License-Identifier: Apache-2.0
// mesh_selection.h: chooses the parts of a mesh that share a normal map, and their tangents.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tex/execution.h>
#include <tex/mesh.h>
#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// Where tangents come from: see tangents.h.
enum class TangentSource { file, mikktspace, meshopt };

inline constexpr Named<TangentSource> kTangentSourceNames[] = {
    {TangentSource::file, "file", "those that the mesh has stored"},
    {TangentSource::mikktspace, "mikktspace", "MikkTSpace: most bakers, Blender, Unity, Unreal"},
    {TangentSource::meshopt, "meshopt", "meshoptimizer 1.3 with its own weights: Godot"},
};

// Which parts of a mesh use a map. What is not given does not restrict the choice.
struct MeshSelection {
    std::string material;                   // a name, or an index into Mesh::materials
    std::optional<int> primitive;           // MeshPart::primitive
    std::string node;                       // the parts as this node places them in the scene; else in their own space
    bool in_scene = false;                  // without `node`: each part as the first node that shows it places it
    std::optional<int> uv_set;              // none: the one that the material's normal map uses, or 0
    std::optional<TangentSource> tangents;  // none: those of the file if all of these parts have them and uv_set is not
                                            // given; else mikktspace
    // How the map places the UVs. None: as the material says of its normal map, if `uv_set` is not another set.
    std::optional<UvTransform> uv_transform = {};
};

// Triangles of a SelectedPart that come from one part of the file.
struct SelectedPiece {
    std::string name;          // of the node that places the part, or of the part if that has none
    std::string material;      // may be empty
    std::size_t triangle = 0;  // the first one; the others follow up to that of the next piece
};

// The chosen parts, joined. The part has one set of UVs, in which the transform is applied, normals, and no tangents of
// vertices.
struct SelectedPart {
    MeshPart part;
    std::vector<Float4> tangents;  // one for each element of part.indices
    TangentSource source = TangentSource::mikktspace;
    bool has_normal_map = false;        // their material
    bool has_tangents = false;          // every part has stored tangents, whether or not they were chosen
    bool has_transform = false;         // UVs were moved: they are not those of the file
    std::vector<SelectedPiece> pieces;  // in the order of their triangles
    // Those of the mesh, and what the choice left out, as sentences that follow the name of the file.
    std::vector<std::string> remarks = {};
    // Positions, normals and triangles that in_tile() left out, for TransferInputs::around; otherwise empty.
    MeshPart rest = {};
};

// Joins the parts that `selection` names. Tangents are made for each part, from the moved UVs, before a node transforms
// it. Stored tangents stay as they are: a transform moves the map, not the tangents. If only some of the parts have the
// set of UVs, the others are left out, as they show no map.
//
// Preconditions (asserted): every part passes check_part().
// Errors: bad_option   there is no such material, node or part; several nodes have this name; the parts have different
//                      materials; no part has the set of UVs; a part lacks normals or the tangents
//         unsupported  the parts have more than kMaxTriangles triangles; and as make_tangents()
//         bad_data     as in_scene()
//         out_of_memory, cancelled
[[nodiscard]] Result<SelectedPart> select_part(const Mesh& mesh, const MeshSelection& selection,
                                               const Execution& execution = {});

// All parts as the nodes of the scene place them: once for each node that shows them; in their own space if there are
// no nodes at all. Parts that no node shows are left out. Each is called as its node is, if that has a name.
//
// Preconditions (asserted): every part passes check_part().
// Errors: bad_data     as in_scene(), or no node shows a part
//         out_of_memory
[[nodiscard]] Result<std::vector<MeshPart>> parts_in_scene(Mesh mesh);

// Which names belong together: numbers for TransferInputs.
struct MatchedNames {
    std::vector<int> low, high;                    // the number of each name; equal numbers belong together
    std::vector<std::string> lone_low, lone_high;  // those without partner, each once
};

// Names of parts of a low and a high mesh belong together if their stems are equal, in upper or lower case. The stem of
// "Rock_low" is "Rock"; what follows the mark does not count, so that "Rock_high", "rock_high_bolts" and
// "Rock_high.001" belong to it. A mark is low, lowpoly, lo or lp, or high, highpoly, hi or hp, between separators (_ -
// . or a space) or at the end; the last one counts. A name without a mark is its own stem. (Bakers agree on _low and
// _high.)
[[nodiscard]] MatchedNames match_names(const std::vector<std::string>& low, const std::vector<std::string>& high);

// The triangles whose UVs have their centre in a UDIM tile, with their tangents, and the others as `rest`. Tile 1001 +
// u + 10 v is the square from (u, v) to (u + 1, v + 1), where v points up and u is 0 to 9 (Foundry, Mari).
//
// Errors: bad_data (check_part(selected.part) fails), bad_option (tile is below 1001; no triangle is there),
//         out_of_memory
[[nodiscard]] Result<SelectedPart> in_tile(const SelectedPart& selected, int tile);

// The UDIM tiles of a part, and what does not fit into them.
struct UvTiles {
    std::vector<int> tiles;    // those with triangles, as in_tile() takes them, ascending
    std::size_t outside = 0;   // triangles in no tile, because u or v is negative or u is 10 or more
    std::size_t crossing = 0;  // triangles in a tile that reach more than 1e-4 out of it
};

// Errors: bad_data (check_part(selected.part) fails), out_of_memory
[[nodiscard]] Result<UvTiles> tiles_of(const SelectedPart& selected);

}  // namespace tex
#pragma GCC visibility pop
