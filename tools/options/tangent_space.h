// SPDX-License-Identifier: Apache-2.0
// tangent_space.h: the option group of maps that belong to a mesh: which mesh, which of its parts, tangents, decoders.

#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tex/file.h>
#include <tex/mesh.h>
#include <tex/types.h>

#include "cli/command.h"
#include "options/mesh_files.h"
#include "tasks/job.h"

namespace tex::cli {

// The space of a normal map's vectors.
enum class Space { tangent, object };

inline constexpr Named<Space> kSpaceNames[] = {
    {Space::tangent, "tangent", "tangent space"},
    {Space::object, "object", "object space: x, y, z of the mesh in R, G, B"},
};

// The selected part of a mesh file, with the decoder of a map on it.
class MeshSpace {
public:
    MeshSpace(std::shared_ptr<const SelectedPart> selected, Decoder decoder, std::string file)
        : selected_(std::move(selected)), decoder_(decoder), file_(std::move(file)) {}

    // Valid as long as this object.
    [[nodiscard]] TangentSpace space() const { return {selected_->part, selected_->tangents, 0, decoder_, file_}; }
    [[nodiscard]] const SelectedPart& selected() const { return *selected_; }
    [[nodiscard]] Decoder decoder() const { return decoder_; }
    [[nodiscard]] TangentSource source() const { return selected_->source; }
    [[nodiscard]] const std::string& file() const { return file_; }

private:
    std::shared_ptr<const SelectedPart> selected_;
    Decoder decoder_;
    std::string file_;
};

// The inputs of a command as far as options for meshes are concerned: maps in files, and models, which have their own
// meshes.
struct MapInputs {
    std::string model = {};  // one of them; empty: there is none
    bool has_maps = false;

    [[nodiscard]] static MapInputs of(const std::vector<Task>& tasks);
};

// --mesh, --to-mesh, --from, --to, --decoder, --decoder-in, --tangents, --tangents-in, --material, --primitive, --node,
// --uv-set.
class TangentSpaceOptions {
public:
    Space from = Space::tangent;
    Space to = Space::tangent;

    void add(Command& command);
    // Adds the options of an input alone: --mesh, which may be left out, --decoder, --tangents, the choice of parts,
    // and --from. --material, --decoder, --tangents and --from are for models, too.
    void add_input(Command& command, bool with_from = false);

    // Throws UsageError if the options do not fit the inputs: those of add_input(), and those of add().
    void check_models(const Command& command, const MapInputs& inputs) const;
    void check_conversion(const Command& command, const MapInputs& inputs) const;

    // For a command that only asks which texels a mesh covers: --mesh, which may be left out, and the choice of parts.
    void add_charts(Command& command);

    // For a command whose inputs are meshes, which it places in the scene: --decoder, --tangents, --tile, the choice of
    // parts.
    void add_low(Command& command);

    [[nodiscard]] bool has_mesh() const { return !mesh_.empty(); }
    [[nodiscard]] const std::string& material() const { return selection_.material; }
    [[nodiscard]] Decoder decoder() const { return decoder_; }
    [[nodiscard]] std::optional<TangentSource> tangents() const { return tangents_; }
    // Whether the maps of a model that is written again are converted.
    [[nodiscard]] bool changes_models() const;
    // Whether the engine that decodes the input ignores its z, so that x and y must be read as they are stored.
    [[nodiscard]] bool ignores_z(bool of_model) const {
        return from == Space::tangent && rebuilds_z(input_decoder(of_model));
    }

    // --mesh and the options that choose its parts and tangents, as they were given and as a shell reads them: with
    // them, and with --decoder, another command decodes an input in the same way.
    [[nodiscard]] std::string input_arguments() const;

    // Arguments for a mesh of of_low(): preview-normals then draws it, if it needs one node at most.
    [[nodiscard]] std::string low_arguments(const MeshSpace& low) const;

    // The mesh files, with those that hold buffers of them.
    [[nodiscard]] std::vector<std::string> files() const;

    // Reads the mesh of the input or of the output. Jobs share a mesh; it is read again if the file has changed. Any
    // thread may call this.
    //
    // `tile` is the UDIM tile that the map shows, or 0 if it shows all triangles. Errors: as read_mesh(), select_part()
    // and in_tile().
    [[nodiscard]] Result<MeshSpace> input(int tile, const ReadOptions& read, const Execution& execution) const;
    [[nodiscard]] Result<MeshSpace> output(int tile, const ReadOptions& read, const Execution& execution) const;

    // The space of a map in a model, with its own mesh, UVs and transform. --to-mesh has its material by name.
    [[nodiscard]] Result<MeshSpace> input(const ModelInput& map, const ReadOptions& read,
                                          const Execution& execution) const;
    [[nodiscard]] Result<MeshSpace> output(const ModelInput& map, const ReadOptions& read,
                                           const Execution& execution) const;

    // The space of an input that is a mesh: its triangles in the tile of --tile, of the task, or all.
    // If the task is for a material of a model, those that have it.
    [[nodiscard]] Result<MeshSpace> of_low(const Task& task, const ReadOptions& read, const Execution& execution) const;
    // The tiles of such a mesh that outputs are made for: that of --tile, or those that have triangles.
    [[nodiscard]] std::vector<int> tiles_of_low(const std::string& file, const ReadOptions& read) const;

    // The parts of a cage that belong to those of of_low(). It needs neither normals nor UVs, except for tiles, nor
    // materials. Errors: as of_low().
    [[nodiscard]] Result<MeshSpace> cage(const std::string& file, const Task& task, const ReadOptions& read,
                                         const Execution& execution) const;
    // The parts of --mesh as far as their UVs are concerned: it needs no normals. Errors: as of_low().
    [[nodiscard]] Result<MeshSpace> charts(const ReadOptions& read, const Execution& execution) const;
    // Warns of what was left out of a mesh, and, if outputs are for tiles, of triangles that do not fit into them, once
    // in a run. Any thread may call this.
    void note(Job& job, const MeshSpace& mesh) const;

private:
    void check(const Command& command) const;
    void check_input(const Command& command) const;
    void add_mesh(Command& command, const char* meaning);
    void add_parts(Command& command, const char* node);
    void add_decoder(Command& command, const char* meaning);
    void add_tangents(Command& command);
    [[nodiscard]] Decoder input_decoder(bool of_model) const;
    [[nodiscard]] std::string arguments_for(const std::string& mesh, const std::string& node,
                                            std::optional<TangentSource> tangents) const;
    [[nodiscard]] int tile_of_low(const Task& task) const;
    [[nodiscard]] Result<UvTiles> all_tiles_of_low(const std::string& file, const ReadOptions& read) const;
    [[nodiscard]] std::vector<std::string> remarks_on_tiles(const Job& job) const;
    [[nodiscard]] Result<MeshSpace> read(const ModelInput& map, std::optional<TangentSource> tangents, Decoder decoder,
                                         const ReadOptions& options, const Execution& execution) const;
    // The selection, with meshes where the scene places them if a picture shows several.
    [[nodiscard]] MeshSelection in_place(const Mesh& mesh, MeshSelection selection) const;
    [[nodiscard]] Result<MeshSpace> read(const std::string& file, std::optional<TangentSource> tangents,
                                         Decoder decoder, int tile, const ReadOptions& options,
                                         const Execution& execution) const;
    [[nodiscard]] Result<std::shared_ptr<const SelectedPart>> load(const std::string& file,
                                                                   std::optional<TangentSource> tangents,
                                                                   const ReadOptions& options,
                                                                   const Execution& execution) const;

    // A mesh that was read, and the states of its files before.
    struct Loaded {
        std::vector<FileState> files;
        std::shared_ptr<const SelectedPart> part;
    };

    std::string mesh_, to_mesh_;
    bool converts_ = false;  // there is an output
    bool draws_ = false;     // or the mesh is looked at
    int tile_ = 0;           // of low meshes; 0: all triangles
    MeshSelection selection_;
    Decoder decoder_ = Decoder::gltf;
    std::optional<Decoder> decoder_in_;
    std::optional<TangentSource> tangents_, tangents_in_;
    mutable std::mutex mutex_;
    mutable std::map<std::pair<std::string, std::optional<TangentSource>>, Loaded> loaded_;
    // The tiles of low meshes, and the states of their files before.
    struct KnownTiles {
        std::vector<FileState> files;
        UvTiles tiles;
    };
    mutable std::map<std::string, KnownTiles> tiles_;
    mutable std::set<std::string> noted_;
};

}  // namespace tex::cli
