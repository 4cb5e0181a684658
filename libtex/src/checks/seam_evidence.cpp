// SPDX-License-Identifier: Apache-2.0

#include "checks/seam_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "checks/tangent_rules.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

// The side of a square around the worst edge, in texels.
constexpr int kRegion = 16;

// What is usual: see SeamEvidence. Of 42 maps of waves on seven meshes, at three sizes, the largest mean is 5.0 times
// the change, and the smallest one with green the other way, but for one mesh of which few seams turn, is 6.2 times it.
constexpr double kUsualRounding = 0.6, kUsualChanges = 5.0;

// The square of texels around a place of the map, inside of the map.
Region region_around(const std::array<double, 2>& place, Extent extent) {
    const auto first = [](double at, int size, int whole) {
        const double wrapped = at - std::floor(at / whole) * whole;
        return std::clamp(static_cast<int>(wrapped) - size / 2, 0, whole - size);
    };
    const int width = std::min(kRegion, extent.width), height = std::min(kRegion, extent.height);
    return {0, first(place[0], width, extent.width), first(place[1], height, extent.height), width, height};
}

}  // namespace

double seam_degrees(Vector3 gap) {
    const double sine = std::min(1.0, std::sqrt(gap.x * gap.x + gap.y * gap.y + gap.z * gap.z) / 2.0);
    return 2.0 * kDegrees * math::atan(sine / std::sqrt(1.0 - sine * sine));  // of infinity for opposite normals
}

SeamEvidence seam_evidence(const SeamSamples& samples, const std::vector<Vector3>& gaps, Extent extent) {
    SeamEvidence evidence;
    std::vector<std::pair<double, double>> angles;  // with their weights
    double all = 0.0, change = 0.0, of_edge = 0.0, count = 0.0;
    const auto& places = samples.samples();
    for (std::size_t k = 0; k < places.size(); ++k) {
        const double angle = seam_degrees(gaps[k]);
        angles.emplace_back(angle, places[k].weight);
        evidence.mean += places[k].weight * angle;
        change += places[k].weight * places[k].change;
        all += places[k].weight;
        of_edge += angle;
        count += 1.0;
        if (k + 1 < places.size() && places[k + 1].edge == places[k].edge) continue;
        ++evidence.edges;
        if (of_edge / count >= evidence.worst) {
            evidence.worst = of_edge / count;
            evidence.worst_edge = region_around(places[k].at, extent);
        }
        of_edge = count = 0.0;
    }
    evidence.mean = all > 0.0 ? evidence.mean / all : 0.0;
    evidence.usual = kUsualRounding + (all > 0.0 ? kUsualChanges * change / all : 0.0);
    std::sort(angles.begin(), angles.end());
    double below = 0.0;
    for (const auto& [angle, weight] : angles) {
        evidence.p99 = angle;
        below += weight;
        if (below >= 0.99 * all) break;
    }
    return evidence;
}

}  // namespace tex::inline v1
