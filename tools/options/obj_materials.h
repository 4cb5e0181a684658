// SPDX-License-Identifier: Apache-2.0
// obj_materials.h: what the materials of an OBJ file say about holes: map_d and d of its MTL files.

#pragma once

#include <map>
#include <string>
#include <vector>

namespace tex::cli {

struct ObjAlpha {
    std::string picture;  // of map_d, a path; empty: none
    double factor = 1.0;  // d
};

struct ObjMaterials {
    std::map<std::string, ObjAlpha> alphas;  // by name
    std::vector<std::string> files;          // what was read, and the pictures
};

// Reads the MTL files that an OBJ file names, where they lie in its folder or below. What cannot be read, and names
// that lead elsewhere, are left out, as many OBJ files come without these files. Only the first 16 MiB of each file are
// looked at. Nothing for other meshes.
[[nodiscard]] ObjMaterials obj_materials(const std::string& mesh);
// Adds these files to a list.
void add_obj_files(const std::string& mesh, std::vector<std::string>& files);

}  // namespace tex::cli
