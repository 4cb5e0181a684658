// SPDX-License-Identifier: Apache-2.0

#include "options/sky.h"

#include <utility>

#include <fmt/format.h>

#include "cli/usage_error.h"
#include "cli/value.h"
#include "fields/surface_fields.h"

namespace tex::cli {

void SkyOptions::add(Command& command, const FileOptions& files) {
    command.group("Occlusion");
    occlusion_
        .add(command, files, "--occlusion-out",
             "write ambient occlusion: 1 is open, 0 closed; of many inputs a pattern as --name")
        .often(2, "write ambient occlusion of the heights");
    sky_view_.add(command, files, "--sky-view-out", "write the part of the sky above each texel: 1 is all of it");
    bent_.add(command, files, "--bent-out", "write bent normals, the mean directions that are open");
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
    for (const MapOutput* const map : {&occlusion_, &sky_view_, &bent_}) map->amend(task);
}

bool SkyOptions::is_given() const { return occlusion_.is_given() || sky_view_.is_given() || bent_.is_given(); }

void SkyOptions::apply(BakeFileOptions& options, bool is_extra) const {
    if (!is_given() && !is_extra) return;
    options.occlusion = options_;
    options.occlusion->occlusion = occlusion_.is_given();
    options.occlusion->sky_view = sky_view_.is_given();
    options.occlusion->bent = bent_.is_given();
}

void SkyOptions::check(const Command& command, bool is_extra) const {
    const auto idle = command.given_of({"--occlusion-directions", "--occlusion-distance"});
    if (!idle.empty() && !is_given() && !is_extra)
        throw UsageError(idle.front() +
                         " needs --occlusion-out, --sky-view-out, --bent-out, or occlusion beside the normals");
}

Result<void> SkyOptions::write(Job& job, OcclusionMaps maps, YAxis y) const {
    if (occlusion_.is_given()) {
        if (auto done = write_plane(job, occlusion_, std::move(maps.occlusion), "occlusion"); !done) return done;
    }
    if (sky_view_.is_given()) {
        if (auto done = write_plane(job, sky_view_, std::move(maps.sky_view), "sky_view"); !done) return done;
    }
    if (!bent_.is_given()) return {};
    Json report;
    if (auto done = bent_.write(job, std::move(maps.bent), y, report); !done) return done;
    job.report["bent"] = std::move(report);
    return {};
}

// Into report[key].
Result<void> SkyOptions::write_plane(Job& job, const MapOutput& output, Plane<float> values, const char* key) {
    Json report;
    if (auto done = output.write(job, std::move(values), report); !done) return done;
    job.report[key] = std::move(report);
    return {};
}

}  // namespace tex::cli
