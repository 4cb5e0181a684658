// SPDX-License-Identifier: Apache-2.0
// high_meshes.h: the option group of the meshes that rays hit: --high, or the inputs after the first one.

#pragma once

#include <string>
#include <vector>

#include <tex/mesh.h>

#include "cli/command.h"
#include "tasks/job.h"

namespace tex::cli {

class HighMeshes {
public:
    void add(Command& command);

    // Whether --high names them.
    [[nodiscard]] bool is_given() const { return !patterns_.empty(); }

    // The files that hold buffers of these meshes.
    [[nodiscard]] static std::vector<std::string> buffers_of(const std::vector<std::string>& meshes);

    // Adds the files of --high, and what holds buffers of all meshes, to the task.
    void amend(Task& task) const;

    // Reads the meshes of a job, as the nodes of their scenes place them.
    [[nodiscard]] Result<std::vector<MeshPart>> read(Job& job) const;

    // An error about the low mesh, with the remedy if both may have changed places.
    [[nodiscard]] static Error with_order(const Error& error);
    // Warns if the low mesh has more than twice as many triangles as the high ones.
    static void compare(Job& job, const MeshPart& low, const std::vector<MeshPart>& high);

private:
    [[nodiscard]] std::vector<std::string> names_of(const Task& task) const;

    std::vector<std::string> patterns_;
};

}  // namespace tex::cli
