// SPDX-License-Identifier: Apache-2.0

#include "checks/convention_rules.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

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

Votes votes_of(const CheckContext& context) {
    const std::vector<Neighbourhood> all = neighbourhoods_of(context.curl);
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

void check_mixed(const CheckContext& context, Findings& findings) {
    if (context.curl.usable < kLeastUsable) return;
    Votes votes = votes_of(context);
    const bool up_is_less = votes.up.size() < votes.down.size();
    const std::vector<Region>& less = up_is_less ? votes.up : votes.down;
    const double all = static_cast<double>(votes.up.size() + votes.down.size());
    if (less.size() < kMixedRegions) return;
    const double share = static_cast<double>(less.size()) / all;
    if (share < kMixedShare || all < kClearShare * static_cast<double>(votes.all)) return;
    if (votes.median() < kClearCorrelation) return;
    const YAxis y = up_is_less ? YAxis::up : YAxis::down;
    Finding& finding =
        findings.add("N402", std::to_string(less.size()) + " of " + decimal(all, 0) + " regions point " + direction(y) +
                                 ", the others " + direction(y == YAxis::up ? YAxis::down : YAxis::up));
    finding.figure = share;
    finding.unit = "share";
    finding.confidence = context.y.confidence;
    finding.regions = less;
}

// The first limit that the evidence misses.
std::string undecided_by(const Curl& curl) {
    if (curl.usable < kLeastUsable)
        return "only " + percent(curl.usable) + " of them hold a usable normal, of at least " + percent(kLeastUsable);
    const CurlSums& sums = curl.scale[curl.best_scale];
    if (!sums.changes_across() && sums.px_square * sums.qy_square > 0.0)
        return "the slopes change along the axes alone, as those of lines and bevels do";
    if (std::abs(curl.correlation) < kLeastCorrelation)
        return "the correlation is below " + decimal(kLeastCorrelation, 1);
    return "the confidence is below " + decimal(kLeastConfidence, 2);
}

}  // namespace

void check_convention_rules(const CheckContext& context, Findings& findings) {
    if (!context.sampled_ok) return;
    check_mixed(context, findings);
    const auto add = [&](std::string_view id, std::string message) {
        Finding& finding = findings.add(id, std::move(message) + " (correlation " + decimal(context.y.correlation, 2) +
                                                ", confidence " + decimal(context.y.confidence, 3) + ")");
        finding.figure = context.y.correlation;
        finding.unit = "correlation";
        finding.confidence = context.y.confidence;
    };
    const auto& require = context.options.require;
    if (require.y && !context.y.y) add("N403", "the texels do not show it: " + undecided_by(context.curl));
    if (!context.y.y) return;
    if (require.y && *context.y.y != *require.y) {
        add("N401", "green points " + direction(*context.y.y) + " instead of " + direction(*require.y));
    }
    if (context.texture.y_known && *context.y.y != context.texture.y_axis) {
        add("N404", "green points " + direction(*context.y.y) + ", the file says " + direction(context.texture.y_axis));
    }
}

}  // namespace tex::inline v1
