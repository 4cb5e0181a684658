// SPDX-License-Identifier: Apache-2.0

#include "options/mesh_files.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <tex/mesh.h>

namespace tex::cli {

std::vector<std::string> files_of_mesh(const std::string& mesh) {
    auto files = mesh_files(mesh);
    return files ? std::move(*files) : std::vector<std::string>{mesh};
}

FileState FileState::of(const std::string& file) {
    std::error_code error;
    return {file, std::filesystem::last_write_time(file, error), std::filesystem::file_size(file, error)};
}

std::vector<FileState> states_of(const std::vector<std::string>& meshes) {
    std::vector<FileState> states;
    for (const std::string& mesh : meshes) {
        for (const std::string& file : files_of_mesh(mesh)) states.push_back(FileState::of(file));
    }
    return states;
}

bool are_current(const std::vector<FileState>& states) {
    return std::all_of(states.begin(), states.end(),
                       [](const FileState& state) { return FileState::of(state.file) == state; });
}

}  // namespace tex::cli
