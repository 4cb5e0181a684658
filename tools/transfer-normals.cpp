// SPDX-License-Identifier: Apache-2.0
// transfer-normals: makes the normal map of a low mesh from a high one.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/batch.h"
#include "batch/lod_rules.h"
#include "batch/model_plan.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/guides.h"
#include "options/high_details.h"
#include "options/high_meshes.h"
#include "options/mips.h"
#include "options/part_ids.h"
#include "options/rays.h"
#include "options/tangent_space.h"
#include "reports/transfer_report.h"
#include "tasks/lod_notes.h"
#include "tasks/model_occlusion.h"
#include "tasks/model_output.h"
#include "tasks/written_levels.h"

namespace {

using namespace tex;

class TransferNormals : public cli::Converter {
public:
    explicit TransferNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] const cli::MipChainOptions* mip_chain() const override { return &mips_; }
    [[nodiscard]] cli::OutputRules rules() const override;
    [[nodiscard]] bool writes_models() const { return cli::writes_models(files); }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    // Tasks that share the high mesh use the trees of those before them, and memory holds these once.
    [[nodiscard]] std::size_t most_at_once(const std::vector<cli::Task>& tasks) const override {
        const auto shares = [this](const cli::Task& task) { return high_.is_shared(task); };
        return std::any_of(tasks.begin(), tasks.end(), shares) ? 1 : cli::kMostFilesAtOnce;
    }
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    struct Meshes {
        cli::MeshSpace low;
        std::shared_ptr<const cli::HighParts> high;
    };
    [[nodiscard]] Result<std::shared_ptr<const cli::HighParts>> read_high(cli::Job& job) const;
    [[nodiscard]] Result<Meshes> read(cli::Job& job) const;
    [[nodiscard]] Result<TransferredMaps> cast(cli::Job& job, const Meshes& meshes, const cli::HighPictures& pictures,
                                               Extent extent, bool occlusion) const;
    [[nodiscard]] Result<void> make(cli::Job& job);
    [[nodiscard]] Result<PackedTexture> pack_maps(cli::Job& job, TransferredMaps& maps, PackOptions& with) const;
    [[nodiscard]] Result<void> write(cli::Job& job, const Meshes& meshes, TransferredMaps& maps);
    [[nodiscard]] Result<void> make_model(cli::Job& job);
    [[nodiscard]] Result<bool> make_picture(cli::Job& job, const cli::HighPictures& pictures,
                                            std::shared_ptr<const cli::HighParts> high, ModelPicture& picture,
                                            ModelPicture* occlusion, const cli::ModelOcclusion& place);
    [[nodiscard]] cli::ExitCode finish(cli::Console& console) override { return report_.write(console); }

    cli::HighMeshes high_;
    cli::TangentSpaceOptions low_;
    cli::RayOptions rays_;
    cli::GuideOptions guides_;
    cli::HighDetailOptions pictures_;
    cli::PartIds ids_;
    cli::TransferMaps maps_;
    cli::MipChainOptions mips_;
    cli::TransferReport report_;
};

TransferNormals::TransferNormals(const cli::ProgramRow& row) : Converter(row) {
    command.usage("LOW HIGH... -o FILE");
    command.usage("LOW... --high PATTERN --out-dir DIR");
    command.usage("LOW HIGH... -o MODEL");
    command.input("LOW HIGH...",
                  "meshes (glTF, GLB, OBJ, FBX, PLY ...): the one that gets the map, then those that rays hit");
    files.add(command, true);
    report_.add(command);
    high_.add(command);
    low_.add_low(command);
    rays_.add(command);
    guides_.add(command);
    pictures_.add(command, [this] { return writes_models(); });
    maps_.add(command, files);
    ids_.add(command, files);
    output.add(command, cli::default_encodings(), "up");
    output.add_engines(command);
    mips_.add(command, false, "all in dds and ktx2, else none");
    running.add(command);
    command.example("transfer-normals rock_low.glb rock_high.glb -o rock_n.dds --extent 2048",
                    "The high mesh's normals as a DXT5nm texture with all its levels.");
    command.example("transfer-normals rock_low.glb rock_high.glb -o rock_n.png --report rock.html",
                    "A page with the result beside the high mesh, missed texels in red.");
    command.example("transfer-normals cat_low.glb cat.glb -o cat_lod.glb",
                    "A simplified model with maps that bring back what it lost.");
    command.example("transfer-normals low.glb high.glb -o n.png --occlusion-out ao.png",
                    "Ambient occlusion beside the map.");
    command.example(
        "transfer-normals crate_low.fbx crate_high.obj -o crate_n.png --rays straight --subsamples 4 "
        "--decoder unreal --y down --height-out crate_h.exr --max-missed 0.1",
        "Hard edges without skew, 16 rays a texel, for Unreal; fails if much is missed.");
    command.example(
        "transfer-normals rock_low.glb rock_high.glb -o rock_n.png --subsamples 2 --occlusion-out rock_ao.png "
        "--bent-out rock_bent.png --rays-per-hit 32",
        "Ambient occlusion and bent normals beside the map, from 128 rays a texel.");
    command.example("transfer-normals set_low.fbx set_high.fbx -o set_n.png --match name --id-out set_id.png",
                    "Parts that touch each other, each onto its own, with a mask for each.");
    command.example(
        "transfer-normals scan_low.glb scan_high.glb -o scan_n.png --high-normals scan_fine.png "
        "--high-color scan_base.png --color-out scan_c.png",
        "A scan's base colour and its own fine normals beside its shape.");
    command.example("transfer-normals set_low.glb set_high.glb -o 'set_n.<UDIM>.png' --height-out 'set_h.<UDIM>.exr'",
                    "A map for each UDIM tile that the low mesh uses.");
    command.example(
        "transfer-normals meshes/*_low.glb --high '{dir}/{stem:-_low}_high.glb' --out-dir out "
        "--name '{stem:-_low}_n.png'",
        "A folder of pairs at once.");
}

cli::OutputRules TransferNormals::rules() const {
    cli::OutputRules rules;
    rules.batch = Container::dds;
    rules.joins = !high_.is_given();
    if (rules.joins) rules.shared = high_.buffers_of(command.inputs());
    if (rules.joins) pictures_.add_files_beside(command.inputs(), running.read, rules.shared);
    rules.tiles = [this](const std::string& input) { return low_.tiles_of_low(input, running.read); };
    cli::set_lod_rules(rules, {command, files, low_, maps_, running.read});
    rules.amend = [this](cli::Task& task) {
        high_.amend(task);
        if (high_.is_given()) pictures_.add_files_beside(high_.names_of(task), running.read, task.own);
        guides_.amend(task);
        pictures_.amend(task);
        ids_.amend(task);
        maps_.amend(task);
    };
    return rules;
}

Result<void> TransferNormals::check(const std::vector<cli::Task>& tasks) {
    if (writes_models() && mips_.levels.value_or(1) != 1)
        throw cli::UsageError("--mips", "models hold no levels: engines build them");
    mips_.check(tasks);
    high_.note_tasks(tasks);
    for (const cli::Task& task : tasks) {
        if (task.joined.empty() && !high_.is_given())
            throw cli::UsageError("no high mesh: give LOW HIGH... -o FILE, or --high PATTERN");
    }
    std::vector<cli::NamedFile> others = files.lists();
    others.push_back({"--depfile", files.depfile});
    report_.check(tasks, std::move(others));
    return {};
}

Result<std::shared_ptr<const cli::HighParts>> TransferNormals::read_high(cli::Job& job) const {
    return high_.read(
        job, {pictures_.is_given(), maps_.wants_vertex_colors(), pictures_.takes_own(), pictures_.takes_alpha()});
}

Result<TransferNormals::Meshes> TransferNormals::read(cli::Job& job) const {
    auto high = read_high(job);
    if (!high) return high.error();
    auto low = low_.of_low(job.task, job.read_options, {job.threads(), {}});
    if (!low) return high_.with_order(low.error());
    if (cli::has_tile(job.task.output))
        return Error{ErrorCode::bad_option, job.task.input,
                     "has no triangle in a UDIM tile, for which the output would be: u or v is negative, or u is 10 or "
                     "more"};
    if (job.task.is_tile_of_mesh()) job.report["tile"] = job.task.tile;
    low_.note(job, *low);
    return Meshes{std::move(*low), std::move(*high)};
}

Result<TransferredMaps> TransferNormals::cast(cli::Job& job, const Meshes& meshes, const cli::HighPictures& pictures,
                                              Extent extent, bool occlusion) const {
    const cli::MeshSpace& low = meshes.low;
    const cli::HighParts& high = *meshes.high;
    high_.compare(job, low.selected().part, high);
    job.report["tangents"] = name_of(kTangentSourceNames, low.source());
    TransferInputs inputs;
    if (const MeshPart& rest = low.selected().rest; !rest.indices.empty()) inputs.around = &rest;
    if (auto matched = high_.match(job, low.selected(), high, inputs); !matched) return matched.error();
    const auto guides = guides_.read(job, low_, low);
    if (!guides) return guides.error();
    guides->fill(inputs);
    const bool is_plain =
        std::all_of(high.parts.begin(), high.parts.end(), [](const MeshPart& part) { return part.colors.empty(); });
    if (maps_.wants_vertex_colors() && is_plain)
        job.warn("the high mesh has no vertex colours, so that --vertex-color-out is white");
    inputs.high_details = pictures.details;
    ids_.number(high, inputs);
    inputs.high_places = high.places;
    inputs.trees = high.trees;
    // A simplified model lies on the other one, and what stands before it is another part.
    TransferOptions with = rays_.transfer(writes_models() ? HitChoice::nearest : HitChoice::outermost);
    if (guides_.wants_straight()) with.rays = RayMode::straight;
    maps_.request(with);
    with.occlusion = with.occlusion || occlusion;
    if (!job.reached(0.1)) return Error{ErrorCode::cancelled, {}, "cancelled"};
    cli::RaySpeed speed;
    inputs.rays = &speed.rays();
    job.show([&speed] { return speed.short_words(); });
    auto maps = transfer(extent, low.space(), high.parts, inputs, with, job.until(0.8));
    job.show({});
    if (maps && with.has_second_rays() && job.task.output != "-")
        job.say(fmt::format("{}: {}\n", cli::printable(job.task.output), speed.words()));
    return maps;
}

Result<PackedTexture> TransferNormals::pack_maps(cli::Job& job, TransferredMaps& maps, PackOptions& with) const {
    const auto chain =
        build_mip_chain(std::move(maps.map), mips_.options(mips_.levels_for(job.task), {}), job.until(0.85));
    if (!chain) return chain.error();
    const cli::OutputOptions own = output.of(job.task.engine);
    constexpr bool kKnown = true;
    with = own.pack_options(own.format.value_or(default_encoding(job.task.container)), YAxis::up, kKnown);
    return pack(*chain, with, job.until(0.95));
}

Result<void> TransferNormals::write(cli::Job& job, const Meshes& meshes, TransferredMaps& maps) {
    const cli::OutputOptions own = output.of(job.task.engine);
    PackOptions with;
    auto texture = pack_maps(job, maps, with);
    if (!texture) return texture.error();
    std::optional<RdoReport> rdo;
    if (with.rdo.mean > 0.0f) rdo = texture->rdo;
    if (report_.is_given()) {
        const std::string arguments = low_.low_arguments(meshes.low);
        const cli::TransferReport::Entry entry{meshes.low, arguments, *meshes.high, maps, *texture};
        if (auto added = report_.add(job, entry); !added) return added;
    }
    const Extent extent = texture->extent();
    const auto written = cli::write_levels(job, std::move(*texture), own.write_options(job));
    if (!written) return written.error();
    cli::report_texture(job, extent, written->levels, with, written->bytes, rdo);
    note_output(job, {extent, written->levels, extent != rays_.extent(), with.encoding});
    // The model keeps its old map, which was made for other triangles.
    if (is_model(job.task.input) && meshes.low.selected().has_normal_map)
        note_pictures(job, "has a normal map, and its new map is written as a picture");
    return {};
}

Result<void> TransferNormals::make(cli::Job& job) {
    const auto meshes = read(job);
    if (!meshes) return meshes.error();
    const auto pictures = pictures_.read(job, meshes->high);
    if (!pictures) return pictures.error();
    auto maps = cast(job, *meshes, **pictures, rays_.extent(), false);
    if (!maps) return maps.error();
    if (auto judged = rays_.judge(job, *maps, guides_.remedy()); !judged) return judged;
    if (auto written = write(job, *meshes, *maps); !written) return written;
    if (auto written = ids_.write(job, *meshes->high, *maps); !written) return written;
    const YAxis y = output.of(job.task.engine).y.value_or(YAxis::up);
    if (auto written = maps_.write(job, *maps, y); !written) return written;
    if (job.task.output != "-") job.say(fmt::format("{}: {}\n", cli::printable(job.task.output), cli::reach_of(*maps)));
    return {};
}

// The map of one material, whose job this is.
Result<bool> TransferNormals::make_picture(cli::Job& job, const cli::HighPictures& pictures,
                                           std::shared_ptr<const cli::HighParts> high, ModelPicture& picture,
                                           ModelPicture* occlusion, const cli::ModelOcclusion& place) {
    const cli::ModelInput& material = *job.task.model;
    auto low = low_.of_low(job.task, job.read_options, {job.threads(), {}});
    if (!low) return low.error();
    low_.note(job, *low);
    Extent extent = rays_.extent(pictures.largest_own.width > 0 ? pictures.largest_own : rays_.extent());
    if (!rays_.has_extent() && material.map->image >= 0) {
        const auto model = material.read(cli::LastModel::Part::all, job.read_options);
        if (!model) return model.error();
        const auto old = read_map(**model, *material.map, job.read_options);
        if (!old) return old.error();
        extent = old->extent();
    }
    const Meshes meshes{std::move(*low), std::move(high)};
    auto orm = cli::orm_of(material, place, job.read_options);
    if (!orm) return orm.error();
    const Extent of_orm = orm->planes.empty() ? extent : orm->planes.front().extent();
    auto maps = cast(job, meshes, pictures, extent, occlusion != nullptr && of_orm == extent);
    if (!maps) return maps.error();
    if (cli::repeats(*maps, rays_.transfer().subsamples)) {
        job.warn("its UVs repeat the picture, so that no map can be made for it; it stays as it is");
        return false;
    }
    if (auto judged = rays_.judge(job, *maps, guides_.remedy()); !judged) return judged.error();
    job.say(fmt::format("{}: {}\n", cli::printable(job.task.name()), cli::reach_of(*maps)));
    PackOptions with;
    const auto texture = pack_maps(job, *maps, with);
    if (!texture) return texture.error();
    auto bytes =
        encode_file(*texture, job.task.container, output.of(job.task.engine).write_options(job), {job.threads(), {}});
    if (!bytes) return bytes.error().of(job.task.name());
    picture.bytes = std::move(*bytes);
    if (occlusion != nullptr && maps->occlusion.empty()) {
        cli::Job again(job.task, job.console, job.read_options, job.write_options, job.threads(),
                       [&](double, const std::string&) { return job.reached(0.95); });
        auto other = cast(again, meshes, pictures, of_orm, true);
        if (!other) return other.error();
        maps->occlusion = std::move(other->occlusion);
    }
    if (occlusion != nullptr) {
        auto made = cli::occlusion_picture(job, std::move(maps->occlusion), std::move(*orm), occlusion->container);
        if (!made) return made.error().of(job.task.name());
        occlusion->bytes = std::move(*made);
    }
    material.report(job.report);
    cli::report_texture(job, texture->extent(), 1, with, picture.bytes.size(), std::nullopt);
    return true;
}

Result<void> TransferNormals::make_model(cli::Job& job) {
    const cli::ModelOutput& model = *job.task.model_output;
    ModelChanges changes = model.changes(job.task.container);
    const auto high = read_high(job);
    if (!high) return high.error();
    const auto pictures = pictures_.read(job, *high);
    if (!pictures) return pictures.error();
    if (auto noted = cli::note_lacks(job); !noted) return noted;
    const std::size_t count = model.images.size();
    const auto make = [&](cli::Job& one, ModelPicture& picture) {
        const auto k = static_cast<std::size_t>(&picture - changes.pictures.data());
        const bool has_occlusion = !model.occlusion.empty();
        return make_picture(one, **pictures, *high, picture, has_occlusion ? &changes.pictures[count + k] : nullptr,
                            has_occlusion ? model.occlusion[k] : cli::ModelOcclusion{});
    };
    if (auto made = cli::make_pictures(job, changes, make); !made) return made;
    if (changes.pictures.empty()) return Error{ErrorCode::bad_option, job.task.input, "no map can be made for it"};
    auto tangents = cli::tangents_for(job, changes, low_.tangents());
    if (!tangents) return tangents.error();
    changes.tangents = std::move(*tangents);
    if (output.of(job.task.engine).y == YAxis::down)
        repeated_.add(job, job.task.input, "green points down in the output, and viewers of glTF expect up");
    if (auto written = cli::write_model_output(job, changes); !written) return written;
    if (!report_.is_given()) return {};
    return report_.add_model(job, high_.names_of(job.task));
}

Result<void> TransferNormals::process(cli::Job& job) {
    auto made = job.task.model_output ? make_model(job) : make(job);
    if (!made && report_.is_given()) report_.add_failure(job, made.error());
    return made;
}

const cli::Registered<TransferNormals> kRegistered(
    "transfer-normals",
    "Makes the normal map of a low mesh from a high one, by rays, with heights, occlusion and more.");

}  // namespace
