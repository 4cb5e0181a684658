// SPDX-License-Identifier: Apache-2.0

#include "options/tangent_space.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <tex/mesh.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"

namespace tex::cli {
namespace {

constexpr const char* kNodeOfMap = "only the mesh of this node; object space is then the space of the scene";

// What select_part() needs, and nobody reads.
void give_attributes(MeshPart& part, bool with_uvs) {
    const std::size_t count = part.positions.size();
    if (part.normals.empty()) part.normals.assign(count, {0.0f, 0.0f, 1.0f});
    part.tangents.assign(count, {1.0f, 0.0f, 0.0f, 1.0f});
    if (with_uvs && part.uvs.empty()) part.uvs.emplace_back(count);
}

// The option that avoids an error of select_part().
Error with_option(const Error& error) {
    Error with = error;
    if (error.detail == ErrorDetail::several_materials) with.reason += "; --material chooses one";
    if (error.detail == ErrorDetail::no_tangents) with.reason += " with --tangents mikktspace";
    return with;
}

}  // namespace

void TangentSpaceOptions::add(Command& command) {
    converts_ = true;
    add_mesh(command, "the mesh that the map is on: glTF, GLB, OBJ, FBX, PLY ...; required, but for models");
    command.text(to_mesh_, "--to-mesh", "FILE", "another version of the mesh, with the same UVs, which the output fits")
        .often(2, "another version of the mesh, which the output fits")
        .completes = Completes::files;
    add_parts(command, kNodeOfMap);
    command.group("Spaces");
    command.choice(from, "--from", "SPACE", kSpaceNames, "the space of the input's vectors")
        .often(2, "the space of the input's vectors: tangent or object");
    command.choice(to, "--to", "SPACE", kSpaceNames, "the space of the output's vectors")
        .often(2, "the space of the output's vectors: tangent or object");
    add_decoder(command, "the engine that decodes the tangent-space map");
    command.choice(decoder_in_, "--decoder-in", "D", kDecoderNames, "the decoder that the input was made for").preset =
        "as --decoder";
    add_tangents(command);
    command
        .choice(tangents_in_, "--tangents-in", "T", kTangentSourceNames,
                "where the tangents that the input was made for come from")
        .preset = "as --tangents";
    command.check([this, &command] { check(command); });
}

void TangentSpaceOptions::add_input(Command& command, bool with_from) {
    draws_ = true;
    add_mesh(command, "the mesh that the inputs are on: glTF, GLB, OBJ, FBX, PLY ...; models have their own");
    add_parts(command, kNodeOfMap);
    if (with_from) command.choice(from, "--from", "SPACE", kSpaceNames, "the space of the inputs' vectors");
    add_decoder(command, "the engine that decodes the inputs");
    add_tangents(command);
    command.check([this, &command] { check_input(command); });
}

void TangentSpaceOptions::add_charts(Command& command) {
    add_mesh(command, "only the texels that the triangles of this mesh cover: glTF, GLB, OBJ, FBX, PLY ...");
    add_parts(command, "only the mesh of this node");
    command.check([this, &command] {
        check_input(command);
        const std::vector<std::string>& inputs = command.inputs();
        if (!has_mesh() && command.given("--material") && std::none_of(inputs.begin(), inputs.end(), is_model))
            throw UsageError("--material needs --mesh, or a model");
    });
}

MapInputs MapInputs::of(const std::vector<Task>& tasks) {
    MapInputs inputs;
    const auto add = [&](const std::shared_ptr<const ModelInput>& map) {
        if (!map)
            inputs.has_maps = true;
        else if (inputs.model.empty())
            inputs.model = map->file;
    };
    for (const Task& task : tasks) {
        add(task.model);
        for (const auto& model : task.joined_models) add(model);
    }
    return inputs;
}

void TangentSpaceOptions::check_models(const Command& command, const MapInputs& inputs) const {
    if (!inputs.model.empty() && has_mesh())
        throw UsageError(
            fmt::format("--mesh is for maps, and {} is a model with meshes of its own", printable(inputs.model)));
    if (!inputs.model.empty() || has_mesh()) return;
    const auto idle = command.given_of({"--material", "--from", "--decoder", "--tangents"});
    if (!idle.empty()) throw UsageError(fmt::format("{} needs --mesh, or a model", idle.front()));
}

void TangentSpaceOptions::check_conversion(const Command& command, const MapInputs& inputs) const {
    if (inputs.has_maps && !has_mesh()) throw UsageError("no mesh: give --mesh FILE");
    check_models(command, inputs);
    if (inputs.model.empty() || from != to || !to_mesh_.empty()) return;
    if (decoder_ == input_decoder(true) && command.given_of({"--tangents-in"}).empty())
        throw UsageError("nothing changes: give --decoder, --to object, --to-mesh or --tangents-in");
}

void TangentSpaceOptions::add_low(Command& command) {
    command.group("Low mesh");
    selection_.in_scene = true;
    add_parts(command, "only the mesh of this node");
    command
        .option("--tile", "N",
                "only the triangles in this UDIM tile, such as 1002; <UDIM> in names of outputs makes all",
                [this](const std::string& text) { tile_ = parse_int(text, 1001, 9999); })
        .preset = "all";
    add_decoder(command, "the engine that decodes the map");
    add_tangents(command);
}

void TangentSpaceOptions::add_mesh(Command& command, const char* meaning) {
    command.group("Mesh");
    command.text(mesh_, "--mesh", "FILE", meaning)
        .often(2, "the mesh that the map is on: glTF, GLB, OBJ, FBX ...")
        .completes = Completes::files;
}

void TangentSpaceOptions::add_decoder(Command& command, const char* meaning) {
    command.choice(decoder_, "--decoder", "D", kDecoderNames, meaning)
        .often(4, "the engine that decodes the map: unreal, godot, three ...");
}

void TangentSpaceOptions::add_tangents(Command& command) {
    command.choice(tangents_, "--tangents", "T", kTangentSourceNames, "where the tangents of the mesh come from")
        .preset = "file if it has any, else mikktspace";
}

void TangentSpaceOptions::add_parts(Command& command, const char* node) {
    command.text(selection_.material, "--material", "NAME",
                 "the material whose triangles the map is on, or its number from 0; required if there are several");
    command
        .option("--primitive", "N", "only the N-th primitive of each mesh, from 0",
                [this](const std::string& text) {
                    selection_.primitive = parse_int(text, 0, std::numeric_limits<int>::max());
                })
        .preset = "all";
    command.text(selection_.node, "--node", "NAME", node);
    command
        .option("--uv-set", "N", "the set of UVs, from 0",
                [this](const std::string& text) {
                    selection_.uv_set = parse_int(text, 0, std::numeric_limits<int>::max());
                })
        .preset = "that of the material, else 0";
}

void TangentSpaceOptions::check_input(const Command& command) const {
    if (mesh_ == "-") throw UsageError("--mesh", "a mesh cannot come from standard input");
    if (has_mesh()) return;
    const auto idle = command.given_of({"--primitive", "--node", "--uv-set"});
    if (!idle.empty()) throw UsageError(fmt::format("{} needs --mesh", idle.front()));
}

void TangentSpaceOptions::check(const Command& command) const {
    check_input(command);
    if (mesh_.empty() && command.inputs().empty() && !command.given("--files-from"))
        throw UsageError("no mesh: give --mesh FILE");
    for (const auto& [name, file] : {std::pair{"--mesh", &mesh_}, std::pair{"--to-mesh", &to_mesh_}}) {
        if (*file == "-") throw UsageError(name, "a mesh cannot come from standard input");
    }
    if (from == Space::tangent && to == Space::tangent && has_mesh()) {
        const auto changes = command.given_of({"--to-mesh", "--decoder-in", "--tangents-in"});
        if (changes.empty())
            throw UsageError("nothing changes: give --from object, --to object, --to-mesh or --decoder-in");
        return;
    }
    if (from == Space::tangent && to == Space::tangent) return;  // of models, see check_conversion()
    if (from == to) throw UsageError("nothing changes: both --from and --to are object");
    if (!to_mesh_.empty()) throw UsageError("--to-mesh needs tangent space on both sides");
    if (from == Space::tangent) return;
    const auto idle = command.given_of({"--decoder-in", "--tangents-in"});
    if (!idle.empty()) throw UsageError(fmt::format("{} needs --from tangent", idle.front()));
}

std::string TangentSpaceOptions::arguments_for(const std::string& mesh, const std::string& node,
                                               std::optional<TangentSource> tangents) const {
    std::string text = "--mesh " + shell_file(mesh);
    const auto add = [&](const char* name, const std::string& value) {
        text += fmt::format(" {} {}", name, shell_word(value));
    };
    if (!selection_.material.empty()) add("--material", selection_.material);
    if (selection_.primitive) add("--primitive", std::to_string(*selection_.primitive));
    if (!node.empty()) add("--node", node);
    if (selection_.uv_set) add("--uv-set", std::to_string(*selection_.uv_set));
    if (tangents) add("--tangents", std::string(name_of(kTangentSourceNames, *tangents)));
    return text;
}

std::string TangentSpaceOptions::input_arguments() const {
    return arguments_for(mesh_, selection_.node, tangents_in_ ? tangents_in_ : tangents_);
}

std::string TangentSpaceOptions::low_arguments(const MeshSpace& low) const {
    const std::vector<SelectedPiece>& pieces = low.selected().pieces;
    const bool names_node = selection_.node.empty() && pieces.size() == 1;
    return arguments_for(low.file(), names_node ? pieces.front().name : selection_.node, tangents_);
}

std::vector<std::string> TangentSpaceOptions::files() const {
    std::vector<std::string> files;
    if (has_mesh()) files = files_of_mesh(mesh_);
    if (to_mesh_.empty()) return files;
    for (std::string& file : files_of_mesh(to_mesh_)) {
        if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(std::move(file));
    }
    return files;
}

bool TangentSpaceOptions::changes_models() const {
    return decoder_ != input_decoder(true) || (tangents_in_ && tangents_in_ != tangents_);
}

// A model's maps are for glTF's decoder, unless they are only looked at.
Decoder TangentSpaceOptions::input_decoder(bool of_model) const {
    return decoder_in_.value_or(of_model && converts_ ? Decoder::gltf : decoder_);
}

Result<MeshSpace> TangentSpaceOptions::input(int tile, const ReadOptions& options, const Execution& execution) const {
    return read(mesh_, tangents_in_ ? tangents_in_ : tangents_, input_decoder(false), tile, options, execution);
}

Result<MeshSpace> TangentSpaceOptions::output(int tile, const ReadOptions& options, const Execution& execution) const {
    return read(to_mesh_.empty() ? mesh_ : to_mesh_, tangents_, decoder_, tile, options, execution);
}

Result<MeshSpace> TangentSpaceOptions::input(const ModelInput& map, const ReadOptions& options,
                                             const Execution& execution) const {
    return read(map, tangents_in_ ? tangents_in_ : tangents_, input_decoder(true), options, execution);
}

Result<MeshSpace> TangentSpaceOptions::output(const ModelInput& map, const ReadOptions& options,
                                              const Execution& execution) const {
    if (to_mesh_.empty()) return read(map, tangents_, decoder_, options, execution);
    MeshReadOptions how;
    how.reader = options;
    const auto mesh = read_mesh(to_mesh_, how);
    if (!mesh) return mesh.error().of(to_mesh_);
    MeshSelection selection;
    if (!mesh->materials.empty()) selection.material = map.material;
    selection.tangents = tangents_;
    auto selected = select_part(*mesh, selection, execution);
    if (!selected) return selected.error().of(to_mesh_);
    return MeshSpace(std::make_shared<const SelectedPart>(std::move(*selected)), decoder_, to_mesh_);
}

Result<MeshSpace> TangentSpaceOptions::read(const ModelInput& map, std::optional<TangentSource> tangents,
                                            Decoder decoder, const ReadOptions& options,
                                            const Execution& execution) const {
    const auto model = map.read(LastModel::Part::all, options);
    if (!model) return model.error();
    MeshSelection selection = selection_of(**model, *map.map);
    selection.tangents = tangents;
    auto selected = select_part((*model)->mesh, in_place((*model)->mesh, selection), execution);
    if (!selected) return selected.error().of(map.name());
    return MeshSpace(std::make_shared<const SelectedPart>(std::move(*selected)), decoder, map.file);
}

// One mesh is looked at along its own axes. Several would lie on each other.
MeshSelection TangentSpaceOptions::in_place(const Mesh& mesh, MeshSelection selection) const {
    const auto is_other = [&](const MeshPart& part) { return part.mesh != mesh.parts.front().mesh; };
    const bool has_several = !mesh.nodes.empty() && std::any_of(mesh.parts.begin(), mesh.parts.end(), is_other);
    if (draws_ && from == Space::tangent && selection.node.empty() && has_several) selection.in_scene = true;
    return selection;
}

Result<MeshSpace> TangentSpaceOptions::of_low(const Task& task, const ReadOptions& options,
                                              const Execution& execution) const {
    if (!task.model) return read(task.input, tangents_, decoder_, tile_of_low(task), options, execution);
    const auto model = task.model->read(LastModel::Part::all, options);
    if (!model) return model.error();
    MeshSelection selection = task.model->selection(**model);
    selection.tangents = tangents_;
    auto selected = select_part((*model)->mesh, selection, execution);
    if (!selected) return with_option(selected.error()).of(task.model->name());
    return MeshSpace(std::make_shared<const SelectedPart>(std::move(*selected)), decoder_, task.model->name());
}

Result<MeshSpace> TangentSpaceOptions::charts(const ReadOptions& options, const Execution& execution) const {
    MeshReadOptions how;
    how.reader = options;
    auto mesh = read_mesh(mesh_, how);
    if (!mesh) return mesh.error().of(mesh_);
    for (MeshPart& part : mesh->parts) give_attributes(part, false);
    MeshSelection selection = selection_;
    selection.tangents = TangentSource::file;  // which do not count
    auto selected = select_part(*mesh, selection, execution);
    if (!selected) return with_option(selected.error()).of(mesh_);
    return MeshSpace(std::make_shared<const SelectedPart>(std::move(*selected)), decoder_, mesh_);
}

Result<MeshSpace> TangentSpaceOptions::cage(const std::string& file, const Task& task, const ReadOptions& options,
                                            const Execution& execution) const {
    const int tile = tile_of_low(task);
    MeshReadOptions how;
    how.reader = options;
    auto mesh = read_mesh(file, how);
    if (!mesh) return mesh.error().of(file);
    for (MeshPart& part : mesh->parts) give_attributes(part, tile == 0);
    MeshSelection selection = selection_;
    selection.tangents = TangentSource::file;  // which do not count
    selection.uv_set.reset();
    if (mesh->materials.empty()) selection.material.clear();
    if (mesh->nodes.size() <= 1) selection.node.clear();
    auto selected = select_part(*mesh, selection, execution);
    if (selected && tile != 0) selected = in_tile(*selected, tile);
    if (!selected) return with_option(selected.error()).of(file);
    return MeshSpace(std::make_shared<const SelectedPart>(std::move(*selected)), decoder_, file);
}

Result<MeshSpace> TangentSpaceOptions::read(const std::string& file, std::optional<TangentSource> tangents,
                                            Decoder decoder, int tile, const ReadOptions& options,
                                            const Execution& execution) const {
    const auto whole = load(file, tangents, options, execution);
    if (!whole) return whole.error();
    if (tile == 0) return MeshSpace(*whole, decoder, file);
    auto part = in_tile(**whole, tile);
    if (!part) return part.error().of(file);
    return MeshSpace(std::make_shared<const SelectedPart>(std::move(*part)), decoder, file);
}

Result<std::shared_ptr<const SelectedPart>> TangentSpaceOptions::load(const std::string& file,
                                                                      std::optional<TangentSource> tangents,
                                                                      const ReadOptions& options,
                                                                      const Execution& execution) const {
    const std::lock_guard lock(mutex_);
    constexpr std::size_t kMostLoaded = 16;  // of a tree of meshes, not all stay in memory
    if (loaded_.size() >= kMostLoaded && !loaded_.contains({file, tangents})) loaded_.clear();
    Loaded& loaded = loaded_[{file, tangents}];
    if (loaded.part && are_current(loaded.files)) return loaded.part;
    std::vector<FileState> files = states_of({file});
    MeshReadOptions how;
    how.reader = options;
    const auto mesh = read_mesh(file, how);
    if (!mesh) return mesh.error().of(file);
    MeshSelection selection = selection_;
    selection.tangents = tangents;
    auto selected = select_part(*mesh, in_place(*mesh, std::move(selection)), execution);
    if (!selected) return with_option(selected.error()).of(file);
    loaded = {std::move(files), std::make_shared<const SelectedPart>(std::move(*selected))};
    return loaded.part;
}

}  // namespace tex::cli
