// SPDX-License-Identifier: Apache-2.0

#include "options/ground.h"

#include <cmath>

#include <fmt/format.h>

#include "cli/text.h"

namespace tex::cli {
namespace {

// Three digits, or all of a whole number of metres.
std::string metres_text(double metres) {
    return metres < 1000.0 ? fmt::format("{:.3g}", metres) : fmt::format("{:.0f}", metres);
}

std::string heights_text(const Ground& ground) {
    constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0, kSame = 1e-9;
    const auto is = [&](double metres) { return std::abs(ground.height_metres - metres) < kSame; };
    if (!ground.has_height_unit) return "heights taken as metres";
    if (is(1.0)) return "heights in metres";
    if (is(kFoot)) return "heights in feet";
    if (is(kSurveyFoot)) return "heights in US survey feet";
    return fmt::format("heights in units of {:.6g} m", ground.height_metres);
}

}  // namespace

std::string texel_text(const Ground& ground, int rows) {
    const double middle = 0.5 * (rows - 1);
    const TexelSize size = texel_size(ground, middle);
    std::string text = fmt::format("{} x {} m a texel", metres_text(size.width), metres_text(size.height));
    if (ground.unit == GroundUnit::metre) return text;
    const double latitude = latitude_of(ground, middle);
    return text + fmt::format(" at {:.1f} {}", std::abs(latitude), latitude < 0.0 ? "south" : "north");
}

void note_ground(Job& job, const HeightReport& heights, const GroundUse& use) {
    if (!heights.ground) {
        if (!heights.ground_remark.empty() && use.instead.empty()) job.warn(heights.ground_remark);
        return;
    }
    const Ground& ground = *heights.ground;
    const double middle = 0.5 * (use.extent.height - 1);
    const TexelSize size = texel_size(ground, middle);
    Json& report = job.report["ground"];
    report = {{"used", use.is_used},
              {"unit", name_of(kGroundUnitNames, ground.unit)},
              {"texel", {size.width, size.height}},
              {"height_metres", ground.height_metres}};
    if (ground.unit != GroundUnit::metre) report["latitude"] = latitude_of(ground, middle);
    if (job.task.output == "-") return;
    const std::string file = printable(job.task.input), texel = texel_text(ground, use.extent.height);
    if (!use.is_used) {
        if (use.instead.empty()) return;
        return job.say(fmt::format("{}: {} is used, not the {} that the file states ({} x {} m in all)\n", file,
                                   use.instead, texel, metres_text(size.width * use.extent.width),
                                   metres_text(size.height * use.extent.height)));
    }
    std::string line = fmt::format("{}: {}, {}", file, texel, heights_text(ground));
    if (use.vertical_scale != 1.0f) line += fmt::format(", {} times as steep", use.vertical_scale);
    if (!heights.ground_remark.empty()) line += "; " + heights.ground_remark;
    if (use.repeats) line += "; without --wrap clamp, heights repeat beyond the border";
    job.say(line + "\n");
}

}  // namespace tex::cli
