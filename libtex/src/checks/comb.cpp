// SPDX-License-Identifier: Apache-2.0

#include "checks/comb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "checks/tone_texels.h"
#include "checks/tone_text.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr int kCombRadius = 6;          // of the mean about a code
constexpr double kLeastCombMean = 8.0;  // texels
constexpr double kMostRelative = 2.5;   // flat texels alone are no comb
constexpr int kCombEnds = 3;            // cut off codes gather at the ends
constexpr double kHalf = 0.5, kCut = 1e-6;
constexpr double kLeastGaps = 16.0;  // of some thousand curves, chance suits none
constexpr double kLeastCombScore = 0.3, kLeastCombProof = 6.0;
constexpr double kLeastOpaque = 0.05;  // share of texels

using CombCounts = CodeComb::Counts;

// Neighbours often have the same code, and a processor waits for a count that it has just changed.
using CombTables = std::array<std::array<std::int64_t, CodeComb::kCodes>, 4>;

// Counts the codes of 8 bits in a row. False if a value is none.
bool count_codes(const float* row, int texels, std::vector<std::uint8_t>& codes, CombTables& counts) {
    constexpr float kOnCode = 1e-3f;
    constexpr float kShift = 12582912.0f;  // 1.5 * 2^23: the sum has the whole number nearby in its last bits
    codes.resize(static_cast<std::size_t>(texels));
    std::uint8_t* const to = codes.data();
    int on = 1;
    for (int i = 0; i < texels; ++i) {
        const float value = row[i], code = 255.0f * value, whole = (code + kShift) - kShift;
        on &= (value >= 0.0f) & (value <= 1.0f) & (std::abs(code - whole) <= kOnCode);  // 0 for NaN
    }
    if (on == 0) return false;
    for (int i = 0; i < texels; ++i)
        to[i] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(255.0f * row[i] + kShift));
    int i = 0;
    for (; i + 4 <= texels; i += 4) {
        ++counts[0][to[i]];
        ++counts[1][to[i + 1]];
        ++counts[2][to[i + 2]];
        ++counts[3][to[i + 3]];
    }
    for (; i < texels; ++i) ++counts[0][to[i]];
    return true;
}

// The mean about each code; the ends are mirrored.
CombCounts means_about(const CombCounts& counts) {
    CombCounts means{};
    for (int code = 0; code < CodeComb::kCodes; ++code) {
        double sum = 0.0;
        for (int k = code - kCombRadius; k <= code + kCombRadius; ++k) {
            const int inside = k < 0 ? -k : k >= CodeComb::kCodes ? 2 * CodeComb::kCodes - 2 - k : k;
            sum += counts[static_cast<std::size_t>(inside)];
        }
        means[static_cast<std::size_t>(code)] = sum / (2 * kCombRadius + 1);
    }
    return means;
}

// How many codes become each one. Programs add `half`, a half of a code, or cut off what is behind the point
// (ImageMagick 6).
template <class Redo>
CombCounts shares_of(Redo&& redo, double half) {
    CombCounts shares{};
    for (int code = 0; code < CodeComb::kCodes; ++code)
        shares[static_cast<std::size_t>(255.0 * std::clamp(redo(code / 255.0), 0.0, 1.0) + half)] += 1.0;
    const CombCounts means = means_about(shares);
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] = means[k] > 0.0 ? shares[k] / means[k] : 0.0;
    return shares;
}

double share_of_ones(const Plane<float>& alpha) {
    double ones = 0.0;
    for (int j = 0; j < alpha.extent().height; ++j) {
        const float* const row = alpha.row(j);
        ones += static_cast<double>(std::count(row, row + alpha.extent().width, 1.0f));
    }
    return ones / static_cast<double>(alpha.extent().texels());
}

// From the darkest code that a curve makes to the one after the lightest. What lies beyond shows where a map ends, and
// nothing about the curve.
std::pair<std::size_t, std::size_t> made_codes(const CombCounts& shares) {
    const auto is_used = [](double share) { return share > 0.0; };
    const auto first = std::find_if(shares.begin(), shares.end(), is_used) - shares.begin();
    const auto last = std::find_if(shares.rbegin(), shares.rend(), is_used) - shares.rbegin();
    return {static_cast<std::size_t>(first), shares.size() - static_cast<std::size_t>(last)};
}

bool is_multiple(double value, double of) { return std::abs(value / of - std::floor(value / of + 0.5)) < 1e-6; }

}  // namespace

bool CombFit::is_correlated() const {
    return score >= kLeastCombScore && score * std::sqrt(static_cast<double>(codes)) >= kLeastCombProof;
}

bool CombFit::is_proof() const { return gaps >= kLeastGaps || is_correlated(); }

CodeComb::CodeComb(const Stored& stored, const Background* background) {
    const Extent extent = stored.extent();
    // What was divided by alpha was rounded twice.
    const auto& planes = stored.image->planes;
    const Plane<float>* alpha = planes.size() == 4 && stored.channel(Component::x) != 3 ? &planes[3] : nullptr;
    if (alpha != nullptr && share_of_ones(*alpha) < kLeastOpaque) alpha = nullptr;
    int number = 0;
    std::vector<std::uint8_t> codes;
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        CombTables texels{};
        for (int j = 0; j < extent.height; ++j) {
            const float *const row = plane.row(j), *const alphas = alpha != nullptr ? alpha->row(j) : nullptr;
            if (background == nullptr && alphas == nullptr) {
                if (count_codes(row, extent.width, codes, texels)) continue;
                collect_values(stored, background, alpha);
                return;
            }
            for (int i = 0; i < extent.width; ++i) {
                if (background != nullptr && background->holds(i, j)) continue;
                if (alphas != nullptr && alphas[i] < 1.0f) continue;
                const float code = 255.0f * row[i];
                const int whole = code >= 0.0f && code <= 255.0f ? static_cast<int>(code + 0.5f) : -1;
                if (whole < 0 || std::abs(code - static_cast<float>(whole)) > 1e-3f) {
                    collect_values(stored, background, alpha);
                    return;
                }
                ++texels[0][static_cast<std::size_t>(whole)];
            }
        }
        CombCounts counts{};
        for (const auto& table : texels)
            std::transform(table.begin(), table.end(), counts.begin(), counts.begin(),
                           [](std::int64_t n, double sum) { return sum + static_cast<double>(n); });
        const CombCounts means = means_about(counts);
        Channel& channel = channels_[static_cast<std::size_t>(number++)];
        for (std::size_t k = kCombEnds; k + kCombEnds < counts.size(); ++k) {
            channel.counts[k] = means[k] >= kLeastCombMean;
            if (!channel.counts[k]) continue;
            channel.is_empty[k] = counts[k] == 0.0;
            channel.relative[k] = std::min(counts[k] / means[k], kMostRelative);
            ++codes_;
        }
    }
}

// What was stored with 8 bits, changed and stored with 16 has few values, and the right curve makes codes of 8 bits of
// all of them.
void CodeComb::collect_values(const Stored& stored, const Background* background, const Plane<float>* alpha) {
    constexpr float kTop = 65535.0f, kOnCode = 0.02f;
    codes_ = 0;
    for (const Component component : {Component::x, Component::y}) {
        const Plane<float>& plane = stored.image->planes[static_cast<std::size_t>(stored.channel(component))];
        std::vector<bool> is_used(static_cast<std::size_t>(kTop) + 1);
        int used = 0;
        for (int j = 0; j < stored.extent().height; ++j) {
            for (int i = 0; i < stored.extent().width; ++i) {
                if ((background != nullptr && background->holds(i, j)) || (alpha != nullptr && alpha->at(i, j) < 1.0f))
                    continue;
                const float code = kTop * plane.at(i, j);
                if (!(code >= 0.0f && code <= kTop)) return values_.clear();
                const auto whole = static_cast<std::size_t>(code + 0.5f);
                if (std::abs(code - static_cast<float>(whole)) > kOnCode) return values_.clear();
                if (is_used[whole]) continue;
                is_used[whole] = true;
                if (++used > kCodes) return values_.clear();
            }
        }
        // Values at the ends may have been cut off.
        for (std::size_t k = 1; k + 1 < is_used.size(); ++k) {
            if (is_used[k]) values_.push_back(static_cast<double>(k) / static_cast<double>(kTop));
        }
    }
    if (fit_values({}, [](double c) { return c; }).score > 0.0) values_.clear();  // codes of 8 bits as they are
    codes_ = static_cast<int>(values_.size());
}

template <class Undo>
CombFit CodeComb::fit_values(const ToneCurve& curve, Undo&& undo) const {
    constexpr double kLeastOnCodes = 0.8;  // the mean cosine: chance makes 0.1 of it
    double sum = 0.0;
    for (const double value : values_) sum += math::cos(2.0 * math::kPi * 255.0 * undo(value));
    const double mean = values_.empty() ? 0.0 : sum / static_cast<double>(values_.size());
    return {curve, mean < kLeastOnCodes ? 0.0 : mean, codes_};
}

CombFit CodeComb::fit(const ToneCurve& curve) const {
    if (!values_.empty()) return fit_values(curve, [&](double c) { return undone(curve, c); });
    if (codes_ == 0 || is_shift(curve)) return {curve};  // a shift leaves no gaps
    const auto redo = [&](double c) { return redone(curve, c); };
    return fit_shares(curve, shares_of(redo, kHalf), shares_of(redo, kCut));
}

CombFit CodeComb::fit_srgb(bool is_encoded) const {
    if (!values_.empty()) return fit_values({}, is_encoded ? srgb_decoded : srgb_encoded);
    if (codes_ == 0) return {};
    const auto redo = is_encoded ? srgb_encoded : srgb_decoded;
    return fit_shares({}, shares_of(redo, kHalf), shares_of(redo, kCut));
}

CombFit CodeComb::fit_shares(const ToneCurve& curve, const Counts& rounded, const Counts& cut) const {
    return {curve, std::max(correlation(rounded), correlation(cut)), codes_,
            std::max(gap_evidence(rounded), gap_evidence(cut))};
}

// A histogram may be rough, but one texel in a gap shows that there is none. Where few values are used at all, gaps
// show nothing, and neither do codes beyond the darkest and the lightest.
double CodeComb::gap_evidence(const Counts& shares) const {
    constexpr double kCostOfFilled = 6.0, kMostByChance = 0.35;
    const auto [first, end] = made_codes(shares);
    double empty = 0.0, filled = 0.0, empty_elsewhere = 0.0, elsewhere = 0.0;
    for (const Channel& channel : channels_) {
        for (std::size_t k = first; k < end; ++k) {
            if (!channel.counts[k]) continue;
            const double is_empty = channel.is_empty[k] ? 1.0 : 0.0;
            (shares[k] == 0.0 ? empty : empty_elsewhere) += is_empty;
            (shares[k] == 0.0 ? filled : elsewhere) += shares[k] == 0.0 ? 1.0 - is_empty : 1.0;
        }
    }
    const double by_chance = (empty_elsewhere + 0.5) / (elsewhere + 1.0);
    return by_chance > kMostByChance ? 0.0 : -empty * math::log(by_chance) - kCostOfFilled * filled;
}

double CodeComb::correlation(const Counts& shares) const {
    const auto [first, end] = made_codes(shares);
    double product = 0.0, squares = 0.0, squares_of_shares = 0.0;
    for (const Channel& channel : channels_) {
        double mean = 0.0, mean_share = 0.0, n = 0.0;
        for (std::size_t k = first; k < end; ++k) {
            if (!channel.counts[k]) continue;
            mean += channel.relative[k];
            mean_share += shares[k];
            n += 1.0;
        }
        if (n == 0.0) continue;
        for (std::size_t k = first; k < end; ++k) {
            if (!channel.counts[k]) continue;
            const double a = channel.relative[k] - mean / n, b = shares[k] - mean_share / n;
            product += a * b;
            squares += a * a;
            squares_of_shares += b * b;
        }
    }
    const double root = std::sqrt(squares * squares_of_shares);
    return root > 0.0 ? product / root : 0.0;
}

double CodeComb::share_empty() const {
    std::size_t empty = 0, codes = 0;
    for (const Channel& channel : channels_) {
        const auto is_used = [&channel](std::size_t k) { return channel.counts[k] && !channel.is_empty[k]; };
        std::size_t first = 0, end = kCodes;
        while (first < end && !is_used(first)) ++first;
        while (end > first && !is_used(end - 1)) --end;
        for (std::size_t k = first; k < end; ++k) {
            codes += channel.counts[k] ? 1 : 0;
            empty += channel.is_empty[k] ? 1 : 0;
        }
    }
    return codes > 0 ? static_cast<double>(empty) / static_cast<double>(codes) : 0.0;
}

bool CodeComb::is_smooth(double most_empty) const {
    constexpr int kLeastCodes = 20;
    return values_.empty() && codes_ >= kLeastCodes && share_empty() <= most_empty;
}

CombFit CodeComb::best(const std::vector<ToneCurve>& curves) const {
    CombFit best;
    if (codes_ == 0) return best;
    // There are many more numbers that are not round, so that chance finds one of them sooner.
    const double cost = 0.5 / std::sqrt(static_cast<double>(codes_));
    constexpr double kCostOfGaps = 3.0;
    double most = -2.0, most_gaps = kLeastGaps;
    CombFit by_gaps;
    for (const ToneCurve& curve : curves) {
        const CombFit one = fit(curve);
        const double score = one.score - cost * roundness(curve), gaps = one.gaps - kCostOfGaps * roundness(curve);
        if (gaps >= most_gaps) {
            most_gaps = gaps;
            by_gaps = one;
        }
        if (score <= most) continue;
        most = score;
        best = one;
    }
    return by_gaps.codes > 0 && !best.is_correlated() ? by_gaps : best;
}

std::vector<ToneCurve> usual_tones(const Centre& centre, double most_off) {
    std::vector<ToneCurve> curves;
    const auto add = [&](const ToneCurve& curve) {
        for (const double c : {centre.x, centre.y}) {
            if (std::abs(undone(curve, c) - 0.5) > most_off) return;
        }
        curves.push_back(curve);
    };
    const auto is_identity = [](double gamma) { return std::abs(gamma - 1.0) < 0.025; };
    for (int k = 40; k <= 250; ++k) {
        if (!is_identity(k / 100.0)) add({0.0, 1.0, k / 100.0});
        if (k % 5 == 0 && !is_identity(100.0 / k)) add({0.0, 1.0, 100.0 / k});
    }
    for (int k = 50; k <= 150; ++k) {  // darkened, and lightened
        if (k < 98 || k > 102) add({0.0, 100.0 / k, 1.0});
    }
    // Brightness shifts all values.
    for (int k = 1; k <= 30; ++k) {
        add({-k / 100.0, 1.0 - k / 100.0, 1.0});
        add({k / 100.0, 1.0 + k / 100.0, 1.0});
    }
    for (int k = 1; k <= 76; ++k) {
        add({-k / 255.0, 1.0 - k / 255.0, 1.0});
        add({k / 255.0, 1.0 + k / 255.0, 1.0});
    }
    // People set levels in percent or codes, and cut little off. Programs that stretch a picture to its own darkest and
    // lightest codes make any contrast of maps that are nearly flat.
    constexpr double kLeastByPeople = 0.5, kLeastSpan = 0.2, kMiddle = 0.48;
    for (const int top : {100, 255}) {
        const double least = top * (top == 100 ? kLeastByPeople : kLeastSpan);
        const int darkest = static_cast<int>(top * (top == 100 ? 0.4 : kMiddle));
        for (int black = 0; black <= darkest; ++black) {
            for (int white = top - darkest; white <= top; ++white) {
                if ((black == 0 && white == top) || white - black < least) continue;
                if (top == 255 && black % 51 == 0 && white % 51 == 0) continue;  // in percent, too
                add({static_cast<double>(black) / top, static_cast<double>(white) / top, 1.0});
            }
        }
    }
    return curves;
}

std::vector<ToneCurve> even_contrasts() {
    std::vector<ToneCurve> curves;
    for (int k = 500; k < 980; ++k) curves.push_back({0.5 - 0.0005 * k, 0.5 + 0.0005 * k, 1.0});
    return curves;
}

int roundness(const ToneCurve& curve) {
    if (curve.gamma != 1.0) {
        const auto is_round = [&](double step) {
            return is_multiple(curve.gamma, step) || is_multiple(1.0 / curve.gamma, step);
        };
        return is_round(0.1) ? 0 : is_round(0.05) ? 1 : 2;
    }
    const bool is_plain = curve.black == 0.0 || curve.white == 1.0 || std::abs(curve.black + curve.white - 1.0) < 1e-9;
    const auto is_round = [&](double step) { return is_multiple(curve.black, step) && is_multiple(curve.white, step); };
    if (std::abs(curve.white - curve.black - 1.0) < 1e-9)
        return is_multiple(curve.black, 0.05) ? 0 : is_multiple(curve.black, 0.01) ? 1 : 2;
    if (is_round(0.05)) return is_plain ? 0 : 1;
    if (curve.black == 0.0 && is_multiple(1.0 / curve.white, 0.05)) return 1;  // a factor
    return is_round(0.01) && is_plain ? 1 : 2;
}

}  // namespace tex::inline v1
