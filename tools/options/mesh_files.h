// SPDX-License-Identifier: Apache-2.0
// mesh_files.h: the files that meshes are in, and whether they have changed since a mesh was read.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tex::cli {

// The files of a mesh, with those that hold buffers of it. If it cannot be read, only the file itself: reading it will
// say why.
[[nodiscard]] std::vector<std::string> files_of_mesh(const std::string& mesh);

// What the system says about a file.
struct FileState {
    std::string file;
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;

    [[nodiscard]] static FileState of(const std::string& file);
    friend bool operator==(const FileState&, const FileState&) = default;
};

// The state of all files of some meshes.
[[nodiscard]] std::vector<FileState> states_of(const std::vector<std::string>& meshes);
[[nodiscard]] bool are_current(const std::vector<FileState>& states);

}  // namespace tex::cli
