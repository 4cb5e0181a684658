// SPDX-License-Identifier: Apache-2.0
// The content that check-normals and compare-normals add to a page.

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tex/check.h>
#include <tex/format.h>

#include "cli/text.h"
#include "reports/findings.h"
#include "reports/fixes.h"
#include "reports/html.h"
#include "reports/html_marks.h"
#include "reports/html_pairs.h"
#include "reports/html_report.h"

namespace tex::cli {
namespace {

constexpr std::size_t kMostRegions = 4;  // the most that are listed for a finding

std::string fact(const char* name, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html_text(value));
}

std::string extent_text(Extent extent) { return fmt::format("{} x {}", extent.width, extent.height); }

std::string layout_text(Format format, const Swizzle& swizzle) {
    return fmt::format("{}, {}", name_of(kFormatNames, format), layout_name(swizzle));
}

std::string chip(Severity severity, const std::string& text) {
    return fmt::format("<span class=\"chip {}\">{}</span>", name_of(kSeverityNames, severity), html_text(text));
}

// -- check-normals -----------------------------------------------------------------------------------------

std::string y_text(const YEvidence& y) {
    if (!y.y) return fmt::format("unclear (r = {:.2f})", y.correlation);
    return fmt::format("{} (r = {:.2f})", name_of(kYAxisNames, *y.y), y.correlation);
}

std::string places_text(const Finding& finding) {
    std::string text;
    for (std::size_t k = 0; k < std::min(finding.regions.size(), kMostRegions); ++k) {
        const Region& region = finding.regions[k];
        if (finding.has_texel && region.width == 1 && region.height == 1) continue;  // the message names the texel
        text += fmt::format("{}level {}: {} x {} texels at {}, {}", text.empty() ? "" : "; ", region.level,
                            region.width, region.height, region.x, region.y);
    }
    if (finding.regions.size() > kMostRegions)
        text += fmt::format("; and {} more places", finding.regions.size() - kMostRegions);
    return text;
}

Result<std::string> finding_html(const Finding& finding, const CheckReport& report, const Requirements& require,
                                 bool has_marks) {
    const Rule& rule = *finding.rule;
    std::string_view sentence = rule.sentence;
    sentence.remove_suffix(1);  // its full stop
    std::string html =
        fmt::format("<li class=\"finding\">{} <a class=\"rule\" href=\"#{}\">{} {}</a>\n<p>{}: {}.</p>\n",
                    chip(finding.severity, std::string(name_of(kSeverityNames, finding.severity))), rule.id, rule.id,
                    html_text(rule.name), html_text(sentence), html_text(finding.message));
    std::string figures;
    if (finding.confidence < 0.995) figures = fmt::format("confidence {:.2f}", finding.confidence);
    if (const std::string places = places_text(finding); !places.empty())
        figures += (figures.empty() ? "" : "; ") + places;
    if (!figures.empty()) html += fmt::format("<p class=\"figures\">{}</p>\n", html_text(figures));
    const Fix fix = fix_of(finding, report, require);
    const char* form = fix.is_command ? "<p class=\"fix\">Fix: <code>{}</code></p>\n" : "<p class=\"fix\">{}</p>\n";
    if (!fix.text.empty()) html += fmt::format(fmt::runtime(form), html_text(fix.text));
    if (!fix.advice.empty()) html += fmt::format("<p class=\"fix\">{}</p>\n", html_text(fix.advice));
    if (has_marks) {
        auto marks = marks_html(finding, title_of(report));
        if (!marks) return marks.error();
        html += *marks;
    }
    return html + "</li>\n";
}

Result<std::string> list_html(const std::vector<Finding>& findings, const CheckReport& report,
                              const Requirements& require, bool has_marks) {
    std::string html = "<ul class=\"findings\">\n";
    for (const Finding& finding : findings) {
        auto item = finding_html(finding, report, require, has_marks);
        if (!item) return item.error();
        html += *item;
    }
    return html + "</ul>\n";
}

std::string facts_html(const CheckReport& report) {
    std::string html = "<dl>\n" + fact("format", layout_text(report.format, report.swizzle)) +
                       fact("extent", extent_text(report.extent)) + fact("levels", std::to_string(report.levels)) +
                       fact("green points, measured", y_text(report.y));
    if (report.pair) {
        html += fact("height map",
                     fmt::format("correlation {:.3f}, strength {:.2f}, offset {}, {}", report.pair->correlation,
                                 report.pair->strength, report.pair->offset_x, report.pair->offset_y));
    }
    if (report.occlusion) html += fact("occlusion", fmt::format("correlation {:.3f}", report.occlusion->correlation));
    if (report.explained > 0)
        html += fact("left out", fmt::format("{} that another finding explains", report.explained));
    return html + "</dl>\n";
}

// -- compare-normals ---------------------------------------------------------------------------------------

std::string level_row(const ComparedLevel& level) {
    const AngularError& e = level.error;
    std::string html = fmt::format("<tr{}><th scope=\"row\">{}</th><td>{}</td>", level.within ? "" : " class=\"over\"",
                                   level.number, extent_text(level.extent));
    for (const double angle : {e.mean, e.rms, e.p50, e.p99, e.p999, e.max})
        html += fmt::format("<td>{:.3f}</td>", angle);
    return html + fmt::format("<td>{}, {}</td></tr>\n", e.max_column, e.max_row);
}

}  // namespace

std::vector<std::string> check_columns() { return {"findings", "format", "extent", "levels", "green"}; }

Result<HtmlEntry> check_entry(const CheckReport& report, const Requirements& require,
                              const std::vector<Finding>& waived, HtmlMap* map, bool has_marks) {
    HtmlEntry entry;
    entry.title = title_of(report);
    entry.row = "<td>";
    std::vector<Finding> worst_first = report.findings;
    std::stable_sort(worst_first.begin(), worst_first.end(),
                     [](const Finding& p, const Finding& q) { return p.severity > q.severity; });
    for (const Finding& finding : worst_first) {
        entry.row += chip(finding.severity, fmt::format("{} {}", finding.rule->id, finding.rule->name)) + " ";
        const std::string word(name_of(kSeverityNames, finding.severity));
        if (entry.words.find(word) == std::string::npos) entry.words += (entry.words.empty() ? "" : " ") + word;
    }
    if (report.findings.empty()) {
        const bool unreadable = report.error && waived.empty();
        entry.words = unreadable ? "error" : "clean";
        if (unreadable) entry.row += chip(Severity::error, report.error->reason);
        if (!report.error && waived.empty()) entry.row += "<span class=\"chip clean\">nothing found</span>";
    }
    if (!waived.empty()) entry.row += fmt::format("<span class=\"chip clean\">{} accepted</span>", waived.size());
    entry.row += "</td>";
    if (report.error) {
        entry.row += "<td></td><td></td><td></td><td></td>";
        entry.body = fmt::format("<p><b>{}</b></p>\n", html_text(report.error->reason));
    } else {
        for (const std::string& cell : {layout_text(report.format, report.swizzle), extent_text(report.extent),
                                        std::to_string(report.levels), y_text(report.y)}) {
            entry.row += fmt::format("<td>{}</td>", html_text(cell));
        }
        entry.body = facts_html(report);
    }
    if (!report.findings.empty()) {
        auto list = list_html(report.findings, report, require, has_marks && map != nullptr);
        if (!list) return list.error();
        entry.body += *list;
    } else if (!report.error || !waived.empty()) {
        entry.body += waived.empty() ? "<p class=\"nothing\">Nothing found.</p>\n"
                                     : "<p class=\"nothing\">Nothing found that the baseline does not accept.</p>\n";
    }
    if (!waived.empty()) {
        auto list = list_html(waived, report, require, has_marks && map != nullptr);
        if (!list) return list.error();
        entry.body += "<p>Accepted by the baseline:</p>\n" + *list;
    }
    if (map != nullptr) entry.maps.push_back(std::move(*map));
    return entry;
}

HtmlEntry failed_entry(const std::string& name, const Error& error, std::size_t columns) {
    HtmlEntry entry;
    entry.title = printable(name);
    entry.words = "error";
    entry.row = fmt::format("<td><span class=\"chip error\">{}</span></td>", html_text(error.reason));
    for (std::size_t k = 1; k < columns; ++k) entry.row += "<td></td>";
    entry.body = fmt::format("<p><b>{}</b></p>\n", html_text(error.of(name).message()));
    return entry;
}

std::vector<std::string> compare_columns() { return {"limits", "level", "mean", "p99.9", "largest, degrees"}; }

Result<HtmlEntry> compare_entry(const std::vector<ComparedLevel>& levels, HtmlMap a, HtmlMap b,
                                const Plane<float>& degrees, std::optional<double> scale) {
    HtmlEntry entry;
    entry.title = fmt::format("{} and {}", a.file, b.file);
    const bool within =
        std::all_of(levels.begin(), levels.end(), [](const ComparedLevel& level) { return level.within; });
    entry.words = within ? "clean" : "error";
    const ComparedLevel& first = levels.front();
    entry.row = fmt::format(
        "<td>{}</td><td>{}</td>",
        within ? "<span class=\"chip clean\">within the limits</span>" : chip(Severity::error, "over a limit"),
        first.number);
    for (const double angle : {first.error.mean, first.error.p999, first.error.max})
        entry.row += fmt::format("<td>{:.4f}</td>", angle);

    entry.body = "<dl>\n" + fact("A", a.file) + fact("", layout_text(a.format, a.swizzle)) + fact("B", b.file) +
                 fact("", layout_text(b.format, b.swizzle)) + "</dl>\n";
    entry.body +=
        "<div class=\"scroll\"><table class=\"levels\">\n<caption>The angle between the normals of A and B, in degrees";
    entry.body += within ? "</caption>\n" : "; levels over the limits are marked</caption>\n";
    entry.body += "<thead><tr>";
    for (const char* column : {"level", "texels", "mean", "rms", "p50", "p99", "p99.9", "max", "at"}) {
        entry.body += fmt::format("<th scope=\"col\">{}</th>", column);
    }
    entry.body += "</tr></thead>\n<tbody>\n";
    for (const ComparedLevel& level : levels) entry.body += level_row(level);
    entry.body += "</tbody>\n</table></div>\n";

    auto split = split_picture(a, b, {"A", "B"});
    if (!split) return split.error();
    auto heat = heat_picture(degrees, scale.value_or(first.error.max), "A and B");
    if (!heat) return heat.error();
    entry.extras.push_back(std::move(*split));
    entry.extras.push_back(std::move(*heat));
    entry.maps.push_back(std::move(a));
    entry.maps.push_back(std::move(b));
    return entry;
}

}  // namespace tex::cli
