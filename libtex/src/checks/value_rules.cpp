// SPDX-License-Identifier: Apache-2.0

#include "checks/value_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "checks/background_fill.h"
#include "checks/centre.h"
#include "checks/comb.h"
#include "checks/context.h"
#include "checks/tone.h"
#include "checks/tone_text.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr double kOffLengthShare = 0.05;
constexpr double kBelowShare = 0.0005;
// Share of those with z below -0.1. Vectors that lie flat on the surface and were rounded or compressed have few there:
// 0.13 in a JPEG of wild4's half that sets thresholds, and 0.91 in its other map, which has an overhang.
constexpr double kFarBelow = 0.3;
constexpr double kBlueOff = 0.001;  // share of the vectors that a filler in blue makes longer than unit vectors
constexpr double kBeyondShare = 0.001;
constexpr double kNullShare = 0.0001;
constexpr double kNullShareBesideGrey = 0.002;  // if there is a background: what JPEG left of it far from its edge
constexpr double kLongMean = 1.06;              // of 520 maps of strangers the greatest is 1.052
constexpr double kFlatShare = 0.25;
constexpr std::int64_t kFlatLeast = 256;  // texels
constexpr double kLeanDegrees = 10.0;
constexpr double kMostEmpty = 0.1;   // of the codes of x and y: a contrast that cuts z off everywhere leaves more
constexpr double kLeastComb = 0.4;   // maps of few codes, whose histograms have gaps, too: at most 0.33
constexpr double kUnsure = 0.9;      // a confidence
constexpr float kVaries = 0.05f;     // of a stored channel: more than its rounding
constexpr float kSteepRange = 0.4f;  // of x or y as stored: z would vary by 10 codes

// Levels that were stretched on both sides alike leave x and y on the middle; z was cut off, and shows how far. Maps
// that lean have no middle, but the codes of 8 bits may show a curve.
void find_levels_of(const CheckContext& context, bool is_stretched, Finding& finding) {
    const Stored& stored = context.stored;
    if (!stored.has_z() || stored.is_signed || context.kind != Kind::normals) return;
    const Background* const background = context.background ? &*context.background : nullptr;
    const Centre centre = measure_centre(stored, background);
    const bool is_by_z = finding.rule->id == "N201";  // and not constant
    auto fit = is_stretched ? find_contrast(stored, centre, background) : std::nullopt;
    if (fit && !is_by_z && !fit->is_in_codes) return;
    if (!fit && is_by_z) fit = find_tone_in_codes(stored, centre, background);
    if (!fit) return;
    const ToneCurve& curve = fit->curve;
    finding.tone = curve;
    finding.message += std::string(is_by_z ? "; z fits x and y" : "; the codes of x and y show no gaps") +
                       (curve.gamma != 1.0 ? " if gamma " + decimal(curve.gamma, 2)
                                           : " if a contrast of " + decimal(1.0 / (curve.white - curve.black), 2)) +
                       " is taken back";
}

// A change of red or of green alone makes a map lean, and z no longer fits.
void find_tone_of_one(const CheckContext& context, Finding& finding) {
    const Stored& stored = context.stored;
    if (!stored.has_z() || stored.is_signed || context.kind != Kind::normals || has_free_lengths(context)) return;
    const Background* const background = context.background ? &*context.background : nullptr;
    const auto found = find_channel_tone(stored, measure_centre(stored, background), background);
    if (!found) return;
    const ToneCurve& curve = found->curve;
    finding.tone = curve;
    const std::string of = std::string(" of ") + "RGBA"[stored.channel(found->component)] + " alone";
    finding.message += "; vectors are unit vectors if " + curve_text(curve, of) + " taken back (z then differs by " +
                       decimal(found->error, 1) + " codes from what x and y imply, and by " +
                       decimal(found->as_stored, 1) + " as stored)";
}

// Whether x and y went through some contrast, whatever its numbers.
bool has_gaps_of_contrast(const CheckContext& context) {
    const CodeComb comb(context.stored, context.background ? &*context.background : nullptr);
    if (comb.share_empty() <= kMostEmpty) return false;
    const CombFit fit = comb.best(even_contrasts());
    return fit.score >= kLeastComb || fit.gaps > 0.0;
}

void check_lengths(const CheckContext& context, Findings& findings) {
    const TexelCounts& counts = context.counts;
    if (counts[Property::not_finite].count > 0)
        add_counted(context, findings, "N204", Property::not_finite, " are NaN or infinite");
    if (counts.share(Property::null_vector) >
        (context.background && context.background->texels > 0 ? kNullShareBesideGrey : kNullShare)) {
        add_counted(context, findings, "N205", Property::null_vector, " are shorter than 0.1");
    }
    if (!has_free_lengths(context) && counts.share(Property::off_length) > kOffLengthShare) {
        // Averages and interpolation make vectors shorter.
        constexpr float kStretched = 1.08f;
        const bool is_stretched = counts.mean_length > 1.0 && counts.max_length > kStretched;
        Finding& finding =
            add_counted(context, findings, "N201", Property::off_length,
                        " are off unit length by more than two codes (mean length " + decimal(counts.mean_length, 3) +
                            ", " + decimal(static_cast<double>(counts.min_length), 2) + " to " +
                            decimal(static_cast<double>(counts.max_length), 2) + ")");
        if (is_stretched) {
            finding.message += "; lengths above 1 come from contrast, levels and sharpening, which turn vectors, too";
        }
        if (counts.mean_length > kLongMean) findings.rate(finding, Severity::warning);
        find_levels_of(context, is_stretched, finding);
    }
    const double below = counts.share(Property::z_below);
    if (below > kBelowShare && counts.share(Property::z_behind) > kFarBelow * below) {
        constexpr float kOvershot = 1.15f;
        const bool is_sharpened = !has_free_lengths(context) && context.stored.has_z() &&
                                  counts.max_length > kOvershot && counts.share(Property::off_length) > kOffLengthShare;
        add_counted(
            context, findings, "N202", Property::z_below,
            " have z below zero" +
                (is_sharpened ? ", and vectors are up to " + decimal(static_cast<double>(counts.max_length), 2) +
                                    " long: sharpening and contrast overshoot so, and no repair brings back "
                                    "what was cut off"
                              : std::string()));
    }
    if (!context.stored.has_z() && counts.share(Property::beyond_unit) > kBeyondShare) {
        add_counted(context, findings, "N203", Property::beyond_unit, " have x^2 + y^2 above 1");
    }
}

Result<void> check_background(const CheckContext& context, Findings& findings) {
    if (!context.background || context.background->texels == 0 || !findings.wants("N215")) return {};
    const Background& background = *context.background;
    const Extent extent = context.stored.extent();
    const double share = static_cast<double>(background.texels) / static_cast<double>(extent.texels());
    Finding& finding = findings.add(
        "N215", percent(share) + " of the texels are background: " + background_name(background, context.stored) +
                    ", which is no normal; the first at " + texel_text(background.column, background.row));
    finding.figure = share;
    finding.unit = "share";
    set_texel(finding, background.column, background.row);
    const auto harm = harm_of_filling(context.stored, background, context.execution);
    if (!harm) return harm.error();
    if (harm->is_any()) finding.fix_harms = harm->text();
    return {};
}

void check_means(const CheckContext& context, Findings& findings) {
    const TexelCounts& counts = context.counts;
    const double lean = std::sqrt(counts.mean_x * counts.mean_x + counts.mean_y * counts.mean_y);
    const double angle = math::atan(lean / std::max(counts.mean_z, 1e-6)) * 180.0 / math::kPi;
    if (angle > kLeanDegrees) {
        Finding& finding =
            findings.add("N207", "the mean normal leans by " + decimal(angle, 1) + " degrees, towards x " +
                                     decimal(counts.mean_x, 3) + ", y " + decimal(counts.mean_y, 3));
        finding.figure = angle;
        finding.unit = "degrees";
        find_tone_of_one(context, finding);
    }
    const Tally &low = counts[Property::flat_low], &high = counts[Property::flat_high];
    const bool is_low = low.count > high.count;
    const Tally &most = is_low ? low : high, &least = is_low ? high : low;
    const double share = static_cast<double>(most.count) / static_cast<double>(counts.texels);
    if (counts.texels >= kFlatLeast && share > kFlatShare && least.count * 20 < most.count) {
        Finding& finding =
            findings.add("N208", percent(share) + " of the texels are flat as (" + (is_low ? "127, 127" : "128, 128") +
                                     "), which leans by 0.32 degrees");
        finding.figure = share;
        finding.unit = "share";
    }
}

void check_channels(const CheckContext& context, Findings& findings) {
    const TexelCounts& counts = context.counts;
    const Stored& stored = context.stored;
    const auto range = [&](int channel) {
        return counts.high[static_cast<std::size_t>(channel)] - counts.low[static_cast<std::size_t>(channel)];
    };
    const int cx = stored.channel(Component::x), cy = stored.channel(Component::y), cz = stored.channel(Component::z);
    const auto is_filler = [&] {
        const float varies = std::max(range(cx), range(cy));
        if (!has_free_lengths(context) && counts.share(Property::off_length) < kBlueOff) return false;
        if (range(cz) == 0.0f) return varies > 2.0f * kVaries;
        return stored.in_blocks && range(cz) <= kBlockError && varies > kSteepRange;
    };
    if (cz >= 0 && is_filler()) {
        const float blue = counts.low[static_cast<std::size_t>(cz)];
        Finding& finding = findings.add("N209", "blue is " + decimal(static_cast<double>(blue), 3) + " everywhere");
        if (blue == 1.0f) find_levels_of(context, true, finding);  // which may have cut all of z off
        if (blue == 1.0f && !finding.tone && has_gaps_of_contrast(context)) {
            finding.confidence = kUnsure;
            finding.message += ", and the histograms of x and y have gaps, as after a contrast that cut z off";
            finding.fix_harms = "z that is rebuilt from x and y of too great a contrast makes vectors worse";
        }
    }
    if (counts[Property::red_not_one].count > 0) {
        add_counted(context, findings, "N211", Property::red_not_one, " have R below 255");
    }
    // The option for the layout says that alpha holds something else.
    if (counts[Property::alpha_not_one].count > 0 && !context.options.swizzle) {
        add_counted(context, findings, "N212", Property::alpha_not_one, " have A below 255");
    }
}

}  // namespace

Result<void> check_value_rules(const CheckContext& context, Findings& findings) {
    if (format_info(context.texture.format).channels == 1) findings.add("N210", "the file has one channel alone");
    if (!context.has_vectors) return {};
    if (context.constant && context.counts.texels > 1) {
        findings.add("N206", "every texel is the same as the first").unit = "";
    }
    if (auto done = check_background(context, findings); !done) return done;
    check_lengths(context, findings);
    check_means(context, findings);
    check_channels(context, findings);
    return {};
}

}  // namespace tex::inline v1
