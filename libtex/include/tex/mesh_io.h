// SPDX-License-Identifier: Apache-2.0
// mesh_io.h: reads triangle meshes from glTF 2.0 (.gltf, .glb), Wavefront OBJ, FBX, PLY and other files.
//
// The first bytes of a file decide how it is read; for Assimp's types, its extension comes first.
//
// glTF   Buffers are inside the file (GLB), in data URIs (base64), or in files beside it. Such a file must be named by
//        a relative path that stays in the folder of the .gltf file or below it: "mesh.bin", "parts/mesh.bin". URIs
//        with a scheme, absolute paths and ".." are refused, because a mesh from a stranger must not choose what is
//        read. Read: triangles, strips and fans (points and lines are skipped); indices of 8, 16 and 32 bits; POSITION,
//        NORMAL, TANGENT and up to kMaxUvSets sets TEXCOORD_n, as floats or as integers (KHR_mesh_quantization); sparse
//        accessors; matrices, translations, rotations and scales of nodes; instances of nodes
//        (EXT_mesh_gpu_instancing); buffers compressed by meshoptimizer (EXT_meshopt_compression,
//        KHR_meshopt_compression); triangles compressed by Draco (KHR_draco_mesh_compression), which a separate process
//        decodes, as for other file types. Vertices that no triangle uses are dropped. UVs stay as stored; materials
//        say how textures move them (KHR_texture_transform). Ignored: skins, morph targets (the base shape is read),
//        animations, cameras. Other extensions: refused if the file requires them and they are not known to leave
//        triangles alone; else Mesh::remarks says if one was ignored where it might change UVs, normals or tangents.
//        Colours of vertices are COLOR_0 without its alpha, as floats or normalised integers.
// OBJ    v, vt, vn, f, o, usemtl. Polygons become fans around their first corner. Faces of the same object and material
//        are one part; those of them without UVs are another. A part has normals if all of its corners have them.
//        Colours are the three numbers after a position ("v x y z r g b"), which many programs write; a part has them
//        if all of its corners do. All else is ignored.
// other  What Assimp reads from one file: FBX, PLY, Collada, STL and more. As Assimp has crashed on damaged files, it
//        runs in a separate process, tex-mesh-reader, under the limits of memory and time that ReadOptions states,
//        and can open no other file. Polygons become triangles as Assimp divides them. Tangents count if the file has
//        bitangents, too. Coordinates are in the units and axes of Assimp.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tex/image_io.h>
#include <tex/mesh.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

inline constexpr int kMaxUvSets = 8;

struct MeshReadOptions {
    // The reader program of other file types: tex-mesh-reader, beside the program that `reader` names if it is given.
    ReadOptions reader;
    // The largest size in bytes of the file and of each file beside it.
    std::int64_t max_bytes = std::int64_t{4} << 30;
    // Read colours of vertices, which only transfer() uses.
    bool colors = false;
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
[[nodiscard]] Result<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options = {});

// The files that read_mesh() may read for this path: `path` itself, then the existing files that hold buffers of a glTF
// file, each once. A mesh is the same as long as these files are. Only `path` if it is "-" or not a regular file, which
// can be read only once.
//
// Errors: those of read_mesh(), as far as the glTF file without its buffers causes them.
[[nodiscard]] Result<std::vector<std::string>> mesh_files(const std::string& path, const MeshReadOptions& options = {});

}  // namespace tex
#pragma GCC visibility pop
