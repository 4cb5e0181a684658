// SPDX-License-Identifier: Apache-2.0

#include "options/surface.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tex/check.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "options/output.h"

namespace tex::cli {
namespace {

bool holds_floats(Format format) { return format_info(format).sample == SampleKind::floating; }

}  // namespace

IntegrateOptions integrate_options_for(const SourceInfo& info) {
    IntegrateOptions options;
    const FormatInfo format = format_info(info.format);
    if (format.sample == SampleKind::floating) return options;
    options.least_z = format.bits == 16 ? 0x1p-15f : 0x1p-7f;
    if (format.bits != 16) options.least_response = 0.1f;
    return options;
}

void StoredHeights::add(Command& command) {
    command.group("Heights");
    Option& row = command.option("--heights", "fit|raw|LOW,HIGH", "which heights become 0 and 1 in the file",
                                 [this](const std::string& text) { parse(text); });
    row.words = {{"fit", "the lowest and the highest of each map"},
                 {"raw", "the lowest becomes 0; the strength alone sets the rest"}};
    row.completes = Completes::words;
    row.preset = "fit for integers, raw for floats";
    command.choice(format, "--format", "F", kHeightFormatNames, "how heights are stored")
        .often(3, "how heights are stored: r16, r8, float ...")
        .preset = "float in exr; r8 in tga, bmp, jpeg, webp; else r16";
}

void StoredHeights::parse(const std::string& text) {
    if (text == "fit" || text == "raw") {
        choice_ = text == "fit" ? Choice::fit : Choice::raw;
        return;
    }
    const auto [low, high] = cut(text, ',');
    if (text.find(',') == std::string::npos) throw UsageError("needs fit, raw or LOW,HIGH");
    span_ = {parse_float(low), parse_float(high)};
    if (!(span_.low < span_.high)) throw UsageError("LOW must be less than HIGH");
    choice_ = Choice::span;
}

Format StoredHeights::format_in(const Task& task) const {
    const Format chosen = format.value_or(map_format(task.container));
    if (can_hold(task.container, chosen)) return chosen;
    throw UsageError(printable(task.output),
                     fmt::format("{} files cannot hold heights as {}", name_of(kContainerNames, task.container),
                                 name_of(kHeightFormatNames, chosen)));
}

StoredHeights::Span StoredHeights::span_of(const std::vector<Integration>& levels, Format in) const {
    if (choice_ == Choice::span) return span_;
    const bool fits = choice_ == Choice::fit || (choice_ == Choice::automatic && !holds_floats(in));
    if (!fits) return {};
    float highest = 0.0f;
    for (const Integration& level : levels) highest = std::max(highest, level.highest);
    return {0.0f, highest};
}

void SurfaceMaps::add(Command& command, const FileOptions& files) {
    command.group("Maps of the surface");
    curvature_
        .add(command, files, "--curvature-out",
             "write the curvature, around 0.5 or as floats; of many inputs a pattern as --name")
        .often(2, "write the curvature of the surface");
    command.choice(kind_, "--curvature", "KIND", kCurvatureKindNames, "which curvature");
    command
        .option("--curvature-range", "C", "the curvature, in 1/texel, that becomes white in pictures",
                [this](const std::string& text) { curvature_range_ = parse_double(text, kPositive); })
        .preset = "3 times the root mean square";
    curl_.add(command, files, "--curl-out",
              "write the angle between the map and the bake of the heights: degrees as floats, or a heat map");
    command
        .option("--curl-max", "DEG", "the angle at the end of the heat map's legend",
                [this](const std::string& text) {
                    curl_max_ = parse_double(text, {0.0, 180.0, false});
                })
        .preset = "the largest";
    command.check([this, &command] {
        const auto curvature = command.given_of({"--curvature", "--curvature-range"});
        if (!curvature_.is_given() && !curvature.empty())
            throw UsageError(curvature.front() + " does nothing without --curvature-out");
        if (!curl_.is_given() && curl_max_) throw UsageError("--curl-max does nothing without --curl-out");
    });
}

void SurfaceMaps::amend(Task& task) const {
    curvature_.amend(task);
    curl_.amend(task);
}

Result<void> SurfaceMaps::write_curvature(Job& job, const NormalMap& map, const WrapOptions& wrap, double until) {
    if (!curvature_.is_given()) return {};
    auto bend = curvature(map, {kind_, wrap.x, wrap.y}, job.until(until));
    if (!bend) return bend.error();
    Json report = {{"kind", name_of(kCurvatureKindNames, kind_)}, {"values", {bend->least, bend->greatest}}};
    if (!curvature_.holds_floats(job)) {
        const auto white = static_cast<float>(curvature_range_.value_or(3.0 * bend->rms));
        // A flat map has no range, and is grey.
        const float shown = white > 0.0f ? white : 1.0f;
        stretch_heights(bend->values, -shown, shown, {job.threads(), {}});
        report["range"] = shown;
    }
    if (auto written = curvature_.write(job, std::move(bend->values), report); !written) return written;
    job.report["curvature"] = std::move(report);
    return {};
}

Result<void> SurfaceMaps::write_curl(Job& job, Integration& heights, double until) {
    const AngularError& error = heights.curl;
    Json report = {{"mean", error.mean}, {"p99", error.p99}, {"max", error.max}};
    if (curl_.is_given()) {
        if (curl_.holds_floats(job)) {
            if (auto written = curl_.write(job, std::move(heights.degrees), report); !written) return written;
        } else {
            const double end = curl_max_.value_or(std::clamp(error.max, 0.01, 180.0));
            const auto colors = heat_map(heights.degrees, end, job.until(until));
            if (!colors) return colors.error();
            if (auto written = curl_.write(job, *colors, report); !written) return written;
        }
    }
    job.report["curl"] = std::move(report);
    return {};
}

}  // namespace tex::cli
