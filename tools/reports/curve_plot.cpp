// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "reports/curve.h"
#include "reports/html.h"

namespace tex::cli {
namespace {

// The size of a panel, in units of the picture.
constexpr double kPanelWidth = 220.0;
constexpr double kPanelHeight = 200.0;
constexpr double kPanelTop = 48.0;
constexpr double kPanelLeft = 80.0;  // of the first one
constexpr double kPanelStep = 250.0;
constexpr double kPictureWidth = 820.0;
constexpr double kPictureHeight = 300.0;

// One direction of a panel: marks at multiples of a round step, from the last one below the data to the first one
// above.
struct CurveAxis {
    double least, greatest, step;

    CurveAxis(double low, double high) {
        const double span = std::max(high - low, 1e-3 * std::max(std::abs(high), 1e-3));
        const double power = std::pow(10.0, std::floor(std::log10(span / 4.0)));
        step = power;
        for (const double multiple : {2.0, 5.0, 10.0}) {
            if (span / step > 5.0) step = multiple * power;
        }
        least = std::floor(low / step) * step;
        greatest = std::max(std::ceil(high / step) * step, least + step);
    }
    [[nodiscard]] double part(double value) const { return (value - least) / (greatest - least); }
    [[nodiscard]] int marks() const { return static_cast<int>(std::lround((greatest - least) / step)); }
    [[nodiscard]] double mark(int k) const { return least + step * k; }
};

CurveAxis axis_of(const std::vector<CurvePoint>& points, double (*value)(const CurvePoint&)) {
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(), [&](const CurvePoint& a, const CurvePoint& b) { return value(a) < value(b); });
    return {value(*low), value(*high)};
}

double bytes_of(const CurvePoint& point) { return static_cast<double>(point.bytes); }

struct CurvePanel {
    const char* words;
    double (*value)(const CurvePoint&);
};
constexpr CurvePanel kCurvePanels[] = {
    {"mean angle, degrees", [](const CurvePoint& point) { return point.error.mean; }},
    {"99.9th percentile, degrees", [](const CurvePoint& point) { return point.error.p999; }},
    {"largest angle, degrees", [](const CurvePoint& point) { return point.error.max; }},
};

std::string draw_panel(const CurvePanel& panel, double left, const CurveAxis& bytes,
                       const std::vector<CurvePoint>& points) {
    const CurveAxis angles = axis_of(points, panel.value);
    const double bottom = kPanelTop + kPanelHeight;
    const auto x = [&](double angle) { return left + kPanelWidth * angles.part(angle); };
    const auto y = [&](double size) { return bottom - kPanelHeight * bytes.part(size); };
    std::string svg;
    for (int k = 0; k <= bytes.marks(); ++k) {
        const double at = y(bytes.mark(k));
        svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}h{:.1f}\"/>\n", left, at, kPanelWidth);
    }
    for (int k = 0; k <= angles.marks(); ++k) {
        const double at = x(angles.mark(k));
        svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}v{:.1f}\"/>\n", at, kPanelTop, kPanelHeight);
        svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{:.4g}</text>\n", at, bottom + 16.0,
                           angles.mark(k));
    }
    svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left + kPanelWidth / 2.0,
                       bottom + 36.0, panel.words);
    std::string line;
    for (const CurvePoint& point : points)
        line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x(panel.value(point)), y(bytes_of(point)));
    svg += fmt::format("<path class=\"line\" d=\"{}\"/>\n", line);
    for (const CurvePoint& point : points) {
        const double angle = panel.value(point);
        svg +=
            fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"><title>--rdo-mean {}: {} bytes, {:.4f} degrees",
                        x(angle), y(bytes_of(point)), point.rdo_mean, point.bytes, angle);
        svg += "</title></circle>\n";
    }
    return svg;
}

}  // namespace

std::string plot_curve(const std::string& title, const std::vector<CurvePoint>& points) {
    const CurveAxis bytes = axis_of(points, bytes_of);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" role=\"img\">\n<title>{2}</title>\n",
        kPictureWidth, kPictureHeight, html_text(title));
    svg +=
        "<style>\n"
        "svg { background: #fff; font: 12px sans-serif; fill: #222; }\n"
        ".grid { stroke: #ddd; }\n.line { fill: none; stroke: #0b62a8; stroke-width: 2; }\n"
        "circle { fill: #0b62a8; }\n.middle { text-anchor: middle; }\n.end { text-anchor: end; }\n"
        "@media (prefers-color-scheme: dark) {\n"
        "svg { background: #181818; fill: #ddd; }\n.grid { stroke: #444; }\n"
        ".line { stroke: #6cb6f5; }\ncircle { fill: #6cb6f5; }\n}\n</style>\n";
    svg += fmt::format("<text x=\"{}\" y=\"20\">{}</text>\n", 8, html_text(title));
    svg +=
        fmt::format("<text class=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">bytes</text>\n", kPanelLeft - 8.0, kPanelTop - 10.0);
    for (int k = 0; k <= bytes.marks(); ++k) {
        svg += fmt::format("<text class=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{:.0f}</text>\n", kPanelLeft - 8.0,
                           kPanelTop + kPanelHeight * (1.0 - bytes.part(bytes.mark(k))) + 4.0, bytes.mark(k));
    }
    double left = kPanelLeft;
    for (const CurvePanel& panel : kCurvePanels) {
        svg += draw_panel(panel, left, bytes, points);
        left += kPanelStep;
    }
    return svg + "</svg>\n";
}

}  // namespace tex::cli
