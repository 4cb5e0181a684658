// SPDX-License-Identifier: Apache-2.0

#include "reports/sarif.h"

#include <string_view>

#include <fmt/format.h>
#include <tex/tex.h>

#include "cli/json.h"
#include "files/path_names.h"
#include "reports/findings.h"
#include "reports/fixes.h"

namespace tex::cli {
namespace {

std::string_view level_of(Severity severity) {
    return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

// A path as a relative reference of RFC 3986.
std::string uri_of(const std::string& path) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
    if (kHasBackslashes && path.size() > 2 && path.substr(1, 2) == ":/")  // C:/a.png becomes file:///C:/a.png
        return "file:///" + path.substr(0, 3) + uri_of("." + path.substr(2));
    std::string uri = path.starts_with('/') ? "file://" : "";
    for (const char c : path.starts_with("./") ? std::string_view(path).substr(2) : std::string_view(path)) {
        if (kPlain.find(c) != std::string_view::npos) {
            uri += c;
        } else {
            uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return uri;
}

Json text_json(std::string_view text) {
    Json json;
    json["text"] = text;
    return json;
}

Json rule_json(const Rule& rule) {
    Json json;
    json["id"] = rule.id;
    json["name"] = rule.name;
    json["shortDescription"] = text_json(rule.sentence);
    json["fullDescription"] = text_json(rule.explanation);
    json["help"] =
        text_json(rule.fix.empty() ? rule.explanation : fmt::format("{} Fix: {}", rule.explanation, rule.fix));
    json["defaultConfiguration"] = {{"enabled", rule.on}, {"level", level_of(rule.severity)}};
    json["properties"] = {{"tags", {name_of(kRuleFamilyNames, rule.family)}}};
    return json;
}

Json location_json(const CheckReport& report) {
    Json location;
    location["artifactLocation"] = {{"uri", uri_of(report.file)}};
    location["region"] = {{"startLine", 1}};  // textures have no lines, but viewers require one
    Json json;
    json["physicalLocation"] = std::move(location);
    if (!report.map.empty()) json["logicalLocations"] = Json::array({{{"name", report.map}}});
    return json;
}

Json result_json(const CheckReport& report, const Finding& finding, const Requirements& require) {
    Json json;
    json["ruleId"] = finding.rule->id;
    json["ruleIndex"] = finding.rule - rules().data();
    json["level"] = level_of(finding.severity);
    const Fix fix = fix_of(finding, report, require);
    json["message"] =
        text_json(fmt::format("{}{}{}{}{}{}{}{}", report.map, report.map.empty() ? "" : ": ", statement_of(finding),
                              fix.text.empty() ? "" : " ", fix.is_command ? "Fix: " : "", fix.text,
                              fix.advice.empty() ? "" : ". ", fix.advice));
    json["locations"] = Json::array({location_json(report)});
    const int level = finding.regions.empty() ? 0 : finding.regions.front().level;
    json["partialFingerprints"] = {{"rule/v1", fmt::format("{}:{}:{}", finding.rule->id, level, title_of(report))}};
    Json properties;
    properties["figure"] = static_cast<float>(finding.figure);
    properties["unit"] = finding.unit;
    properties["confidence"] = static_cast<float>(finding.confidence);
    if (finding.has_texel) properties["texel"] = {finding.column, finding.row};
    json["properties"] = std::move(properties);
    return json;
}

}  // namespace

std::string sarif_text(const std::vector<JudgedReport>& reports) {
    Json driver;
    driver["name"] = "check-normals";
    driver["version"] = version();
    constexpr std::string_view kHomepage = TEX_HOMEPAGE;  // of project() in CMakeLists.txt
    if (!kHomepage.empty()) driver["informationUri"] = kHomepage;
    driver["rules"] = Json::array();
    for (const Rule& rule : rules()) driver["rules"].push_back(rule_json(rule));

    Json results = Json::array(), notifications = Json::array();
    for (const JudgedReport& judged : reports) {
        const CheckReport& report = judged.report;
        for (const Finding& finding : report.findings) results.push_back(result_json(report, finding, judged.require));
        for (const Finding& finding : judged.waived) {
            Json result = result_json(report, finding, judged.require);
            result["suppressions"] = {{{"kind", "external"}, {"justification", "listed in the baseline"}}};
            results.push_back(std::move(result));
        }
        if (!judged.is_unreadable() || !report.findings.empty()) continue;
        Json notification;
        notification["level"] = "error";
        notification["message"] = text_json(report.error->reason);
        notification["locations"] = Json::array({location_json(report)});
        notifications.push_back(std::move(notification));
    }
    Json invocation;
    invocation["executionSuccessful"] = notifications.empty();
    if (!notifications.empty()) invocation["toolExecutionNotifications"] = std::move(notifications);

    Json run;
    run["tool"] = {{"driver", std::move(driver)}};
    run["invocations"] = Json::array({std::move(invocation)});
    run["results"] = std::move(results);
    Json log;
    log["$schema"] = "https://json.schemastore.org/sarif-2.1.0.json";
    log["version"] = "2.1.0";
    log["runs"] = Json::array({std::move(run)});
    return log.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tex::cli
