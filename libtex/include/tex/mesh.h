// SPDX-License-Identifier: Apache-2.0
// mesh.h: triangles: reading, tangents, normals in tangent and object space; models.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- mesh ----------------------------------------------------------------------------------------------------------
//
// Triangle meshes in memory, with what tangent space needs: normals, texture coordinates (UV) and tangents.
//
// Conventions. A triangle's corners are counter-clockwise if seen from outside. Positions are in object space, in the
// unit of the file. u points right. v points the way that the file stores it (`v_axis`): down in glTF, whose UV origin
// is the top left corner of the picture, and up in OBJ. UVs are never converted, because 1 - v rounds, and tangents
// depend on the last bits.
//
// A tangent is (x, y, z, w). T = (x, y, z) points to greater u. w is 1 or -1: the bitangent B = w cross(N, T) points
// *up* in the picture, whichever way v points. So a normal map with y up gives, at a corner,
//
//     n = normalize(x T + y B + z N)
//
// This is glTF's convention, and that of MikkTSpace if v points up.

// Triangles that share a material: a primitive of glTF, or the faces of one object and material of OBJ.
//
// positions, normals, tangents, colors and each set of uvs have one element for each vertex. Normals, tangents and
// colours may be missing (empty), and there may be no set of UVs. Normals are as stored, of any length.
struct MeshPart {
    std::string name;   // of the mesh (glTF) or object (OBJ); may be empty
    int mesh = 0;       // parts of the same mesh of the file have the same number
    int primitive = 0;  // counts the parts of a mesh, as stored in the file
    int material = -1;  // an index into Mesh::materials, or -1
    YAxis v_axis = YAxis::up;

    std::vector<Float3> positions;
    std::vector<Float3> normals;
    std::vector<Float4> tangents;
    std::vector<std::vector<Float2>> uvs;
    std::vector<std::uint32_t> indices;  // three vertices for each triangle
    // Triangles that, each with the next one, were a quad in the file (OBJ): its corners 0, 1, 2 and 0, 2, 3.
    // Ascending.
    std::vector<std::uint32_t> quads;
    // Red, green and blue as stored: most files have them from 0 to 1. Read if MeshReadOptions::colors asks for them.
    std::vector<Float3> colors;
    // Other materials that the part can have (glTF's KHR_materials_variants), as indices like `material`. Ascending.
    std::vector<int> variants;

    [[nodiscard]] std::size_t triangles() const { return indices.size() / 3; }
    // Whether `number` is its material, or one of the others.
    [[nodiscard]] bool can_have(int number) const {
        return number == material || std::binary_search(variants.begin(), variants.end(), number);
    }
};

struct MeshMaterial {
    std::string name;
    std::string normal_map;       // the path of the normal map as the file states it; empty: none, or inside the file
    int uv_set = 0;               // the set of UVs that the normal map uses
    bool has_normal_map = false;  // in a file or inside the mesh's file
    // The one of the normal map. Without one, that which all textures of the material share.
    UvTransform uv_transform = {};
    bool mixed_transforms = false;  // there is no normal map, and the other textures differ in this
    AlphaMode alpha_mode = AlphaMode::opaque;
    double alpha_cutoff = 0.5;
    double alpha = 1.0;  // by which the alpha of textures is multiplied
};

// A place where a mesh stands in the scene.
struct MeshNode {
    std::string name;
    int mesh = 0;  // of the parts that stand here
    // From object space to the space of the scene, with the transforms of all parents: rows of a 3x4 matrix.
    std::array<double, 12> to_scene = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

// The contents of a file. Each part is stored once, however many nodes show it.
struct Mesh {
    std::vector<MeshPart> parts;
    std::vector<MeshMaterial> materials;
    std::vector<MeshNode> nodes;  // in depth-first order; those without a mesh are left out
    // What was left out and may matter, as sentences that follow the name of the file.
    std::vector<std::string> remarks = {};
};

// The largest number of triangles of a part: the reference implementation of MikkTSpace stops here, too.
inline constexpr std::size_t kMaxTriangles = std::size_t{1} << 28;

// Checks what all functions that take a part require: at least one triangle and at most kMaxTriangles; attributes for
// every vertex or none; indices of existing vertices; quads of existing triangles; finite numbers. read_mesh() returns
// such parts only. (Tangents of files may be of any length, and their w may be any number.)
//
// Errors: bad_data, with the first violation ("index 8 of triangle 3 is out of range: there are 8 vertices").
[[nodiscard]] TEX_API Result<void> check_part(const MeshPart& part);

// The part with the UVs of a set where a material puts them. Errors: bad_option (no such set), bad_data (infinite UVs).
[[nodiscard]] TEX_API Result<MeshPart> with_moved_uvs(MeshPart part, int uv_set, const UvTransform& transform);

// The part as it stands in the scene. Positions are multiplied by the matrix; normals by its inverse transpose, then
// normalised; tangents by the matrix, then normalised. If the determinant is negative, the node mirrors the part: each
// triangle's second and third corner change places, so that corners stay counter-clockwise, and w changes its sign
// (glTF 2.0, 3.7.4; Unity's odd negative scale). The quads of mirrored parts are forgotten.
//
// Errors: bad_data (check_part(part) fails; the matrix is not invertible or not finite, or coordinates become
// infinite), out_of_memory.
[[nodiscard]] TEX_API Result<MeshPart> in_scene(MeshPart part, const MeshNode& node);

// -- mesh io -------------------------------------------------------------------------------------------------------
//
// Reads triangle meshes from glTF 2.0 (.gltf, .glb), Wavefront OBJ, FBX, PLY and other files.
//
// The first bytes of a file decide how it is read; for Assimp's types, its extension comes first.
//
// glTF   Buffers are inside the file (GLB), in data URIs, or in files beside it. Such a file must be named by a
//        relative path that stays in the folder of the .gltf file or below it: "mesh.bin", "parts/mesh.bin", and be a
//        regular file. URIs with a scheme, absolute paths and ".." are refused, because a mesh from a stranger must not
//        choose what is read. Read: triangles, strips and fans (points and lines are skipped); indices of 8, 16 and 32
//        bits; POSITION, NORMAL, TANGENT and up to kMaxUvSets sets TEXCOORD_n, as floats or as integers
//        (KHR_mesh_quantization); sparse accessors; matrices, translations, rotations and scales of nodes; instances of
//        nodes (EXT_mesh_gpu_instancing); buffers compressed by meshoptimizer (EXT_meshopt_compression,
//        KHR_meshopt_compression); triangles compressed by Draco (KHR_draco_mesh_compression), which a separate process
//        decodes, as for other file types. Vertices that no triangle uses are dropped. UVs stay as stored; materials
//        say how textures move them (KHR_texture_transform). Ignored: skins, morph targets (the base shape is read),
//        animations, cameras. Other extensions: refused if the file requires them and they are not known to leave
//        triangles alone; else Mesh::remarks says if one was ignored where it might change UVs, normals or tangents.
//        Colours of vertices are COLOR_0 without its alpha, as floats or normalised integers.
// OBJ    v, vt, vn, f, o, usemtl. Polygons become fans around their first corner. Faces of the same object and material
//        are one part; those of them without UVs, or with a corner without a normal, are others. Lines end with LF, CR
//        and LF, or CR alone.
//        Colours are the three numbers after a position ("v x y z r g b"), which many programs write; a part has them
//        if all of its corners do. All else is ignored.
// other  What Assimp reads from one file: FBX, PLY, Collada, STL and more. As Assimp has crashed on damaged files, it
//        runs in a separate process, tex-mesh-reader, under the limits of memory and time that ReadOptions states,
//        and can open no other file. Polygons become triangles as Assimp divides them. Tangents count if the file has
//        bitangents, too. Coordinates are in the units and axes of Assimp.

inline constexpr int kMaxUvSets = 8;

struct MeshReadOptions {
    // The reader program of other file types: tex-mesh-reader, beside the program that `reader` names if it is given.
    ReadOptions reader;
    // The largest size in bytes of the file and of each file beside it.
    std::int64_t max_bytes = std::int64_t{4} << 30;
    // Read colours of vertices, which only transfer() uses.
    bool colors = false;
    // Read the bytes of all images in a model, not only those of normal maps.
    bool images = false;
};

// Reads a mesh. `path` "-" reads standard input; glTF from there can have no buffers in other files. Every part of the
// result passes check_part(); there is at least one part.
//
// Errors: io           the file or one beside it cannot be opened or read; the reader program cannot be started
//         bad_data     empty, truncated, damaged; indices out of range; infinite or NaN coordinates; nodes that contain
//                      themselves; accessors that leave their buffers; no triangles
//         unsupported  valid, but of a type not handled (glTF 1.0, compressed geometry, a required extension that is
//                      not listed above); more than max_bytes
//         out_of_memory
// No file content makes this function crash or hang beyond reader_timeout. The memory that it uses stays in proportion
// to the bytes that the files hold, not to what they claim.
[[nodiscard]] TEX_API Result<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options = {});

// The files that read_mesh() may read for this path: `path` itself, then the existing files that hold buffers of a glTF
// file, each once. A mesh is the same as long as these files are. Only `path` if it is "-" or not a regular file, which
// can be read only once.
//
// Errors: those of read_mesh(), as far as the glTF file without its buffers causes them.
[[nodiscard]] TEX_API Result<std::vector<std::string>> mesh_files(const std::string& path,
                                                                  const MeshReadOptions& options = {});

// -- mesh selection ------------------------------------------------------------------------------------------------
//
// Chooses the parts of a mesh that share a normal map, and their tangents.

// Where tangents come from: see make_tangents().
enum class TangentSource { file, mikktspace, meshopt };

inline constexpr Named<TangentSource> kTangentSourceNames[] = {
    {TangentSource::file, "file", "those that the mesh has stored"},
    {TangentSource::mikktspace, "mikktspace", "MikkTSpace on triangles: most bakers, Unity, Unreal"},
    {TangentSource::meshopt, "meshopt", "meshoptimizer 1.3 with its own weights: Godot after 4.6"},
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

// The chosen parts, joined. The part has one set of UVs, moved by the transform, normals, and no tangents of vertices.
struct SelectedPart {
    MeshPart part;
    std::vector<Float4> tangents;  // one for each element of part.indices
    TangentSource source = TangentSource::mikktspace;
    bool has_normal_map = false;        // their material
    bool has_tangents = false;          // every part has stored tangents, whether or not they were chosen
    bool has_transform = false;         // UVs were moved: they are not those of the file
    std::vector<SelectedPiece> pieces;  // in the order of their triangles
    // Warnings of the mesh, and what the choice left out, as sentences that follow the name of the file.
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
[[nodiscard]] TEX_API Result<SelectedPart> select_part(const Mesh& mesh, const MeshSelection& selection,
                                                       const Execution& execution = {});

// The most triangles that copies of parts make, if the caller does not allow more: about 3 GB in transfer().
inline constexpr std::size_t kMaxCopied = std::size_t{1} << 24;

// All parts as the nodes of the scene place them: once for each node that shows them; in their own space if there are
// no nodes at all. Parts that no node shows are left out. Each is called as its node is, if that has a name.
//
// A small file can show a mesh in a million places. So copies are counted before any is made: if a part is shown more
// than once, all together may have `most` triangles, where a copy of a part counts as 16 or more.
//
// Preconditions (asserted): every part passes check_part().
// Errors: bad_data     as in_scene(), or no node shows a part
//         unsupported  the nodes make too many copies
//         out_of_memory
[[nodiscard]] TEX_API Result<std::vector<MeshPart>> parts_in_scene(Mesh mesh, std::size_t most = kMaxCopied);

// A place in the scene where a part stands.
struct PartPlace {
    std::size_t part = 0;  // an index into the parts
    std::string name;      // of the node that shows it, if that has one, else of the part
    std::array<double, 12> to_scene = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // as that of MeshNode
};

struct SceneParts {
    std::vector<MeshPart> parts;
    std::vector<PartPlace> places;  // empty: each part stands once, where it is stored
};

// Copies of parts with fewer triangles than this, together, are made: rays are faster, and the memory does not matter.
inline constexpr std::size_t kFewCopied = std::size_t{1} << 18;

// parts_in_scene(), but parts that nodes show more than once are not copied if that would make kFewCopied triangles or
// more, so that a forest takes as much memory as one tree: they stay in their own space, for
// TransferInputs::high_places. Parts that are shown once have a place there, too, and are moved. If no part is shown
// more than once, or copies are made, the parts are those of parts_in_scene(), and there are no places.
// `most` limits copies and places of parts that are shown more than once, alone: a place counts as 16 triangles.
// Preconditions, errors: as parts_in_scene().
[[nodiscard]] TEX_API Result<SceneParts> places_in_scene(Mesh mesh, std::size_t most = kMaxCopied);

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
[[nodiscard]] TEX_API MatchedNames match_names(const std::vector<std::string>& low,
                                               const std::vector<std::string>& high);

// The triangles whose UVs have their centre in a UDIM tile, with their tangents, and the others as `rest`. Tile 1001 +
// u + 10 v is the square from (u, v) to (u + 1, v + 1), where v points up and u is 0 to 9 (Foundry, Mari).
//
// Errors: bad_data (check_part(selected.part) fails), bad_option (tile is below 1001; no triangle is there),
//         out_of_memory
[[nodiscard]] TEX_API Result<SelectedPart> in_tile(const SelectedPart& selected, int tile);

// The UDIM tiles of a part, and what does not fit into them.
struct UvTiles {
    std::vector<int> tiles;    // those with triangles, as in_tile() takes them, ascending
    std::size_t outside = 0;   // triangles in no tile, because u or v is negative or u is 10 or more
    std::size_t crossing = 0;  // triangles in a tile that reach more than 1e-4 out of it
};

// Errors: bad_data (check_part(selected.part) fails), out_of_memory
[[nodiscard]] TEX_API Result<UvTiles> tiles_of(const SelectedPart& selected);

// -- tangents ------------------------------------------------------------------------------------------------------
//
// Makes the tangents of a mesh, by the method that a baker or an engine uses.
//
// A normal map and the tangents that decode it belong together. If the engine makes tangents by another method than the
// baker, the shading is wrong by the angle between the two, which shows most along the seams of UV charts.

// How tangents are made.
//
//   mikktspace  corners weld if position, normal and UV are equal. Triangles around a corner form groups, which end at
//               edges that are not shared and where the UVs change from mirrored to not mirrored. A group's tangent is
//               the sum of the directions in which u grows on its triangles, each projected into the plane of the
//               normal and weighted by the triangle's angle. Degenerate triangles take the tangents of their
//               neighbours. (Morten S. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and mikktspace.h.)
//               Results are those of the reference implementation, including the neighbours that it misses: it leaves
//               the edges of the last vertex unsorted.
//   meshopt     meshoptimizer 1.3 (meshopt_generateTangents without flags): similar groups, but larger triangles weigh
//               more. The weight is the product of the angle and the lengths of both edges, in the plane of the normal.
enum class TangentMethod { mikktspace, meshopt };

inline constexpr Named<TangentMethod> kTangentMethodNames[] = {
    {TangentMethod::mikktspace, "mikktspace", "MikkTSpace on triangles: most bakers, Unity, Unreal"},
    {TangentMethod::meshopt, "meshopt", "meshoptimizer 1.3 with its own weights: Godot after 4.6"},
};

// The most triangles that may meet at one vertex if their tangents point in opposite directions (mikktspace) or at all
// (meshopt). The methods compare all pairs of these.
inline constexpr int kMaxFan = 4096;

// The tangents of all corners: one for each element of part.indices, from set `uv_set` of its UVs. Tangents have unit
// length; corners for which the method finds no direction have (1, 0, 0). w is as described above.
// Vertices whose corners have different tangents must be split before the tangents become an attribute of vertices.
//
// Errors: bad_data     check_part(part) fails
//         bad_option   the part has no normals or no such set of UVs
//         unsupported  more than kMaxFan triangles meet at one vertex, as explained there
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
// Memory: about 50 bytes for each corner, including the result.
[[nodiscard]] TEX_API Result<std::vector<Float4>> make_tangents(const MeshPart& part,
                                                                TangentMethod method = TangentMethod::mikktspace,
                                                                int uv_set = 0, const Execution& execution = {});

// The tangents that the part's vertices have, one for each corner. Errors: bad_option (there are none), out_of_memory.
[[nodiscard]] TEX_API Result<std::vector<Float4>> stored_tangents(const MeshPart& part);

// -- convert -------------------------------------------------------------------------------------------------------
//
// Converts normal maps between tangent space and object space, with the tangents of a mesh.
//
// An engine makes three vectors at each texel from a triangle's corners (`Decoder`), and decodes a texel t = (x, y, z)
// of the map, y up, with them:
//
//     n = normalize(x T' + y B' + z N')
//
// where z is rebuilt from x and y if the engine does so (rebuilds_z()). For it, x and y must be those of the texture:
// UnpackOptions::keep_length.
// Engines differ in these vectors, so a map decodes to other normals than it was made for, unless both are the same.
// to_tangent_space() is the exact inverse of to_object_space() for each decoder, of unit vectors with z >= 0:
//
//     r0 = cross(B', N'), r1 = cross(N', T'), r2 = cross(T', B'), s = the sign of dot(T', r0)
//     t = normalize(s (dot(n, r0), dot(n, r1), dot(n, r2)))
//
// A map in object space holds x, y and z of the mesh's own axes, which are those of the file: right-handed, with y up
// in glTF. z may be negative.

// How an engine makes the vectors T', B' and N' that decode a texel (see above) from the normals N, the tangents T
// and the signs w of a triangle's corners. N and T are normalised at the corners first. Interpolation is linear in UV
// space.
//
//   per vertex     T' and N' are interpolated, B' is the interpolated w cross(N, T); nothing is normalised
//   per fragment   T' and N' are interpolated, B' = w cross(N', T'); nothing is normalised
//   normalized     as per vertex, but B is normalised at the corners, and T', B' and N' after interpolation
//
// Decoders of the same kind give the same vectors. Where engines differ in y, or in how exactly they store tangents,
// the decoders here do not: Unreal reads maps with y down and stores tangents in 8 bits by default. rebuilds_z() says
// which ones ignore z.
enum class DecoderKind { per_vertex, per_fragment, normalized };

inline constexpr Named<DecoderKind> kDecoderKindNames[] = {
    {DecoderKind::per_vertex, "per-vertex", "B is made at the vertices; nothing is normalised"},
    {DecoderKind::per_fragment, "per-fragment", "B is made at the fragment; nothing is normalised"},
    {DecoderKind::normalized, "normalized", "B is made at the vertices; T, B and N are normalised"},
};

enum class Decoder {
    unity_builtin,
    unity_urp,
    unity_hdrp,
    unreal,
    godot,
    gltf,
    blender,
    three,
    substance_vertex,
    substance_fragment,
};

inline constexpr Named<Decoder> kDecoderNames[] = {
    {Decoder::unity_builtin, "unity-builtin", "Unity's built-in pipeline, xNormal: per vertex"},
    {Decoder::unity_urp, "unity-urp", "Unity URP: per fragment"},
    {Decoder::unity_hdrp, "unity-hdrp", "Unity HDRP: per fragment"},
    {Decoder::unreal, "unreal", "Unreal: per fragment"},
    {Decoder::godot, "godot", "Godot: per vertex"},
    {Decoder::gltf, "gltf", "glTF's formula: per fragment"},
    {Decoder::blender, "blender", "Blender (Cycles): per fragment"},
    {Decoder::three, "three", "three.js: normalised per vertex and per fragment"},
    {Decoder::substance_vertex, "substance-vertex", "Substance, binormal per vertex"},
    {Decoder::substance_fragment, "substance-fragment", "Substance, binormal per fragment"},
};

[[nodiscard]] constexpr DecoderKind decoder_kind(Decoder decoder) {
    switch (decoder) {
        case Decoder::unity_builtin:
        case Decoder::godot:
        case Decoder::substance_vertex: return DecoderKind::per_vertex;
        case Decoder::three: return DecoderKind::normalized;
        case Decoder::unity_urp:
        case Decoder::unity_hdrp:
        case Decoder::unreal:
        case Decoder::gltf:
        case Decoder::blender:
        case Decoder::substance_fragment: break;
    }
    return DecoderKind::per_fragment;
}

// Whether the engine ignores the z of every texture, and takes sqrt(max(0, 1 - x^2 - y^2)) for it.
[[nodiscard]] constexpr bool rebuilds_z(Decoder decoder) { return decoder == Decoder::godot; }

// The tangent space of a map: a mesh with a tangent for each corner, and a decoder. Refers to the caller's objects.
struct TangentSpace {
    const MeshPart& part;
    const std::vector<Float4>& tangents;  // one for each element of part.indices
    int uv_set = 0;
    Decoder decoder = Decoder::gltf;
    std::string file = {};  // that errors name; may be empty
};

// The padding that fills the whole map.
inline constexpr int kPadAll = 1 << 30;

// The most subsamples of a texel in each direction.
inline constexpr int kMaxSubsamples = 8;

struct ConvertOptions {
    int padding = kPadAll;  // the width in texels of the border around each chart, 0 or more
    int subsamples = 1;     // of a texel, in each direction, 1 to kMaxSubsamples
};

// Whether every option is in its range. The verbs call it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const ConvertOptions& options);

// How a texel of a converted map got its normal.
enum class Coverage : std::uint8_t {
    none,      // it is background: (0, 0, 1)
    padding,   // it is a copy of the nearest texel that has a normal
    gutter,    // it continues the nearest triangle's plane (object space only)
    triangle,  // a triangle covers it
};

struct ConvertedMap {
    NormalMap map;
    Plane<Coverage> coverage;
    std::int64_t covered = 0;    // texels that triangles cover
    std::int64_t overlaps = 0;   // those (subsamples, if there are any) that several triangles cover: the first decides
    std::int64_t moved = 0;      // those that triangles from outside of 0 to 1 cover, too, and do not decide
    std::int64_t backward = 0;   // those whose z is negative in tangent space, so that most encodings cannot hold them
    std::int64_t singular = 0;   // those where T', B' and N' lie in one plane: they are (0, 0, 1) in tangent space
    std::int64_t unmatched = 0;  // refit() only: those that no triangle of the first space covers
};

// Converts a map.
//
// A texel belongs to the triangle whose UVs contain its centre; of two triangles that share an edge, exactly one does.
// The map repeats, so UVs may be outside of 0 to 1. Where several triangles cover a texel, those between 0 and 1 come
// before those that lie elsewhere and repeat there, so that shells which were moved by whole units decide nothing; then
// the first one of the part counts. Corners are rounded to 1/256 texel.
//
// With n subsamples, a texel is divided into n x n squares. Each belongs to a triangle as a texel does, and converts
// the texel's normal with its own T', B' and N'. The texel becomes the normalised sum of those that triangles cover,
// however few they are. Corners are then rounded to 1/256 square.
//
// The border of `padding` texels around the charts is filled afterwards. In object space, its first two texels (the
// gutter) are decoded from the map, with the nearest triangle continued beyond its edge; no weight of a corner goes
// beyond -1. All others are copies of the nearest texel. A map in object space often has no valid texels outside of its
// charts, so to_tangent_space() reads none of them: its border consists of copies alone.
//
// Data beside the normals (NormalMap::blue, alpha, length) stay where they are, as they are.
//
// Errors: bad_data     check_part(space.part) fails
//         bad_option   the map has no texels; as validate(options); no normals, no such set of UVs, not as many
//                      tangents as corners; no triangle covers a texel
//         unsupported  UVs beyond a million; a triangle covers more than 16 repeats of the map, or more than 2^22
//                      texels, in one direction
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
// Memory: 12 bytes for each texel of the result, 4 for each of its other data, and 1 for its coverage; 4 more while the
// border is filled; and about 80 bytes for each triangle.
[[nodiscard]] TEX_API Result<ConvertedMap> to_object_space(const NormalMap& map, const TangentSpace& space,
                                                           const ConvertOptions& options = {},
                                                           const Execution& execution = {});
[[nodiscard]] TEX_API Result<ConvertedMap> to_tangent_space(const NormalMap& map, const TangentSpace& space,
                                                            const ConvertOptions& options = {},
                                                            const Execution& execution = {});

// Makes a map in the tangent space `from` fit the tangent space `to`: another decoder, other tangents, or another
// version of the mesh with the same UVs. to_object_space() with `from`, padded, then to_tangent_space() with `to`.
// The counts are those of the second step. If charts share texels, the first triangle of each mesh decides.
//
// Errors and memory: as above, with two maps in memory besides `map`.
[[nodiscard]] TEX_API Result<ConvertedMap> refit(const NormalMap& map, const TangentSpace& from, const TangentSpace& to,
                                                 const ConvertOptions& options = {}, const Execution& execution = {});

// -- model ---------------------------------------------------------------------------------------------------------
//
// glTF models with their normal maps: meshes, materials, images.
//
// A glTF material names textures by the part that they play, a slot: normalTexture, baseColorTexture ... A texture
// names an image, which is a file beside the model, or bytes in it.

// The slots that hold normals.
enum class NormalSlot { normal, clearcoat_normal };

inline constexpr Named<NormalSlot> kNormalSlotNames[] = {
    {NormalSlot::normal, "normal", "normalTexture"},
    {NormalSlot::clearcoat_normal, "clearcoat-normal", "clearcoatNormalTexture of KHR_materials_clearcoat"},
};

// A slot of a material that uses an image.
struct ImageUse {
    int material = 0;       // an index into Mesh::materials
    std::string slot;       // "baseColorTexture"
    bool is_color = false;  // glTF reads the slot as sRGB colours
};

// An image of a model.
struct ModelImage {
    std::string name;       // as the model calls it, else the name of its file, else "image 3"
    std::string file;       // the path of its file, which need not exist; empty: its bytes are in the model
    std::string mime_type;  // as the model states it; may be empty
    std::vector<std::byte> bytes;
    std::vector<ImageUse> uses;  // of this image, and of others of the same file or buffer view
    std::optional<Error> error;  // why it cannot be read, if the model says enough to know that
};

// A normal map that a material uses.
struct ModelMap {
    int material = 0;  // an index into Mesh::materials
    NormalSlot slot = NormalSlot::normal;
    int image = -1;  // an index into Model::images; -1: none that libtex knows
    int uv_set = 0;
    UvTransform uv_transform = {};
    double scale = 1.0;            // x and y are multiplied by it (normalTexture.scale)
    bool is_double_sided = false;  // the material
};

// A slot of a material that uses a texture of any kind.
struct ModelTexture {
    int material = 0;       // an index into Mesh::materials
    std::string slot;       // "baseColorTexture"
    std::string extension;  // of glTF, such as KHR_materials_clearcoat, that has the slot; may be empty
    int image = -1;         // an index into Model::images; -1: none that libtex knows
    int uv_set = 0;
    UvTransform uv_transform = {};
};

struct Model {
    std::string file;  // its path
    Mesh mesh;
    std::vector<ModelImage> images;
    std::vector<ModelMap> maps;               // by material, then slot
    std::vector<ModelTexture> textures = {};  // by material
};

// Whether a file begins as a glTF model does, as text or as GLB, or is called .gltf or .glb and begins as no other type
// that libtex knows. False if it cannot be read; "-" is not looked at.
[[nodiscard]] TEX_API bool is_model(const std::string& path);

// Reads a model: its meshes as read_mesh(), and the bytes of those images that are inside it and that a normal slot
// uses, or of all with MeshReadOptions::images. Of the sources of a texture, the first that is there counts:
// KHR_texture_basisu, MSFT_texture_dds, EXT_texture_webp, else the texture's own. An image in a file must be in the
// folder of the model or below it, as buffers must.
//
// Errors: those of read_mesh(); unsupported (the file is not glTF; it is "-").
[[nodiscard]] TEX_API Result<Model> read_model(const std::string& path, const MeshReadOptions& options = {});

// Reads no geometry: of the mesh, the materials alone. Errors: those of read_model() without geometry.
[[nodiscard]] TEX_API Result<Model> read_model_maps(const std::string& path, const MeshReadOptions& options = {});

// The material and the image of a map, as messages name them: "Leather: leather_n.png"; "2 (clearcoat): image 3".
[[nodiscard]] TEX_API std::string map_name(const Model& model, const ModelMap& map);

// Reads the image of a map. Its content decides how, whatever mime_type says. Errors: those of read_texture(); bad_data
// (the map has no image). They name the image.
[[nodiscard]] TEX_API Result<Texture> read_map(const Model& model, const ModelMap& map,
                                               const ReadOptions& options = {});

// The triangles that the map is on: those of its material, with its UV set and transform.
[[nodiscard]] TEX_API MeshSelection selection_of(const Model& model, const ModelMap& map);

// The maps of a material, by its name or its number from 0; all maps if `material` is empty. Errors: bad_option (there
// is no such material).
[[nodiscard]] TEX_API Result<std::vector<ModelMap>> maps_of(const Model& model, const std::string& material);

}  // namespace tex::inline v1
