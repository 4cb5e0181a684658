// SPDX-License-Identifier: Apache-2.0
// Painted and filtered occlusion is seldom what rays find. It is therefore compared with several things that are light
// where the surface is open, and the best counts: of 181 maps with the occlusion of their authors, horizons alone are
// below a correlation of 0.25 in 38, and the best in 4.

#include "checks/occlusion_rules.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rows/curvature_rows.h"
#include "surface/horizons.h"
#include "surface/integrator.h"

namespace tex::inline v1 {
namespace {

constexpr double kFollows = 0.15;       // the least correlation of occlusion that belongs to the map
constexpr double kFitsMirrored = 0.4;   // of occlusion that is mirrored or inverted,
constexpr double kMirroredLead = 0.25;  // and how much better it fits than as it is
constexpr double kLeastSpread = 0.004;  // standard deviation: one code
constexpr double kTells = 0.03;         // the same of occlusion that must follow: rays find less about flat meshes
constexpr int kDirections = 8;          // of horizons
constexpr int kLocal = 2;               // the radius of the mean that local contrast is without

// How an occlusion map may lie.
struct Placed {
    bool mirrored_x = false, mirrored_y = false;
};
constexpr Placed kPlaces[] = {{}, {true, false}, {false, true}, {true, true}};

// The occlusion map with as many texels as the normals, and its differences from the mean around each texel.
struct Given {
    Plane<float> values, local;
};

Plane<float> resized(const Plane<float>& given, Extent extent) {
    Plane<float> values(extent);
    const Extent from = given.extent();
    for (int j = 0; j < extent.height; ++j) {
        const auto y = static_cast<int>(std::int64_t{j} * from.height / extent.height);
        for (int i = 0; i < extent.width; ++i)
            values.at(i, j) = given.at(static_cast<int>(std::int64_t{i} * from.width / extent.width), y);
    }
    return values;
}

Plane<float> without_mean(const Plane<float>& values) {
    const Extent extent = values.extent();
    Plane<float> local(extent);
    for (int j = 0; j < extent.height; ++j) {
        const int top = std::max(0, j - kLocal), bottom = std::min(extent.height - 1, j + kLocal);
        for (int i = 0; i < extent.width; ++i) {
            const int left = std::max(0, i - kLocal), right = std::min(extent.width - 1, i + kLocal);
            double sum = 0.0;
            for (int y = top; y <= bottom; ++y) {
                for (int x = left; x <= right; ++x) sum += values.at(x, y);
            }
            const int count = (bottom - top + 1) * (right - left + 1);
            local.at(i, j) = static_cast<float>(values.at(i, j) - sum / count);
        }
    }
    return local;
}

double correlation_of(const Plane<float>& expected, const Plane<float>& given, Placed placed, double least_spread) {
    const int width = expected.extent().width, height = expected.extent().height;
    double count = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (int j = 0; j < height; ++j) {
        const float* const wanted = expected.row(j);
        const float* const row = given.row(placed.mirrored_y ? height - 1 - j : j);
        for (int i = 0; i < width; ++i) {
            const double u = wanted[i], v = row[placed.mirrored_x ? width - 1 - i : i];
            if (!(std::abs(u + v) < 1e9)) continue;  // also if NaN
            count += 1.0;
            a += u;
            b += v;
            aa += u * u;
            bb += v * v;
            ab += u * v;
        }
    }
    if (count == 0.0) return 0.0;
    const double of_a = aa / count - a / count * (a / count), of_b = bb / count - b / count * (b / count);
    if (of_a < 1e-12 || of_b < least_spread * least_spread) return 0.0;
    return (ab / count - a / count * (b / count)) / std::sqrt(of_a * of_b);
}

// The normals of a map whose green points to y; NaN where none is usable. z is rebuilt: where a filter or a JPEG has
// changed it, slopes jump.
NormalMap normals_of(const CheckContext& context, YAxis y) {
    const Extent extent = context.stored.extent();
    Stored without_z = context.stored;
    std::replace(without_z.swizzle.begin(), without_z.swizzle.end(), Component::z, Component::other);
    const Slopes slopes = slopes_of(without_z, {0, 0, extent.width, extent.height});
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float p = slopes.p.at(i, j), q = y == YAxis::up ? slopes.q.at(i, j) : -slopes.q.at(i, j);
            const float z = 1.0f / std::sqrt(1.0f + p * p + q * q);
            map.x.at(i, j) = -p * z;
            map.y.at(i, j) = -q * z;
            map.z.at(i, j) = z;
        }
    }
    return map;
}

// Occlusion, heights and curvature of the surface; none if the normals show no surface.
Result<std::vector<Plane<float>>> expectations(const NormalMap& map, const Execution& execution) {
    std::vector<Plane<float>> all;
    const IntegrateOptions how;
    const Integrator integrator(map, how);
    const auto count = integrator.count(execution);
    if (!count) return count.error();
    if (is_unusable(*count, map.extent())) return all;
    int steps = 0;
    auto heights = integrator.heights(count->unused, execution, {0.0, 0.5}, steps);
    if (!heights) return heights.error();
    const HeightFieldHead head{1.0f, 1.0f, how.wrap_x, how.wrap_y, {}};
    const Gradient gradient = gradient_of(how.bake);
    OcclusionOptions options;
    options.directions = kDirections;
    auto sky = sky_of({*heights, *heights, head, gradient, {1.0f, 1.0f}}, options, execution, {0.5, 1.0});
    if (!sky) return sky.error();
    Plane<float> curvature(map.extent());
    CurvatureRows rows(map, false, how.wrap_x, how.wrap_y);
    for (int j = 0; j < map.extent().height; ++j) rows.make(j, curvature.row(j));
    all.push_back(std::move(sky->occlusion));
    all.push_back(std::move(*heights));
    all.push_back(std::move(curvature));
    return all;
}

// The best correlations for each place, and for the inverted map.
struct Fits {
    double placed[std::size(kPlaces)] = {-1.0, -1.0, -1.0, -1.0};
    double inverted = -1.0;

    void add(const Plane<float>& expected, const Plane<float>& given, double least_spread) {
        for (std::size_t k = 0; k < std::size(kPlaces); ++k) {
            const double fit = correlation_of(expected, given, kPlaces[k], least_spread);
            placed[k] = std::max(placed[k], fit);
            if (k == 0) inverted = std::max(inverted, -fit);
        }
    }
};

Given given_of(const CheckContext& context) {
    Given given;
    const CheckOptions& options = context.options;
    if (options.occlusion != nullptr) {
        given.values = resized(*options.occlusion, context.stored.extent());
    } else if (options.occlusion_in_blue && context.base.planes.size() > 2) {
        given.values = context.base.planes[2].clone();
    }
    if (given.values.empty()) return given;
    if (correlation_of(given.values, given.values, {}, kLeastSpread) == 0.0) return {};  // one value
    given.local = without_mean(given.values);
    return given;
}

std::string mirrored_text(Placed placed) {
    if (placed.mirrored_x && placed.mirrored_y) return "turned by 180 degrees";
    return placed.mirrored_x ? "mirrored from left to right" : "mirrored from top to bottom";
}

OcclusionEvidence judge(const Fits& fits, bool judges_mismatch, Findings& findings) {
    const auto first = std::begin(fits.placed), best = std::max_element(first, std::end(fits.placed));
    OcclusionEvidence evidence;
    evidence.correlation = evidence.best = *first;
    const auto is_better = [&](double fit) { return fit >= std::max(kFitsMirrored, *first + kMirroredLead); };
    std::string what;
    if (is_better(fits.inverted) && fits.inverted >= *best) {
        evidence.correlation = -fits.inverted;
        what = "it fits when it is inverted, so that 1 is open: correlation " + decimal(fits.inverted, 2) +
               ", and as it is " + decimal(evidence.correlation, 2);
    } else if (is_better(*best)) {
        const Placed placed = kPlaces[best - first];
        evidence.mirrored_x = placed.mirrored_x;
        evidence.mirrored_y = placed.mirrored_y;
        evidence.best = *best;
        what = "it fits when it is " + mirrored_text(placed) + ": correlation " + decimal(*best, 2) +
               ", and as it is " + decimal(*first, 2);
    } else if (*first < kFollows && judges_mismatch) {
        what = "their correlation is " + decimal(*first, 2);
    }
    if (what.empty()) return evidence;
    Finding& finding = findings.add("N603", what);
    finding.figure = evidence.correlation;
    finding.unit = "correlation";
    finding.confidence = 0.9;
    return evidence;
}

}  // namespace

Result<std::optional<OcclusionEvidence>> check_occlusion_rules(const CheckContext& context, Findings& findings) {
    const std::optional<OcclusionEvidence> nothing;
    if (!context.has_vectors || context.constant) return nothing;
    const Given given = given_of(context);
    if (given.values.empty()) return nothing;
    Fits fits;
    bool has_any = false;
    for (const YAxis y : {YAxis::up, YAxis::down}) {
        if (context.y.y.value_or(y) != y) continue;
        const auto expected = expectations(normals_of(context, y), context.execution);
        if (!expected) return expected.error();
        for (const Plane<float>& plane : *expected) fits.add(plane, given.values, kLeastSpread);
        if (expected->empty()) continue;
        fits.add(expected->back(), given.local, 0.0);
        has_any = true;
    }
    if (!has_any) return nothing;
    // Where no surface shows, as on most maps of charts, the occlusion may be that of a mesh, or painted.
    const bool tells = correlation_of(given.values, given.values, {}, kTells) > 0.0;
    return std::optional(judge(fits, tells && context.y.y.has_value(), findings));
}

}  // namespace tex::inline v1
