// SPDX-License-Identifier: Apache-2.0
// surface.h: the option groups of commands that make surfaces from normal maps.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/surface.h>

#include "cli/command.h"
#include "options/heights.h"
#include "options/maps.h"
#include "options/mips.h"
#include "tasks/job.h"

namespace tex::cli {

// What suits the precision of the source: the least z with a slope that means anything, and the least response.
[[nodiscard]] IntegrateOptions integrate_options_for(const SourceInfo& info);

// The formats of heights, with the names that --format accepts.
inline constexpr Named<Format> kHeightFormatNames[] = {
    {Format::r8_unorm, "r8", "8 bits"},
    {Format::r16_unorm, "r16", "16 bits"},
    {Format::r16_float, "half", "16-bit floats"},
    {Format::r32_float, "float", "32-bit floats"},
};

// --heights, --format: which heights are stored, and how.
class StoredHeights {
public:
    std::optional<Format> format;

    void add(Command& command);

    // The format in this container. Throws UsageError if the container cannot hold it.
    [[nodiscard]] Format format_in(const Task& task) const;

    // What becomes 0 and 1 in the file.
    struct Span {
        float low = 0.0f;
        float high = 1.0f;
    };
    [[nodiscard]] Span span_of(const std::vector<Integration>& levels, Format in) const;

private:
    void parse(const std::string& text);

    enum class Choice { automatic, fit, raw, span };
    Choice choice_ = Choice::automatic;
    Span span_;
};

// --curvature-out, --curvature, --curvature-range, --curl-out, --curl-max: maps beside the heights.
class SurfaceMaps {
public:
    void add(Command& command, const FileOptions& files);
    void amend(Task& task) const;

    // Write what the user wants, up to this fraction of the job, and add it to the job's report.
    [[nodiscard]] Result<void> write_curvature(Job& job, const NormalMap& map, const WrapOptions& wrap, double until);
    [[nodiscard]] Result<void> write_curl(Job& job, Integration& heights, double until);

private:
    MapOutput curvature_, curl_;
    CurvatureKind kind_ = CurvatureKind::mean;
    std::optional<double> curvature_range_, curl_max_;
};

}  // namespace tex::cli
