// SPDX-License-Identifier: Apache-2.0
// mesh.h: triangle meshes in memory, with what tangent space needs: normals, texture coordinates (UV) and tangents.
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

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

struct Float2 {
    float x = 0.0f, y = 0.0f;
};
struct Float3 {
    float x = 0.0f, y = 0.0f, z = 0.0f;
};
struct Float4 {
    float x = 0.0f, y = 0.0f, z = 0.0f, w = 0.0f;
};

// Triangles that share a material: a primitive of glTF, or the faces of one object and material of OBJ.
//
// positions, normals, tangents, colors and each set of uvs have one element for each vertex. Normals, tangents and
// colours may be missing (empty), and there may be no set of UVs. Normals are as stored, so they may differ from unit
// length.
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

    [[nodiscard]] std::size_t triangles() const { return indices.size() / 3; }
};

// How a material moves UVs before it looks up a texture (glTF's KHR_texture_transform). With c and s the cosine and the
// sine of `rotation`, and v pointing down,
//
//     u' =  c scale_x u + s scale_y v + offset_x
//     v' = -s scale_x u + c scale_y v + offset_y
//
// A mesh keeps the UVs that its file stores; select_part() moves them.
struct UvTransform {
    double offset_x = 0.0, offset_y = 0.0;
    double rotation = 0.0;  // radians
    double scale_x = 1.0, scale_y = 1.0;

    friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

struct MeshMaterial {
    std::string name;
    std::string normal_map;       // the path of the normal map as the file states it; empty: none, or inside the file
    int uv_set = 0;               // the set of UVs that the normal map uses
    bool has_normal_map = false;  // in a file or inside the mesh's file
    // Of the normal map. Without one, that which all textures of the material share.
    UvTransform uv_transform = {};
    bool mixed_transforms = false;  // there is no normal map, and the other textures differ in this
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
[[nodiscard]] Result<void> check_part(const MeshPart& part);

// The part as it stands in the scene. Positions are multiplied by the matrix; normals by its inverse transpose, then
// normalised; tangents by the matrix, then normalised. If the determinant is negative, the node mirrors the part: each
// triangle's second and third corner change places, so that corners stay counter-clockwise, and w changes its sign
// (glTF 2.0, 3.7.4; Unity's odd negative scale). The quads of mirrored parts are forgotten.
//
// Errors: bad_data (check_part(part) fails; the matrix is not invertible or not finite, or coordinates become
// infinite), out_of_memory.
[[nodiscard]] Result<MeshPart> in_scene(MeshPart part, const MeshNode& node);

}  // namespace tex
#pragma GCC visibility pop
