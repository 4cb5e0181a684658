// SPDX-License-Identifier: Apache-2.0

#include "options/maps.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/preview.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "tasks/name_pattern.h"

namespace tex::cli {

Format map_format(Container container) {
    for (const Format format : {Format::r16_unorm, Format::r32_float}) {
        if (can_hold(container, format)) return format;
    }
    return Format::r8_unorm;
}

namespace {

// Levels of values as those of data beside normals, which are flat here.
Result<RoughnessChain> averages(Plane<float> values, const MipOptions& mips, const Execution& execution) {
    const Extent extent = values.extent();
    NormalMap base(extent);
    for (int j = 0; j < extent.height; ++j) {
        std::fill_n(base.x.row(j), extent.width, 0.0f);
        std::fill_n(base.y.row(j), extent.width, 0.0f);
        std::fill_n(base.z.row(j), extent.width, 1.0f);
    }
    base.alpha = std::move(values);
    auto chain = build_mip_chain(std::move(base), mips, execution);
    if (!chain) return chain.error();
    RoughnessChain levels;
    for (NormalMap& level : chain->levels) levels.levels.push_back(std::move(level.alpha));
    return levels;
}

}  // namespace

Option& MapOutput::add(Command& command, const FileOptions& files, std::string name, std::string help) {
    files_ = &files;
    name_ = std::move(name);
    Option& row = command.output_file(pattern_, name_, std::move(help));
    command.check([this, &command] {
        if (command.given(name_) && pattern_.empty()) throw UsageError(name_ + ": needs a value that is not empty");
        if (pattern_ == "-") throw UsageError(name_ + ": needs a file, not standard output");
        if (is_given() && (NamePattern(pattern_).uses("level") || NamePattern(pattern_).uses("format")))
            throw UsageError(name_ + ": {level} and {format} have no meaning here");
    });
    return row;
}

std::string MapOutput::path_of(const Task& task) const {
    return with_tile(files_->further(name_, pattern_, task), task.tile);
}

Container MapOutput::container_of_path(const std::string& path) const {
    const auto container = container_of(path);
    if (!container) throw UsageError(name_, fmt::format("{}: unsupported output format", printable(path)));
    if (can_hold(*container, map_format(*container))) return *container;
    throw UsageError(name_, fmt::format("{}: {} files cannot hold such a map", printable(path),
                                        name_of(kContainerNames, *container)));
}

void MapOutput::amend(Task& task) const {
    if (!is_given()) return;
    if (task.is_tile_of_mesh() && !has_tile(pattern_))
        throw UsageError(name_, fmt::format("{}: needs <UDIM>, as the output has it: each tile has its own file",
                                            printable(pattern_)));
    if (task.tile == 0 && has_tile(pattern_) && !has_tile(task.output))
        throw UsageError(name_, fmt::format("{}: <UDIM> needs it in the name of the output, too", printable(pattern_)));
    std::string path = path_of(task);
    std::ignore = container_of_path(path);
    task.more_outputs.push_back(std::move(path));
}

bool MapOutput::holds_floats(const Job& job) const {
    return map_format(container_of_path(path_of(job.task))) == Format::r32_float;
}

Result<void> MapOutput::write(Job& job, const Texture& texture, Json& report) const {
    const std::string path = path_of(job.task);
    const auto bytes = encode_file(texture, container_of_path(path), job.write_options, {job.threads(), {}});
    if (!bytes) return bytes.error().of(path);
    if (auto written = write_file(path, *bytes, job.write_options); !written) return written;
    job.wrote(path);
    report["output"] = path;
    return {};
}

Result<void> MapOutput::write(Job& job, Plane<float> values, Json& report, const MipOptions* mips) const {
    const Container container = container_of_path(path_of(job.task));
    RoughnessChain chain;
    if (mips != nullptr && can_hold_blocks(container)) {
        auto levels = averages(std::move(values), *mips, {job.threads(), {}});
        if (!levels) return levels.error();
        chain = std::move(*levels);
    } else {
        chain.levels.push_back(std::move(values));
    }
    const auto texture = pack_roughness(chain, map_format(container), Effort::normal, {job.threads(), {}});
    if (!texture) return texture.error();
    if (mips != nullptr) report["levels"] = chain.levels.size();
    return write(job, *texture, report);
}

Result<void> MapOutput::write(Job& job, NormalMap normals, YAxis y, Json& report, const MipOptions* mips) const {
    const Container container = container_of_path(path_of(job.task));
    MipChain chain;
    if (mips != nullptr && can_hold_blocks(container)) {
        auto levels = build_mip_chain(std::move(normals), *mips, {job.threads(), {}});
        if (!levels) return levels.error();
        chain = std::move(*levels);
    } else {
        chain.levels.push_back(std::move(normals));
    }
    if (mips != nullptr) report["levels"] = chain.levels.size();
    PackOptions with;
    with.encoding = can_hold_blocks(container) ? Encoding::rgb8 : default_encoding(container);
    with.y_axis = y;
    const auto texture = pack(chain, with, {job.threads(), {}});
    if (!texture) return texture.error();
    return write(job, *texture, report);
}

Result<void> MapOutput::write(Job& job, const Image& colors, Json& report) const {
    const auto texture = picture_of(colors);
    if (!texture) return texture.error();
    return write(job, *texture, report);
}

}  // namespace tex::cli
