// SPDX-License-Identifier: Apache-2.0

#include "tasks/model_output.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "files/path_names.h"

namespace tex::cli {
namespace {

// Whether two maps have one image, or images of the same file or bytes, which have the same uses.
bool share_an_image(const Model& model, const ModelMap& a, const ModelMap& b) {
    if (a.image == b.image) return true;
    const ImageUse& first = model.images[static_cast<std::size_t>(a.image)].uses.front();
    const ImageUse& second = model.images[static_cast<std::size_t>(b.image)].uses.front();
    return first.material == second.material && first.slot == second.slot;
}

// Adds the files that are written if no map changes.
void add_copies(ModelFiles& all, const Result<ModelFiles>& copies) {
    if (!copies) return;
    for (const ModelFile& copy : copies->files) {
        const bool is_known = std::any_of(all.files.begin(), all.files.end(),
                                          [&](const ModelFile& file) { return file.path == copy.path; });
        if (!is_known) all.files.insert(all.files.begin(), copy);
    }
}

}  // namespace

bool names_model(const std::string& name) {
    const std::string extension = lower_case(slashed(std::filesystem::path(name).extension()));
    return extension == ".glb" || extension == ".gltf";
}

bool is_for_models(Encoding encoding) {
    return encoding == Encoding::rgb8 || encoding == Encoding::rgba8 || encoding == Encoding::rgb16 ||
           encoding == Encoding::rgba16 || encoding == Encoding::uastc;
}

Result<ModelOutput> maps_to_write(const std::string& input, const std::string& material,
                                  const MeshReadOptions& options) {
    ModelOutput output;
    const auto maps = with_maps_of_models({{input}}, material, options);
    if (maps.front().model == nullptr) {  // it is no model, or cannot be opened
        const auto model = read_model_maps(input, options);
        return model ? Error{ErrorCode::io, input, "changed while it was read"} : model.error();
    }
    if (maps.front().model->error) return *maps.front().model->error;
    if (!maps.front().model->map) {
        return Error{ErrorCode::unsupported, input,
                     material.empty() ? "no material uses a normal map" : "the material uses no normal map"};
    }
    const auto model = maps.front().model->read(LastModel::Part::maps, options.reader);
    if (!model) return model.error();
    for (const Input& map : maps) {
        if (map.model->map->image < 0) return Error{ErrorCode::bad_data, map.model->name(), "its texture has no image"};
        const auto group = std::find_if(output.images.begin(), output.images.end(), [&](const auto& known) {
            return share_an_image(**model, *known.front()->map, *map.model->map);
        });
        if (group == output.images.end())
            output.images.push_back({map.model});
        else
            group->push_back(map.model);
    }
    return output;
}

ModelChanges ModelOutput::changes(Container container) const {
    ModelChanges all;
    for (const auto& group : images) {
        if (keeps_maps) break;
        ModelPicture& picture = all.pictures.emplace_back();
        picture.container = container;
        picture.sets_slots = is_lod;
        for (const auto& map : group) {
            picture.maps.push_back(*map->map);
            if (is_lod) picture.maps.back().scale = 1.0;
        }
    }
    for (std::size_t k = 0; k < occlusion.size(); ++k) {
        ModelPicture& picture = all.pictures.emplace_back();
        picture.container = container == Container::webp ? container : Container::png;
        picture.maps = {*images[k].front()->map};
        picture.use = occlusion[k].use;
    }
    all.tangents = tangents;
    all.adds_material = adds_material;
    return all;
}

namespace {

std::vector<ModelFile> set_output(Task& task, Result<ModelOutput> made, bool may_keep, const MeshReadOptions& options) {
    auto output = std::make_shared<ModelOutput>();
    task.model_output = output;
    std::optional<Result<ModelFiles>> files;
    if (made) files = model_files(task.input, task.output, made->changes(task.container), options);
    if (made && *files && may_keep) add_copies(**files, model_files(task.input, task.output, {}, options));
    if (!made || !*files) {
        output->error = made ? files->error() : made.error();
        return {};
    }
    *output = std::move(*made);
    std::set<std::string> read;
    for (const auto& group : output->images) {
        for (const auto& map : group) read.insert(map->beside.begin(), map->beside.end());
    }
    read.insert((*files)->joined.begin(), (*files)->joined.end());
    for (const ModelFile& file : (*files)->files) {
        if (!file.from.empty()) read.insert(file.from);
        if (file.path != task.output) task.more_outputs.push_back(file.path);
    }
    task.own.insert(task.own.end(), read.begin(), read.end());
    return (*files)->files;
}

// Finds the parts that get tangents.
Result<void> find_tangents(ModelOutput& output, std::optional<TangentSource> tangents, const MeshReadOptions& options) {
    const auto model = output.images.front().front()->read(LastModel::Part::all, options.reader);
    if (!model) return model.error();
    std::set<std::pair<int, int>> known;
    for (const auto& group : output.images) {
        for (const MeshPart* const part : group.front()->parts_without(**model, tangents)) {
            if (known.emplace(part->mesh, part->primitive).second)
                output.tangents.push_back({part->mesh, part->primitive, {}});
        }
    }
    return {};
}

// The red of the texture of roughness is free for occlusion, unless that has another one already. Its UVs must be those
// of the map.
ModelOcclusion occlusion_of(const Model& model, const ModelMap& map) {
    const ModelTexture *occlusion = nullptr, *roughness = nullptr;
    for (const ModelTexture& texture : model.textures) {
        if (texture.material != map.material || !texture.extension.empty()) continue;
        if (texture.slot == "occlusionTexture") occlusion = &texture;
        if (texture.slot == "metallicRoughnessTexture") roughness = &texture;
    }
    const bool fits = roughness != nullptr && roughness->image >= 0 && roughness->uv_set == map.uv_set &&
                      roughness->uv_transform == map.uv_transform &&
                      (occlusion == nullptr || occlusion->image == roughness->image);
    return fits ? ModelOcclusion{PictureUse::orm, roughness->image} : ModelOcclusion{};
}

Result<ModelOutput> lod_of(const std::string& input, const std::string& material, std::optional<TangentSource> tangents,
                           bool occlusion, const MeshReadOptions& options) {
    ModelOutput output;
    output.is_lod = true;
    for (const auto& map : materials_of_model(input, material, options)) {
        if (map->error) return *map->error;
        output.adds_material = map->is_added;
        output.images.push_back({map});
    }
    if (auto found = find_tangents(output, tangents, options); !found) return found.error();
    if (!occlusion) return output;
    const auto model = output.images.front().front()->read(LastModel::Part::all, options.reader);
    if (!model) return model.error();
    for (const auto& group : output.images) output.occlusion.push_back(occlusion_of(**model, *group.front()->map));
    return output;
}

// Each map gets a picture of its own, because maps of different triangles become different ones.
Result<ModelOutput> conversion_of(const std::string& input, const std::string& material, TangentSource tangents,
                                  bool changes_maps, const MeshReadOptions& options) {
    auto output = maps_to_write(input, material, options);
    if (!output) return output.error();
    output->is_lod = true;
    output->keeps_maps = !changes_maps;
    std::vector<std::vector<std::shared_ptr<const ModelInput>>> single;
    for (const auto& group : std::exchange(output->images, {})) {
        for (const auto& map : group) single.push_back({map});
    }
    output->images = std::move(single);
    if (auto found = find_tangents(*output, tangents, options); !found) return found.error();
    if (output->keeps_maps && output->tangents.empty())
        return Error{ErrorCode::bad_option, input, "no triangle with a normal map has UVs and normals"};
    return output;
}

// A part has one tangent for all of its maps.
void warn_of_other_uvs(Job& job, const ModelInput& first, const ModelInput& other) {
    if (first.map->uv_set == other.map->uv_set && first.map->uv_transform == other.map->uv_transform) return;
    job.warn(fmt::format("is on triangles of {}, whose UVs lie elsewhere; the tangents are made for those",
                         printable(first.field)),
             other.name());
}

}  // namespace

std::vector<ModelFile> set_model_output(Task& task, const std::string& material, bool may_keep,
                                        const MeshReadOptions& options) {
    return set_output(task, maps_to_write(task.input, material, options), may_keep, options);
}

std::vector<ModelFile> set_lod_output(Task& task, const std::string& material, std::optional<TangentSource> tangents,
                                      bool occlusion, const MeshReadOptions& options) {
    return set_output(task, lod_of(task.input, material, tangents, occlusion, options), false, options);
}

std::vector<ModelFile> set_converted_output(Task& task, const std::string& material, TangentSource tangents,
                                            bool changes_maps, const MeshReadOptions& options) {
    return set_output(task, conversion_of(task.input, material, tangents, changes_maps, options), false, options);
}

Result<std::vector<ModelTangents>> tangents_for(Job& job, const ModelChanges& changes,
                                                std::optional<TangentSource> tangents) {
    const TangentMethod method =
        tangents == TangentSource::meshopt ? TangentMethod::meshopt : TangentMethod::mikktspace;
    std::vector<ModelTangents> all;
    std::map<std::pair<int, int>, const ModelInput*> known;
    for (const auto& group : job.task.model_output->images) {
        const ModelInput& material = *group.front();
        const auto is_made = [&](const ModelPicture& picture) {
            return picture.maps.front().material == material.map->material;
        };
        const bool keeps = job.task.model_output->keeps_maps;
        if (!keeps && std::none_of(changes.pictures.begin(), changes.pictures.end(), is_made)) continue;
        const auto model = material.read(LastModel::Part::all, job.read_options);
        if (!model) return model.error();
        for (const MeshPart* const part : material.parts_without(**model, tangents)) {
            const auto [first, is_new] = known.emplace(std::pair(part->mesh, part->primitive), &material);
            if (!is_new) {
                warn_of_other_uvs(job, *first->second, material);
                continue;
            }
            const auto moved = with_moved_uvs(*part, material.map->uv_set, material.map->uv_transform);
            if (!moved) return moved.error().of(material.name());
            auto made = make_tangents(*moved, method, material.map->uv_set, {job.threads(), {}});
            if (!made) return made.error().of(material.name());
            all.push_back({part->mesh, part->primitive, std::move(*made)});
        }
    }
    return all;
}

Result<void> make_pictures(Job& job, ModelChanges& changes,
                           const std::function<Result<bool>(Job& one, ModelPicture& picture)>& make) {
    const ModelOutput& model = *job.task.model_output;
    for (std::size_t k = 0; k < model.images.size() && !model.keeps_maps; ++k) {
        Task task = job.task;
        task.model_output = nullptr;
        task.model = model.images[k].front();
        const auto count = static_cast<double>(model.images.size());
        const auto advance = [&](double done, const std::string&) {
            return job.reached(0.95 * (static_cast<double>(k) + done) / count);
        };
        Job one(task, job.console, job.read_options, job.write_options, job.threads(), advance);
        const auto made = make(one, changes.pictures[k]);
        if (!made) return made.error();
        job.take(one);
        if (*made) job.report["maps"].push_back(std::move(one.report));
    }
    std::erase_if(changes.pictures, [](const ModelPicture& picture) { return picture.bytes.empty(); });
    if (!job.reached(0.95)) return Error{ErrorCode::cancelled, {}, "cancelled"};
    return {};
}

namespace {

// Whether a map that is replaced was JPEG, and the picture that takes its place is not.
bool had_jpeg(const Job& job, const ModelChanges& changes) {
    const auto model = job.task.model_output->images.front().front()->read(LastModel::Part::maps, job.read_options);
    if (!model) return false;
    return std::any_of(changes.pictures.begin(), changes.pictures.end(), [&](const ModelPicture& picture) {
        const int image = picture.maps.front().image;
        if (picture.container == Container::jpeg || picture.use != PictureUse::normals || image < 0) return false;
        const ModelImage& old = (*model)->images[static_cast<std::size_t>(image)];
        return old.mime_type == "image/jpeg" || container_of(old.file) == Container::jpeg;
    });
}

// UASTC is small in the memory of a GPU, and often larger than PNG in the file, and what JPEG has lost does not make
// PNG smaller: both surprise those who shrink models.
void warn_of_growth(Job& job, const ModelChanges& changes) {
    const bool has_uastc = std::any_of(changes.pictures.begin(), changes.pictures.end(),
                                       [](const ModelPicture& one) { return one.container == Container::ktx2; });
    std::error_code error;
    const auto size = [&](const std::string& path) { return std::filesystem::file_size(path, error); };
    const std::uintmax_t before = size(job.task.input), after = size(job.task.output);
    const auto is_whole = [](const std::string& name) { return lower_case(name).ends_with(".glb"); };
    if (error || after <= before || !is_whole(job.task.input) || !is_whole(job.task.output)) return;
    if (!has_uastc && after > before + before / 10 && had_jpeg(job, changes)) {
        job.warn(
            fmt::format("it has {} bytes, and {} before: its maps were JPEG, which loses detail; --max-size makes it "
                        "smaller, --container webp somewhat, and --container jpeg keeps them JPEG",
                        after, before),
            job.task.output);
    }
    if (!has_uastc) return;
    job.warn(fmt::format("it has {} bytes, and {} before: UASTC saves memory of the GPU, not always bytes of the file; "
                         "--max-size makes it smaller, or --container webp in its place",
                         after, before),
             job.task.output);
}

}  // namespace

Result<void> write_model_output(Job& job, const ModelChanges& changes) {
    MeshReadOptions how;
    how.reader = job.read_options;
    const auto written = write_model(job.task.input, job.task.output, changes, how, job.write_options);
    if (!written) return written.error();
    job.wrote(job.task.output);
    for (const ModelFile& file : written->files) {
        if (file.path == job.task.output) continue;
        job.wrote(file.path);
        job.report["files"].push_back(file.path);
    }
    const auto warn_of = [&](const std::vector<std::string>& names, const char* what) {
        if (names.empty()) return;
        const std::string more = names.size() > 1 ? fmt::format(" and {} more", names.size() - 1) : "";
        job.warn(fmt::format("it names {}{}, which {}", printable(names.front()), more, what));
    };
    warn_of_growth(job, changes);
    warn_of(written->missing, "cannot be found, and so there is no copy beside the output");
    warn_of(written->outside, "is not in its folder, and so there is no copy beside the output");
    if (written->mirrors > 0) {
        job.report["mirrors"] = written->mirrors;
        job.say(
            fmt::format("{}: nodes that mirrored meshes with these tangents: {}; these meshes are mirrored instead\n",
                        printable(job.task.output), written->mirrors));
    }
    if (written->left_mirrors > 0) {
        job.warn(
            fmt::format("nodes still mirror meshes with tangents ({} of them), where three.js, PlayCanvas and filament "
                        "turn y over: these have instances, or animations point at them",
                        written->left_mirrors),
            job.task.output);
    }
    if (written->compressed > 0) {
        job.warn(
            fmt::format("Draco compresses {} of its primitives, which get no tangents: viewers that make them by "
                        "MikkTSpace, as glTF says, need none",
                        written->compressed));
    }
    return {};
}

}  // namespace tex::cli
