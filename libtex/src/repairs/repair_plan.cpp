// SPDX-License-Identifier: Apache-2.0

#include "repairs/repair_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <tex/format.h>

#include "checks/findings.h"
#include "checks/tone_text.h"

namespace tex::inline v1 {
namespace {

using enum RepairClass;
using enum RepairKind;

constexpr RuleRepair kRepairs[] = {
    // How the bytes are read.
    {"N311", safe, change_sign},
    {"N111", safe, drop_srgb},
    // What the channels went through. N303 first: what is multiplied by alpha is darker, too.
    {"N303", safe, divide_by_alpha},
    {"N301", safe, encode_srgb},
    {"N302", safe, decode_srgb},
    {"N313", safe, undo_tone},
    {"N314", safe, undo_tone},
    // Which channel holds what.
    {"N308", safe, exchange},
    {"N308", likely, exchange},
    {"N308", choice, turn_left},
    {"N308", choice, turn_right},
    {"N220", likely, invert},
    {"N221", safe, stretch_z},
    {"N209", safe, rebuild_z},
    // Directions.
    {"N402", likely, invert_part},
    {"N401", choice, invert},
    {"N404", choice, state_y},
    {"N112", safe, invert},
    {"N601", safe, turn_left},
    {"N601", safe, turn_right},
    {"N601", safe, exchange},
    // What are no normals yet.
    {"N210", choice, bake_heights},
    // Vectors.
    {"N315", likely, smooth_steps},
    {"N305", likely, smooth_steps},
    {"N215", likely, fill_background},
    {"N207", likely, straighten},
    {"N205", likely, normalize},
    {"N201", likely, normalize},
    // Levels, which follow from all of the above.
    {"N501", safe, rebuild_levels},
    {"N502", likely, rebuild_levels},
    {"N503", likely, rebuild_levels},
    {"N103", likely, rebuild_levels},
};

int channel_of(const Swizzle& swizzle, Component component) {
    const auto at = std::find(swizzle.begin(), swizzle.end(), component);
    return at == swizzle.end() ? -1 : static_cast<int>(at - swizzle.begin());
}

// The words of N308, where the direction of green says which of the two it was.
constexpr std::string_view kTurned = "the picture was turned";

// Two channels are exchanged: z and the one that the finding names, or x and y.
std::vector<RepairStep> exchanges(const RepairStep& step, const Finding& finding, const CheckReport& report,
                                  bool y_is_known) {
    const int x = channel_of(report.swizzle, Component::x), y = channel_of(report.swizzle, Component::y);
    const int z = channel_of(report.swizzle, Component::z);
    const bool misplaces_z = finding.unit == "component";
    std::vector<RepairStep> steps;
    const auto add = [&](int a, int b) {
        steps.push_back(step);
        steps.back().channel = std::min(a, b);
        steps.back().other = std::max(a, b);
    };
    if (misplaces_z && step.certainty == safe && z >= 0) {
        add(x, z);
        add(y, z);
    } else if (!misplaces_z && step.certainty == likely && y_is_known && !finding.message.starts_with(kTurned)) {
        add(x, y);
    }
    return steps;
}

// The vectors are turned as the picture was. Either turn suits the slopes; one makes dents of bumps, which heights
// show. Heights that the slopes do not follow (N601) may follow after a turn, or after x and y are exchanged.
std::vector<RepairStep> turns(RepairStep step, const Finding& finding, const KnownOfMap& known) {
    const bool by_heights = known.heights && known.y, is_of_heights = finding.rule->id == "N601";
    if (finding.unit == "component" || (is_of_heights && !by_heights)) return {};
    if (known.turned && (*known.turned == TurnedPicture::left) != (step.kind == turn_left)) return {};
    if (known.turned || by_heights) step.certainty = safe;
    // Whoever says that the picture was turned says with it which way green points: see exchange_text().
    if (known.turned && !is_of_heights) step.y = finding.turned_y;
    return {step};
}

constexpr double kSurely = 0.95;  // Finding::confidence of a tone
constexpr double kPlainPower = 2.2;

bool has_rule(const CheckReport& report, std::string_view id) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [id](const Finding& finding) { return finding.rule->id == id; });
}

std::string tone_text(const ToneCurve& tone) {
    if (tone.lightness != 1.0) return "take lightness " + decimal(100.0 * tone.lightness, 0) + " % (HSL) back";
    if (tone.gamma != 1.0) return "take gamma " + decimal(tone.gamma, 3) + " back";
    if (tone.black == 0.0 && tone.white > 1.0) return "divide by " + decimal(1.0 / tone.white, 3);
    if (is_shift(tone)) {
        return std::string(tone.black < 0.0 ? "subtract " : "add ") + decimal(255.0 * std::abs(tone.black), 0) +
               " of 255";
    }
    return "take levels from " + decimal(100.0 * tone.black, 1) + " % to " + decimal(100.0 * tone.white, 1) + " % back";
}

}  // namespace

std::span<const RuleRepair> rule_repairs() { return kRepairs; }

RepairClass repair_class(const Rule& rule) {
    for (const RuleRepair& row : kRepairs) {
        if (row.rule == rule.id) return row.certainty;
    }
    return never;
}

std::string text_of(const RepairStep& step) {
    const auto letter = [](int channel) { return std::string(1, "RGBA"[channel]); };
    switch (step.kind) {
        case exchange: return "exchange " + letter(step.channel) + " and " + letter(step.other);
        case invert: return "invert " + letter(step.channel);
        case undo_tone:
            if (step.tones) return "take the levels of each channel back";
            if (!step.tone) return {};
            return tone_text(*step.tone) + (step.channel < 0 ? std::string() : " in " + letter(step.channel));
        default: break;
    }
    for (const Named<RepairKind>& row : kRepairKindNames) {
        if (row.value == step.kind)
            return std::string(row.meaning) + (step.y == YAxis::down ? "; green points down" : "");
    }
    return {};
}

std::vector<RepairStep> steps_for(const RuleRepair& row, const Finding& finding, const CheckReport& report,
                                  const KnownOfMap& known) {
    RepairStep step{finding.rule, row.kind, row.certainty};
    if (row.kind == bake_heights) {
        if (known.bumpiness) step.certainty = safe;
        return {step};
    }
    const int x = channel_of(report.swizzle, Component::x), y = channel_of(report.swizzle, Component::y);
    const int z = channel_of(report.swizzle, Component::z);
    if (x < 0 || y < 0 || !finding.fix_harms.empty()) return {};
    const bool by_heights = report.pair && report.pair->decides();
    const bool is_decided = by_heights || known.mirrored;
    const bool is_red = by_heights ? report.pair->strength < 0.0 : known.mirrored == MirroredChannel::red;
    switch (row.kind) {
        case exchange:
            if (row.rule != "N601") return exchanges(step, finding, report, known.y);
            if (!known.heights || !known.y) return {};
            step.channel = std::min(x, y);
            step.other = std::max(x, y);
            break;
        case turn_left:
        case turn_right: return turns(step, finding, known);
        case invert:
            step.channel = row.rule == "N220" ? z : is_red ? x : y;
            if (row.rule == "N401" && is_decided) step.certainty = safe;
            // Green is as required, so the statement is wrong, or red is mirrored.
            if (row.rule == "N112" && report.y.y) {
                if (is_decided && is_red) return {};
                step = {finding.rule, state_y, is_decided ? safe : choice};
            }
            if (step.kind == invert && step.channel < 0) return {};
            break;
        case state_y:
            if (is_red) {
                step.kind = invert;
                step.channel = x;
            }
            if (is_decided) step.certainty = safe;
            break;
        case encode_srgb:
        case decode_srgb:
            if (finding.confidence < kSurely) step.certainty = likely;
            if (z < 0 || row.kind == encode_srgb) break;
            if (finding.tone) return {{finding.rule, undo_tone, step.certainty, -1, -1, {}, finding.tone}, step};
            // Noise, as of texture compression, may hide which of the two it was. The wrong one leaves N314.
            return {step, {finding.rule, undo_tone, step.certainty, -1, -1, {}, ToneCurve{0.0, 1.0, kPlainPower}}};
        case divide_by_alpha:
            if (format_info(report.format).channels < 4) return {};
            break;
        case rebuild_z:
            if (x == 2 || y == 2 || format_info(report.format).channels < 3) return {};
            // What a contrast cut off follows from x and y once these are shorter again, and not before.
            if (finding.tone && z >= 0) return {{finding.rule, undo_tone, likely, -1, -1, {}, finding.tone}};
            break;
        case undo_tone:
            if ((!finding.tone && !finding.tones) || z < 0) return {};
            step.tone = finding.tone;
            step.tones = finding.tones;
            // Gamma and levels may fit alike.
            if (step.certainty == safe && finding.confidence < kSurely) step.certainty = likely;
            break;
        case straighten:
            // A channel that was changed leans, too, and leaves vectors that are not unit vectors. The other one of x
            // and y would lean more.
            if (finding.tone && z >= 0) {
                return {{finding.rule, undo_tone, likely, x, -1, {}, finding.tone},
                        {finding.rule, undo_tone, likely, y, -1, {}, finding.tone},
                        step};
            }
            if (has_rule(report, "N201")) return {};
            break;
        case normalize:
            if (z < 0) return {};
            // Vectors that contrast made longer were turned by it, too.
            if (finding.tone) return {{finding.rule, undo_tone, likely, -1, -1, {}, finding.tone}, step};
            break;
        case stretch_z:
            if (z < 0) return {};
            if (finding.confidence < kSurely) step.certainty = likely;
            break;
        default: break;
    }
    return {step};
}

std::vector<RepairStep> guesses_for(const Rule& rule, const CheckReport& report) {
    const int x = channel_of(report.swizzle, Component::x), z = channel_of(report.swizzle, Component::z);
    std::vector<RepairStep> steps;
    if (x < 0 || z < 0) return steps;
    const auto add = [&](RepairKind kind, int channel = -1, int other = -1) {
        steps.push_back({&rule, kind, likely, channel, other});
    };
    if (format_info(report.format).channels == 4) add(divide_by_alpha);
    add(exchange, std::min(x, z), std::max(x, z));
    add(encode_srgb);
    add(decode_srgb);
    add(invert, z);
    return steps;
}

std::optional<RepairStep> first_step(const Finding& finding, const CheckReport& report, const KnownOfMap& known) {
    for (const RuleRepair& row : kRepairs) {
        if (row.rule != finding.rule->id) continue;
        const std::vector<RepairStep> steps = steps_for(row, finding, report, known);
        if (!steps.empty()) return steps.front();
    }
    return std::nullopt;
}

std::optional<RepairStep> repair_of(const Finding& finding, const CheckReport& report, const CheckOptions& checks) {
    return first_step(finding, report, {checks.require.y.has_value()});
}

}  // namespace tex::inline v1
