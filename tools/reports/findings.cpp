// SPDX-License-Identifier: Apache-2.0

#include "reports/findings.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tex/format.h>

#include "cli/text.h"
#include "reports/fixes.h"

namespace tex::cli {
namespace {

std::string_view name_of_y(YAxis y) { return name_of(kYAxisNames, y); }

Json region_json(const Region& region) {
    Json json;
    json["level"] = region.level;
    json["x"] = region.x;
    json["y"] = region.y;
    json["width"] = region.width;
    json["height"] = region.height;
    return json;
}

// The first line about a map names it. Long names of materials and images are cut in the others.
std::string line_title(const CheckReport& report, bool is_first) {
    constexpr std::size_t kLong = 60, kKept = 24;
    if (is_first || report.map.size() <= kLong) return printable(title_of(report));
    std::size_t end = kKept;
    while (end > 0 && (static_cast<unsigned char>(report.map[end]) & 0xc0) == 0x80) --end;  // between characters
    return printable(report.file + ": " + report.map.substr(0, end)) + "...";
}

std::string later_title(const CheckReport& report) { return line_title(report, report.findings.empty()); }

}  // namespace

std::string title_of(const CheckReport& report) {
    return report.map.empty() ? report.file : report.file + ": " + report.map;
}

std::string statement_of(const Finding& finding) {
    std::string_view sentence = finding.rule->sentence;
    sentence.remove_suffix(1);  // its full stop
    return fmt::format("{}: {}.", sentence, finding.message);
}

std::string findings_text(const CheckReport& report, const Requirements& require) {
    std::string text, told;  // the command that was printed before
    std::vector<const Finding*> by_weight;
    for (const Finding& finding : report.findings) by_weight.push_back(&finding);
    std::stable_sort(by_weight.begin(), by_weight.end(),
                     [](const Finding* a, const Finding* b) { return a->severity > b->severity; });
    for (const Finding* const each : by_weight) {
        const Finding& finding = *each;
        const Rule& rule = *finding.rule;
        std::string statement = statement_of(finding);
        statement.pop_back();
        text += fmt::format("{}: {} {} {}: {}\n", line_title(report, text.empty()),
                            name_of(kSeverityNames, finding.severity), rule.id, rule.name, printable(statement));
        const Fix fix = fix_of(finding, report, require);
        if (fix.text.empty()) continue;
        const bool is_told = fix.is_command && fix.text == told;
        if (fix.is_command) told = fix.text;
        text += is_told ? "    fix: the same command\n"
                        : fmt::format("    {}: {}\n", fix.is_command ? "fix" : "advice", fix.text);
        if (!fix.advice.empty()) text += fmt::format("    advice: {}\n", fix.advice);
    }
    return text;
}

std::string pair_text(const CheckReport& report) {
    if (!report.pair) return {};
    const PairEvidence& pair = *report.pair;
    return fmt::format("{}: best fit to the height map: correlation {:.2f}, strength {:.2f}, y {}, offset {}, {}\n",
                       later_title(report), pair.correlation, pair.strength, name_of_y(pair.y), pair.offset_x,
                       pair.offset_y);
}

std::string occlusion_text(const CheckReport& report) {
    if (!report.occlusion) return {};
    return fmt::format("{}: correlation of the occlusion with the surface: {:.2f}\n", later_title(report),
                       report.occlusion->correlation);
}

std::string y_text(const CheckReport& report) {
    if (report.error) return {};
    // Slopes show that one of red and green is mirrored, but not which.
    const std::string words = report.y.y ? fmt::format("green points {}{}", name_of_y(*report.y.y),
                                                       *report.y.y == YAxis::down ? ", or red points left" : "")
                                         : std::string("which way green points does not show");
    return fmt::format("{}: {}\n", later_title(report), words);
}

std::string seams_text(const CheckReport& report) {
    if (!report.seams) return {};
    const SeamEvidence& seams = *report.seams;
    return fmt::format(
        "{}: seams: {}: {} edges of the mesh, mean {:.2f} degrees, where a map of this detail that was baked for its "
        "mesh and decoder has less than {:.1f}; p99 {:.2f}, {:.2f} in the mean of the worst edge\n",
        later_title(report), seams.mean < seams.usual ? "fine" : "visible", seams.edges, seams.mean, seams.usual,
        seams.p99, seams.worst);
}

Json findings_json(const CheckReport& report, const Requirements& require) {
    Json json;
    if (!report.map.empty()) json["map"] = report.map;
    if (report.error) {
        json["error"] = {{"code", name_of(kErrorCodeNames, report.error->code)}, {"reason", report.error->reason}};
    } else {
        json["format"] = name_of(kFormatNames, report.format);
        json["swizzle"] = layout_name(report.swizzle);
        json["kind"] = name_of(kPictureKindNames, report.kind);
        json["kind_confidence"] = static_cast<float>(report.kind_confidence);
        if (report.height_bytes) json["height_bytes"] = name_of(kHeightChannelNames, *report.height_bytes);
        json["extent"] = {report.extent.width, report.extent.height};
        json["levels"] = report.levels;
        json["y"] = {{"measured", report.y.y ? Json(name_of_y(*report.y.y)) : Json()},
                     {"correlation", static_cast<float>(report.y.correlation)},
                     {"confidence", static_cast<float>(report.y.confidence)}};
    }
    if (report.pair) {
        json["pair"] = {{"correlation", static_cast<float>(report.pair->correlation)},
                        {"strength", static_cast<float>(report.pair->strength)},
                        {"y", name_of_y(report.pair->y)},
                        {"offset", {report.pair->offset_x, report.pair->offset_y}}};
    }
    if (report.occlusion) {
        json["occlusion"] = {{"correlation", static_cast<float>(report.occlusion->correlation)},
                             {"mirrored", {report.occlusion->mirrored_x, report.occlusion->mirrored_y}},
                             {"best", static_cast<float>(report.occlusion->best)}};
    }
    if (report.seams) {
        json["seams"] = {{"edges", report.seams->edges},
                         {"mean", static_cast<float>(report.seams->mean)},
                         {"p99", static_cast<float>(report.seams->p99)},
                         {"worst", static_cast<float>(report.seams->worst)},
                         {"worst_edge", region_json(report.seams->worst_edge)},
                         {"usual", static_cast<float>(report.seams->usual)}};
    }
    json["findings"] = Json::array();
    for (const Finding& finding : report.findings) {
        Json item;
        item["id"] = finding.rule->id;
        item["name"] = finding.rule->name;
        item["severity"] = name_of(kSeverityNames, finding.severity);
        item["message"] = finding.message;
        item["figure"] = static_cast<float>(finding.figure);
        item["unit"] = finding.unit;
        item["confidence"] = static_cast<float>(finding.confidence);
        item["regions"] = Json::array();
        for (const Region& region : finding.regions) item["regions"].push_back(region_json(region));
        if (finding.has_texel) item["texel"] = {finding.column, finding.row};
        const Fix fix = fix_of(finding, report, require);
        if (!fix.text.empty()) item[fix.is_command ? "fix" : "advice"] = fix.text;
        if (!fix.advice.empty()) item["advice"] = fix.advice;
        json["findings"].push_back(std::move(item));
    }
    json["explained"] = report.explained;
    return json;
}

std::string rules_text() {
    std::string text;
    RuleFamily family = RuleFamily::pair;
    for (const Rule& rule : rules()) {
        if (text.empty() || rule.family != family) {
            family = rule.family;
            for (const auto& row : kRuleFamilyNames) {
                if (row.value == family)
                    text += fmt::format("{}{}: {}\n", text.empty() ? "" : "\n", row.name, row.meaning);
            }
        }
        text += fmt::format("  {}  {:<20} {:<8} {}{}\n", rule.id, rule.name, name_of(kSeverityNames, rule.severity),
                            rule.sentence, rule.on ? "" : " (off by default)");
    }
    return text;
}

std::string rule_text(const Rule& rule) {
    std::string text = fmt::format("{} {} ({}, {})\n\n", rule.id, rule.name, name_of(kRuleFamilyNames, rule.family),
                                   name_of(kSeverityNames, rule.severity));
    for (const std::string_view part : {rule.sentence, rule.explanation}) {
        for (const std::string& line : wrapped(part, 78)) text += line + "\n";
    }
    if (!rule.fix.empty()) text += fmt::format("\nFix: {}\n", rule.fix);
    if (!rule.explains.empty()) text += fmt::format("\nIf it is found, these are left out: {}\n", rule.explains);
    return text;
}

void CheckTotals::add(const CheckReport& report, int its_known) {
    known += its_known;
    if (report.error && its_known == 0) ++unreadable;
    for (const Finding& finding : report.findings) ++by_severity[static_cast<int>(finding.severity)];
}

std::string CheckTotals::text() const {
    const auto count = [](int n, const char* one) { return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s"); };
    std::string line = fmt::format("{}: {}, {}, {}", count(files, "file"), count(by_severity[2], "error"),
                                   count(by_severity[1], "warning"), count(by_severity[0], "note"));
    if (unreadable > 0) line += fmt::format("; {} unreadable", unreadable);
    if (known > 0) line += fmt::format("; {} known and accepted", known);
    line += left_out;
    if (!fails && by_severity[2] == 0 && by_severity[1] > 0) line += "; warnings pass, --fail-on warning refuses them";
    return line;
}

}  // namespace tex::cli
