// SPDX-License-Identifier: Apache-2.0

#include "checks/curve_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "checks/auto_levels.h"
#include "checks/comb.h"
#include "checks/context.h"
#include "checks/lengths.h"
#include "checks/thresholds.h"
#include "checks/tone.h"
#include "checks/tone_texels.h"
#include "checks/tone_text.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// Thresholds that follow from the nature of the damage and need no fitting.
constexpr double kOffCentre = 0.03;
constexpr double kLikelyLevels = 0.9;                   // a confidence
constexpr double kPlainPower = 2.2;                     // which many programs have in place of the curve of sRGB
constexpr double kLeastDarkened = 0.94;                 // nearer to 1, flat maps with short vectors look alike
constexpr double kUnitAfterDivision = 0.05;             // the mean error of the lengths
constexpr double kFormError = 1.0;                      // codes, of z that was stored in another form
constexpr std::int64_t kLeastDarkenedTexels = 16 * 16;  // a number that suits a few colours can always be found

// The number by which most vectors are unit vectors if their values are divided by it: |2 c / f - 1| = 1.
double unit_factor(const Stored& stored) {
    std::vector<double> factors;
    visit_samples(stored, [&](const double(&c)[3], int, int) {
        const double sum = c[0] + c[1] + c[2], squares = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
        const double root = sum * sum - 2.0 * squares;
        if (root >= 0.0 && sum > 0.0) factors.push_back(2.0 * squares / (sum + std::sqrt(root)));
    });
    if (factors.empty()) return 1.0;
    const auto middle = factors.begin() + static_cast<std::ptrdiff_t>(factors.size() / 2);
    std::nth_element(factors.begin(), middle, factors.end());
    return *middle;
}

// People darken by round shares. The number that the histogram of 8 bits shows, else one of twentieths that is near.
double rounded_factor(const CheckContext& context, double factor) {
    constexpr double kAbout = 0.03, kNear = 0.012, kRound = 0.05;
    std::vector<ToneCurve> usual;
    for (int k = 10; k < 100; ++k) {
        if (std::abs(k / 100.0 - factor) <= kAbout) usual.push_back({0.0, 100.0 / k, 1.0});
    }
    for (int k = 25; k < 255; ++k) {
        if (std::abs(k / 255.0 - factor) <= kAbout) usual.push_back({0.0, 255.0 / k, 1.0});
    }
    const Background* const background = context.background ? &*context.background : nullptr;
    if (const CombFit fit = CodeComb(context.stored, background).best(usual); fit.is_proof())
        return 1.0 / fit.curve.white;
    const double round = kRound * std::floor(factor / kRound + 0.5);
    return std::abs(round - factor) <= kNear ? round : factor;
}

// All channels multiplied by one number: where an opacity was flattened on black, or a picture darkened. Then dividing
// by it makes the vectors unit vectors, and x and y centre on half of it, not on the middle, on which those of maps
// with short vectors do. The curve of sRGB moves the centre as well, but leaves 1 where it is. Returns whether it was
// found.
bool check_darkened(const CheckContext& context, const Centre& centre, Findings& findings) {
    if (channel_like_z(context.stored) < 0 || centre.distance(0.5) < kOffCentre) return false;
    if (context.stored.extent().texels() < kLeastDarkenedTexels) return false;
    const Background* const background = context.background ? &*context.background : nullptr;
    const ToneTexels texels = tone_texels(context.stored, background);
    const double by_centre = std::min(1.0, centre.x + centre.y);
    const ZForm form = by_centre > 0.0 ? likeliest_form(ToneCurve{0.0, 1.0 / by_centre, 1.0}, texels) : ZForm::whole;
    // Lengths of vectors show the number only if z was stored as usual.
    const double measured = form == ZForm::whole ? unit_factor(context.stored) : by_centre;
    if (measured > kLeastDarkened || centre.distance(measured / 2.0) > centre.distance(0.5) / 2.0) return false;
    const double factor = rounded_factor(context, measured);
    const double as_stored = length_error(context.stored, [](double c, int, int) { return c; });
    const double decoded =
        length_error(context.stored, [](double c, int, int) { return srgb_encoded(std::clamp(c, 0.0, 1.0)); });
    const double divided = length_error(context.stored, [&](double c, int, int) { return c / factor; });
    if (form == ZForm::whole) {
        if (divided > kUnitAfterDivision || divided > as_stored / 2.0 || divided > decoded) return false;
    } else {
        const bool is_srgb = centre.distance(srgb_decoded(0.5)) < thresholds::kDarkCentre;
        if (is_srgb || error_of(ToneCurve{0.0, 1.0 / factor, 1.0}, texels, form) > kFormError) return false;
    }
    Finding& finding =
        findings.add("N313", "vectors are unit vectors if all channels are divided by " + decimal(factor, 2) +
                                 "; x and y centre on " + decimal(255.0 * centre.x, 0) + " and " +
                                 decimal(255.0 * centre.y, 0) + " of 255 instead of 128");
    finding.figure = factor;
    finding.unit = "ratio";
    finding.confidence = 0.99;
    finding.tone = ToneCurve{0.0, 1.0 / factor, 1.0};
    return true;
}

// Levels of each channel by itself.
bool check_auto_levels(const CheckContext& context, const Centre& centre, Findings& findings) {
    if (!context.stored.has_z() || context.kind != Kind::normals || !context.sampled_ok || has_free_lengths(context))
        return false;
    const auto found = find_auto_levels(context, centre);
    if (!found) return false;
    std::string levels;
    constexpr std::array kComponents{Component::x, Component::y, Component::z};
    for (std::size_t k = 0; k < kComponents.size(); ++k) {
        const ToneCurve& curve = found->curves[k];
        levels += (levels.empty() ? "" : ", ") + std::string(1, "RGBA"[context.stored.channel(kComponents[k])]) + " " +
                  decimal(100.0 * curve.black, 0) + " % to " + decimal(100.0 * curve.white, 0) + " %";
    }
    Finding& finding = findings.add(
        "N314",
        "each channel reaches from 0 to 255, as automatic levels make it, and vectors are unit vectors if these "
        "are taken back: " +
            levels + " (z then differs by " + decimal(found->error, 1) + " codes from what x and y imply, and by " +
            decimal(found->as_stored, 1) + " as stored)");
    finding.confidence = kLikelyLevels;
    finding.tones = found->curves;
    return true;
}

// A change of levels that is neither the curve of sRGB nor a darkening: it moves x and y off the middle, and one curve
// brings them back and makes vectors unit vectors.
bool check_tone(const CheckContext& context, const Centre& centre, Findings& findings) {
    if (!context.stored.has_z() || context.kind != Kind::normals || !context.sampled_ok || has_free_lengths(context))
        return false;
    const auto fit = find_tone(context.stored, centre, context.background ? &*context.background : nullptr);
    if (!fit) return false;
    const ToneCurve& curve = fit->curve;
    const bool is_gamma = curve.gamma != 1.0;
    // Nor may it bring them off the middle, apart from what its contrast makes of their distance: a change of x and y
    // alone fits some shift of all three.
    constexpr double kAway = 2.5 / 255.0;
    const Centre without{undone(curve, centre.x), undone(curve, centre.y)};
    const bool is_lightness = curve.lightness != 1.0;
    const double contrast = is_gamma ? 1.0 : 1.0 / (curve.white - curve.black);
    if (!fit->is_in_codes && !is_lightness && without.distance(0.5) > contrast * centre.distance(0.5) + kAway)
        return false;
    Finding& finding = findings.add("N314", "vectors are unit vectors if " + curve_text(curve) +
                                                " taken back (z then differs by " + decimal(fit->error, 1) +
                                                " codes from what x and y imply, and by " + decimal(fit->as_stored, 1) +
                                                " as stored); x and y centre on " + decimal(255.0 * centre.x, 0) +
                                                " and " + decimal(255.0 * centre.y, 0) + " of 255 instead of 128");
    const bool is_brightness = is_shift(curve);
    finding.figure = is_lightness ? curve.lightness : is_gamma ? curve.gamma : is_brightness ? -curve.black : contrast;
    finding.unit = is_lightness ? "lightness" : is_gamma ? "gamma" : is_brightness ? "brightness" : "contrast";
    // Gamma and levels look alike in maps that are nearly flat, and then either leaves little.
    // A change of x and y alone fits no curve of all three by more than some codes.
    // Nor does a change of another kind, as of saturation or of each channel by itself. Rounding alone makes 0.3 codes.
    constexpr double kClearlyBetter = 0.7, kMostError = 1.0, kClear = 0.99, kUnclear = 0.9;
    const bool is_clear = fit->is_in_codes || (fit->error < kMostError && fit->error < kClearlyBetter * fit->other &&
                                               roundness(curve) <= 1);
    // x and y that were cut off do not come back, however sure the numbers are.
    constexpr double kMostCut = 0.01;  // share of the texels
    const Background* const background = context.background ? &*context.background : nullptr;
    const double cut = share_cut(curve, tone_texels(context.stored, background));
    finding.confidence = is_clear && !fit->is_cut && cut <= kMostCut ? kClear : kUnclear;
    if (cut > kMostCut) {
        finding.message += "; x or y was cut off in " + percent(cut) + " of the texels, where no repair brings it back";
    }
    if (fit->is_cut) finding.message += "; z was cut off nearly everywhere, and does not confirm these numbers";
    finding.tone = curve;
    return true;
}

double power_of_middle() { return math::pow(0.5, 1.0 / kPlainPower); }

// What made a map light whose middle lies nearer to a plain power of 2.2, which image editors call gamma 2.2, than to
// the curve of sRGB, two codes above it: the histogram shows it, or vectors are nearer to unit length without it.
enum class LightCurve { srgb, power, unknown };

LightCurve light_curve(const CheckContext& context, const Centre& centre) {
    if (centre.distance(power_of_middle()) >= centre.distance(srgb_encoded(0.5))) return LightCurve::srgb;
    const CodeComb comb(context.stored, context.background ? &*context.background : nullptr);
    const CombFit power = comb.fit({0.0, 1.0, kPlainPower}), srgb = comb.fit_srgb(true);
    const auto beats = [](const CombFit& one, const CombFit& other) {
        return one.is_proof() && std::pair(one.gaps, one.score) > std::pair(other.gaps, other.score);
    };
    if (beats(power, srgb)) return LightCurve::power;
    if (beats(srgb, power)) return LightCurve::srgb;
    if (!context.stored.has_z()) return LightCurve::unknown;
    const auto clamped = [](double c) { return std::clamp(c, 0.0, 1.0); };
    constexpr double kLead = 0.95;  // of 40 maps that went through the curve of sRGB, the least is 0.98
    const double with_power =
        length_error(context.stored, [&](double c, int, int) { return math::pow(clamped(c), kPlainPower); });
    const double with_srgb = length_error(context.stored, [&](double c, int, int) { return srgb_decoded(clamped(c)); });
    return with_power < kLead * with_srgb ? LightCurve::power : LightCurve::unknown;
}

// What else may have moved the middle nearly as far as the curve of sRGB does: brightness, lightness, levels. z tells.
// Of 36 maps that went through the curve, those whose z another curve explains better have at most 2.5 codes of error
// with the curve of sRGB, or at least 0.5 of it with the other one.
struct OtherTone {
    bool is_known = false;  // another curve fits so much better that it is the one
    bool is_likely = true;  // the curve of sRGB is not proved
};

OtherTone other_tone(const CheckContext& context, const Centre& centre, bool is_light) {
    constexpr double kLead = 0.4;
    constexpr double kNear = 4.0 / 255.0, kLeastError = 0.6, kMostOfNear = 2.5;  // errors in codes
    const Background* const background = context.background ? &*context.background : nullptr;
    const ToneTexels texels = tone_texels(context.stored, background);
    const double by_srgb = error_of_srgb(is_light, texels), least = least_tone_error(centre, texels);
    const bool is_near = centre.distance(is_light ? srgb_encoded(0.5) : srgb_decoded(0.5)) <= kNear;
    OtherTone other;
    other.is_known = by_srgb > (is_near ? kMostOfNear : kLeastError) && least < kLead * by_srgb &&
                     find_tone(context.stored, centre, background);
    // The figures are in tests/bench/VERDICTS.md.
    constexpr double kMostOfSure = 1.2;
    const CombFit in_codes = CodeComb(context.stored, background).fit_srgb(is_light);
    other.is_likely = !in_codes.is_proof() && !(is_near && by_srgb <= kMostOfSure);
    return other;
}

// Whether the curve of sRGB explains z if it was inverted, or stored from 0 to 1, before. A plain power of 2.2, or its
// inverse, explains it nearly as well; where the curve is steep, rounding alone makes errors of z, and the histogram
// decides.
bool is_srgb_of_other_z(const CheckContext& context, const Centre& centre, bool is_light) {
    constexpr double kMostError = 1.2, kNearly = 1.2;  // codes, and a ratio
    const Background* const background = context.background ? &*context.background : nullptr;
    const ToneTexels texels = tone_texels(context.stored, background);
    double error = std::numeric_limits<double>::infinity();
    for (const ZForm form : possible_forms(texels)) {
        if (form != ZForm::whole) error = std::min(error, error_of_srgb(is_light, texels, form));
    }
    const auto other = find_tone(context.stored, centre, background);
    if (error < kMostError && (!other || error < other->error)) return true;
    if (!other || error > kNearly * other->error) return false;
    const CodeComb comb(context.stored, background);
    const CombFit srgb = comb.fit_srgb(is_light);
    return srgb.is_proof() && srgb.score > comb.fit(other->curve).score;
}

}  // namespace

void check_curve(const CheckContext& context, const Centre& centre, Findings& findings) {
    if (context.stored.is_signed || check_auto_levels(context, centre, findings) ||
        check_darkened(context, centre, findings))
        return;
    const bool dark = centre.distance(srgb_decoded(0.5)) < thresholds::kDarkCentre;
    const bool light = centre.distance(srgb_encoded(0.5)) < thresholds::kLightCentre;
    if (!dark && !light) {
        check_tone(context, centre, findings);
        return;
    }
    bool is_sure = true, is_of_other_z = false;
    if (context.stored.has_z()) {
        const double as_stored = length_error(context.stored, [](double c, int, int) { return c; });
        const double restored = length_error(context.stored, [&](double c, int, int) {
            return dark ? srgb_encoded(std::clamp(c, 0.0, 1.0)) : srgb_decoded(std::clamp(c, 0.0, 1.0));
        });
        const bool is_shorter = restored < as_stored;
        const OtherTone other = is_shorter ? other_tone(context, centre, light) : OtherTone{true};
        is_of_other_z = other.is_known && is_srgb_of_other_z(context, centre, light);
        // The curve leaves z of 1 where it is, and x and y that vary would have another z: a contrast cut it off.
        const auto z = static_cast<std::size_t>(context.stored.channel(Component::z));
        const bool is_cut = dark && context.counts.low[z] == 1.0f && restored > kUnitAfterDivision;
        if (!is_of_other_z && (is_cut || !is_shorter)) {
            check_tone(context, centre, findings);
            return;
        }
        if (!is_of_other_z && other.is_known && check_tone(context, centre, findings)) return;
        is_sure = is_of_other_z || !other.is_likely;
    }
    const LightCurve made_light = light && !is_of_other_z ? light_curve(context, centre) : LightCurve::srgb;
    const bool is_power = made_light == LightCurve::power;
    // Where neither z nor the histogram tells them apart, the middle speaks for the power.
    if (made_light == LightCurve::unknown) is_sure = false;
    Finding& finding =
        findings.add(dark ? "N301" : "N302", "x and y centre on " + decimal(255.0 * centre.x, 0) + " and " +
                                                 decimal(255.0 * centre.y, 0) + " of 255 instead of 128");
    finding.figure = (centre.x + centre.y) / 2.0;
    finding.unit = "of full scale";
    finding.confidence = is_sure ? 0.99 : 0.9;
    if (!is_sure) finding.message += "; z does not confirm the curve: other levels may have made it so";
    if (is_power) {
        finding.message += "; gamma " + decimal(kPlainPower, 1) + " fits better than the curve of sRGB itself";
        finding.tone = ToneCurve{0.0, 1.0, kPlainPower};
    }
}

}  // namespace tex::inline v1
