// SPDX-License-Identifier: Apache-2.0

#include "reports/repair_fixes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>
#include <tex/repair.h>

#include "cli/text.h"
#include "options/output.h"
#include "tasks/model_output.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

constexpr std::string_view kRepair = "repair-normals FILE";

// The command for what repair-normals undoes and no other command does; empty for other findings. It keeps the format
// and the data beside the normals.
std::string repair_command(const Finding& finding, const CheckReport& report, const Requirements& require) {
    CheckOptions checks;
    checks.require = require;
    const auto step = repair_of(finding, report, checks);
    const std::string model = report.map.empty() ? "" : type_of_model(report);
    if (!step || (!report.map.empty() && model.empty())) return {};
    std::string text(finding.rule->fix);
    if (is_any_of(finding.rule->id, {"N201", "N207", "N209"}) && finding.tone)
        text = std::string(kRepair) + " -o FIXED";
    if (finding.rule->id == "N308") {
        text = std::string(kRepair) +
               (step->certainty == RepairClass::likely   ? " --likely --y WANTED"
                : step->certainty == RepairClass::choice ? " --turned left"
                                                         : "") +
               " -o FIXED";
        replace_word(text, "WANTED", name_of(kYAxisNames, require.y.value_or(YAxis::up)));
    }
    if (!text.starts_with(kRepair)) return {};
    if (step->certainty == RepairClass::likely && text.find("--likely") == std::string::npos)
        text.insert(kRepair.size(), " --likely");
    const std::optional<Container> own = container_of(report.file);
    const bool is_kept = own && *own != Container::jpeg;
    replace_word(text, "FIXED", "FIXED" + (model.empty() ? extension_of(is_kept ? *own : Container::png) : model));
    // A model is not written with green down, of which repair-normals cannot say whether it is green or red.
    if (!model.empty() && report.y.y == YAxis::down && text.find("--mirrored") == std::string::npos)
        text.insert(kRepair.size(), " --mirrored green");
    const std::string material = model.empty() ? "" : " --material " + shell_word(report.material);
    replace_word(text, "FILE", shell_file(report.file) + material);
    return text;
}

}  // namespace

bool is_any_of(std::string_view id, std::initializer_list<std::string_view> ids) {
    for (const std::string_view other : ids) {
        if (id == other) return true;
    }
    return false;
}

void replace_word(std::string& text, std::string_view word, std::string_view by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size())) {
        text.replace(at, word.size(), by);
    }
}

std::string type_of_model(const CheckReport& report) {
    const std::string type = lower_case(report.file.substr(std::min(report.file.rfind('.'), report.file.size())));
    return !report.material.empty() && (type == ".glb" || type == ".gltf") ? type : "";
}

std::optional<Fix> repair_fix(const Finding& finding, const CheckReport& report, const Requirements& require) {
    std::string command = repair_command(finding, report, require);
    if (command.empty()) {
        return finding.rule->fix.starts_with(kRepair) ? std::optional(Fix{"Export the map again from its source."})
                                                      : std::nullopt;
    }
    Fix fix{std::move(command), true};
    if (fix.text.find("--turned left") != std::string::npos) {
        fix.advice = "If bumps look like dents after that, it was turned to the right: --turned right";
        // The two look the same, and what was exchanged stays wrong when it is turned.
        if (finding.message.find("if green points") != std::string::npos) {
            const bool is_up = finding.message.find("are exchanged, if green points up") != std::string::npos;
            fix.advice += fmt::format("; if green points {0} in it, x and y were exchanged: --likely --y {0} instead",
                                      is_up ? "up" : "down");
        }
    }
    if (finding.rule->id == "N308" && fix.text.find("--likely --y") != std::string::npos) {
        fix.advice =
            "If bumps look like dents after that, the picture was mirrored along its diagonal: scale-normals "
            "--scale -1 turns the result over";
    }
    if (fix.text.find("--mirrored green") != std::string::npos) {
        fix.advice =
            "Green points down in it, which glTF does not allow, and is turned over, too; if bumps look like dents "
            "after that, red was mirrored instead: --mirrored red";
    }
    if (finding.rule->id == "N303")
        fix.advice = "With --likely, texels that alpha left without a direction become flat";
    return fix;
}

std::optional<Fix> tangent_fix(const Finding& finding, const CheckReport& report) {
    const std::string_view id = finding.rule->id;
    const std::string type = report.map.empty() ? "" : type_of_model(report);
    // Tangents mend what engines draw wrongly because there are none.
    const bool lacks_tangents = id == "N808" && finding.message.find("no TANGENT") != std::string::npos;
    if (type.empty() || !(lacks_tangents || is_any_of(id, {"N701", "N702", "N703", "N704", "N705", "N706"})))
        return std::nullopt;
    const std::string material = id == "N701" || id == "N808" ? "" : " --material " + shell_word(report.material);
    Fix fix{
        fmt::format("convert-normals {}{} --tangents mikktspace -o FIXED{}", shell_file(report.file), material, type),
        true};
    if (id == "N705") {
        fix.advice =
            "That is right if the map was baked for MikkTSpace on triangles, as most bakers do; leave the tangents if "
            "it was baked for those of the file, as in Blender, which makes them on quads";
    }
    return fix;
}

}  // namespace tex::cli
