// SPDX-License-Identifier: Apache-2.0
// The UDIM tiles of low meshes, and what may matter about them.

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "options/tangent_space.h"

namespace tex::cli {

// 0: all triangles. A tile that only the name of the file says does not count.
int TangentSpaceOptions::tile_of_low(const Task& task) const {
    return tile_ == 0 && task.is_tile_of_mesh() ? task.tile : tile_;
}

Result<UvTiles> TangentSpaceOptions::all_tiles_of_low(const std::string& file, const ReadOptions& options) const {
    {
        const std::lock_guard lock(mutex_);
        const auto known = tiles_.find(file);
        if (known != tiles_.end() && are_current(known->second.files)) return known->second.tiles;
    }
    std::vector<FileState> files = states_of({file});
    const auto whole = load(file, tangents_, options, {});
    auto found = whole ? tex::tiles_of(**whole) : Result<UvTiles>(whole.error());
    if (!found) return found;
    const std::lock_guard lock(mutex_);
    tiles_[file] = {std::move(files), *found};
    return found;
}

std::vector<int> TangentSpaceOptions::tiles_of_low(const std::string& file, const ReadOptions& options) const {
    const auto found = all_tiles_of_low(file, options);
    if (!found) return {};  // the job reads it again, and says why
    const bool has_it = std::find(found->tiles.begin(), found->tiles.end(), tile_) != found->tiles.end();
    if (tile_ == 0) return found->tiles;
    return has_it ? std::vector<int>{tile_} : std::vector<int>();
}

void TangentSpaceOptions::note(Job& job, const MeshSpace& mesh) const {
    std::vector<std::string> remarks = mesh.selected().remarks;
    if (job.task.is_tile_of_mesh() || tile_ != 0) {
        for (std::string& remark : remarks_on_tiles(job)) remarks.push_back(std::move(remark));
    }
    const std::lock_guard lock(mutex_);
    const std::string& file = job.task.model ? job.task.input : mesh.file();  // what it says is true of all materials
    for (const std::string& remark : remarks) {
        if (noted_.insert(file + '\n' + remark).second)
            job.warn(remark, mesh.file());
        else
            job.remark(remark, mesh.file());
    }
}

std::vector<std::string> TangentSpaceOptions::remarks_on_tiles(const Job& job) const {
    const auto found = all_tiles_of_low(job.task.input, job.read_options);
    if (!found) return {};
    std::vector<std::string> remarks;
    const auto triangles = [](std::size_t count, const char* one, const char* many) {
        return fmt::format("{} triangle{}", count, count == 1 ? one : many);
    };
    if (found->outside > 0 && tile_ == 0)
        remarks.push_back(triangles(found->outside, " is", "s are") +
                          " in no UDIM tile, because u or v is negative or u is 10 or more; no map shows them");
    if (found->crossing > 0)
        remarks.push_back(triangles(found->crossing, " reaches", "s reach") +
                          " out of the UDIM tile of the middle; what is outside comes back at the other side of it");
    return remarks;
}

}  // namespace tex::cli
