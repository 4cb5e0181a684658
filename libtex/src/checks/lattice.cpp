// SPDX-License-Identifier: Apache-2.0

#include "checks/lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "checks/thresholds.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr int kSlopeBins = 2048;  // of slopes from -1/2 to 1/2
constexpr double kSlopeRange = 0.5;
constexpr double kLeastRate = 16.0;  // teeth per unit of slope
constexpr double kMostRate = 51.0;
constexpr double kRateStep = 0.25;
constexpr float kSteep = 2.0f;  // the other slope: there z has few codes of 8 bits, and quotients by them form a comb
constexpr double kLeastShare = 0.1;  // of the examined texels: a few gentle slopes in a steep map prove nothing
// Share of the examined texels that slope along both axes. Lines and bevels along the axes have few slopes, because
// all their profiles are the same, and few slopes fit some lattice.
constexpr double kLeastOblique = 0.025;
constexpr float kFlat = 0.015f;  // two codes of 8 bits

void add_slopes(const Plane<float>& slopes, const Plane<float>& across, std::vector<double>& bins) {
    const auto [width, height] = slopes.extent();
    for (int j = 0; j < height; ++j) {
        const float *const row = slopes.row(j), *const other = across.row(j);
        for (int i = 0; i < width; ++i) {
            const float s = row[i];
            if (!(std::abs(s) < static_cast<float>(kSlopeRange)) || std::abs(other[i]) > kSteep) continue;
            const auto bin = static_cast<int>((s + static_cast<float>(kSlopeRange)) * static_cast<float>(kSlopeBins));
            bins[static_cast<std::size_t>(std::clamp(bin, 0, kSlopeBins - 1))] += 1.0;
        }
    }
}

double count_oblique(const Slopes& slopes) {
    const auto slopes_gently = [](float s) {
        return std::abs(s) > kFlat && std::abs(s) < static_cast<float>(kSlopeRange);
    };
    double count = 0.0;
    for (int j = 0; j < slopes.extent().height; ++j) {
        for (int i = 0; i < slopes.extent().width; ++i)
            count += slopes_gently(slopes.p.at(i, j)) && slopes_gently(slopes.q.at(i, j)) ? 1.0 : 0.0;
    }
    return count;
}

double count(const std::vector<double>& bins) {
    double sum = 0.0;
    for (const double bin : bins) sum += bin;
    return sum;
}

// Subtracts the average over one period of the slowest comb, and removes slopes near 0, because a flat map is not a
// comb.
std::vector<double> detail_of(const std::vector<double>& bins) {
    constexpr int kRadius = static_cast<int>(kSlopeBins / kLeastRate / 2.0);
    std::vector<double> weighted(bins.size()), detail(bins.size());
    double total = 0.0;
    for (int k = 0; k < kSlopeBins; ++k) {
        const double s = (k + 0.5) / kSlopeBins - kSlopeRange;
        weighted[static_cast<std::size_t>(k)] =
            bins[static_cast<std::size_t>(k)] * (math::exp(-s * s / (0.2 * 0.2)) - math::exp(-s * s / (0.03 * 0.03)));
        total += weighted[static_cast<std::size_t>(k)];
    }
    for (int k = 0; k < kSlopeBins; ++k) {
        double sum = 0.0;
        int count = 0;
        for (int n = std::max(0, k - kRadius); n <= std::min(kSlopeBins - 1, k + kRadius); ++n, ++count) {
            sum += weighted[static_cast<std::size_t>(n)];
        }
        detail[static_cast<std::size_t>(k)] =
            total > 0.0 ? (weighted[static_cast<std::size_t>(k)] - sum / count) / total : 0.0;
    }
    return detail;
}

// How much of the detail lies at the teeth of a comb. It has a tooth at 0, so only the cosine is used, which is the
// same on both sides of 0. All angles are multiples of one, whose cosines are computed once: a small map would spend
// most of its time on them.
double comb_of(const std::vector<double>& detail, double rate) {
    constexpr int kAngles = static_cast<int>(2.0 * kSlopeBins / kRateStep);  // of a whole turn
    static const std::vector<double> cosines = [] {
        std::vector<double> all(kAngles);
        for (int k = 0; k < kAngles; ++k) all[static_cast<std::size_t>(k)] = math::cos(2.0 * math::kPi * k / kAngles);
        return all;
    }();
    const int turns = static_cast<int>(rate / kRateStep);
    double sum = 0.0;
    for (int k = 0; k < kSlopeBins / 2; ++k) {
        const int angle = turns * (kSlopeBins - 1 - 2 * k) % kAngles;  // the slope is half a bin off whole bins
        const double both = detail[static_cast<std::size_t>(k)] + detail[static_cast<std::size_t>(kSlopeBins - 1 - k)];
        sum += both * cosines[static_cast<std::size_t>(angle)];
    }
    return sum;
}

// The number of teeth at multiples of `step` other than 0 that hold at least 1 % of the total of all these teeth.
int count_teeth(const std::vector<double>& bins, double step) {
    std::vector<double> teeth(static_cast<std::size_t>(2.0 * kSlopeRange / step) + 3);
    double sum = 0.0;
    for (int k = 0; k < kSlopeBins; ++k) {
        const double s = (k + 0.5) / kSlopeBins - kSlopeRange;
        const double tooth = std::floor(s / step + 0.5);
        if (tooth == 0.0) continue;
        teeth[static_cast<std::size_t>(tooth + std::floor(kSlopeRange / step) + 1.0)] +=
            bins[static_cast<std::size_t>(k)];
        sum += bins[static_cast<std::size_t>(k)];
    }
    return static_cast<int>(
        std::count_if(teeth.begin(), teeth.end(), [&](double t) { return sum > 0.0 && t >= 0.01 * sum; }));
}

// Whether the map has many different squares of 8x8 texels. Structures that repeat have few, and few slopes fit some
// lattice.
bool is_varied(const Stored& stored) {
    constexpr std::size_t kLeastSquares = 64;
    constexpr int kSide = 8;
    std::unordered_set<std::uint64_t> squares;
    for (const Rect& window : sample_windows(stored.extent())) {
        const Slopes slopes = slopes_of(stored, window);
        for (int y = 0; y + kSide <= window.height; y += kSide) {
            for (int x = 0; x + kSide <= window.width; x += kSide) {
                std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a of 64 bits, a value at a time
                for (int j = y; j < y + kSide; ++j) {
                    for (int i = x; i < x + kSide; ++i) {
                        hash = (hash ^ std::bit_cast<std::uint32_t>(slopes.p.at(i, j))) * 0x100000001b3u;
                        hash = (hash ^ std::bit_cast<std::uint32_t>(slopes.q.at(i, j))) * 0x100000001b3u;
                    }
                }
                squares.insert(hash);
                if (squares.size() > kLeastSquares) return true;
            }
        }
    }
    return false;
}

// Counts the gentle slopes along the rows of `slopes`, or its columns, that differ from the mean of the slopes beside
// them by a quarter of `step`.
struct Evenness {
    double all = 0.0, uneven = 0.0;

    void add(const Plane<float>& slopes, bool columns, double step) {
        const int dx = columns ? 0 : 1, dy = columns ? 1 : 0;
        const auto [width, height] = slopes.extent();
        for (int j = dy; j + dy < height; ++j) {
            for (int i = dx; i + dx < width; ++i) {
                const float s = slopes.at(i, j);
                const float bend = slopes.at(i - dx, j - dy) - 2.0f * s + slopes.at(i + dx, j + dy);
                if (!(std::abs(s) > kFlat && std::abs(s) < static_cast<float>(kSlopeRange)) || !(bend == bend))
                    continue;
                all += 1.0;
                uneven += std::abs(bend) > 0.5f * static_cast<float>(step) ? 1.0 : 0.0;
            }
        }
    }
};

double uneven_share(const Stored& stored, double step) {
    Evenness sums;
    for (const Rect& window : sample_windows(stored.extent())) {
        const Slopes slopes = slopes_of(stored, window);
        sums.add(slopes.p, false, step);
        sums.add(slopes.q, true, step);
    }
    return sums.all > 0.0 ? sums.uneven / sums.all : 0.0;
}

}  // namespace

Lattice measure_lattice(const Stored& stored) {
    std::vector<double> bins_p(kSlopeBins), bins_q(kSlopeBins);
    double looked_at = 0.0, oblique = 0.0;
    for (const Rect& window : sample_windows(stored.extent())) {
        looked_at += static_cast<double>(window.width) * window.height;
        const Slopes slopes = slopes_of(stored, window);
        add_slopes(slopes.p, slopes.q, bins_p);
        add_slopes(slopes.q, slopes.p, bins_q);
        oblique += count_oblique(slopes);
    }
    Lattice lattice;
    if (std::min(count(bins_p), count(bins_q)) < kLeastShare * looked_at) return lattice;
    if (oblique < kLeastOblique * looked_at) return lattice;
    const std::vector<double> detail_p = detail_of(bins_p), detail_q = detail_of(bins_q);
    constexpr int kRates = static_cast<int>((kMostRate - kLeastRate) / kRateStep) + 1;
    for (int r = 0; r < kRates; ++r) {
        const double rate = kLeastRate + r * kRateStep;
        const double strength = std::min(comb_of(detail_p, rate), comb_of(detail_q, rate));
        if (strength > lattice.strength) lattice = {1.0 / rate, strength, 0.0, 0};
    }
    if (lattice.step > 0.0)
        lattice.teeth = std::min(count_teeth(bins_p, lattice.step), count_teeth(bins_q, lattice.step));
    if (lattice.strength > thresholds::kLatticeStrength && is_varied(stored))
        lattice.uneven = uneven_share(stored, lattice.step);
    return lattice;
}

}  // namespace tex::inline v1
