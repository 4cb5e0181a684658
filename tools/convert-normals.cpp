// SPDX-License-Identifier: Apache-2.0
// convert-normals: converts normal maps between tangent space and object space, and makes them fit another mesh.

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/tex.h>

#include "batch/model_plan.h"
#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/conversion.h"
#include "options/mips.h"
#include "tasks/model_output.h"
#include "tasks/written_levels.h"

namespace {

using namespace tex;
using cli::Space;

bool holds_z(const Swizzle& swizzle) {
    return std::find(swizzle.begin(), swizzle.end(), Component::z) != swizzle.end();
}

std::string encodings_with_z() {
    std::vector<std::string> names;
    for (const auto& row : kEncodingNames) {
        if (holds_z(encoding_info(row.value).swizzle)) names.emplace_back(row.name);
    }
    return cli::join(names, ", ");
}

// Without --format: block encodings store no z.
Encoding object_encoding(Container container) {
    return can_hold_blocks(container) ? Encoding::rgb8 : default_encoding(container);
}

class ConvertNormals : public cli::NormalsConverter {
public:
    explicit ConvertNormals(const cli::ProgramRow& row);

private:
    [[nodiscard]] const cli::MipChainOptions* mip_chain() const override { return &mips_; }
    [[nodiscard]] cli::OutputRules rules() const override {
        cli::OutputRules rules{{}, Container::dds, false, conversion_.spaces.files(), {}, usual_encoding()};
        rules.models = conversion_.spaces.material();
        rules.writes_models = true;
        rules.conversion = {conversion_.spaces.tangents().value_or(TangentSource::file),
                            conversion_.spaces.changes_models()};
        rules.not_for_models = {"--mesh", "--to-mesh", "--from", "--to"};
        rules.amend = [this](cli::Task& task) { extras.amend(task); };
        return rules;
    }
    [[nodiscard]] Encoding (*usual_encoding() const)(Container) {
        return conversion_.makes_object() ? &object_encoding : &default_encoding;
    }
    [[nodiscard]] Result<void> check(const std::vector<cli::Task>& tasks) override;
    [[nodiscard]] Result<void> process(cli::Job& job) override;
    // What a map is packed from, and how.
    struct Made {
        MipChain chain;
        PackOptions pack_with;
        Extent whole;
    };
    [[nodiscard]] Result<Made> make(cli::Job& job);
    [[nodiscard]] Result<void> make_model(cli::Job& job);
    [[nodiscard]] Result<void> make_picture(cli::Job& job, ModelPicture& picture);
    [[nodiscard]] bool writes_models() const { return cli::writes_models(files); }
    [[nodiscard]] Result<void> apply_scale(cli::Job& job, Source& source) const;
    [[nodiscard]] PackOptions packing(const SourceInfo& input, const cli::Task& task) const;

    cli::ConversionOptions conversion_;
    cli::MipChainOptions mips_;
};

ConvertNormals::ConvertNormals(const cli::ProgramRow& row) : NormalsConverter(row) {
    command.usage("NORMALS... -o FILE --mesh MESH");
    command.usage("NORMALS... --out-dir DIR --mesh MESH");
    command.usage("MODEL... --out-dir DIR");
    command.usage("MODEL -o MODEL");
    command.input("NORMALS...", "normal maps, or glTF models with their maps; - is standard input");
    files.add(command);
    conversion_.add(command);
    normals.add(command, false);
    output.add(command, cli::default_encodings() + "; rgb8 in dds and ktx2 for object space",
               "as in the input; up if the space changes");
    output.add_engines(command);
    extras.add(command, output, &normals);
    mips_.add(command, false, "all in dds and ktx2, else none");
    running.add(command);
    command.example("convert-normals rock_n.png -o rock_obj.exr --mesh rock.glb --to object",
                    "What the map means on the mesh.");
    command.example("convert-normals n.png -o new.png --mesh rock_v1.glb --to-mesh rock_v2.glb",
                    "The tangents changed: makes the map fit again.");
    command.example("convert-normals model.glb --out-dir out --decoder godot",
                    "Every normal map that the materials of a model use, each on its mesh.");
    command.example("convert-normals model.glb -o fixed.glb --tangents mikktspace",
                    "The model with the tangents of MikkTSpace; its maps stay.");
    command.example("convert-normals obj_n.exr -o rock_n.dds --mesh rock.glb --from object --decoder unreal --y down",
                    "A baked object-space map for Unreal.");
    command.example(
        "convert-normals rock_n.png -o rock_ue.png --mesh rock.glb --decoder-in unity-builtin --decoder unreal",
        "From one engine to another.");
    command.check([this] {
        if (conversion_.spaces.from == Space::object && normals.measures_y)
            throw cli::UsageError("--y-in measured needs --from tangent");
        if (!conversion_.makes_object()) return;
        if (!extras.stores_z()) throw cli::UsageError("--blue needs tangent space: object space needs z");
        if (mips_.mip.fade || mips_.mip.domain == MipDomain::slope)
            throw cli::UsageError("--fade and --mip-domain slope need tangent space");
        for (const cli::Engine* const engine : output.engines_or_none()) {
            const auto format = output.of(engine).format;
            if (!format || holds_z(encoding_info(*format).swizzle)) continue;
            throw cli::UsageError(fmt::format("--format {} stores no z, which object space needs; these formats do: {}",
                                              name_of(kEncodingNames, *format), encodings_with_z()));
        }
    });
}

Result<void> ConvertNormals::check(const std::vector<cli::Task>& tasks) {
    if (!writes_models()) {
        conversion_.spaces.check_conversion(command, cli::MapInputs::of(tasks));
    } else if (conversion_.spaces.tangents().value_or(TangentSource::file) == TangentSource::file &&
               !conversion_.spaces.changes_models()) {
        throw cli::UsageError("nothing changes: give --tangents mikktspace or meshopt, --tangents-in or --decoder");
    }
    if (writes_models() && mips_.levels.value_or(1) != 1)
        throw cli::UsageError("--mips", "models hold no levels: engines build them");
    mips_.check(tasks);
    return {};
}

// Object space has no direction of green by itself, so y stays up if the space changes.
PackOptions ConvertNormals::packing(const SourceInfo& input, const cli::Task& task) const {
    cli::OutputOptions own = output.of(task.engine);
    if (conversion_.makes_object()) own.y = output.y;  // engines expect a direction of green in tangent space alone
    const Encoding encoding = own.format.value_or(usual_encoding()(task.container));
    if (conversion_.spaces.from == conversion_.spaces.to)
        return own.pack_options(encoding, input.y_axis, input.y_known);
    return own.pack_options(encoding, YAxis::up, !conversion_.makes_object());
}

// What the material makes of the map becomes a part of the map.
Result<void> ConvertNormals::apply_scale(cli::Job& job, Source& source) const {
    if (!job.task.model || conversion_.spaces.from == Space::object) return {};
    const double by = job.task.model->map->scale;
    if (by == 1.0) return {};
    const ScaleMode mode = conversion_.spaces.ignores_z(true) ? ScaleMode::xy : ScaleMode::slope;
    auto scaled = scale(std::move(source.chain.levels.front()), static_cast<float>(by), mode, {job.threads(), {}});
    if (!scaled) return scaled.error().of(job.task.name());
    source.chain.levels.front() = std::move(*scaled);
    if (!conversion_.makes_object() && !writes_models())
        job.warn(fmt::format("the scale {:.4g} of its material is in the output: set it to 1 there", by));
    return {};
}

Result<ConvertNormals::Made> ConvertNormals::make(cli::Job& job) {
    // In tangent space, a wrong y gives a wrong result, whichever way green points in the output.
    const bool doubt_y = conversion_.spaces.from == Space::tangent;
    const cli::ModelInput* const model = job.task.model.get();
    const bool keep_length = conversion_.spaces.ignores_z(model != nullptr) && !normals.length_in;
    const bool is_object = conversion_.spaces.from == Space::object;
    cli::Reading reading{true, false, {}, keep_length, doubt_y, is_object, model};
    UnpackOptions wanted = normals.options(job).unpack;
    extras.apply(wanted);
    reading.extras = wanted.others;
    reading.holds = [this, &job](const SourceInfo& info) {
        return extras.accounted_for(can_hold(packing(info, job.task).encoding));
    };
    auto source = normals.read(job, job.task.map_path(), job.until(0.2), reading);
    if (!source) return source.error();
    cli::report_input(job, source->info);
    if (is_object && !holds_z(source->info.swizzle))
        return Error{ErrorCode::bad_option, job.task.name(), "stores no z, which object space needs"};
    if (auto scaled = apply_scale(job, *source); !scaled) return scaled.error();
    auto converted = conversion_.convert(job, source->chain.levels.front(), 0.8);
    if (!converted) return converted.error();
    source->chain.levels.clear();
    const PackOptions pack_with = packing(source->info, job.task);
    if (auto put = put_others(converted->map, extras.inputs(job), pack_with.encoding); !put)
        return put.error().of(job.task.name());
    MipOptions mip = mips_.options(mips_.levels_for(job.task), {});
    mip.any_z = conversion_.makes_object();
    extras.apply(mip);
    const Extent whole = converted->map.extent();
    auto chain = build_mip_chain(std::move(converted->map), mip, job.until(0.85));
    if (!chain) return chain.error();
    return Made{std::move(*chain), pack_with, whole};
}

Result<void> ConvertNormals::process(cli::Job& job) {
    if (job.task.model_output) return make_model(job);
    const auto made = make(job);
    if (!made) return made.error();
    const PackOptions& pack_with = made->pack_with;
    auto texture = pack(made->chain, pack_with, job.until(0.95));
    if (!texture) return texture.error();
    std::optional<RdoReport> rdo;
    if (pack_with.rdo.mean > 0.0f) rdo = texture->rdo;
    const Extent extent = texture->extent();
    const auto written = cli::write_levels(job, std::move(*texture), output.of(job.task.engine).write_options(job));
    if (!written) return written.error();
    cli::report_texture(job, extent, written->levels, pack_with, written->bytes, rdo);
    note_output(job, {extent, written->levels, extent != made->whole, pack_with.encoding});
    return {};
}

// The map of one material, whose job this is.
Result<void> ConvertNormals::make_picture(cli::Job& job, ModelPicture& picture) {
    const auto made = make(job);
    if (!made) return made.error();
    const auto texture = pack(made->chain, made->pack_with, job.until(0.95));
    if (!texture) return texture.error();
    auto bytes =
        encode_file(*texture, job.task.container, output.of(job.task.engine).write_options(job), {job.threads(), {}});
    if (!bytes) return bytes.error().of(job.task.name());
    picture.bytes = std::move(*bytes);
    job.task.model->report(job.report);
    cli::report_texture(job, texture->extent(), 1, made->pack_with, picture.bytes.size(), std::nullopt);
    return {};
}

Result<void> ConvertNormals::make_model(cli::Job& job) {
    ModelChanges changes = job.task.model_output->changes(job.task.container);
    auto made = cli::make_pictures(job, changes, [this](cli::Job& one, ModelPicture& picture) -> Result<bool> {
        if (auto converted = make_picture(one, picture); !converted) return converted.error();
        return true;
    });
    if (!made) return made;
    auto tangents = cli::tangents_for(job, changes, conversion_.spaces.tangents().value_or(TangentSource::file));
    if (!tangents) return tangents.error();
    changes.tangents = std::move(*tangents);
    if (output.of(job.task.engine).y == YAxis::down)
        repeated_.add(job, job.task.input, "green points down in the output, and viewers of glTF expect up");
    return cli::write_model_output(job, changes);
}

const cli::Registered<ConvertNormals> kRegistered(
    "convert-normals",
    "Converts normal maps between tangent space and object space, and makes them fit other tangents of a mesh.");

}  // namespace
