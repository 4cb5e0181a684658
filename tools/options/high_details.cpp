// SPDX-License-Identifier: Apache-2.0

#include "options/high_details.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <tex/blend.h>
#include <tex/file.h>
#include <tex/mesh.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/obj_materials.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

// An error about part k.
Error lacks(const HighParts& high, std::size_t k, const std::string& what, const std::string& option) {
    return {ErrorCode::bad_option, high.names[static_cast<std::size_t>(high.files[k])],
            fmt::format("part \"{}\" has no {}, which {} needs", printable(high.parts[k].name), what, option)};
}

std::string path_of(const std::string& pattern, const Task& task) {
    return NamePattern(pattern).expand(name_fields(task.input));
}

Result<NormalMap> read_map(Job& job, const std::string& file, std::optional<YAxis> y) {
    SourceOptions options;
    options.read = job.read_options;
    options.unpack.y_axis = y;
    options.doubt_y = options.inspect = true;
    auto source = read_normals(file, options, true, {job.threads(), {}});
    if (!source) return source.error();
    if (source->info.y_doubtful && !y) {
        job.warn(fmt::format("green is taken to point {}, but the texels show the other direction; --high-y decides",
                             name_of(kYAxisNames, source->info.y_axis)),
                 file);
    }
    return std::move(source->chain.levels.front());
}

Result<std::vector<Float4>> tangents_of(const MeshPart& part, int uv_set, const Execution& execution) {
    return part.tangents.empty() ? make_tangents(part, TangentMethod::mikktspace, uv_set, execution)
                                 : stored_tangents(part);
}

}  // namespace

Option& HighDetailOptions::add_files(Command& command, std::vector<Assigned>& files, const std::string& name,
                                     std::string help) {
    Option& row = command.option(name, "[NAME=]FILE", std::move(help), [&files](const std::string& text) {
        const auto [before, after] = cut(text, '=');
        const bool is_named = text.find('=') != std::string::npos;
        const Assigned added{is_named ? std::string(before) : std::string(), is_named ? std::string(after) : text};
        if (added.pattern.empty() || added.pattern == "-") throw UsageError("needs a file");
        if (is_named && added.material.empty()) throw UsageError("needs a material before =");
        if (NamePattern(added.pattern).uses("level") || NamePattern(added.pattern).uses("format"))
            throw UsageError("{level} and {format} have no meaning here");
        const auto same = [&](const Assigned& other) { return other.material == added.material; };
        if (std::any_of(files.begin(), files.end(), same))
            throw UsageError(is_named ? "is given twice for this material" : "is given twice without a material");
        files.push_back(added);
    });
    row.completes = Completes::files;
    row.repeatable = true;
    return row;
}

void HighDetailOptions::add(Command& command, std::function<bool()> implies_own) {
    implies_own_ = std::move(implies_own);
    command.group("Pictures on the high mesh");
    Option& row =
        add_files(command, normals_, "--high-normals",
                  "its own normal map, of all parts or of those with this material; may be repeated; own: those of its "
                  "materials (glTF); off: none");
    row.preset = "off; of a model, own";
    row.take = [this, take = row.take](const std::string& text) {
        if (text == "own" || text == "off")
            own_ = text == "own";
        else
            take(text);
    };
    add_files(command, colors_, "--high-color",
              "a texture for --color-out, of all parts or of those with this material; may be repeated");
    Option& alpha =
        add_files(command, alphas_, "--high-alpha",
                  "where this is below its cutoff, rays pass the high mesh, or its parts with this material; "
                  "may be repeated; off: it is solid");
    alpha.preset = "of materials with alphaMode MASK (glTF) or map_d (OBJ), their own";
    alpha.take = [this, take = alpha.take](const std::string& text) {
        if (text == "off")
            is_solid_ = true;
        else
            take(text);
    };
    command.choice(y_, "--high-y", "Y", kYAxisNames, "where green of --high-normals points").preset =
        "as the file says, else up";
    command.choice(decoder_, "--high-decoder", "D", kDecoderNames, "the engine that --high-normals are made for");
    command.check([this, &command] {
        const auto idle = command.given_of({"--high-y", "--high-decoder"});
        if (!idle.empty() && normals_.empty() && !takes_own()) throw UsageError(idle.front() + " needs --high-normals");
        const auto is_for_all = [](const Assigned& file) { return file.material.empty(); };
        if (own_ && std::any_of(normals_.begin(), normals_.end(), is_for_all))
            throw UsageError("--high-normals", "a file for all materials, and own or off, contradict each other");
        if (is_solid_ && !alphas_.empty()) throw UsageError("--high-alpha", "a file, and off, contradict each other");
        if (command.given("--high-color") != command.given("--color-out"))
            throw UsageError(command.given("--high-color") ? "--high-color needs --color-out"
                                                           : "--color-out needs --high-color");
    });
}

void HighDetailOptions::amend(Task& task) const {
    for (const std::vector<Assigned>* files : {&normals_, &colors_, &alphas_}) {
        for (const Assigned& file : *files) task.own.push_back(path_of(file.pattern, task));
    }
}

void HighDetailOptions::add_files_beside(const std::vector<std::string>& meshes, const ReadOptions& options,
                                         std::vector<std::string>& files) const {
    MeshReadOptions how;
    how.reader = options;
    for (const std::string& mesh : meshes) {
        if (takes_alpha()) add_obj_files(mesh, files);
        if (!takes_own() && !(takes_alpha() && has_cutouts(mesh, how))) continue;
        for (std::string& file : files_beside_model(mesh, how))
            if (!file.empty()) files.push_back(std::move(file));
    }
}

const HighDetailOptions::Assigned* HighDetailOptions::find(const std::vector<Assigned>& files,
                                                           const std::string& material) {
    const Assigned* found = nullptr;
    for (const Assigned& file : files) {
        if (file.material.empty() && found == nullptr) found = &file;
        if (!file.material.empty() && file.material == material) found = &file;
    }
    return found;
}

Result<void> HighDetailOptions::check(const std::vector<Assigned>& files, const HighParts& high,
                                      const std::string& option) {
    for (const Assigned& file : files) {
        const bool exists =
            std::find(high.materials.begin(), high.materials.end(), file.material) != high.materials.end();
        if (file.material.empty() || exists) continue;
        return Error{ErrorCode::bad_option,
                     {},
                     fmt::format("{}: the high mesh has no material \"{}\"; it has {}", option,
                                 printable(file.material), quoted_list(high.materials))};
    }
    return {};
}

Result<void> HighDetailOptions::read_normals_of(Job& job, const HighParts& high, HighPictures& pictures) const {
    if (auto known = check(normals_, high, "--high-normals"); !known) return known;
    std::map<const Assigned*, const NormalMap*> maps;
    for (std::size_t k = 0; k < high.parts.size(); ++k) {
        const Assigned* const file = find(normals_, high.materials[k]);
        const MeshPart& part = high.parts[k];
        if (file == nullptr && high.maps[k] != nullptr) {
            if (auto done = add_own(job, high, k, pictures); !done) return done;
        }
        if (file == nullptr) continue;
        if (part.uvs.empty()) return lacks(high, k, "UVs", "--high-normals");
        if (part.normals.empty()) return lacks(high, k, "normals", "--high-normals");
        if (maps[file] == nullptr) {
            auto map = read_map(job, path_of(file->pattern, job.task), y_);
            if (!map) return map.error();
            maps[file] = &pictures.normals.emplace_back(std::move(*map));
        }
        auto tangents = tangents_of(part, 0, {job.threads(), {}});
        if (!tangents) return tangents.error();
        HighDetail& detail = pictures.details[k];
        detail.normals = maps[file];
        detail.tangents = &pictures.tangents.emplace_back(std::move(*tangents));
        detail.decoder = decoder_;
    }
    return {};
}

// Without UVs or normals, nobody sees the map.
Result<void> HighDetailOptions::add_own(Job& job, const HighParts& high, std::size_t k, HighPictures& pictures) const {
    const ModelInput& map = *high.maps[k];
    const MeshPart& part = high.parts[k];
    const int uv_set = map.map->uv_set;
    if (static_cast<std::size_t>(uv_set) >= part.uvs.size() || part.normals.empty()) return {};
    const auto normals = own_map(job, map, pictures);
    if (!normals) return normals.error();
    auto tangents = tangents_of(part, uv_set, {job.threads(), {}});
    if (!tangents) return tangents.error().of(map.name());
    HighDetail& detail = pictures.details[k];
    detail.normals = *normals;
    detail.tangents = &pictures.tangents.emplace_back(std::move(*tangents));
    detail.decoder = decoder_;
    detail.uv_set = uv_set;
    return {};
}

// The map of a material, as engines draw it: glTF has no other direction of green than up, and yet there are such maps.
Result<const NormalMap*> HighDetailOptions::own_map(Job& job, const ModelInput& map, HighPictures& pictures) const {
    const NormalMap*& known = pictures.own[&map];
    if (known != nullptr) return known;
    SourceOptions options;
    options.read = job.read_options;
    options.unpack.y_axis = y_.value_or(YAxis::up);
    options.doubt_y = options.inspect = true;
    if (auto opened = map.open(options.read); !opened) return opened.error();
    auto source = read_normals(map.path, options, true, {job.threads(), {}});
    if (!source) return source.error();
    if (source->info.y_doubtful && !y_) {
        job.warn(
            "green is taken to point up, as viewers draw this normal map, but its texels show that it points down; "
            "--high-y down bakes what they show",
            map.name());
    }
    NormalMap& own = pictures.normals.emplace_back(std::move(source->chain.levels.front()));
    const Extent extent = own.extent(), largest = pictures.largest_own;
    pictures.largest_own = {std::max(extent.width, largest.width), std::max(extent.height, largest.height)};
    if (map.map->scale != 1.0) {
        auto scaled = scale(std::move(own), static_cast<float>(map.map->scale), ScaleMode::slope, {job.threads(), {}});
        if (!scaled) return scaled.error().of(map.name());
        own = std::move(*scaled);
    }
    return known = &own;
}

// Says which maps everybody sees and rays do not.
void HighDetailOptions::note_unused(Job& job, const HighParts& high, const HighPictures& pictures) {
    std::vector<std::string> materials;
    bool in_model = false;
    for (std::size_t k = 0; k < high.parts.size(); ++k) {
        if (!high.has_maps[k] || (!pictures.details.empty() && pictures.details[k].normals != nullptr)) continue;
        materials.push_back(high.materials[k]);
        in_model = in_model || is_model(high.names[static_cast<std::size_t>(high.files[k])]);
    }
    if (materials.empty()) return;
    job.warn(
        fmt::format("the high mesh has normal maps of its own, which are not used (material {}); --high-normals "
                    "{} uses them",
                    quoted_list(materials), in_model ? "own" : "FILE"));
}

Result<void> HighDetailOptions::read_colors_of(Job& job, const HighParts& high, HighPictures& pictures) const {
    if (auto known = check(colors_, high, "--high-color"); !known) return known;
    std::map<const Assigned*, const Image*> images;
    for (std::size_t k = 0; k < high.parts.size(); ++k) {
        const Assigned* const file = find(colors_, high.materials[k]);
        if (file == nullptr) continue;
        if (high.parts[k].uvs.empty()) return lacks(high, k, "UVs", "--high-color");
        if (images[file] == nullptr) {
            ReadOptions how = job.read_options;
            how.values = FileValues::unit;
            auto image = read_image(path_of(file->pattern, job.task), how);
            if (!image) return image.error();
            images[file] = &pictures.colors.emplace_back(std::move(*image));
        }
        pictures.details[k].color = images[file];
    }
    return {};
}

namespace {

// Alpha is the last of two or four channels. A file without it holds alpha itself.
Result<Plane<float>> alpha_in(const std::string& file, ReadOptions how, bool is_mask) {
    how.values = FileValues::unit;
    auto image = read_image(file, how);
    if (!image) return image.error();
    const std::size_t count = image->planes.size();
    if (count == 2 || count == 4) return std::move(image->planes.back());
    if (!is_mask) return std::move(image->planes.front());
    Plane<float> whole(Extent{1, 1});
    whole.at(0, 0) = 1.0f;
    return whole;
}

}  // namespace

// The alpha of a material with holes. Null: it is solid.
Result<const Plane<float>*> HighDetailOptions::alpha_of(Job& job, const PartAlpha& alpha, HighPictures& pictures,
                                                        std::map<std::string, const Plane<float>*>& known) const {
    if (!alpha.has_picture()) {
        if (alpha.factor >= alpha.cutoff) return nullptr;
        pictures.alphas.emplace_back(Extent{1, 1}).at(0, 0) = 0.0f;
        return &pictures.alphas.back();
    }
    const Plane<float>*& plane = known[alpha.file];
    if (plane != nullptr) return plane;
    ReadOptions how = job.read_options;
    how.bytes = alpha.bytes;
    auto read = alpha_in(alpha.file, how, !alpha.is_grey);
    if (!read) return read.error().of(alpha.file);
    return plane = &pictures.alphas.emplace_back(std::move(*read));
}

Result<void> HighDetailOptions::read_alphas_of(Job& job, const HighParts& high, HighPictures& pictures) const {
    if (auto known = check(alphas_, high, "--high-alpha"); !known) return known;
    std::map<const Assigned*, const Plane<float>*> planes;
    std::map<std::string, const Plane<float>*> own;
    std::vector<std::string> blended;
    for (std::size_t k = 0; k < high.parts.size(); ++k) {
        const Assigned* const file = find(alphas_, high.materials[k]);
        const PartAlpha& alpha = high.alphas[k];
        HighDetail& detail = pictures.details[k];
        if (file != nullptr) {
            if (high.parts[k].uvs.empty()) return lacks(high, k, "UVs", "--high-alpha");
            if (planes[file] == nullptr) {
                auto read = alpha_in(path_of(file->pattern, job.task), job.read_options, false);
                if (!read) return read.error();
                planes[file] = &pictures.alphas.emplace_back(std::move(*read));
            }
            detail.alpha = planes[file];
            detail.alpha_cutoff = static_cast<float>(alpha.mode == AlphaMode::mask ? alpha.cutoff : 0.5);
            continue;
        }
        if (alpha.mode == AlphaMode::blend) blended.push_back(high.materials[k]);
        if (alpha.mode != AlphaMode::mask || high.parts[k].uvs.empty()) continue;
        const auto plane = alpha_of(job, alpha, pictures, own);
        if (!plane) return plane.error();
        detail.alpha = *plane;
        detail.alpha_uv_set = alpha.has_picture() ? static_cast<int>(high.parts[k].uvs.size()) - 1 : 0;
        // Texels are multiplied by the factor.
        detail.alpha_cutoff = alpha.factor > 0.0 ? static_cast<float>(alpha.cutoff / alpha.factor) : 2.0f;
    }
    if (blended.empty()) return {};
    job.remark(
        fmt::format("rays meet what blends with its background as if it were solid (material {}); --high-alpha "
                    "FILE makes holes",
                    quoted_list(blended)));
    return {};
}

std::vector<FileState> HighDetailOptions::files_of(const Task& task) const {
    std::vector<FileState> states;
    for (const std::vector<Assigned>* files : {&normals_, &colors_, &alphas_}) {
        for (const Assigned& file : *files) states.push_back(FileState::of(path_of(file.pattern, task)));
    }
    return states;
}

// What was said of them when they were read is printed once.
Result<std::shared_ptr<const HighPictures>> HighDetailOptions::read(
    Job& job, const std::shared_ptr<const HighParts>& high) const {
    const bool shares = high->trees != nullptr;
    const std::unique_lock lock = shares ? std::unique_lock(mutex_) : std::unique_lock<std::mutex>();
    std::vector<FileState> files = shares ? files_of(job.task) : std::vector<FileState>();
    if (shares && last_.high == high && last_.files == files) {
        for (const FileWarning& warning : last_.warnings) job.remark(warning.message, warning.file);
        return last_.pictures;
    }
    if (shares) last_ = {};
    Job own(job.task, job.console, job.read_options, job.write_options, job.threads(),
            [](double, const std::string&) { return true; });
    auto read = read_all(own, *high);
    job.take(own);
    if (!read) return read.error();
    auto pictures = std::make_shared<const HighPictures>(std::move(*read));
    if (!shares) return pictures;
    last_ = {high, std::move(files), pictures, own.warnings()};
    last_.warnings.insert(last_.warnings.end(), own.remarks().begin(), own.remarks().end());
    for (FileWarning& warning : last_.warnings) {
        if (warning.file == job.task.name()) warning.file.clear();
    }
    return pictures;
}

Result<HighPictures> HighDetailOptions::read_all(Job& job, const HighParts& high) const {
    HighPictures pictures;
    const auto is_own = [](const std::shared_ptr<const ModelInput>& map) { return map != nullptr; };
    const auto has_alpha = [](const PartAlpha& alpha) { return alpha.mode != AlphaMode::opaque; };
    const bool any_alpha = takes_alpha() && std::any_of(high.alphas.begin(), high.alphas.end(), has_alpha);
    if (is_given() || any_alpha || std::any_of(high.maps.begin(), high.maps.end(), is_own)) {
        pictures.details.resize(high.parts.size());
        if (takes_alpha()) {
            if (auto done = read_alphas_of(job, high, pictures); !done) return done.error();
        }
        if (auto done = read_normals_of(job, high, pictures); !done) return done.error();
        if (auto done = read_colors_of(job, high, pictures); !done) return done.error();
    }
    if (own_.value_or(true)) note_unused(job, high, pictures);  // off says that they are known
    return pictures;
}

}  // namespace tex::cli
