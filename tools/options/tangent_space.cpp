// SPDX-License-Identifier: Apache-2.0

#include "options/tangent_space.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <tex/mesh_io.h>
#include <tex/model.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

// The files of a mesh. If it cannot be read, only the file itself: reading it will say why.
std::vector<std::string> files_of(const std::string& mesh) {
    auto files = mesh_files(mesh);
    return files ? std::move(*files) : std::vector<std::string>{mesh};
}

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
    add_mesh(command, "the mesh that the map is on: glTF, GLB, OBJ, FBX, PLY ...; required");
    command.text(to_mesh_, "--to-mesh", "FILE", "another version of the mesh, with the same UVs, which the output fits")
        .completes = Completes::files;
    add_parts(command, kNodeOfMap);
    command.group("Spaces");
    command.choice(from, "--from", "SPACE", kSpaceNames, "the space of the input's vectors");
    command.choice(to, "--to", "SPACE", kSpaceNames, "the space of the output's vectors");
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

void TangentSpaceOptions::add_input_options(Command& command, bool with_from, const char* meaning) {
    add_mesh(command, meaning);
    add_parts(command, kNodeOfMap);
    if (with_from) command.choice(from, "--from", "SPACE", kSpaceNames, "the space of the inputs' vectors");
    add_decoder(command, "the engine that decodes the inputs");
    add_tangents(command);
}

void TangentSpaceOptions::add_input(Command& command, bool with_from) {
    add_input_options(command, with_from, "the mesh that the inputs are on: glTF, GLB, OBJ, FBX, PLY ...");
    command.check([this, &command] { check_input(command); });
}

void TangentSpaceOptions::add_input_of_models(Command& command) {
    add_input_options(command, false,
                      "the mesh that the inputs are on: glTF, GLB, OBJ, FBX, PLY ...; models have their own");
    command.check([this, &command] {
        if (mesh_ == "-") throw UsageError("--mesh: a mesh cannot come from standard input");
        const auto idle = command.given_of({"--primitive", "--node", "--uv-set"});
        if (!has_mesh() && !idle.empty()) throw UsageError(fmt::format("{} needs --mesh", idle.front()));
    });
}

void TangentSpaceOptions::check_models(const Command& command, const std::vector<std::string>& inputs) const {
    const auto model =
        std::find_if(inputs.begin(), inputs.end(), [](const std::string& name) { return is_model(name); });
    if (model != inputs.end() && has_mesh())
        throw UsageError(
            fmt::format("--mesh is for maps, and {} is a model with meshes of its own", printable(*model)));
    if (model != inputs.end() || has_mesh()) return;
    const auto idle = command.given_of({"--material", "--decoder", "--tangents"});
    if (!idle.empty()) throw UsageError(fmt::format("{} needs --mesh, or a model", idle.front()));
}

void TangentSpaceOptions::add_low(Command& command) {
    command.group("Low mesh");
    selection_.in_scene = true;
    add_parts(command, "only the mesh of this node");
    command
        .option("--tile", "N", "only the triangles in this UDIM tile, such as 1002",
                [this](const std::string& text) { tile_ = parse_int(text, 1001, 9999); })
        .preset = "all";
    add_decoder(command, "the engine that decodes the map");
    add_tangents(command);
}

void TangentSpaceOptions::add_mesh(Command& command, const char* meaning) {
    command.group("Mesh");
    command.text(mesh_, "--mesh", "FILE", meaning).completes = Completes::files;
}

void TangentSpaceOptions::add_decoder(Command& command, const char* meaning) {
    command.choice(decoder_, "--decoder", "D", kDecoderNames, meaning);
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
    if (mesh_ == "-") throw UsageError("--mesh: a mesh cannot come from standard input");
    if (has_mesh()) return;
    const auto idle =
        command.given_of({"--material", "--primitive", "--node", "--uv-set", "--from", "--decoder", "--tangents"});
    if (!idle.empty()) throw UsageError(fmt::format("{} needs --mesh", idle.front()));
}

void TangentSpaceOptions::check(const Command& command) const {
    if (mesh_.empty()) throw UsageError("no mesh: give --mesh FILE");
    for (const auto& [name, file] : {std::pair{"--mesh", &mesh_}, std::pair{"--to-mesh", &to_mesh_}}) {
        if (*file == "-") throw UsageError(fmt::format("{}: a mesh cannot come from standard input", name));
    }
    if (from == Space::tangent && to == Space::tangent) {
        const auto changes = command.given_of({"--to-mesh", "--decoder-in", "--tangents-in"});
        if (changes.empty())
            throw UsageError("nothing changes: give --from object, --to object, --to-mesh or --decoder-in");
        return;
    }
    if (from == to) throw UsageError("nothing changes: both --from and --to are object");
    if (!to_mesh_.empty()) throw UsageError("--to-mesh needs tangent space on both sides");
    if (from == Space::tangent) return;
    const auto idle = command.given_of({"--decoder-in", "--tangents-in"});
    if (!idle.empty()) throw UsageError(fmt::format("{} needs --from tangent", idle.front()));
}

std::string TangentSpaceOptions::input_arguments() const {
    std::string text = "--mesh " + shell_file(mesh_);
    const auto add = [&](const char* name, const std::string& value) {
        text += fmt::format(" {} {}", name, shell_word(value));
    };
    if (!selection_.material.empty()) add("--material", selection_.material);
    if (selection_.primitive) add("--primitive", std::to_string(*selection_.primitive));
    if (!selection_.node.empty()) add("--node", selection_.node);
    if (selection_.uv_set) add("--uv-set", std::to_string(*selection_.uv_set));
    if (const auto tangents = tangents_in_ ? tangents_in_ : tangents_)
        add("--tangents", std::string(name_of(kTangentSourceNames, *tangents)));
    return text;
}

std::vector<std::string> TangentSpaceOptions::files() const {
    std::vector<std::string> files = files_of(mesh_);
    if (to_mesh_.empty()) return files;
    for (std::string& file : files_of(to_mesh_)) {
        if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(std::move(file));
    }
    return files;
}

TangentSpaceOptions::FileState TangentSpaceOptions::FileState::of(const std::string& file) {
    std::error_code error;
    return {file, fs::last_write_time(file, error), fs::file_size(file, error)};
}

bool TangentSpaceOptions::Loaded::is_current() const {
    return part && std::all_of(files.begin(), files.end(),
                               [](const FileState& state) { return FileState::of(state.file) == state; });
}

Result<MeshSpace> TangentSpaceOptions::input(int tile, const ReadOptions& options, const Execution& execution) const {
    return read(mesh_, tangents_in_ ? tangents_in_ : tangents_, decoder_in_.value_or(decoder_), tile, options,
                execution);
}

Result<MeshSpace> TangentSpaceOptions::output(int tile, const ReadOptions& options, const Execution& execution) const {
    return read(to_mesh_.empty() ? mesh_ : to_mesh_, tangents_, decoder_, tile, options, execution);
}

Result<MeshSpace> TangentSpaceOptions::of_low(const std::string& file, const ReadOptions& options,
                                              const Execution& execution) const {
    return read(file, tangents_, decoder_, tile_, options, execution);
}

Result<MeshSpace> TangentSpaceOptions::cage(const std::string& file, const ReadOptions& options,
                                            const Execution& execution) const {
    MeshReadOptions how;
    how.reader = options;
    auto mesh = read_mesh(file, how);
    if (!mesh) return mesh.error().of(file);
    for (MeshPart& part : mesh->parts) give_attributes(part, tile_ == 0);
    MeshSelection selection = selection_;
    selection.tangents = TangentSource::file;  // which do not count
    selection.uv_set.reset();
    if (mesh->materials.empty()) selection.material.clear();
    if (mesh->nodes.size() <= 1) selection.node.clear();
    auto selected = select_part(*mesh, selection, execution);
    if (selected && tile_ != 0) selected = in_tile(*selected, tile_);
    if (!selected) return with_option(selected.error()).of(file);
    return MeshSpace(std::make_shared<const SelectedPart>(std::move(*selected)), decoder_, file);
}

void TangentSpaceOptions::note(Job& job, const MeshSpace& mesh) const {
    const std::lock_guard lock(mutex_);
    for (const std::string& remark : mesh.selected().remarks) {
        if (noted_.insert(mesh.file() + '\n' + remark).second)
            job.warn(remark, mesh.file());
        else
            job.remark(remark, mesh.file());
    }
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
    Loaded& loaded = loaded_[{file, tangents}];
    if (loaded.is_current()) return loaded.part;
    std::vector<FileState> files;
    for (const std::string& one : files_of(file)) files.push_back(FileState::of(one));
    MeshReadOptions how;
    how.reader = options;
    const auto mesh = read_mesh(file, how);
    if (!mesh) return mesh.error().of(file);
    MeshSelection selection = selection_;
    selection.tangents = tangents;
    auto selected = select_part(*mesh, selection, execution);
    if (!selected) return with_option(selected.error()).of(file);
    loaded = {std::move(files), std::make_shared<const SelectedPart>(std::move(*selected))};
    return loaded.part;
}

}  // namespace tex::cli
