// SPDX-License-Identifier: Apache-2.0
// preview-normals: draws normal maps under a light, also on a mesh, and in false colours.

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "batch/repack.h"
#include "cli/exit_code.h"
#include "cli/usage_error.h"
#include "options/scene.h"
#include "options/sheet.h"
#include "options/tangent_space.h"
#include "tasks/name_pattern.h"

namespace {

using namespace tex;

bool can_show_any(const cli::SheetOptions::Maps& maps) {
    return std::any_of(maps.begin(), maps.end(), [](const auto& map) { return map.has_value(); });
}

class PreviewNormals : public cli::NormalsConverter {
public:
    explicit PreviewNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules{Container::png, Container::png, true, sources()};
        rules.models = mesh_.material();
        return rules;
    }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] Result<void> process(cli::Job& job) override;

    // The mesh and the scale that a material has for its map.
    [[nodiscard]] Result<void> put_on_mesh(cli::Job& job, const cli::ModelInput& model, cli::SampledMap& map) const;
    [[nodiscard]] Result<cli::SampledMap> read(cli::Job& job, std::size_t number, cli::Sampling sampling,
                                               const Execution& execution);
    [[nodiscard]] static Result<void> leave_out(cli::Job& job, const cli::SheetOptions::Maps& maps);

    // The files besides the maps.
    [[nodiscard]] std::vector<std::string> sources() const;

    cli::SceneOptions scene_;
    cli::SheetOptions sheet_;
    cli::TangentSpaceOptions mesh_;
};

PreviewNormals::PreviewNormals(const cli::ProgramRow& row) : NormalsConverter(row) {
    command.usage("MAP... -o PICTURE");
    command.usage("MAP... --out-dir DIR [--name PATTERN]");
    command.input("MAP...",
                  "normal maps, and glTF models with theirs; with -o all go onto one sheet; - is standard input");
    files.add(command, true);
    command
        .choice(output.container, "--container", "TYPE", kContainerNames,
                "the file type, if the output's name does not say it (a pipe)")
        .preset = "by extension; png for -";
    sheet_.add(command, scene_);
    normals.add(command, false, false);
    scene_.add(command);
    mesh_.add_input(command, true);
    normals.warns_of_background = false;
    running.add(command);
    command.example("preview-normals bricks.dds -o bricks.png", "The map under a light from the upper left.");
    command.example("preview-normals *.dds -o sheet.png --show lit,normals,tilt,curl",
                    "A contact sheet, a row for each map.");
    command.example("preview-normals before.dds after.dds -o split.png --split --difference",
                    "Two maps in one picture, and the angles between them.");
    command.example("preview-normals bricks.dds -o sphere.png --shape sphere --detail grain.dds --detail-tiling 8",
                    "On a sphere, with detail blended in.");
    command.example(
        "preview-normals rock_n.dds -o relief.png --show height,curvature,lit --parallax auto --parallax-steps 64",
        "The heights that the normals show, the curvature, and the surface with parallax.");
    command.example("preview-normals rock_n.dds -o look.png --mesh rock.glb --camera 30,20 --show lit,tangents,seams",
                    "On its mesh, with its tangents and the error along its UV seams.");
    command.example("preview-normals model.glb -o look.png", "A model with its own maps, a picture for each material.");
}

std::vector<std::string> PreviewNormals::sources() const {
    std::vector<std::string> names = scene_.files();
    if (!mesh_.has_mesh()) return names;
    for (std::string& name : mesh_.files()) names.push_back(std::move(name));
    return names;
}

Result<void> PreviewNormals::check(const std::vector<cli::Task>& tasks) {
    const cli::MapInputs inputs = cli::MapInputs::of(tasks);
    mesh_.check_models(command, inputs);
    sheet_.check_mesh(mesh_.has_mesh() || !inputs.has_maps);
    const auto idle = command.given_of({"--shape", "--mirror"});
    if (!idle.empty() && (mesh_.has_mesh() || !inputs.model.empty()))
        throw cli::UsageError(idle.front() + (mesh_.has_mesh() ? " has no meaning with --mesh" : " is not for models"));
    for (const cli::Task& task : tasks) {
        cli::OutputOptions::check_holds(task.output, task.container, Encoding::rgb8);
        if (cli::has_level(task.output)) throw cli::UsageError("{level} has no meaning for pictures");
        sheet_.check(task);
        if (mesh_.has_mesh() && task.tile != 0 && !task.joined.empty())
            throw cli::UsageError("each tile of a mesh becomes its own picture: give --out-dir, not -o");
    }
    if (!mesh_.has_mesh()) return {};
    const auto mesh = mesh_.input(0, running.read, {running.threads, {}});  // jobs share it; one error is enough
    return mesh ? Result<void>() : mesh.error();
}

// Reports the maps that a sheet does without. If there are no others, returns the error of the last one.
Result<void> PreviewNormals::leave_out(cli::Job& job, const cli::SheetOptions::Maps& maps) {
    const bool is_empty = !can_show_any(maps);
    for (const Result<cli::SampledMap>& map : maps) {
        if (map) continue;
        if (is_empty && &map == &maps.back()) return map.error();
        job.console.error(map.error().message());
        job.raise(cli::exit_code(map.error().code));
        job.report["failed"].push_back(cli::error_json(map.error(), {}));
    }
    return {};
}

Result<void> PreviewNormals::put_on_mesh(cli::Job& job, const cli::ModelInput& model, cli::SampledMap& map) const {
    auto mesh = mesh_.input(model, job.read_options, {job.threads(), {}});
    if (!mesh) return mesh.error();
    map.mesh = std::make_shared<const cli::OwnMesh>(std::move(*mesh));
    map.scale = static_cast<float>(model.map->scale);
    return {};
}

// Reads one of the maps of the job.
Result<cli::SampledMap> PreviewNormals::read(cli::Job& job, std::size_t number, cli::Sampling sampling,
                                             const Execution& execution) {
    const auto& model = number == 0 ? job.task.model : job.task.joined_models[number - 1];
    if (!model) return cli::read_sampled_map(job, job.task.inputs()[number], normals, sampling, execution);
    if (model->error) return *model->error;
    if (!model->map) return Error{ErrorCode::unsupported, model->file, "no material uses a normal map"};
    cli::SampledMap on_mesh;
    if (auto put = put_on_mesh(job, *model, on_mesh); !put) return put.error();
    sampling.reading.model = model.get();
    if (sampling.reading.object) sampling.from_object = &on_mesh.mesh->mesh;
    auto map = cli::read_sampled_map(job, model->path, normals, sampling, execution);
    if (!map) return map;
    map->mesh = std::move(on_mesh.mesh);
    map->scale = on_mesh.scale;
    return map;
}

Result<void> PreviewNormals::process(cli::Job& job) {
    std::vector<cli::SheetOptions::MapName> names;
    for (const std::string& input : job.task.inputs()) {
        const auto& model = names.empty() ? job.task.model : job.task.joined_models[names.size() - 1];
        names.push_back(model && model->map ? cli::SheetOptions::MapName{model->name(), model->field}
                                            : cli::SheetOptions::MapName{input});
    }
    std::optional<cli::MeshSpace> mesh;
    if (mesh_.has_mesh()) {
        auto read = mesh_.input(job.task.tile, job.read_options, {job.threads(), {}});
        if (!read) return read.error();
        mesh = std::move(*read);
        mesh_.note(job, *mesh);
        job.report["tangents"] = name_of(kTangentSourceNames, mesh->source());
    }
    const PreviewOptions& preview = scene_.preview;
    const bool with_heights = scene_.needs_heights() || (scene_.height.empty() && sheet_.shows(Show::height));
    const bool is_object = mesh_.from == cli::Space::object;
    const cli::Sampling sampling = {{false, false, {}, !sheet_.is_difference(), !is_object, is_object},
                                    preview.wrap_x,
                                    preview.wrap_y,
                                    with_heights,
                                    is_object && mesh ? &*mesh : nullptr};
    cli::SheetOptions::Maps maps;
    for (const auto& name : names) {
        const double share = static_cast<double>(maps.size() + 1) / static_cast<double>(names.size());
        auto map = read(job, maps.size(), sampling, job.until(0.4 * share));
        if (!map && !sheet_.can_leave_out(map.error(), names.size())) return map.error();
        maps.push_back(map ? std::move(map) : map.error().of(name.file));
    }
    if (!can_show_any(maps)) return leave_out(job, maps);
    auto with = scene_.read(job, normals, job.until(0.5));
    if (!with) return with.error();
    const auto space = mesh ? std::optional<TangentSpace>(mesh->space()) : std::nullopt;
    with->mesh = space ? &*space : nullptr;
    const auto frames = sheet_.draw(names, maps, *with, job.until(0.95));
    if (!frames) return frames.error();
    if (const auto left_out = leave_out(job, maps); !left_out) return left_out;
    const Texture& first = frames->front();
    const auto bytes = sheet_.is_animated()
                           ? encode_animation(*frames)
                           : encode_file(first, job.task.container, job.write_options, {job.threads(), {}});
    if (!bytes) return bytes.error().of(job.task.output);
    if (auto written = write_file(job.task.output, *bytes, job.write_options); !written) return written.error();
    job.wrote(job.task.output);
    for (const auto& name : names) job.report["maps"].push_back(name.file);
    if (!sheet_.is_difference()) job.report["show"] = sheet_.names_of_shows();
    job.report["extent"] = {first.extent().width, first.extent().height};
    job.report["frames"] = frames->size();
    job.report["bytes"] = bytes->size();
    return {};
}

const cli::Registered<PreviewNormals> kRegistered(
    "preview-normals",
    "Renders normal maps: lit as a GPU would, or in false colours that show what is wrong with them.");

}  // namespace
