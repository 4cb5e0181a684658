// SPDX-License-Identifier: Apache-2.0

#include "reports/repairs.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/text.h"
#include "reports/findings.h"

namespace tex::cli {
namespace {

Json left_json(const FaultLeft& fault) {
    Json json;
    json["id"] = fault.finding.rule->id;
    json["name"] = fault.finding.rule->name;
    json["severity"] = name_of(kSeverityNames, fault.finding.severity);
    json["message"] = fault.finding.message;
    json["class"] = name_of(kRepairClassNames, fault.certainty);
    return json;
}

Json step_json(const RepairStep& step) {
    Json json;
    json["id"] = step.rule->id;
    json["name"] = step.rule->name;
    json["repair"] = name_of(kRepairKindNames, step.kind);
    json["class"] = name_of(kRepairClassNames, step.certainty);
    json["text"] = text_of(step);
    if (step.channel >= 0) {
        std::string channels(1, "RGBA"[step.channel]);
        if (step.other >= 0) channels += "RGBA"[step.other];
        json["channels"] = std::move(channels);
    }
    if (step.part) json["part"] = {step.part->x, step.part->y, step.part->width, step.part->height};
    if (step.y) json["y"] = name_of(kYAxisNames, *step.y);
    json["degrees"] = static_cast<float>(step.degrees);
    return json;
}

// Slopes alone do not show which of green and red is mirrored; heights do.
std::string what_repairs(const FaultLeft& fault) {
    if (fault.certainty == RepairClass::likely && fault.finding.rule->id == "N402")
        return "; --likely repairs it if a straight line divides the two parts";
    if (fault.certainty == RepairClass::likely) return "; --likely repairs it";
    if (fault.certainty != RepairClass::choice) return "";
    if (fault.finding.rule->id == "N210") return "; if these are heights, --bumpiness B bakes them";
    if (fault.finding.rule->id == "N308") {
        const bool may_be_exchanged = fault.finding.message.find("if green points") != std::string::npos;
        const bool is_up = fault.finding.message.find("are exchanged, if green points up") != std::string::npos;
        return std::string("; --turned left or --turned right repairs it if the picture was turned") +
               (may_be_exchanged ? fmt::format(", and --likely --y {} if x and y were exchanged", is_up ? "up" : "down")
                                 : "") +
               "; --height FILE shows which";
    }
    return "; --mirrored green repairs it if the map is of the other convention, and --mirrored red if the picture was "
           "mirrored from left to right; --height FILE shows which";
}

}  // namespace

std::string repairs_text(const std::string& name, const Repaired& repaired) {
    std::string text;
    for (const RepairStep& step : repaired.steps) {
        // Occlusion that stays near 1 looks like the z of short vectors.
        const bool may_lose_blue = step.kind == RepairKind::normalize && repaired.before.more_data;
        // What turned vectors, as blur and contrast do beside their lengths, stays.
        const bool keeps_directions = step.kind == RepairKind::normalize;
        text += fmt::format("{}: {} {}: {} ({}), {:.2f} degrees{}{}\n", printable(name), step.rule->id, step.rule->name,
                            text_of(step), name_of(kRepairClassNames, step.certainty), step.degrees,
                            may_lose_blue ? "; if blue holds occlusion, as in LabPBR, that wipes it out" : "",
                            keeps_directions ? "; directions stay as they are" : "");
    }
    for (const FaultLeft& fault : repaired.left) {
        const Finding& finding = fault.finding;
        if (finding.severity == Severity::note) continue;
        std::string statement = statement_of(finding);
        statement.pop_back();
        text += fmt::format("{}: left: {} {} {}: {}{}\n", printable(name), name_of(kSeverityNames, finding.severity),
                            finding.rule->id, finding.rule->name, printable(statement), what_repairs(fault));
    }
    return text;
}

std::string_view manifest_words(const FaultLeft& fault) {
    if (fault.certainty == RepairClass::likely) return " (likely = true repairs it)";
    if (fault.certainty != RepairClass::choice) return "";
    const std::string_view id = fault.finding.rule->id;
    if (id == "N210") return " (bumpiness = B bakes them)";
    if (id == "N308") return " (turned = \"left\" or \"right\" repairs it)";
    return " (mirrored = \"green\" or \"red\" repairs it)";
}

std::string inversion_words(bool is_in_model) {
    return std::string("blue alone was inverted back; if bumps look like dents now, the whole picture was inverted: ") +
           (is_in_model ? "invert it in an image editor instead" : "scale-normals --scale -1 turns x and y, too");
}

bool holds_no_normals(const Repaired& repaired) {
    const PictureKind kind = repaired.after.kind;
    return repaired.has_errors() && kind != PictureKind::normals && kind != PictureKind::object_space &&
           kind != PictureKind::unknown;
}

std::string left_out_text(const std::string& name, const Repaired& repaired) {
    return fmt::format("{}: left out: it holds no normals ({})\n", printable(name),
                       name_of(kPictureKindNames, repaired.after.kind));
}

Json repairs_json(const Repaired& repaired) {
    Json json;
    json["state"] = repaired.has_errors() ? "refused" : repaired.steps.empty() ? "whole" : "repaired";
    json["repairs"] = Json::array();
    for (const RepairStep& step : repaired.steps) json["repairs"].push_back(step_json(step));
    json["left"] = Json::array();
    for (const FaultLeft& fault : repaired.left) json["left"].push_back(left_json(fault));
    return json;
}

void RepairTotals::add(const Repaired& of) {
    ++maps;
    const bool has_notes_alone = std::all_of(of.left.begin(), of.left.end(), [](const FaultLeft& fault) {
        return fault.finding.severity == Severity::note;
    });
    ++(of.has_errors() ? refused : !of.steps.empty() ? repaired : has_notes_alone ? whole : kept);
    const auto is_likely = [](const RepairStep& step) { return step.certainty == RepairClass::likely; };
    if (!of.has_errors() && std::any_of(of.steps.begin(), of.steps.end(), is_likely)) ++likely;
}

void RepairTotals::add(const RepairTotals& of) {
    for (int RepairTotals::*const count :
         {&RepairTotals::maps, &RepairTotals::repaired, &RepairTotals::refused, &RepairTotals::kept,
          &RepairTotals::whole, &RepairTotals::likely, &RepairTotals::left_out})
        this->*count += of.*count;
}

std::string RepairTotals::text(bool is_dry_run) const {
    std::string text =
        fmt::format("{} {}: {} {}repaired", maps, maps == 1 ? "map" : "maps", repaired, is_dry_run ? "would be " : "");
    if (likely > 0) text += fmt::format(" ({} of them as is likely, but not proven)", likely);
    text += fmt::format(", {} without a fault to repair", whole);
    if (kept > 0) text += fmt::format(", {} with what it does not repair", kept);
    if (refused > 0)
        text +=
            fmt::format(", {} {}not written, because an error would be left", refused, is_dry_run ? "would be " : "");
    if (left_out > 0)
        text += fmt::format("; {} {} left out, which {} no normals", left_out, left_out == 1 ? "picture" : "pictures",
                            left_out == 1 ? "holds" : "hold");
    return text;
}

}  // namespace tex::cli
