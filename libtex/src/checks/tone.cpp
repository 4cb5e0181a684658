// SPDX-License-Identifier: Apache-2.0

#include "checks/tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "checks/comb.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// Chosen on the maps of wild4, none of which was held back. Of 24 intact maps from elsewhere, gamma 1.2 and 0.8 are
// found in 16 each, levels from 10 % up in 16, and levels up to 90 % in 22; none is taken for changed as it is.
constexpr double kOffMiddle = 0.02;      // five codes: rounding moves medians by one
constexpr double kLeastToneError = 0.7;  // codes, as stored: rounding alone makes 0.3
constexpr double kToneLead = 1.6;        // of the error as stored over that with the curve
constexpr double kMiddleAfter = 0.02;
constexpr double kContrastLead = 3.0;
constexpr double kLeastContrastError = 1.5, kMostContrastError = 1.5;
constexpr double kLeastUncut = 0.05;                // share of texels whose z tells contrasts apart
constexpr double kSureScore = 0.8;                  // of the histogram of 8 bits, wherever z is
constexpr double kFarOffMiddle = 0.028;             // maps of slopes to one side are off by less
constexpr double kMostSpan = 0.95;                  // white - black
constexpr double kMostUneven = 0.02;                // of black and white from both ends
constexpr std::int64_t kLeastToneTexels = 64 * 64;  // in pixel art, chance makes any curve fit
struct ToneCandidate {
    ToneCurve curve;
    double error = 1e9;
    ZForm form = ZForm::whole;
};

// Gamma, which the middle nearly states.
ToneCandidate best_gamma(double middle, const ToneTexels& texels, ZForm form) {
    ToneCandidate best;
    const double stated = math::log(0.5) / math::log(middle);
    for (int k = -6; k <= 6; ++k) {
        const ToneCurve curve{0.0, 1.0, stated * (1.0 + 0.005 * k)};
        const double off = 255.0 * std::abs(undone(curve, middle) - 0.5);
        const double error = error_of(curve, texels, form) + std::max(0.0, off - 0.6);
        if (error < best.error) best = {curve, error, form};
    }
    return best;
}

// Lightness, which the middle states nearly: flat texels are as light as (c, c, 1), and others go other ways. People
// choose whole percents, and mostly steps of five.
ToneCandidate best_lightness(double middle, const ToneTexels& texels) {
    constexpr int kRange = 6, kStep = 5;  // percents
    constexpr double kAlike = 1.3, kAlikeCodes = 0.1;
    const int stated = static_cast<int>(100.0 * (1.0 + middle) / 1.5 + 0.5);
    std::vector<ToneCandidate> all;
    for (int percent = stated - kRange; percent <= stated + kRange; ++percent) {
        const ToneCurve curve{0.0, 1.0, 1.0, percent / 100.0};
        if (percent != 100) all.push_back({curve, error_of(curve, texels), ZForm::whole});
    }
    ToneCandidate best;
    const auto take_if = [&](auto&& is_one, double most) {
        for (const ToneCandidate& one : all) {
            if (!is_one(one) || one.error >= most) continue;
            most = one.error;
            best = one;
        }
    };
    take_if([](const ToneCandidate&) { return true; }, 1e9);
    take_if([](const ToneCandidate& one) { return static_cast<int>(100.0 * one.curve.lightness + 0.5) % kStep == 0; },
            kAlike * best.error + kAlikeCodes);
    return best;
}

// The middle of x or y once a curve is undone. Of lightness, that is not what becomes of the middle.
double middle_after(const ToneCurve& curve, const Centre& centre, const ToneTexels& texels, std::size_t channel) {
    if (curve.lightness == 1.0) return undone(curve, channel == 0 ? centre.x : centre.y);
    std::vector<double> values;
    for (const ToneTexel& texel : texels) values.push_back(undone(curve, texel)[channel]);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.empty() ? 0.5 : *middle;
}

constexpr double kMostLevels = 1.3, kLeastLevels = 0.5, kLevelsStep = 0.01;  // white - black

// A curve that would go on to fit better if it could.
bool is_at_limit(const ToneCurve& curve) {
    return curve.gamma == 1.0 && curve.white - curve.black < kLeastLevels + 1.5 * kLevelsStep;
}

// Levels that put the middle where it is. Where z is cut off nearly everywhere, many contrasts fit; the least counts.
ToneCandidate best_levels(double middle, double as_stored, const ToneTexels& texels, ZForm form) {
    std::vector<ToneCandidate> all;
    double least = 1e9;
    // Darkened by more, black stays where it is.
    if (const double white = 0.5 / middle; white > kMostLevels) {
        const ToneCurve curve{0.0, white, 1.0};
        all.push_back({curve, error_of(curve, texels, form), form});
        least = all.back().error;
    }
    for (int k = 0; kMostLevels - kLevelsStep * k >= kLeastLevels; ++k) {
        const double span = kMostLevels - kLevelsStep * k;
        const ToneCurve curve{0.5 - span * middle, 0.5 - span * middle + span, 1.0};
        all.push_back({curve, error_of(curve, texels, form), form});
        least = std::min(least, all.back().error);
    }
    const double most = least + 0.01 + 0.002 * as_stored;
    return *std::find_if(all.begin(), all.end(), [most](const ToneCandidate& one) { return one.error <= most; });
}

// Where z is cut off in many texels, many contrasts explain it. If the histogram denies all of them, what moved the
// middle was a shift, as of brightness; people choose whole percents.
std::optional<ToneCandidate> shift_instead(const ToneCandidate& best, double middle, const ToneTexels& texels,
                                           const CodeComb& comb) {
    constexpr double kMostEmpty = 0.02, kMostEmptyOfRound = 0.05;  // a factor of 1.1 leaves 0.09
    constexpr double kAlike = 0.3, kAlikeCodes = 0.1, kCode = 1.0 / 255.0;
    const auto shifted = [](double by) { return ToneCurve{-by, 1.0 - by, 1.0}; };
    const double by = middle - 0.5;
    const auto rounded = [by](double step) { return step * std::floor(by / step + 0.5); };
    double chosen = rounded(kCode);
    if (std::abs(rounded(0.01) - by) <= 0.7 * kCode) chosen = rounded(0.01);
    const bool is_round = std::abs(rounded(0.05) - by) <= 1.5 * kCode;
    if (is_round) chosen = rounded(0.05);
    if (!comb.is_smooth(is_round ? kMostEmptyOfRound : kMostEmpty)) return std::nullopt;
    const ToneCurve curve = shifted(chosen);
    if (best.form != ZForm::whole || best.curve.gamma != 1.0) return std::nullopt;
    const double error = error_of(curve, texels);
    if (error > best.error * (1.0 + kAlike) + kAlikeCodes) return std::nullopt;
    return ToneCandidate{curve, error, ZForm::whole};
}

// z shows that there was a change, but many curves explain it about as well. The one that the codes speak for, if any;
// else the roundest of the same family, because people choose round numbers.
ToneCandidate sharpened(const ToneCandidate& best, const CombFit& in_codes, const std::vector<ToneCurve>& usual,
                        const ToneTexels& texels) {
    constexpr double kHint = 0.2, kAlike = 0.3, kAlikeCodes = 0.1;
    if (in_codes.score >= kHint) {
        const ToneCandidate found{in_codes.curve, error_of(in_codes.curve, texels, best.form), best.form};
        if (found.error <= best.error * (1.0 + kAlike) + kAlikeCodes) return found;
    }
    constexpr double kAbout = 0.03, kAboutCodes = 0.03, kNear = 0.04;
    const double most = best.error * (1.0 + kAbout) + kAboutCodes;
    const double most_beyond = best.error * (1.0 + kAlike) + kAlikeCodes;
    const bool is_gamma = best.curve.gamma != 1.0;
    const bool is_beyond = best.curve.black < -0.01 || best.curve.white > 1.01;
    ToneCandidate chosen = best;
    int chosen_roundness = roundness(best.curve) + 1;
    for (const ToneCurve& curve : usual) {
        if (roundness(curve) > chosen_roundness) continue;
        const bool is_alike = (curve.gamma != 1.0) == is_gamma;
        const bool is_near = std::abs(curve.gamma - best.curve.gamma) <= kNear &&
                             std::abs(curve.black - best.curve.black) <= kNear &&
                             std::abs(curve.white - best.curve.white) <= kNear;
        // It may be a round curve of the other family, the more so as hardly anybody stretches levels beyond their
        // ends.
        if (is_alike ? !is_near : roundness(curve) > 0) continue;
        const double error = error_of(curve, texels, best.form);
        if (error > (is_alike || !is_beyond ? most : most_beyond) ||
            (roundness(curve) == chosen_roundness && error >= chosen.error))
            continue;
        chosen = {curve, error, best.form};
        chosen_roundness = roundness(curve);
    }
    return chosen;
}

// The curve and the form of z that fit best, and the error of the best curve of another family. The usual form is
// taken unless another fits much better, and gamma or levels unless lightness does.
struct BestTone {
    ToneCandidate gamma, levels, lightness;
    [[nodiscard]] bool is_gamma() const { return gamma.error < levels.error; }
    [[nodiscard]] const ToneCandidate& best_of_channels() const { return is_gamma() ? gamma : levels; }
    [[nodiscard]] bool is_lightness() const {
        constexpr double kLead = 0.7;
        return lightness.error < kLead * best_of_channels().error;
    }
    [[nodiscard]] const ToneCandidate& best() const { return is_lightness() ? lightness : best_of_channels(); }
    [[nodiscard]] double other() const {
        return is_lightness() ? best_of_channels().error : is_gamma() ? levels.error : gamma.error;
    }
};

BestTone best_of_forms(double middle, bool with_gamma, const ToneTexels& texels) {
    constexpr double kFormLead = 2.0;
    BestTone chosen;
    for (const ZForm form : possible_forms(texels)) {
        BestTone one;
        if (with_gamma) one.gamma = best_gamma(middle, texels, form);
        if (with_gamma && form == ZForm::whole) one.lightness = best_lightness(middle, texels);
        one.levels = best_levels(middle, error_of({}, texels, form), texels, form);
        const double lead = form == ZForm::from_zero ? kFormLead : 1.0;
        if (lead * one.best().error < chosen.best().error) chosen = one;
    }
    return chosen;
}

// Whether z allows what the codes show. A histogram keeps the traces of all that was ever done to a map, also of levels
// that its maker set and that nobody wants back, so that z decides where vectors are unit vectors by some curve; where
// they are by none, the curve must not make them worse.
bool agrees(ToneCandidate& found, const ToneTexels& texels, const ToneCandidate& best, double as_stored) {
    constexpr double kFits = 1.5, kMostMore = 1.75, kMostMoreCodes = 0.5;  // codes
    constexpr double kMostMoreOfCut = 2.0, kMostMoreCodesOfCut = 0.1;
    const double least = best.error;
    found.error = error_of(found.curve, texels);
    for (const ZForm form : {ZForm::inverted, ZForm::from_zero}) {
        const double error = error_of(found.curve, texels, form);
        if (error < found.error) {
            found.error = error;
            found.form = form;
        }
    }
    // Where it cuts z off nearly everywhere, z says nothing for it, and may say much for another curve.
    const auto is_cut = [&](const auto& one) { return share_uncut(one.curve, texels, one.form) < kLeastUncut; };
    if (found.error > kMostMoreOfCut * least + kMostMoreCodesOfCut && is_cut(found) && !is_cut(best)) return false;
    const bool is_strict = least < kFits || roundness(found.curve) > 1;
    return found.error <= (is_strict ? kMostMore * least + kMostMoreCodes : as_stored);
}

double least_error(const ToneTexels& texels) {
    double least = 1e9;
    for (const ZForm form : possible_forms(texels)) least = std::min(least, error_of({}, texels, form));
    return least;
}

// What the codes show beyond doubt, wherever the middle is, if it does not make z worse: of maps whose vectors were no
// unit vectors, or that lean.
std::optional<ToneFit> sure_tone(const CodeComb& comb, const Centre& centre, const ToneTexels& texels,
                                 double as_stored) {
    constexpr double kFarOff = 0.06;
    std::vector<ToneCurve> round = usual_tones(centre, kFarOff);
    std::erase_if(round, [](const ToneCurve& curve) { return roundness(curve) > 1; });
    const CombFit in_codes = comb.best(round);
    if (!in_codes.is_proof() || in_codes.score < kSureScore) return std::nullopt;
    const ZForm form = likeliest_form(in_codes.curve, texels);
    const double error = error_of(in_codes.curve, texels, form);
    if (error > as_stored) return std::nullopt;
    return ToneFit{in_codes.curve, as_stored, error, as_stored, true};
}

// A contrast leaves the same gaps with some other brightness, and numbers that are not round say nothing against it.
// The one that brings x and y nearest to the middle.
ToneCurve nearest_middle(const CombFit& found, const CodeComb& comb, const Centre& centre) {
    constexpr int kMostShift = 8;  // codes
    constexpr double kAlike = 0.05;
    ToneCurve best = found.curve;
    if (best.gamma != 1.0 || roundness(best) < 2) return best;
    const auto off = [&](const ToneCurve& curve) {
        return std::abs(undone(curve, centre.x) - 0.5) + std::abs(undone(curve, centre.y) - 0.5);
    };
    for (int k = -kMostShift; k <= kMostShift; ++k) {
        const ToneCurve curve{found.curve.black + k / 255.0, found.curve.white + k / 255.0, 1.0};
        if (off(curve) >= off(best)) continue;
        const CombFit fit = comb.fit(curve);
        if (fit.is_proof() && fit.score >= found.score - kAlike) best = curve;
    }
    return best;
}

}  // namespace

std::optional<ToneFit> find_tone(const Stored& stored, const Centre& centre, const Background* background) {
    const double middle = (centre.x + centre.y) / 2.0, off = std::abs(middle - 0.5);
    const bool is_one_curve = off > kOffMiddle && off > std::abs(centre.x - centre.y);
    if (!is_one_curve || middle < 0.15 || middle > 0.85 || stored.extent().texels() < kLeastToneTexels)
        return std::nullopt;
    const ToneTexels texels = tone_texels(stored, background);
    if (has_coarse_middle(texels, middle)) return std::nullopt;
    const double as_stored = least_error(texels);
    const std::vector<ToneCurve> usual = usual_tones(centre);
    const CodeComb comb(stored, background);
    // Where z is cut off nearly everywhere, the middle alone shows the curve.
    const auto shows = [&](const ToneCurve& curve, ZForm form) {
        return off > kFarOffMiddle || share_uncut(curve, texels, form) >= kLeastUncut;
    };
    const CombFit in_codes = comb.best(usual);
    if (as_stored < kLeastToneError && !in_codes.is_proof()) return sure_tone(comb, centre, texels, as_stored);
    const BestTone fits = best_of_forms(middle, true, texels);
    if (in_codes.is_proof()) {
        ToneCandidate found{nearest_middle(in_codes, comb, centre)};
        const bool is_shown = shows(found.curve, found.form) || in_codes.score >= kSureScore;
        if (is_shown && agrees(found, texels, fits.best(), as_stored)) {
            // Codes show a contrast, and which brightness went with it only as far as that is a round number.
            const bool is_cut = share_uncut(found.curve, texels, found.form) < kLeastUncut &&
                                (roundness(found.curve) > 1 || off <= kFarOffMiddle);
            return ToneFit{found.curve, as_stored, found.error, as_stored, true, is_cut};
        }
    }
    if (const auto sure = sure_tone(comb, centre, texels, as_stored)) return sure;
    if (as_stored < kLeastToneError) return std::nullopt;
    const ToneCandidate& best = fits.best();
    if (best.error > as_stored / kToneLead || is_at_limit(best.curve)) return std::nullopt;
    for (const std::size_t c : {std::size_t{0}, std::size_t{1}}) {
        if (std::abs(middle_after(best.curve, centre, texels, c) - 0.5) > kMiddleAfter) return std::nullopt;
    }
    if (fits.is_lightness()) return ToneFit{best.curve, as_stored, best.error, fits.other()};
    const auto shift = in_codes.is_correlated() ? std::nullopt : shift_instead(best, middle, texels, comb);
    const ToneCandidate chosen = shift ? *shift : sharpened(best, in_codes, usual, texels);
    if (!shows(chosen.curve, chosen.form)) return std::nullopt;
    const bool is_cut = share_uncut(chosen.curve, texels, chosen.form) < kLeastUncut;
    return ToneFit{chosen.curve, as_stored, chosen.error, fits.other(), false, is_cut};
}

double least_tone_error(const Centre& centre, const ToneTexels& texels) {
    return best_of_forms((centre.x + centre.y) / 2.0, true, texels).best().error;
}

std::optional<ToneFit> find_contrast(const Stored& stored, const Centre& centre, const Background* background) {
    if (centre.distance(0.5) > kOffMiddle || stored.extent().texels() < kLeastToneTexels) return std::nullopt;
    const ToneTexels texels = tone_texels(stored, background);
    const double as_stored = least_error(texels);
    std::vector<ToneCurve> usual = usual_tones(centre);
    // Where z is left, it decides among the usual ones.
    const auto is_one = [](const std::array<double, 3>& texel) { return texel[2] == 1.0; };
    if (std::all_of(texels.begin(), texels.end(), is_one)) {
        for (const ToneCurve& curve : even_contrasts()) usual.push_back(curve);
    }
    std::erase_if(usual, [](const ToneCurve& curve) {
        return curve.gamma != 1.0 || std::abs(curve.black + curve.white - 1.0) > kMostUneven ||
               curve.white - curve.black > kMostSpan;
    });
    const CombFit in_codes = CodeComb(stored, background).best(usual);
    if (as_stored < kLeastContrastError && !in_codes.is_proof()) return std::nullopt;
    const ToneCandidate best = best_of_forms(0.5, false, texels).levels;
    if (in_codes.is_proof()) {
        ToneCandidate found{in_codes.curve};
        // Where z is cut off nearly everywhere, it contradicts no contrast.
        const bool is_sure =
            in_codes.score >= kSureScore || share_uncut(found.curve, texels, found.form) >= kLeastUncut;
        if (is_sure && agrees(found, texels, best, as_stored))
            return ToneFit{found.curve, as_stored, found.error, as_stored, true};
    }
    if (as_stored < kLeastContrastError) return std::nullopt;
    const bool is_proven = best.error < kMostContrastError && best.error < as_stored / kContrastLead;
    if (!is_proven || is_at_limit(best.curve) || best.curve.white - best.curve.black > kMostSpan) return std::nullopt;
    const ToneCandidate chosen = sharpened(best, in_codes, usual, texels);
    if (share_uncut(chosen.curve, texels, chosen.form) < kLeastUncut) return std::nullopt;
    return ToneFit{chosen.curve, as_stored, chosen.error, as_stored};
}

std::optional<ToneFit> find_tone_in_codes(const Stored& stored, const Centre& centre, const Background* background) {
    constexpr double kFarOff = 0.12, kClearScore = 0.45, kBetter = 0.8;
    if (stored.extent().texels() < kLeastToneTexels) return std::nullopt;
    const ToneTexels texels = tone_texels(stored, background);
    const double as_stored = least_error(texels);
    if (as_stored < kLeastToneError) return std::nullopt;
    std::vector<ToneCurve> round = usual_tones(centre, kFarOff);
    std::erase_if(round, [](const ToneCurve& curve) { return roundness(curve) > 1; });
    const CombFit in_codes = CodeComb(stored, background).best(round);
    if (!in_codes.is_proof() || in_codes.score < kClearScore) return std::nullopt;
    const ZForm form = likeliest_form(in_codes.curve, texels);
    const double error = error_of(in_codes.curve, texels, form);
    if (error > kBetter * as_stored) return std::nullopt;
    return ToneFit{in_codes.curve, as_stored, error, as_stored, true};
}

std::optional<ChannelTone> find_channel_tone(const Stored& stored, const Centre& centre, const Background* background) {
    constexpr double kOff = 0.03;  // of one channel; the other is nearer than kOffMiddle
    constexpr double kCode = 1.0 / 255.0;
    const double off_x = std::abs(centre.x - 0.5), off_y = std::abs(centre.y - 0.5);
    if (std::max(off_x, off_y) < kOff || std::min(off_x, off_y) > kOffMiddle) return std::nullopt;
    const std::size_t changed = off_x > off_y ? 0 : 1;
    const double middle = changed == 0 ? centre.x : centre.y;
    if (middle < 0.15 || middle > 0.85 || stored.extent().texels() < kLeastToneTexels) return std::nullopt;
    const ToneTexels texels = tone_texels(stored, background);
    ChannelTone found{changed == 0 ? Component::x : Component::y, {}, error_of({}, texels), 0.0};
    if (found.as_stored < kLeastToneError) return std::nullopt;
    const auto error_with = [&](const ToneCurve& curve) {
        ToneTexels undone_texels = texels;
        for (auto& texel : undone_texels) texel[changed] = undone(curve, texel[changed]);
        return error_of({}, undone_texels);
    };
    double least = 1e9;
    const auto take = [&](const ToneCurve& curve, double most) {
        const double error = error_with(curve);
        if (error >= most) return;
        found.curve = curve;
        least = found.error = error;
    };
    for (int k = -4; k <= 4; ++k) {
        const double at = middle + 0.5 * k * kCode;
        take({0.0, 1.0, math::log(0.5) / math::log(at)}, least);
        take({0.5 - at, 1.5 - at, 1.0}, least);
        take({0.0, 0.5 / at, 1.0}, least);
        take({(0.5 - at) / (1.0 - at), 1.0, 1.0}, least);
    }
    if (found.error > found.as_stored / kToneLead || found.error > kMostContrastError) return std::nullopt;
    // People choose round numbers.
    if (const double gamma = found.curve.gamma; gamma != 1.0) {
        constexpr double kStep = 0.05, kAlike = 1.05, kAlikeCodes = 0.03;
        const double most = kAlike * least + kAlikeCodes;
        const double round = kStep * std::floor(1.0 / gamma / kStep + 0.5);
        take({0.0, 1.0, 1.0 / round}, most);
    }
    return found;
}

}  // namespace tex::inline v1
