// SPDX-License-Identifier: Apache-2.0

#include "checks/findings.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "checks/rules.h"

namespace tex::inline v1 {
namespace {

bool lists(const std::vector<std::string>& names, const Rule& row) {
    return std::any_of(names.begin(), names.end(), [&](const std::string& n) { return n == row.id || n == row.name; });
}

}  // namespace

bool Findings::wants(std::string_view id) const {
    const Rule& row = rule(id);
    if (lists(options_.disable, row)) return false;
    if (row.on || lists(options_.enable, row)) return true;
    // Rules are off if they check requirements that are not made by default.
    return (id == "N105" && options_.require.power_of_two) || (id == "N307" && options_.require.tiles);
}

Finding& Findings::add(std::string_view id, std::string message) {
    const Rule& row = rule(id);
    Finding& finding = wants(id) ? findings_.emplace_back() : (ignored_ = {});
    finding.rule = &row;
    finding.severity = row.severity;
    for (const auto& [name, severity] : options_.severity) {
        if (name == row.id || name == row.name) finding.severity = severity;
    }
    finding.message = std::move(message);
    return finding;
}

void Findings::rate(Finding& finding, Severity severity) const {
    const auto names_it = [&](const auto& row) {
        return row.first == finding.rule->id || row.first == finding.rule->name;
    };
    if (std::none_of(options_.severity.begin(), options_.severity.end(), names_it)) finding.severity = severity;
}

Finding* Findings::find(std::string_view id) {
    const auto found =
        std::find_if(findings_.begin(), findings_.end(), [&](const Finding& one) { return one.rule->id == id; });
    return found == findings_.end() ? nullptr : &*found;
}

std::vector<Finding> Findings::take(int& explained) {
    std::vector<Finding> kept;
    for (const Finding& finding : findings_) {
        const bool known = std::any_of(findings_.begin(), findings_.end(), [&](const Finding& cause) {
            return has_id(cause.rule->explains, finding.rule->id);
        });
        if (!known) kept.push_back(finding);
    }
    explained = static_cast<int>(findings_.size() - kept.size());
    std::stable_sort(kept.begin(), kept.end(), [](const Finding& a, const Finding& b) {
        const auto level = [](const Finding& f) { return f.regions.empty() ? 0 : f.regions.front().level; };
        return a.rule->id != b.rule->id ? a.rule->id < b.rule->id : level(a) < level(b);
    });
    return kept;
}

void set_texel(Finding& finding, int column, int row) {
    finding.regions = {{0, column, row, 1, 1}};
    finding.has_texel = true;
    finding.column = column;
    finding.row = row;
}

Finding& add_counted(const CheckContext& context, Findings& findings, std::string_view id, Property property,
                     const std::string& what) {
    const Tally& tally = context.counts[property];
    const double share = context.counts.share(property);
    Finding& finding = findings.add(
        id, percent(share) + " of the texels" + what + ", the first at " + texel_text(tally.column, tally.row));
    finding.figure = share;
    finding.unit = "share";
    set_texel(finding, tally.column, tally.row);
    return finding;
}

std::string decimal(double value, int decimals) {
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
    return end.ec == std::errc() ? std::string(text, end.ptr) : std::string("beyond 10^60");
}

std::string percent(double share) {
    const double value = 100.0 * share;
    return decimal(value, value >= 10.0 || value == 0.0 ? 0 : value >= 0.1 ? 1 : value >= 0.001 ? 3 : 6) + " %";
}

std::string extent_text(Extent extent) { return std::to_string(extent.width) + "x" + std::to_string(extent.height); }

std::string texel_text(int column, int row) {
    return "column " + std::to_string(column) + ", row " + std::to_string(row);
}

std::string direction(YAxis y) { return std::string(name_of(kYAxisNames, y)); }

}  // namespace tex::inline v1
