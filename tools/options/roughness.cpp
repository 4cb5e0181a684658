// SPDX-License-Identifier: Apache-2.0

#include "options/roughness.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "tasks/engines.h"
#include "tasks/name_pattern.h"
#include "tasks/written_levels.h"

namespace tex::cli {
namespace {

constexpr const char* kOption = "--roughness-out";

// Throws UsageError if the name does not show the container.
Container container_for(const std::string& path) {
    if (const auto container = container_of(path)) return *container;
    throw UsageError(kOption, fmt::format("{}: unsupported output format", printable(path)));
}

}  // namespace

void RoughnessOptions::add(Command& command, const FileOptions& files) {
    files_ = &files;
    command.group("Roughness");
    command
        .output_file(
            output_, kOption,
            "write a roughness map whose levels make up for what the normals lose; of many inputs a pattern as --name")
        .often(4, "write a roughness map that suits the levels");
    Row& input =
        command.option("--roughness-in", "FILE|VALUE", "the material's own roughness, FILE[:CHANNEL] or a number",
                       [this](const std::string& text) { take_input(text); });
    input.preset = "0";
    input.completes = Completes::files;
    command.choice(model_, "--roughness-model", "M", kRoughnessModelNames, "how lost variance becomes roughness");
    command.choice(format_, "--roughness-format", "F", kRoughnessFormatNames, "how roughness is stored").preset =
        "bc4 in dds, ktx2; astc-4x4 in astc; r16 in tiff; half in exr; else r8";
    command.check([this, &command] {
        const auto idle = command.given_of({"--roughness-in", "--roughness-model", "--roughness-format"});
        if (command.given(kOption) && output_.empty()) throw UsageError(kOption, "needs a value that is not empty");
        if (output_ == "-") throw UsageError(kOption, "needs a file, not standard output");
        if (!is_given() && !idle.empty()) throw UsageError(idle.front() + " does nothing without --roughness-out");
    });
}

void RoughnessOptions::amend(Task& task) const {
    if (!is_given()) return;
    task.more_outputs.push_back(output_of(task));
    if (!input_.file.empty()) task.own.push_back(input_of(task).file);
}

void RoughnessOptions::take_input(const std::string& text) {
    input_ = {};
    const bool is_number = !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string::npos;
    if (is_number) {
        value_ = parse_float(text, {0.0, 1.0});
        return;
    }
    input_ = parse_channel_file(text);
    if (input_.file == "-") throw UsageError("needs a file or a number, not standard input");
    if (NamePattern(input_.file).uses("level")) throw UsageError("{level} has no meaning for an input");
}

ChannelFile RoughnessOptions::input_of(const Task& task) const {
    return {NamePattern(input_.file).expand(name_fields(task.named())), input_.channel};
}

std::string RoughnessOptions::output_of(const Task& task) const {
    const std::string path = files_->further(kOption, output_, task);
    if (!NamePattern(output_).uses("format")) return path;
    return files_->further(kOption, output_, task, name_of(kRoughnessFormatNames, format_in(container_for(path))));
}

Format RoughnessOptions::format_in(Container container) const {
    if (format_) return *format_;
    const Format normals = encoding_info(default_encoding(container)).format;
    if (container == Container::astc) return normals;
    const FormatInfo info = format_info(normals);
    return info.has_blocks() ? Format::bc4_unorm : *format_of(info.sample, info.bits, 1);
}

void RoughnessOptions::check(const std::vector<Task>& tasks, int levels) const {
    if (!is_given()) return;
    for (const Task& task : tasks) {
        const std::string path = output_of(task);
        const Container container = container_for(path);
        const auto kind = name_of(kContainerNames, container);
        if (!can_hold(container, format_in(container))) {
            throw UsageError(printable(path), fmt::format("{} files cannot hold roughness as {}", kind,
                                                          name_of(kRoughnessFormatNames, format_in(container))));
        }
        if (levels == 1 || can_hold_levels(container) || has_level(path)) continue;
        throw UsageError(
            printable(path),
            fmt::format("{} files hold one level; --roughness-out needs .dds, .ktx2 or .exr, or {{level}}", kind));
    }
}

RoughnessFile RoughnessOptions::file(Job& job, Effort effort) const {
    RoughnessFile file;
    file.output = output_of(job.task);
    file.level_names = level_names(file.output);
    file.container = container_for(file.output);
    file.format = format_in(file.container);
    file.effort = effort;
    file.model = model_;
    file.own = value_;
    if (input_.file.empty()) return file;
    file.map = [this, &job]() -> Result<Plane<float>> {
        return read_channel(job, input_of(job.task), {job.threads(), {}});
    };
    return file;
}

void RoughnessOptions::report(Job& job, const PackFileReport& packed) const {
    if (!is_given()) return;
    const std::string path = output_of(job.task);
    const std::vector<std::string> normals = job.outputs();
    if (has_level(job.task.output)) job.report["output"] = normals;
    wrote_levels(job, path, packed.levels);
    const std::vector<std::string> written(job.outputs().begin() + static_cast<std::ptrdiff_t>(normals.size()),
                                           job.outputs().end());
    Json map;
    if (has_level(path))
        map["output"] = written;
    else
        map["output"] = path;
    map["format"] = name_of(kRoughnessFormatNames, format_in(container_for(path)));
    map["model"] = name_of(kRoughnessModelNames, model_);
    map["bytes"] = packed.roughness_bytes;
    job.report["roughness"] = std::move(map);
}

}  // namespace tex::cli
