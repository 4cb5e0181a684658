// SPDX-License-Identifier: Apache-2.0

#include "options/sky.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>
#include <tex/format.h>

#include "cli/usage_error.h"
#include "cli/value.h"
#include "fields/surface_fields.h"
#include "tasks/name_pattern.h"

namespace tex::cli {

namespace {

// The place of the channel in the codes of a texel.
std::size_t place_of(const ChannelFile& file) {
    return static_cast<std::size_t>(file.channel) - static_cast<std::size_t>(HeightChannel::r);
}

// The picture of `file`, which has the channel and the extent.
Result<Texture> picture_for(const ChannelFile& file, Extent wanted, const ReadOptions& read) {
    auto whole = read_texture(file.file, read);
    if (!whole) return whole.error();
    const FormatInfo& format = format_info(whole->format);
    const std::size_t place = place_of(file);
    const auto refused = [&](std::string reason) { return Error{ErrorCode::bad_data, file.file, std::move(reason)}; };
    if (format.has_blocks() || format.sample != SampleKind::unorm || (format.bits != 8 && format.bits != 16))
        return refused("occlusion goes into pictures of 8 or 16 bits alone");
    if (place >= static_cast<std::size_t>(format.channels))
        return refused(fmt::format("has no channel {}, into which --occlusion-into writes", "RGBA"[place]));
    const Extent extent = whole->levels.front().extent;
    if (extent != wanted) {
        return refused(fmt::format("is {}x{} texels, and the occlusion is {}x{}", extent.width, extent.height,
                                   wanted.width, wanted.height));
    }
    return whole;
}

// The picture of `file` with other values, from 0 to 1, in one of its channels. The codes of the other channels stay.
Result<Texture> copy_with(const ChannelFile& file, const Plane<float>& values, const ReadOptions& read) {
    const Extent extent = values.extent();
    const auto whole = picture_for(file, extent, read);
    if (!whole) return whole.error();
    const FormatInfo& format = format_info(whole->format);
    const std::size_t place = place_of(file);
    const auto channels = static_cast<std::size_t>(format.channels);
    Texture copy;
    copy.format = whole->format;
    copy.levels = {whole->levels.front()};
    std::byte* code = copy.levels.front().bytes.data();
    const std::size_t size = format.bits == 8 ? 1 : 2;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i, code += size * channels) {
            const float greatest = size == 1 ? 255.0f : 65535.0f;
            const auto number = static_cast<std::uint16_t>(std::clamp(values.at(i, j), 0.0f, 1.0f) * greatest + 0.5f);
            if (size == 1) {
                code[place] = static_cast<std::byte>(number);
            } else {
                std::memcpy(code + 2 * place, &number, 2);
            }
        }
    }
    return copy;
}

}  // namespace

ChannelFile SkyOptions::into_of(const Task& task) const {
    return {NamePattern(into_.file).expand(name_fields(task.named())), into_.channel};
}

void SkyOptions::add(Command& command, const FileOptions& files) {
    command.group("Occlusion");
    occlusion_
        .add(command, files, "--occlusion-out",
             "write ambient occlusion: 1 is open, 0 closed; of many inputs a pattern as --name")
        .often(2, "write ambient occlusion of the heights");
    command.option(
        "--occlusion-into", "FILE[:CHANNEL]",
        "write it into a copy of FILE, in R or this channel (r, g, b, a), as textures of occlusion, roughness "
        "and metalness (ORM) have it; the copy is the file of --occlusion-out",
        [this](const std::string& text) {
            into_ = parse_channel_file(text);
            if (into_.channel == HeightChannel::automatic) into_.channel = HeightChannel::r;
            if (into_.channel > HeightChannel::a) throw UsageError("is not one of r, g, b, a");
            if (into_.file == "-") throw UsageError("needs a file, not standard input");
        });
    sky_view_.add(command, files, "--sky-view-out", "write the part of the sky above each texel: 1 is all of it");
    bent_.add(command, files, "--bent-out", "write bent normals, the mean directions that are open");
    horizon_.add(command, files, "--horizon-out",
                 "write the sines of horizons, a slice for each direction, one below the other");
    command
        .option("--horizon-directions", "N", "the number of slices",
                [this](const std::string& text) { horizons_ = parse_int(text, 4, 64); })
        .preset = fmt::format("{}", horizons_);
    command
        .option("--occlusion-directions", "N", "measure the horizon in N directions",
                [this](const std::string& text) {
                    options_.directions = parse_int(text, range_of(&OcclusionOptions::directions));
                })
        .preset = fmt::format("{}", options_.directions);
    command
        .option("--occlusion-distance", "TEXELS", "let what hides the sky count less, the farther away it is",
                [this](const std::string& text) {
                    options_.distance = parse_float(text, range_of(&OcclusionOptions::distance));
                })
        .preset = "0: everything counts";
}

void SkyOptions::amend(Task& task) const {
    for (const MapOutput* const map : {&occlusion_, &sky_view_, &bent_, &horizon_}) map->amend(task);
    if (!into_.file.empty()) task.own.push_back(into_of(task).file);
}

bool SkyOptions::is_given() const {
    return occlusion_.is_given() || sky_view_.is_given() || bent_.is_given() || horizon_.is_given();
}

OcclusionOptions SkyOptions::options() const {
    OcclusionOptions options = options_;
    options.occlusion = occlusion_.is_given();
    options.sky_view = sky_view_.is_given();
    options.bent = bent_.is_given();
    options.horizons = horizon_.is_given() ? horizons_ : 0;
    return options;
}

void SkyOptions::apply(BakeFileOptions& options, bool is_extra) const {
    if (is_given() || is_extra) options.occlusion = this->options();
}

void SkyOptions::check(const Command& command, bool is_extra) const {
    if (command.given("--horizon-directions") && !horizon_.is_given())
        throw UsageError("--horizon-directions needs --horizon-out");
    if (!into_.file.empty() && !occlusion_.is_given())
        throw UsageError("--occlusion-into needs --occlusion-out, which names the copy");
    const bool has_light = occlusion_.is_given() || sky_view_.is_given() || bent_.is_given() || is_extra;
    if (command.given("--occlusion-directions") && !has_light)
        throw UsageError(
            "--occlusion-directions needs --occlusion-out, --sky-view-out, --bent-out, or occlusion beside the "
            "normals");
    if (command.given("--occlusion-distance") && !has_light && !horizon_.is_given())
        throw UsageError(
            "--occlusion-distance needs --occlusion-out, --sky-view-out, --bent-out, --horizon-out, or occlusion "
            "beside the normals");
}

Result<void> SkyOptions::accept(const Job& job, const std::function<Result<Extent>()>& extent_of) const {
    if (into_.file.empty()) return {};
    const auto extent = extent_of();
    if (!extent) return extent.error();
    const auto picture = picture_for(into_of(job.task), *extent, job.read_options);
    return picture ? Result<void>() : picture.error();
}

Result<void> SkyOptions::write(Job& job, OcclusionMaps maps, YAxis y, const MipOptions* mips) const {
    if (occlusion_.is_given() && !into_.file.empty()) {
        const auto copy = copy_with(into_of(job.task), maps.occlusion, job.read_options);
        if (!copy) return copy.error();
        Json report;
        if (auto done = occlusion_.write(job, *copy, report); !done) return done;
        job.report["occlusion"] = std::move(report);
    } else if (occlusion_.is_given()) {
        if (auto done = write_plane(job, occlusion_, std::move(maps.occlusion), "occlusion", mips); !done) return done;
    }
    if (sky_view_.is_given()) {
        if (auto done = write_plane(job, sky_view_, std::move(maps.sky_view), "sky_view", mips); !done) return done;
    }
    if (bent_.is_given()) {
        Json report;
        if (auto done = bent_.write(job, std::move(maps.bent), y, report, mips); !done) return done;
        job.report["bent"] = std::move(report);
    }
    return horizon_.is_given() ? write_horizons(job, std::move(maps.horizons)) : Result<void>();
}

// The planes lie one below the other in memory, and become one picture.
Result<void> SkyOptions::write_horizons(Job& job, std::vector<Plane<float>> horizons) const {
    const auto all = std::make_shared<std::vector<Plane<float>>>(std::move(horizons));
    const Extent slice = all->front().extent();
    const Extent extent{slice.width, slice.height * static_cast<int>(all->size())};
    Plane<float> picture(extent, all->front().stride(), std::shared_ptr<float>(all, all->front().row(0)));
    Json report;
    if (auto done = horizon_.write(job, std::move(picture), report); !done) return done;
    report["directions"] = all->size();
    report["extent"] = {extent.width, extent.height};
    job.report["horizons"] = std::move(report);
    return {};
}

// Into report[key].
Result<void> SkyOptions::write_plane(Job& job, const MapOutput& output, Plane<float> values, const char* key,
                                     const MipOptions* mips) {
    Json report;
    if (auto done = output.write(job, std::move(values), report, mips); !done) return done;
    job.report[key] = std::move(report);
    return {};
}

}  // namespace tex::cli
