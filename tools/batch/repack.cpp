// SPDX-License-Identifier: Apache-2.0

#include "batch/repack.h"

#include <string>
#include <utility>

#include "batch/name_pattern.h"

namespace tex::cli {

Result<void> repack(Job& job, SourceOptions& source, const OutputOptions& output, PackFileOptions options,
                    const EncodingOf& encoding, const std::function<void(const PackFileReport&)>& also_tell) {
    options.source = source.options(job);
    options.pack = [&](const SourceInfo& info) {
        return output.pack_options(output.format ? *output.format : encoding(info), output.y.value_or(info.y_axis));
    };
    options.write = output.write_options(job);
    options.level_names = level_names(job.task.output);
    const auto packed = pack_file(job.task.input, job.task.output, job.task.container, options, job.until(1.0));
    if (!packed) return packed.error();
    source.note(job, job.task.input, packed->source);
    report_source(job, packed->source);
    wrote_levels(job, job.task.output, packed->levels);
    report_texture(job, packed->extent, packed->levels, packed->pack, packed->bytes);
    if (also_tell) also_tell(*packed);
    return {};
}

LevelNames level_names(const std::string& name) {
    if (!has_level(name)) return {};
    return [name](int level) { return with_level(name, level); };
}

void wrote_levels(Job& job, const std::string& name, int levels) {
    for (int k = 0; k < (has_level(name) ? levels : 1); ++k) job.wrote(with_level(name, k));
}

}  // namespace tex::cli
