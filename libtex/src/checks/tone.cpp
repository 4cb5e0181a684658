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
constexpr double kMostSpan = 0.95;                  // white - black
constexpr double kMostUneven = 0.02;                // of black and white from both ends
constexpr std::int64_t kLeastToneTexels = 64 * 64;  // in pixel art, chance makes any curve fit
constexpr std::int64_t kToneTexels = 1 << 14;

using ToneTexels = std::vector<std::array<double, 3>>;  // stored x, y and z

ToneTexels tone_texels(const Stored& stored, const Background* background) {
    const int x = stored.channel(Component::x), y = stored.channel(Component::y), z = stored.channel(Component::z);
    const auto& planes = stored.image->planes;
    const std::vector<Rect> windows = sample_windows(stored.extent());
    std::int64_t all = 0;
    for (const Rect& window : windows) all += std::int64_t{window.width} * window.height;
    // Odd, so that it does not follow columns of a map.
    const auto step = all > 7 * kToneTexels ? std::max<std::int64_t>(7, all / kToneTexels) | 1
                      : all > kToneTexels   ? 7
                                            : 1;
    ToneTexels texels;
    for (const Rect& window : windows) {
        for (std::int64_t k = 0; k < std::int64_t{window.width} * window.height; k += step) {
            const int i = window.x + static_cast<int>(k % window.width);
            const int j = window.y + static_cast<int>(k / window.width);
            if (background != nullptr && background->holds(i, j)) continue;
            const auto at = [&](int c) { return static_cast<double>(planes[static_cast<std::size_t>(c)].at(i, j)); };
            const std::array<double, 3> texel = {at(x), at(y), at(z)};
            const auto is_code = [](double c) { return c >= 0.0 && c <= 1.0; };
            if (std::all_of(texel.begin(), texel.end(), is_code)) texels.push_back(texel);
        }
    }
    return texels;
}

// How z was stored before levels were changed.
enum class ZForm { whole, inverted, from_zero };

// The mean distance, in codes, of z as it is stored from what the curve makes of the z of x and y. Where x and y leave
// the unit circle, they add how far.
double error_of(const ToneCurve& curve, const ToneTexels& texels, ZForm form = ZForm::whole) {
    double sum = 0.0;
    for (const auto& [x, y, z] : texels) {
        const double a = 2.0 * undone(curve, x) - 1.0, b = 2.0 * undone(curve, y) - 1.0;
        const double square = 1.0 - a * a - b * b;
        const double root = std::sqrt(std::max(0.0, square));
        const double before = form == ZForm::whole      ? 0.5 + 0.5 * root
                              : form == ZForm::inverted ? 0.5 - 0.5 * root
                                                        : root;
        const double expected = redone(curve, before);
        sum += std::abs(expected - z) + 0.5 * std::max(0.0, -square);
    }
    return 255.0 * sum / static_cast<double>(std::max<std::size_t>(1, texels.size()));
}

struct ToneCandidate {
    ToneCurve curve;
    double error = 1e9;
};

// Gamma, which the middle nearly states.
ToneCandidate best_gamma(double middle, const ToneTexels& texels) {
    ToneCandidate best;
    const double stated = math::log(0.5) / math::log(middle);
    for (int k = -6; k <= 6; ++k) {
        const ToneCurve curve{0.0, 1.0, stated * (1.0 + 0.005 * k)};
        const double off = 255.0 * std::abs(undone(curve, middle) - 0.5);
        const double error = error_of(curve, texels) + std::max(0.0, off - 0.6);
        if (error < best.error) best = {curve, error};
    }
    return best;
}

// Levels that put the middle where it is. Where z is cut off nearly everywhere, many contrasts fit; the least counts.
ToneCandidate best_levels(double middle, double as_stored, const ToneTexels& texels) {
    constexpr double kFrom = 1.3, kTo = 0.5, kStep = 0.01;
    std::vector<ToneCandidate> all;
    double least = 1e9;
    for (int k = 0; kFrom - kStep * k >= kTo; ++k) {
        const double span = kFrom - kStep * k;
        const ToneCurve curve{0.5 - span * middle, 0.5 - span * middle + span, 1.0};
        all.push_back({curve, error_of(curve, texels)});
        least = std::min(least, all.back().error);
    }
    const double most = least + 0.01 + 0.002 * as_stored;
    return *std::find_if(all.begin(), all.end(), [most](const ToneCandidate& one) { return one.error <= most; });
}

// z shows that there was a change, but many curves explain it about as well. The one that the codes speak for, if any;
// else the roundest of the same family, because people choose round numbers.
ToneCandidate sharpened(const ToneCandidate& best, const CombFit& in_codes, const std::vector<ToneCurve>& usual,
                        const ToneTexels& texels) {
    constexpr double kHint = 0.2, kAlike = 0.3, kAlikeCodes = 0.1;
    if (in_codes.score >= kHint) {
        const ToneCandidate found{in_codes.curve, error_of(in_codes.curve, texels)};
        if (found.error <= best.error * (1.0 + kAlike) + kAlikeCodes) return found;
    }
    constexpr double kAbout = 0.03, kAboutCodes = 0.03, kNear = 0.04;
    const double most = best.error * (1.0 + kAbout) + kAboutCodes;
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
        // Nobody stretches levels beyond their ends; then it may be a curve of the other family.
        if (is_alike ? !is_near : !is_beyond || roundness(curve) > 0) continue;
        const double error = error_of(curve, texels);
        if (error > most || (roundness(curve) == chosen_roundness && error >= chosen.error)) continue;
        chosen = {curve, error};
        chosen_roundness = roundness(curve);
    }
    return chosen;
}

// z may contradict what the codes show by so much, where vectors were no unit vectors before.
bool agrees(ToneCandidate& found, const ToneTexels& texels) {
    constexpr double kMostMore = 1.75;
    ZForm best = ZForm::whole;
    found.error = error_of(found.curve, texels);
    for (const ZForm form : {ZForm::inverted, ZForm::from_zero}) {
        const double error = error_of(found.curve, texels, form);
        if (error >= found.error) continue;
        found.error = error;
        best = form;
    }
    return found.error <= kMostMore * error_of({}, texels, best);
}

}  // namespace

double undone(const ToneCurve& curve, double c) {
    const double power = curve.gamma == 1.0 ? c : math::pow(c, curve.gamma);
    return curve.black + (curve.white - curve.black) * power;
}

double redone(const ToneCurve& curve, double c) {
    const double level = std::clamp((c - curve.black) / (curve.white - curve.black), 0.0, 1.0);
    return curve.gamma == 1.0 ? level : math::pow(level, 1.0 / curve.gamma);
}

std::optional<ToneFit> find_tone(const Stored& stored, const Centre& centre, const Background* background) {
    const double middle = (centre.x + centre.y) / 2.0, off = std::abs(middle - 0.5);
    const bool is_one_curve = off > kOffMiddle && off > std::abs(centre.x - centre.y);
    if (!is_one_curve || middle < 0.15 || middle > 0.85 || stored.extent().texels() < kLeastToneTexels)
        return std::nullopt;
    const ToneTexels texels = tone_texels(stored, background);
    const double as_stored = error_of({}, texels);
    const std::vector<ToneCurve> usual = usual_tones(centre);
    const CombFit in_codes = CodeComb(stored, background).best(usual);
    if (in_codes.is_proof()) {
        ToneCandidate found{in_codes.curve};
        if (agrees(found, texels)) return ToneFit{found.curve, as_stored, found.error, as_stored, true};
    }
    if (as_stored < kLeastToneError) return std::nullopt;
    const ToneCandidate gamma = best_gamma(middle, texels), levels = best_levels(middle, as_stored, texels);
    const bool is_gamma = gamma.error < levels.error;
    const ToneCandidate& best = is_gamma ? gamma : levels;
    if (best.error > as_stored / kToneLead) return std::nullopt;
    for (const double c : {centre.x, centre.y}) {
        if (std::abs(undone(best.curve, c) - 0.5) > kMiddleAfter) return std::nullopt;
    }
    const ToneCandidate chosen = sharpened(best, in_codes, usual, texels);
    return ToneFit{chosen.curve, as_stored, chosen.error, is_gamma ? levels.error : gamma.error};
}

std::optional<ToneFit> find_contrast(const Stored& stored, const Centre& centre, const Background* background) {
    if (centre.distance(0.5) > kOffMiddle || stored.extent().texels() < kLeastToneTexels) return std::nullopt;
    const ToneTexels texels = tone_texels(stored, background);
    const double as_stored = error_of({}, texels);
    std::vector<ToneCurve> usual = usual_tones(centre);
    std::erase_if(usual, [](const ToneCurve& curve) {
        return curve.gamma != 1.0 || std::abs(curve.black + curve.white - 1.0) > kMostUneven ||
               curve.white - curve.black > kMostSpan;
    });
    const CombFit in_codes = CodeComb(stored, background).best(usual);
    if (in_codes.is_proof()) {
        ToneCandidate found{in_codes.curve};
        if (agrees(found, texels)) return ToneFit{found.curve, as_stored, found.error, as_stored, true};
    }
    if (as_stored < kLeastContrastError) return std::nullopt;
    const ToneCandidate best = best_levels(0.5, as_stored, texels);
    const bool is_proven = best.error < kMostContrastError && best.error < as_stored / kContrastLead;
    if (!is_proven || best.curve.white - best.curve.black > kMostSpan) return std::nullopt;
    const ToneCandidate chosen = sharpened(best, in_codes, usual, texels);
    return ToneFit{chosen.curve, as_stored, chosen.error, as_stored};
}

int few_levels(const Stored& stored) {
    constexpr int kLeastDistance = 4, kLeastLevels = 6;
    int most = 0;
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        std::array<bool, 256> is_used{};
        // How many values there are, or 0 if two of them lie near to each other.
        const auto count_levels = [&is_used] {
            int levels = 0;
            for (int code = 0, last = -kLeastDistance; code < 256; ++code) {
                if (!is_used[static_cast<std::size_t>(code)]) continue;
                if (code - last < kLeastDistance) return 0;
                last = code;
                ++levels;
            }
            return levels;
        };
        int levels = 0;
        for (int j = 0; j < stored.extent().height; ++j) {
            for (int i = 0; i < stored.extent().width; ++i) {
                const float code = 255.0f * std::clamp(plane.at(i, j), 0.0f, 1.0f);
                is_used[static_cast<std::size_t>(code + 0.5f)] = true;
            }
            levels = count_levels();
            if (levels == 0) return 0;
        }
        if (levels < kLeastLevels) return 0;
        most = std::max(most, levels);
    }
    return most;
}

}  // namespace tex::inline v1
