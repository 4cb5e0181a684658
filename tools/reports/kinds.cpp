// SPDX-License-Identifier: Apache-2.0

#include "reports/kinds.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string_view>

#include <fmt/format.h>
#include <tex/format.h>

#include "cli/text.h"
#include "reports/findings.h"

namespace tex::cli {
namespace {

constexpr std::string_view kNothing = "-";

bool holds_normals(const CheckReport& report) {
    return report.kind == PictureKind::normals || report.kind == PictureKind::object_space;
}

}  // namespace

std::string swizzle_word(const Swizzle& swizzle) {
    std::string word = layout_name(swizzle);
    if (word != to_string(swizzle)) return word;
    std::string channels;
    for (const Component component : {Component::x, Component::y, Component::z}) {
        const auto place = std::find(swizzle.begin(), swizzle.end(), component);
        const auto at = static_cast<std::size_t>(place - swizzle.begin());
        if (at < swizzle.size())
            channels += "rgba"[at];
        else if (component != Component::z)
            return word;
    }
    return channels;
}

std::string kind_text(const CheckReport& report) {
    const bool has_normals = holds_normals(report);
    const std::string layout = has_normals           ? swizzle_word(report.swizzle)
                               : report.height_bytes ? std::string(name_of(kHeightChannelNames, *report.height_bytes))
                                                     : std::string(kNothing);
    const std::string_view y = has_normals && report.y.y ? name_of(kYAxisNames, *report.y.y) : kNothing;
    const std::string confidence =
        report.kind == PictureKind::unknown ? std::string(kNothing) : fmt::format("{:.2f}", report.kind_confidence);
    const std::string format = report.error ? std::string(kNothing) : std::string(name_of(kFormatNames, report.format));
    const std::string extent =
        report.error ? std::string(kNothing) : fmt::format("{}x{}", report.extent.width, report.extent.height);
    const std::string levels = report.error ? std::string(kNothing) : std::to_string(report.levels);
    const std::string why = report.error ? ": " + report.error->reason : std::string();
    return fmt::format("{:<12}  {:<7}  {:<4}  {:<4}  {:<10}  {:<9}  {:>2}  {}{}\n",
                       name_of(kPictureKindNames, report.kind), layout, y, confidence, format, extent, levels,
                       printable(title_of(report)), printable(why));
}

void KindTotals::add(const CheckReport& report) {
    ++of[static_cast<std::size_t>(report.kind)];
    if (!holds_normals(report) || !report.y.y) return;
    ++(*report.y.y == YAxis::up ? up : down);
}

std::string KindTotals::text() const {
    const int files = std::accumulate(of.begin(), of.end(), 0);
    std::string text = fmt::format("{} file{}", files, files == 1 ? "" : "s");
    std::string_view before = ": ";
    for (const Named<PictureKind>& row : kPictureKindNames) {
        const int count = of[static_cast<std::size_t>(row.value)];
        if (count == 0) continue;
        text += fmt::format("{}{} {}", before, count, row.name);
        if (row.value == PictureKind::normals)
            text += fmt::format(" (green up in {}, down, or red left, in {})", up, down);
        before = ", ";
    }
    return text;
}

}  // namespace tex::cli
