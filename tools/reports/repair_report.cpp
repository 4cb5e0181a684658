// SPDX-License-Identifier: Apache-2.0

#include "reports/repair_report.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tex/check.h>
#include <tex/format.h>
#include <tex/pack.h>

#include "cli/text.h"
#include "reports/findings.h"
#include "reports/html.h"
#include "reports/html_pairs.h"
#include "reports/report_file.h"

namespace tex::cli {
namespace {

constexpr int kMostMeanDegrees = 180;

std::string steps_html(const Repaired& repaired) {
    if (repaired.steps.empty()) return "<p class=\"nothing\">Nothing was repaired.</p>\n";
    std::string html =
        "<div class=\"scroll\"><table class=\"levels\">\n<caption>What was done, in this order, and the mean angle by "
        "which each step turns the normals</caption>\n<thead><tr>";
    for (const char* column : {"rule", "repair", "class", "degrees"})
        html += fmt::format("<th scope=\"col\">{}</th>", column);
    html += "</tr></thead>\n<tbody>\n";
    for (const RepairStep& step : repaired.steps)
        html += fmt::format(
            "<tr><th scope=\"row\"><a href=\"#{0}\">{0} {1}</a></th><td>{2}</td><td>{3}</td><td>{4:.2f}</td></tr>\n",
            step.rule->id, html_text(step.rule->name), html_text(text_of(step)),
            name_of(kRepairClassNames, step.certainty), step.degrees);
    return html + "</tbody>\n</table></div>\n";
}

std::string left_html(const Repaired& repaired) {
    if (repaired.left.empty()) return {};
    std::string html = "<p>What is left:</p>\n<ul class=\"findings\">\n";
    for (const FaultLeft& fault : repaired.left) {
        const std::string_view severity = name_of(kSeverityNames, fault.finding.severity);
        html += fmt::format(
            "<li class=\"finding\"><span class=\"chip {0}\">{0}</span> <a class=\"rule\" href=\"#{1}\">{1} {2}</a>\n"
            "<p>{3}</p></li>\n",
            severity, fault.finding.rule->id, html_text(fault.finding.rule->name),
            html_text(statement_of(fault.finding)));
    }
    return html + "</ul>\n";
}

// The map as it is drawn; nothing if the picture holds no normals.
Result<std::optional<HtmlMap>> drawn(const std::string& title, const Texture& texture, const CheckReport& report,
                                     YAxis y, const HtmlSizes& sizes, const Execution& execution) {
    auto map = draw_html_map(title, texture, report.swizzle, y, nullptr, sizes, execution);
    if (map) return std::optional(std::move(*map));
    if (map.error().code != ErrorCode::bad_option) return map.error();
    return std::optional<HtmlMap>();
}

// The angles between both base levels as compare-normals measures them; nothing if one holds no normals. What is drawn
// may be smaller, and need not hold unit vectors.
Result<std::optional<Comparison>> angles_between(const Texture& before, const Texture& after,
                                                 const Execution& execution) {
    const auto a = unpack(before, {}, execution), b = unpack(after, {}, execution);
    if (!a || !b) return std::optional<Comparison>();
    auto compared = compare(a->levels.front(), b->levels.front(), execution);
    if (!compared) return compared.error();
    return std::optional(std::move(*compared));
}

// Adds the pictures that show both maps.
Result<void> add_pictures(const HtmlMap& before, const HtmlMap& after, const Comparison& compared, HtmlEntry& entry) {
    auto split = split_picture(before, after, {"before", "after"});
    if (!split) return split.error();
    auto heat = heat_picture(compared.degrees, compared.error.max, "before and after");
    if (!heat) return heat.error();
    entry.extras.push_back(std::move(*split));
    entry.extras.push_back(std::move(*heat));
    return {};
}

}  // namespace

RepairReport::RepairReport() : page_("repair-normals", {"state", "repairs", "degrees", "left"}) {}

void RepairReport::add(Command& command) {
    add_report_option(command, path_,
                      "write a page with the maps before and after, under a light that can be moved, and their repairs",
                      5, "write a page with the maps before and after");
}

void RepairReport::check(const std::vector<Task>& tasks, std::vector<NamedFile> others) {
    check_report(path_, tasks, std::move(others));
    sizes_ = html_sizes(2 * tasks.size());
}

Result<void> RepairReport::add(Job& job, const std::string& name, const Texture& source, const Repaired& repaired,
                               std::optional<YAxis> y) {
    const Execution execution{job.threads(), {}};
    const Texture& result = repaired.texture ? *repaired.texture : source;
    const YAxis read = y ? *y : result.y_known ? result.y_axis : repaired.after.y.y.value_or(result.y_axis);
    auto before = drawn(name, source, repaired.before, read, sizes_, execution);
    if (!before) return before.error();
    auto after = std::optional<HtmlMap>();
    if (repaired.texture) {
        auto map = drawn(name + ", repaired", result, repaired.after, read, sizes_, execution);
        if (!map) return map.error();
        after = std::move(*map);
    }
    HtmlEntry entry;
    entry.title = printable(name);
    entry.body = steps_html(repaired) + left_html(repaired);
    double degrees = 0.0;
    if (*before && after && (*before)->extent == after->extent && sizes_.view > 0) {
        const auto compared = angles_between(source, result, execution);
        if (!compared) return compared.error();
        if (*compared) {
            degrees = (*compared)->error.mean;
            if (auto added = add_pictures(**before, *after, **compared, entry); !added) return added;
        }
    }
    const bool is_refused = repaired.has_errors();
    entry.words = is_refused ? "error" : repaired.steps.empty() ? "clean" : "warning";
    std::string left;
    for (const FaultLeft& fault : repaired.left) {
        page_.explain(*fault.finding.rule);
        left += fmt::format("<span class=\"chip {}\">{}</span> ", name_of(kSeverityNames, fault.finding.severity),
                            fault.finding.rule->id);
    }
    for (const RepairStep& step : repaired.steps) page_.explain(*step.rule);
    entry.row =
        fmt::format("<td><span class=\"chip {}\">{}</span></td><td>{}</td><td>{:.2f}</td><td>{}</td>", entry.words,
                    is_refused               ? "refused"
                    : repaired.steps.empty() ? "whole"
                                             : "repaired",
                    repaired.steps.size(), std::min<double>(degrees, kMostMeanDegrees), left);
    if (*before) entry.maps.push_back(std::move(**before));
    if (after) entry.maps.push_back(std::move(*after));
    page_.add(name, std::move(entry));
    return {};
}

void RepairReport::add_failure(const Job& job, const Error& error) {
    page_.add(job.task.name(), failed_entry(job.task.name(), error.of(job.task.input), 4));
}

ExitCode RepairReport::write(Console& console, const std::string& summary) const {
    return write_report(path_, page_, summary, console);
}

}  // namespace tex::cli
