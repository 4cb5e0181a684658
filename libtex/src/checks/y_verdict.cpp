// SPDX-License-Identifier: Apache-2.0

#include "checks/y_verdict.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "checks/findings.h"

namespace tex::inline v1 {
namespace {

// A neighbourhood of 3x3 regions counts as clear if its correlation is at least kLeastCorrelation and at least the
// share kLeastAgreement of its evidence agrees.
constexpr double kLeastAgreement = 0.8;
constexpr std::size_t kLeastNeighbours = 4;
constexpr double kLeastEnergy = 0.25;  // of the energy of the median neighbourhood
constexpr double kMixedShare = 0.08;   // of the clear neighbourhoods
constexpr std::size_t kMixedRegions = 3;
// Maps from meshes with overhangs (chains, grips, glass) have slopes of no height field, and regions of either sign by
// chance. There the correlations are small, or few regions are clear.
constexpr double kClearCorrelation = 0.5;  // the median of the clear neighbourhoods
constexpr double kClearShare = 0.5;        // of the neighbourhoods that have details

struct Neighbourhood {
    const CurlRegion* centre = nullptr;
    std::size_t regions = 0;
    CurlSums sums;
    double agreeing = 0.0, evidence = 0.0;  // sums of cross and of |cross| over the regions
};

// The neighbourhoods at the scale at which regions are clearest, each taken separately.
std::vector<Neighbourhood> neighbourhoods_of(const Curl& curl) {
    int scale = 0;
    double most = -1.0;
    for (int k = 0; k < kCurlScales; ++k) {
        double evidence = 0.0, energy = 0.0;
        for (const CurlRegion& region : curl.regions) {
            evidence += std::abs(region.scale[k].cross);
            energy += std::sqrt(region.scale[k].p_square * region.scale[k].q_square);
        }
        if (energy > 0.0 && evidence / energy > most) {
            most = evidence / energy;
            scale = k;
        }
    }
    std::vector<Neighbourhood> all;
    for (const CurlRegion& centre : curl.regions) {
        Neighbourhood n;
        n.centre = &centre;
        for (const CurlRegion& other : curl.regions) {
            const bool near = std::abs(other.rect.x - centre.rect.x) <= centre.rect.width &&
                              std::abs(other.rect.y - centre.rect.y) <= centre.rect.height;
            if (!near) continue;
            ++n.regions;
            n.sums.add(other.scale[scale]);
            n.agreeing += other.scale[scale].cross;
            n.evidence += std::abs(other.scale[scale].cross);
        }
        all.push_back(n);
    }
    return all;
}

// Regions whose neighbourhood clearly shows the direction of green.
struct Votes {
    std::vector<Region> up, down;
    std::vector<double> correlations;  // of both, without signs
    std::size_t all = 0;               // neighbourhoods that have details, clear or not

    [[nodiscard]] double median() {
        const auto middle = correlations.begin() + static_cast<std::ptrdiff_t>(correlations.size() / 2);
        std::nth_element(correlations.begin(), middle, correlations.end());
        return *middle;
    }
};

Votes votes_of(const Curl& curl) {
    const std::vector<Neighbourhood> all = neighbourhoods_of(curl);
    if (all.empty()) return {};
    const auto energy = [](const Neighbourhood& n) { return std::sqrt(n.sums.p_square * n.sums.q_square); };
    std::vector<double> energies;
    energies.reserve(all.size());
    for (const Neighbourhood& n : all) energies.push_back(energy(n));
    const auto middle = energies.begin() + static_cast<std::ptrdiff_t>(energies.size() / 2);
    std::nth_element(energies.begin(), middle, energies.end());
    const double least = kLeastEnergy * *middle;
    Votes votes;
    for (const Neighbourhood& n : all) {
        const double correlation = n.sums.correlation();
        if (n.regions < kLeastNeighbours || energy(n) <= least) continue;
        ++votes.all;
        if (std::abs(correlation) < kLeastCorrelation) continue;
        // If 0.8 of the evidence is on one side, |sum| / sum of magnitudes is 2 * 0.8 - 1.
        if (std::abs(n.agreeing) < (2.0 * kLeastAgreement - 1.0) * n.evidence) continue;
        const Rect& rect = n.centre->rect;
        votes.correlations.push_back(std::abs(correlation));
        (correlation > 0.0 ? votes.up : votes.down).push_back({0, rect.x, rect.y, rect.width, rect.height});
    }
    return votes;
}

// Products of the changes of slopes, summed over a square.
struct GradientSums {
    double xx = 0.0, yy = 0.0, xy = 0.0;
    [[nodiscard]] double energy() const { return xx + yy; }
    // Whether slopes change along one direction alone.
    [[nodiscard]] bool is_one_way() const {
        constexpr double kMostAcross = 0.1;
        const double apart = std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
        return energy() - apart < kMostAcross * (energy() + apart);
    }
};

GradientSums gradients_of(const Slopes& slopes, int left, int top, int side) {
    const auto [width, height] = slopes.extent();
    GradientSums sums;
    for (const Plane<float>* plane : {&slopes.p, &slopes.q}) {
        for (int j = std::max(1, top); j < std::min(top + side, height - 1); ++j) {
            const float *up = plane->row(j - 1), *row = plane->row(j), *down = plane->row(j + 1);
            for (int i = std::max(1, left); i < std::min(left + side, width - 1); ++i) {
                const double x = static_cast<double>(row[i + 1]) - static_cast<double>(row[i - 1]);
                const double y = static_cast<double>(up[i]) - static_cast<double>(down[i]);
                if (!(x + y == x + y)) continue;
                const double weight = 1.0 / (0.25 + x * x + y * y);  // as in sum_region(): jumps count as changes do
                sums.xx += weight * x * x;
                sums.yy += weight * y * y;
                sums.xy += weight * x * y;
            }
        }
    }
    return sums;
}

// Whether the neighbourhood of a region shows streaks: slopes change along one direction alone nearly everywhere.
// Bakers fill the space between charts with the values at their borders, drawn out into streaks, whose curl has either
// sign by chance. Edges and bevels change along one direction, too, but they have corners and ends: in maps of panels
// of both directions, at most 0.7 in three of four regions; in the padding of chessmen, 0.7 and more in five of six.
bool is_streaky(const Region& region, Extent extent, const SlopesAt& slopes_at) {
    constexpr int kSquare = 16;  // of the halved map: there JPEG and the stairs of oblique streaks are faint
    constexpr double kStreakShare = 0.7;
    const int x = std::max(0, region.x - region.width), y = std::max(0, region.y - region.height);
    const Slopes slopes = halved(slopes_at(
        {x, y, std::min(3 * region.width, extent.width - x), std::min(3 * region.height, extent.height - y)}));
    double one_way = 0.0, all = 0.0;
    for (int top = 0; top < slopes.extent().height; top += kSquare) {
        for (int left = 0; left < slopes.extent().width; left += kSquare) {
            const GradientSums sums = gradients_of(slopes, left, top, kSquare);
            all += sums.energy();
            one_way += sums.is_one_way() ? sums.energy() : 0.0;
        }
    }
    return one_way > kStreakShare * all;
}

bool are_mixed(const Votes& votes) {
    const double less = static_cast<double>(std::min(votes.up.size(), votes.down.size()));
    const double all = static_cast<double>(votes.up.size() + votes.down.size());
    return less >= static_cast<double>(kMixedRegions) && less >= kMixedShare * all &&
           all >= kClearShare * static_cast<double>(votes.all);
}

std::optional<MixedY> mixed_y(const Curl& curl, Extent extent, const SlopesAt& slopes_at) {
    if (curl.usable < kLeastUsable) return std::nullopt;
    Votes votes = votes_of(curl);
    if (!are_mixed(votes) || votes.median() < kClearCorrelation) return std::nullopt;
    std::vector<Region> streaks;
    for (std::vector<Region>* regions : {&votes.up, &votes.down}) {
        const auto first = std::stable_partition(regions->begin(), regions->end(), [&](const Region& region) {
            return !is_streaky(region, extent, slopes_at);
        });
        streaks.insert(streaks.end(), first, regions->end());
        regions->erase(first, regions->end());
    }
    votes.all -= streaks.size();
    if (!are_mixed(votes)) return std::nullopt;
    const bool up_is_less = votes.up.size() < votes.down.size();
    MixedY mixed;
    mixed.y = up_is_less ? YAxis::up : YAxis::down;
    mixed.clear = votes.up.size() + votes.down.size();
    mixed.regions = std::move(up_is_less ? votes.up : votes.down);
    mixed.streaks = std::move(streaks);
    return mixed;
}

}  // namespace

std::string MixedY::text() const {
    return std::to_string(regions.size()) + " of " + std::to_string(clear) + " regions point " + direction(y) +
           ", the others " + direction(opposite_of(y));
}

std::optional<YAxis> clear_y(const Curl& curl) {
    if (std::abs(curl.correlation) < kLeastCorrelation || curl.confidence < kLeastConfidence ||
        curl.usable < kLeastUsable)
        return std::nullopt;
    return curl.correlation > 0.0 ? YAxis::up : YAxis::down;
}

YVerdict verdict_of(const Curl& curl, Extent extent, const SlopesAt& slopes_at) {
    YVerdict verdict;
    verdict.mixed = mixed_y(curl, extent, slopes_at);
    if (!verdict.mixed) verdict.y = clear_y(curl);
    return verdict;
}

}  // namespace tex::inline v1
