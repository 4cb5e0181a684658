// SPDX-License-Identifier: Apache-2.0
// comb.h: what a change of levels leaves in the histogram: codes that no texel has, and codes of twice as many.

#pragma once

#include <array>
#include <vector>

#include <tex/check.h>

#include "checks/background.h"
#include "checks/centre.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// 256 codes went through a curve and were rounded again, so that a code of the result stands for none, one or several
// of them. Where the counts of neighbouring codes differ as these numbers do, the curve is known, whatever the vectors
// look like. (Stamm, Liu: Forensic detection of image manipulation using statistical intrinsic fingerprints, 2010.)
struct CombFit {
    ToneCurve curve;
    double score = 0.0;  // a correlation
    int codes = 0;       // over so many codes of x and y
    // Codes that the curve makes of no other one, and that no texel has: how unlikely chance leaves them, as the
    // logarithm of its share.
    double gaps = 0.0;

    // Chance reaches 0.42 in maps of few codes, and the correlation times the root of their number 5.1.
    [[nodiscard]] bool is_correlated() const;  // beyond chance
    [[nodiscard]] bool is_proof() const;
};

class CodeComb {
public:
    static constexpr int kCodes = 256;
    using Counts = std::array<double, kCodes>;

    // Counts the codes of x and y. If these are no codes of 8 bits, and 16 bits hold no 256 values that were, no curve
    // fits.
    CodeComb(const Stored& stored, const Background* background);

    [[nodiscard]] CombFit fit(const ToneCurve& curve) const;
    // How the curve of sRGB fits, encoding or decoding. The curve in the result means nothing.
    [[nodiscard]] CombFit fit_srgb(bool is_encoded) const;
    // The share of codes, from the first to the last that is used, that no texel has although many have those about
    // them: more than a few in a hundred are left by a contrast above 1, whichever it was.
    [[nodiscard]] double share_empty() const;
    // Whether enough codes are used, and at most this share of those between is not, that any contrast would show.
    [[nodiscard]] bool is_smooth(double most_empty = 0.02) const;
    // The best of these.
    [[nodiscard]] CombFit best(const std::vector<ToneCurve>& curves) const;

private:
    [[nodiscard]] CombFit fit_shares(const ToneCurve& curve, const Counts& rounded, const Counts& cut) const;
    [[nodiscard]] double correlation(const Counts& shares) const;
    [[nodiscard]] double gap_evidence(const Counts& shares) const;
    void collect_values(const Stored& stored, const Background* background, const Plane<float>* alpha);
    template <class Undo>
    [[nodiscard]] CombFit fit_values(const ToneCurve& curve, Undo&& undo) const;

    struct Channel {
        std::array<double, kCodes> relative{};  // the count of a code over the mean about it
        std::array<bool, kCodes> counts{};      // whether there are enough texels
        std::array<bool, kCodes> is_empty{};    // whether no texel has it
    };
    std::array<Channel, 2> channels_;
    std::vector<double> values_;  // of 16 bits
    int codes_ = 0;
};

inline constexpr double kUsualMiddle = 0.02;

// Curves with which people change levels, that bring both medians to the middle, or `most_off` from it: gamma in
// hundredths and their inverses; factors and shifts of brightness in percent; levels in percent and in codes of 8
// bits.
[[nodiscard]] std::vector<ToneCurve> usual_tones(const Centre& centre, double most_off = kUsualMiddle);

// Contrasts of any size that leave the middle where it is.
[[nodiscard]] std::vector<ToneCurve> even_contrasts();

// How round the numbers of such a curve are: 0 for gamma in tenths and for levels in steps of 5 % at one end or at both
// alike, 1 for a factor in steps of 5 %. Not for lightness.
[[nodiscard]] int roundness(const ToneCurve& curve);

}  // namespace tex::inline v1
