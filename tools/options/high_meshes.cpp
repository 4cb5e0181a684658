// SPDX-License-Identifier: Apache-2.0

#include "options/high_meshes.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <tex/mesh.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "options/obj_materials.h"
#include "tasks/name_pattern.h"

namespace tex::cli {

std::string quoted_list(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 6;
    std::vector<std::string> once;
    std::set<std::string> seen;
    for (const std::string& name : names) {
        if (seen.insert(name).second) once.push_back(name);
    }
    std::string text;
    for (std::size_t k = 0; k < std::min(kMost, once.size()); ++k)
        text += fmt::format("{}\"{}\"", k == 0 ? "" : ", ", printable(once[k]));
    if (once.size() > kMost) text += fmt::format(" and {} more", once.size() - kMost);
    return text;
}

bool has_cutouts(const std::string& model, const MeshReadOptions& options) {
    if (!is_model(model)) return false;
    const auto read = read_model_maps(model, options);
    return read && std::any_of(read->mesh.materials.begin(), read->mesh.materials.end(),
                               [](const MeshMaterial& material) { return material.alpha_mode == AlphaMode::mask; });
}

std::size_t HighParts::triangles() const {
    std::size_t sum = 0;
    for (std::size_t k = 0; k < standing(); ++k) sum += parts[part_of(k)].triangles();
    return sum;
}

// places_in_scene() has tried all of them, so that in_scene() fails only without memory; then the part is left out.
void HighParts::visit_standing(const std::function<void(const MeshPart&)>& visit) const {
    for (std::size_t k = 0; k < parts.size() && places.empty(); ++k) visit(parts[k]);
    for (const PartPlace& place : places) {
        const auto placed = in_scene(parts[place.part], {place.name, 0, place.to_scene});
        if (placed) visit(*placed);
    }
}

void HighParts::add_places(const std::vector<MeshPart>& added, std::vector<PartPlace> of_added) {
    const std::size_t first = parts.size();
    if (of_added.empty() && places.empty()) return;
    for (std::size_t k = places.empty() ? 0 : first; k < first; ++k) places.push_back({k, parts[k].name});
    for (std::size_t k = 0; k < added.size() && of_added.empty(); ++k) places.push_back({first + k, added[k].name});
    for (PartPlace& place : of_added) {
        place.part += first;
        places.push_back(std::move(place));
    }
}

void HighMeshes::add(Command& command) {
    command.group("High mesh");
    Option& row = command.option(
        "--high", "PATTERN", "the mesh that rays hit, for each input: a file, or a pattern as --name; may be repeated",
        [this](const std::string& text) {
            if (text.empty() || text == "-") throw UsageError("needs a file");
            if (NamePattern(text).uses("level") || NamePattern(text).uses("format"))
                throw UsageError("{level} and {format} have no meaning here");
            patterns_.push_back(text);
        });
    row.completes = Completes::files;
    row.repeatable = true;
    row.preset = "the inputs after the first one";
    command.choice(match_, "--match", "M", kMatchNames, "which parts of both meshes belong together").preset =
        "all; material, if each material gets a map";
    command
        .option("--high-scale", "S", "what the high meshes are multiplied by, if their unit is another one",
                [this](const std::string& text) { units_.scale = parse_double(text, kPositive); })
        .preset = "1";
    command.choice(units_.up, "--high-up", "AXIS", kUpAxisNames, "the axis that points up in the high meshes");
    command
        .option("--max-triangles", "N", "the most triangles that nodes may make by showing meshes more than once",
                [this](const std::string& text) { most_ = parse_count(text); })
        .preset = count_text(most_);
}

std::vector<std::string> HighMeshes::buffers_of(const std::vector<std::string>& meshes) {
    std::vector<std::string> buffers;
    for (const std::string& mesh : meshes) {
        for (std::string& file : files_of_mesh(mesh)) {
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

// Tiles and materials of a low mesh are tasks of their own.
bool HighMeshes::is_shared(const Task& task) const {
    return is_common_ || task.is_tile_of_mesh() || task.model || task.model_output;
}

void HighMeshes::note_tasks(const std::vector<Task>& tasks) {
    is_common_ = tasks.size() > 1 && std::all_of(tasks.begin(), tasks.end(), [&](const Task& task) {
                     return names_of(task) == names_of(tasks.front());
                 });
}

void HighMeshes::amend(Task& task) const {
    if (!is_given()) return;
    std::vector<std::string> meshes = names_of(task);
    task.own.insert(task.own.end(), meshes.begin(), meshes.end());
    meshes.push_back(task.input);
    for (std::string& buffer : buffers_of(meshes)) task.own.push_back(std::move(buffer));
}

Result<std::shared_ptr<const HighParts>> HighMeshes::read(Job& job, const Wanted& wanted) const {
    const std::vector<std::string> names = names_of(job.task);
    const bool shares = is_shared(job.task);
    const std::unique_lock lock = shares ? std::unique_lock(mutex_) : std::unique_lock<std::mutex>();
    if (shares && last_ && last_->names == names && are_current(last_files_)) {
        for (const FileWarning& remark : last_->remarks) job.remark(remark.message, remark.file);
        return last_;
    }
    if (shares) last_.reset();
    std::vector<FileState> files = states_of(shares ? names : std::vector<std::string>());
    for (const std::string& name : names) {
        if (!shares || !(wanted.maps || wanted.alpha)) continue;
        MeshReadOptions how;
        how.reader = job.read_options;
        for (const std::string& file : files_beside_model(name, how)) files.push_back(FileState::of(file));
    }
    auto high = read(names, job.read_options, wanted);
    if (!high) return high.error();
    for (const FileWarning& remark : high->remarks) job.warn(remark.message, remark.file);
    if (shares) high->trees = share_trees();
    auto shared = std::make_shared<const HighParts>(std::move(*high));
    if (shares) {
        last_ = shared;
        last_files_ = std::move(files);
    }
    return shared;
}

Result<HighParts> HighMeshes::read(const std::vector<std::string>& names, const ReadOptions& options,
                                   const Wanted& wanted) const {
    HighParts high;
    MeshReadOptions how;
    how.reader = options;
    how.colors = wanted.colors;
    int file = 0;
    for (const std::string& name : names) {
        auto mesh = read_mesh(name, how);
        if (!mesh) return mesh.error().of(name);
        for (const std::string& remark : mesh->remarks) high.remarks.push_back({name, remark});
        std::vector<PartAlpha> alphas;  // of the materials
        for (const MeshMaterial& of : mesh->materials) alphas.push_back({of.alpha_mode, of.alpha_cutoff, of.alpha});
        if (wanted.alpha && is_model(name)) {
            if (auto done = read_alphas(name, how, *mesh, alphas); !done) return done.error().of(name);
        }
        if (wanted.alpha) read_obj_alphas(name, *mesh, alphas);
        std::map<int, std::shared_ptr<const ModelInput>> maps;
        if (wanted.maps && is_model(name)) {
            if (auto done = read_maps(name, how, *mesh, maps); !done) return done.error().of(name);
        }
        const auto has_picture = [&](const MeshPart& part) {
            return part.material >= 0 && alphas[static_cast<std::size_t>(part.material)].has_picture();
        };
        for (MeshPart& part : mesh->parts) {
            if (wanted.uvs || maps.contains(part.material)) continue;
            part.tangents.clear();
            if (!has_picture(part)) part.uvs.clear();
        }
        const std::vector<MeshMaterial> materials = mesh->materials;
        units_.place(*mesh);
        auto placed = places_in_scene(std::move(*mesh), static_cast<std::size_t>(most_));
        if (!placed) return with_limit(placed.error()).of(name);
        high.add_places(placed->parts, std::move(placed->places));
        for (MeshPart& part : placed->parts) {
            const bool has_material = part.material >= 0 && static_cast<std::size_t>(part.material) < materials.size();
            high.materials.push_back(has_material ? materials[static_cast<std::size_t>(part.material)].name : "");
            high.alphas.push_back(has_material ? alphas[static_cast<std::size_t>(part.material)] : PartAlpha{});
            high.has_maps.push_back(has_material && materials[static_cast<std::size_t>(part.material)].has_normal_map);
            const auto map = maps.find(part.material);
            high.maps.push_back(map == maps.end() ? nullptr : map->second);
            high.files.push_back(file);
            high.parts.push_back(std::move(part));
        }
        high.names.push_back(name);
        ++file;
    }
    return high;
}

// Pictures of alpha for the parts whose materials have holes. Each gets a set of UVs for it, because the normal map may
// move the others elsewhere; this comes before the maps.
Result<void> HighMeshes::read_alphas(const std::string& name, const MeshReadOptions& options, Mesh& mesh,
                                     std::vector<PartAlpha>& alphas) {
    const auto is_mask = [](const PartAlpha& alpha) { return alpha.mode == AlphaMode::mask; };
    if (std::none_of(alphas.begin(), alphas.end(), is_mask)) return {};
    MeshReadOptions how = options;
    how.images = true;
    const auto read = read_model_maps(name, how);
    if (!read) return read.error();
    const auto model = std::make_shared<const Model>(*read);
    for (const ModelTexture& texture : model->textures) {
        const bool is_base = texture.slot == "baseColorTexture" || texture.slot == "diffuseTexture";
        if (!is_base || texture.image < 0) continue;
        PartAlpha& alpha = alphas[static_cast<std::size_t>(texture.material)];
        const ModelImage& image = model->images[static_cast<std::size_t>(texture.image)];
        if (!is_mask(alpha) || alpha.has_picture()) continue;
        if (image.error) return *image.error;
        alpha.file = image.file.empty() ? name + ": " + image.name : image.file;
        if (image.file.empty()) alpha.bytes = std::shared_ptr<const std::vector<std::byte>>(model, &image.bytes);
        for (MeshPart& part : mesh.parts) {
            if (part.material != texture.material || static_cast<std::size_t>(texture.uv_set) >= part.uvs.size())
                continue;
            part.uvs.push_back(part.uvs[static_cast<std::size_t>(texture.uv_set)]);
            const int added = static_cast<int>(part.uvs.size()) - 1;
            auto moved = with_moved_uvs(std::move(part), added, texture.uv_transform);
            if (!moved) return moved.error();
            part = std::move(*moved);
        }
    }
    return {};
}

// In OBJ files, map_d makes holes, and d alone blends.
void HighMeshes::read_obj_alphas(const std::string& name, Mesh& mesh, std::vector<PartAlpha>& alphas) {
    const ObjMaterials materials = obj_materials(name);
    for (std::size_t m = 0; m < alphas.size() && !materials.alphas.empty(); ++m) {
        const auto found = materials.alphas.find(mesh.materials[m].name);
        if (found == materials.alphas.end()) continue;
        alphas[m].factor = found->second.factor;
        if (found->second.picture.empty()) {
            if (found->second.factor < 1.0) alphas[m].mode = AlphaMode::blend;
            continue;
        }
        alphas[m].mode = AlphaMode::mask;
        alphas[m].file = found->second.picture;
        alphas[m].is_grey = true;
        for (MeshPart& part : mesh.parts) {
            if (part.material == static_cast<int>(m) && !part.uvs.empty()) part.uvs.push_back(part.uvs.front());
        }
    }
}

// The maps by material; UVs of parts are moved as they say.
Result<void> HighMeshes::read_maps(const std::string& name, const MeshReadOptions& options, Mesh& mesh,
                                   std::map<int, std::shared_ptr<const ModelInput>>& maps) const {
    for (const Input& input : with_maps_of_models({{name}}, "", options)) {
        if (!input.model) continue;
        if (input.model->error) return *input.model->error;
        if (input.model->map && input.model->map->slot == NormalSlot::normal)
            maps[input.model->map->material] = input.model;
    }
    for (MeshPart& part : mesh.parts) {
        const auto map = maps.find(part.material);
        if (map == maps.end()) continue;
        const ModelMap& of = *map->second->map;
        if (static_cast<std::size_t>(of.uv_set) >= part.uvs.size() || of.uv_transform == UvTransform{}) continue;
        auto moved = with_moved_uvs(std::move(part), of.uv_set, of.uv_transform);
        if (!moved) return moved.error();
        part = std::move(*moved);
    }
    return {};
}

Result<void> HighMeshes::match(Job& job, const SelectedPart& low, const HighParts& high, TransferInputs& inputs) const {
    const Match match = match_.value_or(job.task.model ? Match::material : Match::all);
    if (match == Match::all) return {};
    std::vector<std::string> low_names, high_names;
    for (const SelectedPiece& piece : low.pieces)
        low_names.push_back(match == Match::name ? piece.name : piece.material);
    for (std::size_t k = 0; k < high.standing(); ++k)
        high_names.push_back(match == Match::name ? high.name_of(k) : high.materials[high.part_of(k)]);
    const MatchedNames matched = match_names(low_names, high_names);
    job.report["match"] = {{"lone_low", matched.lone_low}, {"lone_high", matched.lone_high}};
    const std::string what = match == Match::name ? "part" : "material";
    const auto belongs = [&](int number) {
        return std::find(matched.high.begin(), matched.high.end(), number) != matched.high.end();
    };
    const bool has_partner = std::any_of(matched.low.begin(), matched.low.end(), belongs);
    if (!has_partner && !match_) {
        job.report.erase("match");
        // Without names, there is nothing to say about a mesh of one material.
        const bool is_plain = std::all_of(high_names.begin(), high_names.end(),
                                          [&](const std::string& name) { return name == high_names.front(); });
        if (!is_plain) {
            job.warn(
                fmt::format("the high mesh has no material of this name, and so rays meet all of its parts; it "
                            "has {}",
                            quoted_list(high_names)));
        }
        return {};
    }
    if (!has_partner) {
        return Error{ErrorCode::bad_option, job.task.input,
                     fmt::format("no {} has a partner: the low mesh has {}, the high one {}", what,
                                 quoted_list(low_names), quoted_list(high_names))};
    }
    if (!matched.lone_low.empty())
        job.warn(fmt::format("no {} of the high mesh belongs to {}: their texels are missed", what,
                             quoted_list(matched.lone_low)));
    // Each tile and each material has its own parts.
    if (!matched.lone_high.empty() && !job.task.is_tile_of_mesh() && !job.task.model)
        job.warn(fmt::format("no {} of the low mesh belongs to {} of the high one: no ray meets them", what,
                             quoted_list(matched.lone_high)));
    inputs.high_groups = matched.high;
    for (std::size_t k = 0; k < low.pieces.size(); ++k) {
        const std::size_t end = k + 1 < low.pieces.size() ? low.pieces[k + 1].triangle : low.part.triangles();
        inputs.low_groups.resize(end, matched.low[k]);
    }
    return {};
}

Error HighMeshes::with_limit(const Error& error) const {
    if (error.code != ErrorCode::unsupported) return error;
    return {error.code, error.file, error.reason + "; --max-triangles allows more than " + count_text(most_)};
}

Error HighMeshes::with_order(const Error& error) {
    if (error.detail != ErrorDetail::no_uvs) return error;
    return {error.code, error.file, error.reason + "; is it the high mesh? The low one comes first"};
}

void HighMeshes::compare(Job& job, const MeshPart& low, const HighParts& high) const {
    const std::size_t triangles = high.triangles();
    job.report["triangles"] = {{"low", low.triangles()}, {"high", triangles}};
    const bool is_known = !units_.is_plain() || job.task.is_tile_of_mesh() || job.task.model;
    const auto units = is_known ? std::nullopt : fitting_units(low, high.parts, high.places);
    if (units) {
        job.warn(
            fmt::format("both meshes differ in unit or axes, and would fit with {} (FBX files are in centimetres, glTF "
                        "in metres; some programs have z up)",
                        units->arguments()));
    } else if (const auto offset = is_known ? std::nullopt : offset_between(low, high.parts, high.places)) {
        job.warn(
            fmt::format("the meshes have one size and do not lie on each other: the high one is off by ({:.3g}, "
                        "{:.3g}, {:.3g}); is the translation of a node missing in one of the files?",
                        (*offset)[0], (*offset)[1], (*offset)[2]));
    }
    if (low.triangles() <= 2 * triangles) return;
    job.warn(
        fmt::format("has more triangles, {}, than the high mesh, {}; did both change places? The low one comes "
                    "first",
                    low.triangles(), triangles));
}

}  // namespace tex::cli
