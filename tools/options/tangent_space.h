// SPDX-License-Identifier: Apache-2.0
// tangent_space.h: the option group of maps that belong to a mesh: which mesh, which of its parts, tangents, decoders.

#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tex/convert_options.h>
#include <tex/execution.h>
#include <tex/image_io.h>
#include <tex/mesh_selection.h>

#include "cli/command.h"
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

// --mesh, --to-mesh, --from, --to, --decoder, --decoder-in, --tangents, --tangents-in, --material, --primitive, --node,
// --uv-set.
class TangentSpaceOptions {
public:
    Space from = Space::tangent;
    Space to = Space::tangent;

    void add(Command& command);
    // Without those of an output: --mesh, which may be left out, --decoder, --tangents, the choice of parts, and
    // --from.
    void add_input(Command& command, bool with_from = false);

    // The same for a command whose inputs may be models: --material, --decoder and --tangents are then for these, too.
    void add_input_of_models(Command& command);
    // Throws UsageError if the options do not fit the inputs.
    void check_models(const Command& command, const std::vector<std::string>& inputs) const;

    // For a command whose inputs are meshes, which it places in the scene: --decoder, --tangents, --tile, the choice of
    // parts.
    void add_low(Command& command);

    [[nodiscard]] bool has_mesh() const { return !mesh_.empty(); }
    [[nodiscard]] const std::string& material() const { return selection_.material; }
    [[nodiscard]] Decoder decoder() const { return decoder_; }
    [[nodiscard]] std::optional<TangentSource> tangents() const { return tangents_; }
    // Whether the engine that decodes the input ignores its z, so that x and y must be read as they are stored.
    [[nodiscard]] bool ignores_z() const {
        return from == Space::tangent && rebuilds_z(decoder_in_.value_or(decoder_));
    }

    // --mesh and the options that choose its parts and tangents, as they were given and as a shell reads them: with
    // them, and with --decoder, another command decodes an input in the same way.
    [[nodiscard]] std::string input_arguments() const;

    // The mesh files, with those that hold buffers of them.
    [[nodiscard]] std::vector<std::string> files() const;

    // Reads the mesh of the input or of the output. Jobs share a mesh; it is read again if the file has changed. Any
    // thread may call this.
    //
    // `tile` is the UDIM tile that the map shows, or 0 if it shows all triangles. Errors: as read_mesh(), select_part()
    // and in_tile().
    [[nodiscard]] Result<MeshSpace> input(int tile, const ReadOptions& read, const Execution& execution) const;
    [[nodiscard]] Result<MeshSpace> output(int tile, const ReadOptions& read, const Execution& execution) const;

    // The same of an input that is a mesh.
    [[nodiscard]] Result<MeshSpace> of_low(const std::string& file, const ReadOptions& read,
                                           const Execution& execution) const;

    // The parts of a cage that belong to those of of_low(). It needs neither normals nor UVs, except with --tile, nor
    // materials. Errors: as of_low().
    [[nodiscard]] Result<MeshSpace> cage(const std::string& file, const ReadOptions& read,
                                         const Execution& execution) const;
    // Warns of what was left out of a mesh, once in a run. Any thread may call this.
    void note(Job& job, const MeshSpace& mesh) const;

private:
    void check(const Command& command) const;
    void check_input(const Command& command) const;
    void add_input_options(Command& command, bool with_from, const char* meaning);
    void add_mesh(Command& command, const char* meaning);
    void add_parts(Command& command, const char* node);
    void add_decoder(Command& command, const char* meaning);
    void add_tangents(Command& command);
    [[nodiscard]] Result<MeshSpace> read(const std::string& file, std::optional<TangentSource> tangents,
                                         Decoder decoder, int tile, const ReadOptions& options,
                                         const Execution& execution) const;
    [[nodiscard]] Result<std::shared_ptr<const SelectedPart>> load(const std::string& file,
                                                                   std::optional<TangentSource> tangents,
                                                                   const ReadOptions& options,
                                                                   const Execution& execution) const;

    struct FileState {
        std::string file;
        std::filesystem::file_time_type time;
        std::uintmax_t size = 0;

        [[nodiscard]] static FileState of(const std::string& file);
        friend bool operator==(const FileState&, const FileState&) = default;
    };
    // A mesh that was read, and the states of its files before.
    struct Loaded {
        std::vector<FileState> files;
        std::shared_ptr<const SelectedPart> part;

        [[nodiscard]] bool is_current() const;
    };

    std::string mesh_, to_mesh_;
    int tile_ = 0;  // of low meshes; 0: all triangles
    MeshSelection selection_;
    Decoder decoder_ = Decoder::gltf;
    std::optional<Decoder> decoder_in_;
    std::optional<TangentSource> tangents_, tangents_in_;
    mutable std::mutex mutex_;
    mutable std::map<std::pair<std::string, std::optional<TangentSource>>, Loaded> loaded_;
    mutable std::set<std::string> noted_;
};

}  // namespace tex::cli
