// SPDX-License-Identifier: Apache-2.0

#include "options/roughness.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
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

// The place of a channel in R, G, B, A.
std::size_t place_of(HeightChannel channel) {
    return static_cast<std::size_t>(channel) - static_cast<std::size_t>(HeightChannel::r);
}

bool is_one_of_rgba(HeightChannel channel) {
    return channel == HeightChannel::r || channel == HeightChannel::g || channel == HeightChannel::b ||
           channel == HeightChannel::a;
}

constexpr RoughnessParts kEverywhere = {RoughnessPart::roughness, RoughnessPart::roughness, RoughnessPart::roughness,
                                        RoughnessPart::one};

// 1 leaves occlusion out, and metalness to the material's factor.
constexpr RoughnessParts kGreen = {RoughnessPart::one, RoughnessPart::roughness, RoughnessPart::one,
                                   RoughnessPart::one};
constexpr RoughnessParts kSmoothness = {RoughnessPart::zero, RoughnessPart::one, RoughnessPart::one,
                                        RoughnessPart::smoothness};

// Whether R, G and B are the same: in ASTC, and in pictures of one channel, except EXR, which is read as red.
bool holds_luminance(Format format) {
    const FormatInfo info = format_info(format);
    return info.has_blocks() && info.channels == 4 && format != Format::uastc_4x4_unorm;
}
bool is_grey(Container container, Format format) {
    return format_info(format).channels == 1 && !can_hold_blocks(container) && container != Container::exr;
}

// The channels that differ: UASTC has no alpha here.
int own_channels(Format format) {
    return holds_luminance(format) ? 0 : format == Format::uastc_4x4_unorm ? 3 : format_info(format).channels;
}

// Whether the engine loads KTX2 of Basis Universal alone.
bool reads_basis(const Engine* engine) {
    if (engine == nullptr) return false;
    const bool is_alone = engine->in_ktx2.size() == 1 && engine->in_ktx2.front() == Encoding::uastc;
    return is_alone || std::string_view(engine->name).starts_with("gltf");
}

// The texture into which roughness is written, if it has that channel.
Result<Texture> read_kept(const ChannelFile& file, const ReadOptions& read) {
    Result<Texture> texture = read_texture(file.file, read);
    if (!texture) return texture;
    const std::size_t place = place_of(file.channel);
    if (static_cast<int>(place) < format_info(texture->format).channels) return texture;
    return Error{ErrorCode::bad_data, file.file,
                 fmt::format("has no channel {}, into which --roughness-into writes", "RGBA"[place])};
}

// The map of the material's roughness.
Result<Plane<float>> read_roughness(Job& job, const ChannelFile& file) {
    return read_only_channel(job, file,
                             fmt::format("name the one that holds roughness, such as --roughness-in {}:g, which it is "
                                         "in textures of occlusion, roughness and metalness (ORM)",
                                         shell_file(file.file)));
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
    command
        .option("--roughness-into", "FILE:CHANNEL",
                "write it into this channel (r, g, b, a) of a texture, and keep the others; replaces FILE, or with "
                "--roughness-out makes that",
                [this](const std::string& text) { take_into(text); })
        .completes = Completes::files;
    Option& input =
        command.option("--roughness-in", "FILE|VALUE", "the material's own roughness, FILE[:CHANNEL] or a number",
                       [this](const std::string& text) { take_input(text); });
    input.preset = "0, or what --roughness-into has there";
    input.completes = Completes::files;
    command.choice(model_, "--roughness-model", "M", kRoughnessModelNames, "how lost variance becomes roughness");
    command.choice(format_, "--roughness-format", "F", kRoughnessFormatNames, "how roughness is stored").preset =
        "by file type and --for: bc5 in dds, ktx2; uastc in ktx2 for glTF; astc-4x4 in astc; r16 in tiff; half in exr; "
        "else r8";
    command.check([this, &command] {
        const auto idle = command.given_of({"--roughness-in", "--roughness-model", "--roughness-format"});
        if (command.given(kOption) && output_.empty()) throw UsageError(kOption, "needs a value that is not empty");
        if (output_ == "-") throw UsageError(kOption, "needs a file, not standard output");
        if (!is_given() && !idle.empty())
            throw UsageError(idle.front() + " does nothing without --roughness-out or --roughness-into");
        if (is_in_place() && files_->update) {
            throw UsageError(
                "--update cannot tell whether a file that --roughness-into replaces is up to date: give "
                "--roughness-out, too");
        }
    });
}

void RoughnessOptions::amend(Task& task) const {
    if (!is_given()) return;
    const std::string output = output_of(task);
    task.more_outputs.push_back(output);
    const auto reads = [&](const ChannelFile& file) {
        // Its own texture is read before it is replaced.
        if (!file.file.empty() && !(is_in_place() && file.file == output)) task.own.push_back(file.file);
    };
    if (!into_.file.empty()) reads(expanded(into_, task));
    if (!input_.file.empty()) reads(expanded(input_, task));
}

void RoughnessOptions::take_input(const std::string& text) {
    input_ = {};
    value_.reset();
    const bool is_number = !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string::npos;
    if (is_number) {
        value_ = parse_float(text, {0.0, 1.0});
        return;
    }
    input_ = parse_channel_file(text);
    if (input_.file == "-") throw UsageError("needs a file or a number, not standard input");
    if (NamePattern(input_.file).uses("level")) throw UsageError("{level} has no meaning for an input");
}

void RoughnessOptions::take_into(const std::string& text) {
    into_ = parse_channel_file(text);
    if (!is_one_of_rgba(into_.channel))
        throw UsageError(
            "needs a channel, r, g, b or a: FILE:g for the green of occlusion, roughness, metalness (ORM)");
    if (into_.file == "-") throw UsageError("needs a file, not standard input");
    if (NamePattern(into_.file).uses("level")) throw UsageError("needs one file with all levels, not {level}");
}

ChannelFile RoughnessOptions::expanded(const ChannelFile& pattern, const Task& task) const {
    return {NamePattern(pattern.file).expand(name_fields(task.named())), pattern.channel};
}

ChannelFile RoughnessOptions::input_of(const Task& task) const {
    if (!input_.file.empty() || value_ || into_.file.empty()) return expanded(input_, task);
    return expanded(into_, task);
}

std::string RoughnessOptions::output_of(const Task& task) const {
    if (is_in_place()) return expanded(into_, task).file;
    const std::string path = files_->further(kOption, output_, task);
    if (!NamePattern(output_).uses("format")) return path;
    const auto format = format_in(container_for(path), task);
    if (!format) throw UsageError("--roughness-out: {format} needs --roughness-format beside --roughness-into");
    return files_->further(kOption, output_, task, name_of(kRoughnessFormatNames, *format));
}

RoughnessUse RoughnessOptions::use_of(const Task& task) const {
    return task.engine == nullptr ? RoughnessUse::any : task.engine->roughness.use;
}

RoughnessParts RoughnessOptions::parts_for(const Task& task) const {
    const RoughnessUse use = use_of(task);
    if (into_.file.empty())
        return use == RoughnessUse::green ? kGreen : use == RoughnessUse::smoothness ? kSmoothness : kEverywhere;
    RoughnessParts parts;
    parts.fill(RoughnessPart::kept);
    const bool is_smooth = use == RoughnessUse::smoothness && into_.channel == HeightChannel::a;
    parts[place_of(into_.channel)] = is_smooth ? RoughnessPart::smoothness : RoughnessPart::roughness;
    return parts;
}

std::optional<Format> RoughnessOptions::format_in(Container container, const Task& task) const {
    if (format_) return format_;
    const RoughnessUse use = use_of(task);
    const bool is_basis = container == Container::ktx2 && use != RoughnessUse::smoothness && reads_basis(task.engine);
    if (!into_.file.empty()) {
        const bool is_made = is_basis && !is_in_place() && into_.channel != HeightChannel::a;
        return is_made ? std::optional(Format::uastc_4x4_unorm) : std::nullopt;
    }
    if (is_basis) return Format::uastc_4x4_unorm;
    const Format normals = encoding_info(default_encoding(container)).format;
    if (container == Container::astc) return normals;
    const FormatInfo info = format_info(normals);
    const bool is_for_phones = task.engine != nullptr && task.engine->format == Encoding::eac_rg11;
    if (info.has_blocks()) {
        if (use == RoughnessUse::smoothness) return Format::rgba8_unorm;
        return is_for_phones && container == Container::ktx2 ? Format::eac_rg11_unorm : Format::bc5_unorm;
    }
    // One channel is grey: the same in R, G and B.
    const int channels = use == RoughnessUse::smoothness ? 4 : use == RoughnessUse::green ? 3 : 1;
    return *format_of(info.sample, info.bits, channels);
}

void RoughnessOptions::check_format(const Task& task, const std::string& path, Container container) const {
    if (use_of(task) == RoughnessUse::smoothness && !into_.file.empty() && into_.channel != HeightChannel::a) {
        throw UsageError("--roughness-into",
                         fmt::format("{} reads smoothness from alpha: {}:a", task.engine->name, printable(into_.file)));
    }
    const std::optional<Format> format = format_in(container, task);
    if (!format) return;
    const auto name = name_of(kRoughnessFormatNames, *format);
    if (!can_hold(container, *format)) {
        throw UsageError(printable(path), fmt::format("{} files cannot hold roughness as {}",
                                                      name_of(kContainerNames, container), name));
    }
    const RoughnessUse use = use_of(task);
    const bool is_kept = !into_.file.empty();
    if (!is_kept && use == RoughnessUse::any) return;
    if (!is_kept && use == RoughnessUse::green && (holds_luminance(*format) || is_grey(container, *format))) return;
    const std::size_t needed = is_kept ? place_of(into_.channel) : use == RoughnessUse::green ? 1 : 3;
    if (static_cast<int>(needed) < own_channels(*format)) return;
    throw UsageError(
        printable(path),
        fmt::format("--roughness-format {} has no channel {} of its own, {}", name, "RGBA"[needed],
                    is_kept ? std::string("into which it goes") : fmt::format("which {} reads", task.engine->name)));
}

void RoughnessOptions::check(const std::vector<Task>& tasks, int levels) const {
    if (!is_given()) return;
    for (const Task& task : tasks) {
        if (is_in_place() && !task.origin.empty())
            throw UsageError("--roughness-into", "replaces an input, so a manifest needs --roughness-out, too");
        const std::string path = output_of(task);
        const Container container = container_for(path);
        check_format(task, path, container);
        if (levels == 1 || can_hold_levels(container) || has_level(path)) continue;
        if (task.engine != nullptr && !task.engine->roughness.importer.empty() && !is_in_place()) {
            throw UsageError(
                printable(path),
                fmt::format("{} files hold one level, and the importer of {} makes those of roughness: {}",
                            name_of(kContainerNames, container), task.engine->name, task.engine->roughness.importer));
        }
        throw UsageError(
            printable(path),
            is_in_place() ? fmt::format("{} files hold one level; give --roughness-out a .dds, .ktx2 or .exr, or a "
                                        "name with {{level}}, which then holds what is kept, too",
                                        name_of(kContainerNames, container))
                          : fmt::format("{} files hold one level; --roughness-out takes a .dds, .ktx2 or .exr, which "
                                        "hold all, or a name with {{level}} for a file of each",
                                        name_of(kContainerNames, container)));
    }
}

RoughnessFile RoughnessOptions::file(Job& job, Effort effort) const {
    RoughnessFile file;
    file.output = output_of(job.task);
    file.level_names = level_names(file.output);
    file.container = container_for(file.output);
    file.format = format_in(file.container, job.task);
    file.effort = effort;
    file.model = model_;
    file.own = value_.value_or(0.0f);
    file.parts = parts_for(job.task);
    const bool has_one = file.format && (holds_luminance(*file.format) || format_info(*file.format).channels == 1);
    if (has_one && into_.file.empty()) file.parts = kEverywhere;
    if (!into_.file.empty())
        file.kept = [this, &job] { return read_kept(expanded(into_, job.task), job.read_options); };
    if (input_of(job.task).file.empty()) return file;
    file.map = [this, &job]() -> Result<Plane<float>> {
        const bool is_smooth = input_.file.empty() && parts_for(job.task)[3] == RoughnessPart::smoothness;
        Result<Plane<float>> map = read_roughness(job, input_of(job.task));
        if (!map || !is_smooth) return map;
        for (int j = 0; j < map->extent().height; ++j) {
            for (int i = 0; i < map->extent().width; ++i) map->at(i, j) = 1.0f - map->at(i, j);
        }
        return map;
    };
    return file;
}

void RoughnessOptions::report(Job& job, const PackFileReport& packed) const {
    if (!is_given()) return;
    const std::string path = output_of(job.task), shown = written_name(path);
    const std::vector<std::string> normals = job.outputs();
    if (has_level(job.task.output)) job.report["output"] = normals;
    const int levels = packed.roughness_levels;
    wrote_levels(job, path, levels);
    const std::vector<std::string> written(job.outputs().begin() + static_cast<std::ptrdiff_t>(normals.size()),
                                           job.outputs().end());
    const bool is_known = value_ || !input_.file.empty() || !into_.file.empty();
    if (!is_known) {
        job.warn(fmt::format("without --roughness-in, the material's own roughness is 0, a mirror; {} has nothing else",
                             levels == 1 ? "the only level" : "the base level"),
                 shown);
    }
    if (into_.file.empty() && parts_for(job.task)[3] == RoughnessPart::smoothness) {
        job.warn(fmt::format("red is 0, which {} reads as no metal; --roughness-into FILE:a keeps the red of a texture "
                             "that holds metalness",
                             job.task.engine->name),
                 shown);
    }
    const Engine* const engine = job.task.engine;
    if (engine != nullptr && std::string_view(engine->name).starts_with("gltf") &&
        container_for(path) == Container::ktx2 && packed.roughness_format != Format::uastc_4x4_unorm) {
        job.warn(
            fmt::format("glTF models hold KTX2 of Basis Universal alone, not of {}: this file is for programs that "
                        "load it by itself",
                        name_of(kRoughnessFormatNames, packed.roughness_format)),
            shown);
    }
    if (is_known && levels == 1 && packed.left_out == 0) {
        job.warn("one level loses no variance, so its roughness is the material's own, unchanged", shown);
    }
    Json map;
    if (has_level(path))
        map["output"] = written;
    else
        map["output"] = path;
    const bool is_named = std::any_of(std::begin(kRoughnessFormatNames), std::end(kRoughnessFormatNames),
                                      [&](const auto& row) { return row.value == packed.roughness_format; });
    map["format"] = is_named ? name_of(kRoughnessFormatNames, packed.roughness_format)
                             : name_of(kFormatNames, packed.roughness_format);
    map["model"] = name_of(kRoughnessModelNames, model_);
    map["bytes"] = packed.roughness_bytes;
    job.report["roughness"] = std::move(map);
}

}  // namespace tex::cli
