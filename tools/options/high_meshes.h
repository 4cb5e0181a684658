// SPDX-License-Identifier: Apache-2.0
// high_meshes.h: the option group of the meshes that rays hit: --high, or the inputs after the first one;
// --match, --high-scale, --high-up, --max-triangles.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/transfer.h>

#include "cli/command.h"
#include "options/mesh_files.h"
#include "options/mesh_units.h"
#include "tasks/job.h"

namespace tex::cli {

// How parts of the high mesh find those of the low one whose rays meet them.
enum class Match { all, name, material };

inline constexpr Named<Match> kMatchNames[] = {
    {Match::all, "all", "every ray meets all parts"},
    {Match::name, "name", "rock_low and rock_high belong together"},
    {Match::material, "material", "the same with the names of materials"},
};

// What the alpha of a material makes of a part.
struct PartAlpha {
    AlphaMode mode = AlphaMode::opaque;
    double cutoff = 0.5, factor = 1.0;  // which alpha is multiplied by
    bool is_grey = false;               // a picture without alpha holds it itself
    // The picture of a model, if alpha was asked for; neither: it is 1 everywhere.
    std::string file = {};
    std::shared_ptr<const std::vector<std::byte>> bytes = {};
    // Parts with a picture have a set of UVs more, the last one, which lies where the material puts it.

    [[nodiscard]] bool has_picture() const { return bytes != nullptr || !file.empty(); }
};

// The parts that rays may hit, and what their files say about each.
struct HighParts {
    std::vector<MeshPart> parts;
    std::vector<std::string> materials;  // their names; may be empty
    std::vector<bool> has_maps;          // whether the material of a part has a normal map
    // The map, if the parts were read for it, and it is in a model: their UVs lie where it puts them. Else null.
    std::vector<std::shared_ptr<const ModelInput>> maps;
    std::vector<PartAlpha> alphas;       // of the materials
    std::vector<int> files;              // the number of the file
    std::vector<PartPlace> places;       // where they stand; empty: where they are stored (TransferInputs::high_places)
    std::vector<std::string> names;      // of the files
    std::vector<FileWarning> remarks;    // what may matter about them
    std::shared_ptr<SharedTrees> trees;  // of jobs that share the parts; else null

    // What rays tell apart: the places, or else the parts.
    [[nodiscard]] std::size_t standing() const { return places.empty() ? parts.size() : places.size(); }
    [[nodiscard]] std::size_t part_of(std::size_t k) const { return places.empty() ? k : places[k].part; }
    [[nodiscard]] const std::string& name_of(std::size_t k) const {
        return places.empty() ? parts[k].name : places[k].name;
    }
    // In all places.
    [[nodiscard]] std::size_t triangles() const;
    // Calls visit(part) with each where it stands, of which there is one copy at a time.
    void visit_standing(const std::function<void(const MeshPart&)>& visit) const;
    // Adds what places_in_scene() says of parts that are still to be added.
    void add_places(const std::vector<MeshPart>& added, std::vector<PartPlace> of_added);
};

// Whether alpha makes holes in a model (alphaMode MASK). False if it cannot be read.
[[nodiscard]] bool has_cutouts(const std::string& model, const MeshReadOptions& options);

// The first names, each once, in quotes, for a message.
[[nodiscard]] std::string quoted_list(const std::vector<std::string>& names);

class HighMeshes {
public:
    void add(Command& command);

    // Whether --high names them.
    [[nodiscard]] bool is_given() const { return !patterns_.empty(); }

    // The files that hold buffers of these meshes.
    [[nodiscard]] static std::vector<std::string> buffers_of(const std::vector<std::string>& meshes);

    // Adds the files of --high, and what holds buffers of all meshes, to the task.
    void amend(Task& task) const;
    // The high meshes of a task.
    [[nodiscard]] std::vector<std::string> names_of(const Task& task) const;
    // Whether the low mesh of a task is not the only one that the high ones are for.
    [[nodiscard]] bool is_shared(const Task& task) const;
    // Looks whether all tasks have the same high meshes.
    void note_tasks(const std::vector<Task>& tasks);

    // What is read of the meshes besides positions and normals.
    struct Wanted {
        bool uvs = false;  // and tangents
        bool colors = false;
        bool maps = false;   // of the materials, in models
        bool alpha = false;  // likewise
    };

    // Reads the meshes of a job, as the nodes of their scenes place them. Jobs share them if is_shared(task).
    // Any thread may call this.
    [[nodiscard]] Result<std::shared_ptr<const HighParts>> read(Job& job, const Wanted& wanted) const;

    // Numbers the parts as --match says, and reports those without partner. If each material of the low mesh has its
    // own map, the default is `material`, and one without partner gets all parts.
    [[nodiscard]] Result<void> match(Job& job, const SelectedPart& low, const HighParts& high,
                                     TransferInputs& inputs) const;

    // An error about the low mesh, with the remedy if both may have changed places.
    [[nodiscard]] static Error with_order(const Error& error);
    // Warns if the low mesh has more than twice as many triangles as the high ones, or another unit or other axes.
    void compare(Job& job, const MeshPart& low, const HighParts& high) const;

private:
    // An error of places_in_scene(), with the remedy if there are too many copies.
    [[nodiscard]] Error with_limit(const Error& error) const;
    [[nodiscard]] Result<void> read_maps(const std::string& name, const MeshReadOptions& options, Mesh& mesh,
                                         std::map<int, std::shared_ptr<const ModelInput>>& maps) const;
    [[nodiscard]] static Result<void> read_alphas(const std::string& name, const MeshReadOptions& options, Mesh& mesh,
                                                  std::vector<PartAlpha>& alphas);
    static void read_obj_alphas(const std::string& name, Mesh& mesh, std::vector<PartAlpha>& alphas);
    [[nodiscard]] Result<HighParts> read(const std::vector<std::string>& names, const ReadOptions& options,
                                         const Wanted& wanted) const;

    std::vector<std::string> patterns_;
    std::optional<Match> match_;
    MeshUnits units_;
    std::int64_t most_ = kMaxCopied;
    bool is_common_ = false;  // all tasks have the same
    mutable std::mutex mutex_;
    // What was read last for jobs that share it, and the states of its files before.
    mutable std::shared_ptr<const HighParts> last_;
    mutable std::vector<FileState> last_files_;
};

}  // namespace tex::cli
