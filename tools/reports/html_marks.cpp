// SPDX-License-Identifier: Apache-2.0

#include "reports/html_marks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>

#include "reports/html.h"

namespace tex::cli {
namespace {

constexpr std::string_view kFigure = "<figure class=\"marks\">";

// Orange and blue differ to all eyes, and what was left out has stripes, too.
using Pixel = std::array<std::uint8_t, 4>;
constexpr Pixel kSpoke = {255, 138, 0, 255}, kLeftOut = {64, 140, 255, 235}, kStripe = {10, 40, 110, 200}, kNone = {};
constexpr int kStripes = 6;  // pixels from one to the next

Pixel pixel_of(Mark mark, int i, int j) {
    if (mark == Mark::none) return kNone;
    if (mark == Mark::spoke) return kSpoke;
    return (i + j) % kStripes < kStripes / 2 ? kLeftOut : kStripe;
}

Texture marks_picture(const Marks& marks) {
    Texture picture;
    picture.format = Format::rgba8_unorm;
    picture.levels.emplace_back();
    Level& level = picture.levels.front();
    level.extent = marks.extent;
    level.bytes.reserve(4 * marks.squares.size());
    for (std::size_t k = 0; k < marks.squares.size(); ++k) {
        const auto width = static_cast<std::size_t>(marks.extent.width);
        for (const std::uint8_t value :
             pixel_of(marks.squares[k], static_cast<int>(k % width), static_cast<int>(k / width)))
            level.bytes.push_back(static_cast<std::byte>(value));
    }
    return picture;
}

std::string percent(const Marks& marks, Mark mark) {
    std::int64_t all = 0;
    for (const std::int64_t count : marks.texels) all += count;
    const double share = 100.0 * static_cast<double>(marks.count(mark)) / static_cast<double>(all);
    return share > 0.0 && share < 0.01 ? "less than 0.01 %" : fmt::format("{:.{}f} %", share, share < 1.0 ? 2 : 0);
}

// The rows and columns that hold all texels that spoke.
std::string place_of(const Marks& marks) {
    int left = marks.extent.width, right = -1, top = -1, bottom = -1;
    for (std::size_t k = 0; k < marks.squares.size(); ++k) {
        if (marks.squares[k] != Mark::spoke) continue;
        const int i = static_cast<int>(k) % marks.extent.width;
        left = std::min(left, i);
        right = std::max(right, i);
        bottom = static_cast<int>(k) / marks.extent.width;
        if (top < 0) top = bottom;
    }
    return fmt::format("in columns {} to {}, rows {} to {}", left * marks.side, (right + 1) * marks.side - 1,
                       top * marks.side, (bottom + 1) * marks.side - 1);
}

// What the colours mean, and how many texels have them.
std::string legend_of(const Finding& finding, const Marks& marks) {
    std::string text;
    if (marks.count(Mark::spoke) > 0)
        text = fmt::format("Orange: {} of the texels spoke for {}", percent(marks, Mark::spoke), finding.rule->id);
    std::string left_out;
    for (const auto& [mark, name] :
         {std::pair(Mark::background, "background and what is mixed with it"), std::pair(Mark::transparent, "alpha 0"),
          std::pair(Mark::padding, "streaks of padding")}) {
        if (marks.count(mark) > 0)
            left_out += fmt::format("{}{} {}", left_out.empty() ? "" : ", ", percent(marks, mark), name);
    }
    if (left_out.empty()) return text;
    return text + (text.empty() ? "B" : "; b") + "lue stripes: left out, " + left_out;
}

bool judges_texels(RuleFamily family) {
    return family == RuleFamily::values || family == RuleFamily::damage || family == RuleFamily::convention ||
           family == RuleFamily::pair;
}

}  // namespace

int marks_side(std::size_t files) { return files <= 8 ? 512 : files <= 40 ? 256 : files <= 150 ? 128 : 0; }

bool has_marks(const std::string& html) { return html.find(kFigure) != std::string::npos; }

Result<std::string> marks_html(const Finding& finding, const std::string& of) {
    const bool spoke = finding.marks && finding.marks->count(Mark::spoke) > 0;
    std::string html;
    if (!spoke && judges_texels(finding.rule->family))
        html = "<p class=\"figures\">No texel spoke alone: the rule judges the map as a whole.</p>\n";
    if (!finding.marks) return html;
    const Marks& marks = *finding.marks;
    const auto png = encode_file(marks_picture(marks), Container::png);
    if (!png) return png.error();
    const std::string legend = legend_of(finding, marks);
    const std::string alt =
        fmt::format("{}: {}{}{}", of, legend, spoke ? "; those that spoke lie " : "", spoke ? place_of(marks) : "");
    return html + fmt::format(
                      "{}<div><img loading=\"lazy\" decoding=\"async\" width=\"{}\" height=\"{}\" alt=\"{}\" "
                      "src=\"data:image/png;base64,{}\"></div><figcaption>{}</figcaption></figure>\n",
                      kFigure, marks.extent.width, marks.extent.height, html_text(alt), base64(*png),
                      html_text(legend + "."));
}

}  // namespace tex::cli
