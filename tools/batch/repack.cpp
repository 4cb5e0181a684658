// SPDX-License-Identifier: Apache-2.0

#include "batch/repack.h"

#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <tex/format.h>

#include "tasks/model_output.h"
#include "tasks/written_levels.h"

namespace tex::cli {

ExitCode NormalsConverter::finish(Console& console) {
    normals.warn_of_guesses(console);
    return ExitCode::done;
}

void NormalsConverter::note(Job& job, const StepsReport& done) {
    for (const MapRead& map : done.maps) normals.note(job, map.file, map.info);
}

Result<void> NormalsConverter::accept(const Job& job) const {
    SourceInfo doubtful;
    doubtful.z_doubtful = !normals.swizzle;
    return normals.accept(job, job.task.map_path(), doubtful);
}

void NormalsConverter::add_accept(Step& step, const Job& job) const {
    const auto accept = [this, &job](const SourceInfo& info) { return normals.accept(job, job.task.map_path(), info); };
    if (auto* const pack = std::get_if<PackFileOptions>(&step)) pack->accept = accept;
    if (auto* const blend = std::get_if<BlendFileOptions>(&step)) blend->accept = accept;
}

void PackCommand::add_files(const char* inputs) {
    command.usage("NORMALS... -o FILE");
    command.usage("NORMALS... --out-dir DIR [--name PATTERN]");
    command.input("NORMALS...", inputs);
    files.add(command);
    normals.add(command);
}

Encoding PackCommand::encoding(const SourceInfo&, const Task& task) const { return default_encoding(task.container); }

PackFileOptions PackCommand::all_options(Job& job) const {
    PackFileOptions with = options(job);
    with.source = normals.options(job);
    if (extras.is_added()) extras.apply(with.source.unpack);
    // Lengths that are data do not stay in the codes if they are told to go.
    if (normals.length_in && !with.source.unpack.others.length) with.keep_codes = false;
    with.others = extras.inputs(job);
    if (with.mip) extras.apply(*with.mip);
    const OutputOptions own = output.of(job.task.engine);
    // Otherwise y stays as it is, and neither the output nor the user states it.
    with.source.doubt_y = own.y.has_value() || with.source.unpack.y_axis.has_value();
    with.pack = [this, own, &job](const SourceInfo& info) {
        const Encoding usual = own.keeps_format ? encoding_of(info, job.task) : encoding(info, job.task);
        return own.pack_options(own.format.value_or(usual), info.y_axis, info.y_known);
    };
    with.write = own.write_options(job);
    with.level_names = level_names(job.task.output);
    return with;
}

Result<void> PackCommand::process(Job& job) {
    if (job.task.model_output) return process_model(job);
    PackFileOptions with = all_options(job);
    if (job.task.model) {
        if (auto opened = job.task.model->open(with.source.read); !opened) return opened;
    }
    const std::string& input = job.task.map_path();
    const auto packed = pack_file(input, job.task.output, job.task.container, with, job.until(1.0));
    if (!packed) return packed.error();
    normals.note(job, input, packed->source);
    report_input(job, packed->source);
    wrote_levels(job, job.task.output, packed->levels);
    report_texture(job, packed->extent, packed->levels, packed->pack, packed->bytes, packed->rdo);
    note_output(job, {packed->extent, packed->levels, packed->left_out > 0, packed->pack.encoding});
    report(job, *packed);
    const Encoding before = encoding_of(packed->source, job.task), now = packed->pack.encoding;
    if (packed->source.swizzle == kSwizzleYx && now == Encoding::bc5 && job.task.container == Container::dds)
        repeated_.add(
            job, job.task.input,
            "y comes first, as in ATI2 of old, and x in the output, as in BC5; an engine that expects y first "
            "would exchange them");
    // Nobody chose the encoding, and texels could have stayed in that of the input.
    const auto from = container_of(input);
    const bool is_from_texture = format_info(packed->source.format).has_blocks() || (from && can_hold_blocks(*from));
    if (!output.of(job.task.engine).format && is_from_texture && now == default_encoding(job.task.container) &&
        before != now) {
        repeated_.add(job, job.task.input,
                      fmt::format("{} becomes {}, the default; --format keep keeps it", name_of(kEncodingNames, before),
                                  name_of(kEncodingNames, now)));
    }
    // Nobody chose the file type: it is that of the input.
    if (job.task.container == Container::jpeg &&
        command.given_of({"--output", "--name", "--container", "--quality"}).empty())
        repeated_.add(job, job.task.input, "JPEG is lossy, so that normals change; --container png keeps every code");
    return {};
}

// Packs the image of some maps of a model into memory.
Result<void> PackCommand::pack_image(Job& job, const std::vector<std::shared_ptr<const ModelInput>>& maps,
                                     const Execution& execution, ModelPicture& picture) {
    const ModelInput& first = *maps.front();
    PackFileOptions with = all_options(job);
    const auto bytes = std::make_shared<std::vector<std::byte>>();
    with.write.into = bytes;
    // Viewers build no levels of compressed textures.
    if (job.task.container == Container::ktx2 && !with.mip) with.mip.emplace().max_side = with.max_side;
    if (auto opened = first.open(with.source.read); !opened) return opened;
    const auto packed = pack_file(first.path, first.name(), job.task.container, with, execution);
    if (!packed) return packed.error();
    normals.note(job, first.path, packed->source);
    note_output(job, {packed->extent, packed->levels, packed->left_out > 0, packed->pack.encoding}, first.path);
    if (job.task.container == Container::ktx2 && (packed->extent.width % 4 != 0 || packed->extent.height % 4 != 0))
        repeated_.add(job, first.path,
                      "KHR_texture_basisu requires sides that are multiples of 4, and viewers may refuse this");
    picture.bytes = std::move(*bytes);
    for (const auto& map : maps) {
        Json line;
        map->report(line);
        line["extent"] = {packed->extent.width, packed->extent.height};
        line["format"] = name_of(kEncodingNames, packed->pack.encoding);
        line["y"] = nullptr;
        if (packed->pack.y_known) line["y"] = name_of(kYAxisNames, packed->pack.y_axis);
        line["bytes"] = packed->bytes;
        job.report["maps"].push_back(std::move(line));
    }
    return {};
}

Result<void> PackCommand::process_model(Job& job) {
    const ModelOutput& model = *job.task.model_output;
    ModelChanges changes = model.changes(job.task.container);
    std::vector<ModelPicture>& pictures = changes.pictures;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        const double done = 0.95 * static_cast<double>(k + 1) / static_cast<double>(pictures.size());
        if (auto packed = pack_image(job, model.images[k], job.until(done), pictures[k]); !packed) return packed;
    }
    if (job.task.container == Container::jpeg)
        repeated_.add(job, job.task.input, "JPEG is lossy, so that normals change; PNG keeps every code");
    if (output.of(job.task.engine).y == YAxis::down)
        repeated_.add(job, job.task.input, "green points down in the output, and viewers of glTF expect up");
    if (!job.reached(0.95)) return Error{ErrorCode::cancelled, {}, "cancelled"};
    if (auto written = write_model_output(job, changes); !written) return written;
    std::ignore = job.reached(1.0);
    return {};
}

}  // namespace tex::cli
