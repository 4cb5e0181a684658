// SPDX-License-Identifier: Apache-2.0

#include "options/high_meshes.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <tex/mesh_io.h>
#include <tex/mesh_selection.h>

#include "cli/usage_error.h"
#include "tasks/name_pattern.h"

namespace tex::cli {

void HighMeshes::add(Command& command) {
    command.group("High mesh");
    Row& row = command.option("--high", "PATTERN",
                              "the mesh that rays hit, for each input: a file, or a pattern as --name; may be repeated",
                              [this](const std::string& text) {
                                  if (text.empty() || text == "-") throw UsageError("needs a file");
                                  if (NamePattern(text).uses("level") || NamePattern(text).uses("format"))
                                      throw UsageError("{level} and {format} have no meaning here");
                                  patterns_.push_back(text);
                              });
    row.completes = Completes::files;
    row.repeatable = true;
    row.preset = "the inputs after the first one";
}

std::vector<std::string> HighMeshes::buffers_of(const std::vector<std::string>& meshes) {
    std::vector<std::string> buffers;
    for (const std::string& mesh : meshes) {
        auto files = mesh_files(mesh);
        if (!files) continue;  // reading it will say why
        for (std::string& file : *files) {
            if (file != mesh && std::find(buffers.begin(), buffers.end(), file) == buffers.end())
                buffers.push_back(std::move(file));
        }
    }
    return buffers;
}

std::vector<std::string> HighMeshes::names_of(const Task& task) const {
    if (!is_given()) return task.joined;
    std::vector<std::string> names;
    for (const std::string& pattern : patterns_) names.push_back(NamePattern(pattern).expand(name_fields(task.input)));
    return names;
}

void HighMeshes::amend(Task& task) const {
    if (!is_given()) return;
    std::vector<std::string> meshes = names_of(task);
    task.own.insert(task.own.end(), meshes.begin(), meshes.end());
    meshes.push_back(task.input);
    for (std::string& buffer : buffers_of(meshes)) task.own.push_back(std::move(buffer));
}

Result<std::vector<MeshPart>> HighMeshes::read(Job& job) const {
    std::vector<MeshPart> parts;
    MeshReadOptions how;
    how.reader = job.read_options;
    for (const std::string& name : names_of(job.task)) {
        auto mesh = read_mesh(name, how);
        if (!mesh) return mesh.error().of(name);
        for (const std::string& remark : mesh->remarks) job.warn(remark, name);
        for (MeshPart& part : mesh->parts) {  // not needed
            part.uvs.clear();
            part.tangents.clear();
        }
        auto placed = parts_in_scene(std::move(*mesh));
        if (!placed) return placed.error().of(name);
        std::move(placed->begin(), placed->end(), std::back_inserter(parts));
    }
    return parts;
}

Error HighMeshes::with_order(const Error& error) {
    if (error.reason.find("has no UVs") == std::string::npos) return error;
    return {error.code, error.file, error.reason + "; is it the high mesh? The low one comes first"};
}

void HighMeshes::compare(Job& job, const MeshPart& low, const std::vector<MeshPart>& high) {
    std::size_t triangles = 0;
    for (const MeshPart& part : high) triangles += part.triangles();
    job.report["triangles"] = {{"low", low.triangles()}, {"high", triangles}};
    if (low.triangles() <= 2 * triangles) return;
    job.warn(
        fmt::format("has more triangles, {}, than the high mesh, {}; did both change places? The low one comes "
                    "first",
                    low.triangles(), triangles));
}

}  // namespace tex::cli
