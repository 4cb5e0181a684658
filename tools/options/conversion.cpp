// SPDX-License-Identifier: Apache-2.0

#include "options/conversion.h"

#include <fmt/format.h>

#include "cli/value.h"
#include "fields/mesh_fields.h"

namespace tex::cli {

void ConversionOptions::add(Command& command) {
    spaces.add(command);
    command.group("Conversion");
    Option& padding = command.option("--padding", "N", "texels to fill around each chart: a number, or the word",
                                     [this](const std::string& text) {
                                         convert_.padding = text == "all" ? kPadAll : parse_int(text, 0, kMaxExtent);
                                     });
    padding.words = {{"all", "the whole map"}};
    padding.completes = Completes::words;
    padding.preset = "all";
    command
        .option("--subsamples", "N", "divide each texel into N by N squares and average their vectors",
                [this](const std::string& text) {
                    convert_.subsamples = parse_int(text, range_of(&ConvertOptions::subsamples));
                })
        .preset = "1";
    command.choice(overlap_, "--overlap", "O", kOverlapNames, "what happens if triangles share texels");
}

Result<ConvertedMap> ConversionOptions::convert(Job& job, const NormalMap& map, double until) const {
    const ModelInput* const model = job.task.model.get();
    const Execution silent{job.threads(), {}};
    const auto from = model != nullptr ? spaces.input(*model, job.read_options, silent)
                                       : spaces.input(job.task.tile, job.read_options, silent);
    if (!from) return from.error();
    const auto to = model != nullptr ? spaces.output(*model, job.read_options, silent)
                                     : spaces.output(job.task.tile, job.read_options, silent);
    if (!to) return to.error();
    spaces.note(job, *from);
    if (to->file() != from->file()) spaces.note(job, *to);
    const Execution execution = job.until(until);
    const bool both = spaces.from == Space::tangent && !makes_object();
    auto converted = both             ? refit(map, from->space(), to->space(), convert_, execution)
                     : makes_object() ? to_object_space(map, from->space(), convert_, execution)
                                      : to_tangent_space(map, to->space(), convert_, execution);
    if (!converted) return converted;
    job.report["tangents"] = name_of(kTangentSourceNames, (makes_object() ? from : to)->source());
    if (const auto judged = judge(job, *converted, to->file()); !judged) return judged.error();
    return converted;
}

// Reports what was converted, and what could not be converted well.
Result<void> ConversionOptions::judge(Job& job, const ConvertedMap& converted, const std::string& mesh) const {
    job.report["covered"] = converted.covered;
    job.report["overlaps"] = converted.overlaps;
    job.report["moved"] = converted.moved;
    job.report["backward"] = converted.backward;
    const std::string overlaps = fmt::format("UVs overlap in {} places", converted.overlaps);
    if (converted.overlaps > 0 && overlap_ == Overlap::error) return Error{ErrorCode::bad_option, mesh, overlaps};
    if (converted.overlaps > 0) job.warn(overlaps + "; the triangle that comes first in the mesh decides there", mesh);
    if (converted.unmatched > 0) {
        job.warn(fmt::format("covers {} texels that the mesh of the input does not cover: their UVs differ",
                             converted.unmatched),
                 mesh);
    }
    if (converted.singular > 0) {
        job.warn(fmt::format("{} texels have no tangent space, because tangents are missing or parallel to normals; "
                             "they become flat",
                             converted.singular),
                 mesh);
    }
    if (converted.backward > 0) {
        job.warn(
            fmt::format("{} texels point into the surface: z is negative, which shaders that rebuild z lose; if "
                        "these are many, the vectors may be those of another mesh, or of other axes: some "
                        "programs have z up",
                        converted.backward));
    }
    return {};
}

}  // namespace tex::cli
