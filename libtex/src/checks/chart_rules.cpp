// SPDX-License-Identifier: Apache-2.0

#include "checks/chart_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "checks/padding.h"
#include "checks/tangent_rules.h"
#include "checks/thresholds.h"
#include "mesh/charts.h"
#include "mesh/coverage.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// What a strip of the map shows. Sums of doubles depend on their order, so each strip has its own.
struct StripSums {
    std::int64_t overlaps = 0, texels = 0;
    std::int64_t background = 0;  // texels of it that charts cover
    double from_normal = 0.0;     // degrees between the vector as stored and the mesh's normal, summed
    double from_z = 0.0;          // and (0, 0, 1)
};

using Vector = std::array<double, 3>;

double angle_between(const Vector& a, const Vector& b) {
    const double product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double lengths =
        std::sqrt((a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
    return lengths > 1e-12 ? kDegrees * std::acos(std::clamp(product / lengths, -1.0, 1.0)) : 90.0;
}

Vector normal_at(const MeshPart& part, const Covered& texel) {
    Vector normal{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Float3& n = part.normals[part.indices[3 * static_cast<std::size_t>(texel.triangle) + k]];
        normal[0] += texel.weights[k] * static_cast<double>(n.x);
        normal[1] += texel.weights[k] * static_cast<double>(n.y);
        normal[2] += texel.weights[k] * static_cast<double>(n.z);
    }
    return normal;
}

// The mesh on the map: what covers each texel.
struct Covering {
    const MeshPart& part;
    CoverageMap coverage;
    std::vector<std::int32_t> chart_of;  // for each triangle
    Plane<std::int32_t> charts;          // for each texel, or kNoChart
};

StripSums sums_of(Covering& mesh, int strip, const CheckContext& context) {
    const Stored& stored = context.stored;
    StripSums sums;
    std::vector<Covered> texels;
    const Overlaps overlaps = mesh.coverage.cover(strip, texels);
    sums.overlaps = overlaps.same + overlaps.moved;
    const int x = stored.channel(Component::x), y = stored.channel(Component::y), z = stored.channel(Component::z);
    const int width = stored.extent().width;
    for (std::size_t k = 0; k < texels.size(); ++k) {
        const int i = static_cast<int>(k) % width, j = strip * mesh.coverage.strip_rows() + static_cast<int>(k) / width;
        const bool inside = texels[k].inside;
        mesh.charts.at(i, j) = inside ? mesh.chart_of[static_cast<std::size_t>(texels[k].triangle)] : kNoChart;
        if (inside && context.background && context.background->holds(i, j)) ++sums.background;
        if (!inside || !stored.has_z()) continue;  // object space needs z
        const auto component = [&](int channel) { return static_cast<double>(stored.component(channel, i, j)); };
        const Vector n{component(x), component(y), component(z)};
        if (!std::isfinite(n[0] + n[1] + n[2])) continue;
        ++sums.texels;
        sums.from_normal += angle_between(n, normal_at(mesh.part, texels[k]));
        sums.from_z += angle_between(n, {0.0, 0.0, 1.0});
    }
    return sums;
}

// Slivers of less than half a texel show nothing, and rounding their UVs turns them over.
void check_mirrored(const MeshPart& part, Extent extent, Findings& findings) {
    const double least = 0.5 / static_cast<double>(extent.texels());
    std::size_t mirrored = 0, upright = 0;
    for (std::size_t t = 0; t < part.triangles(); ++t) {
        const double area = area_in_map(part, t);
        if (std::abs(area) < least) continue;
        ++(area < 0.0 ? mirrored : upright);
    }
    if (mirrored == 0) return;
    Finding& finding = findings.add(
        "N722", std::to_string(mirrored) + " of " + std::to_string(mirrored + upright) + " triangles are mirrored");
    finding.figure = static_cast<double>(mirrored) / static_cast<double>(mirrored + upright);
    finding.unit = "share";
}

Result<StripSums> sums_over(Covering& mesh, const CheckContext& context) {
    std::vector<StripSums> strips(static_cast<std::size_t>(mesh.coverage.strips()));
    const auto measure = [&](int begin, int end) {
        for (int k = begin; k < end; ++k) strips[static_cast<std::size_t>(k)] = sums_of(mesh, k, context);
    };
    if (const auto done = parallel_for(context.execution, mesh.coverage.strips(), 1, measure, {1.0, 1.0}); !done)
        return done.error();
    StripSums all;
    for (const StripSums& strip : strips) {
        all.overlaps += strip.overlaps;
        all.background += strip.background;
        all.texels += strip.texels;
        all.from_normal += strip.from_normal;
        all.from_z += strip.from_z;
    }
    return all;
}

// Says how much of the background the mesh shows.
void judge_background(const CheckContext& context, std::int64_t covered, Findings& findings) {
    Finding* const finding = findings.find("N215");
    if (finding == nullptr || !context.background) return;
    const double share = static_cast<double>(covered) / static_cast<double>(context.background->masked);
    if (covered == 0) finding->fix_harms.clear();  // what is filled is never seen
    finding->message += covered == 0 ? "; no chart of the mesh covers any of it"
                                     : "; charts of the mesh cover " + percent(share) + " of it and its edges";
}

void check_object_space(const StripSums& all, Findings& findings) {
    if (all.texels == 0 || all.from_normal >= thresholds::kObjectSpace * all.from_z) return;
    const auto texels = static_cast<double>(all.texels);
    Finding& finding = findings.add("N721", "its vectors are " + decimal(all.from_normal / texels, 1) +
                                                " degrees from the normals of the mesh on average, and " +
                                                decimal(all.from_z / texels, 1) + " degrees from z");
    finding.figure = all.from_normal / all.from_z;
    finding.unit = "ratio";
    finding.confidence = 0.99;
}

Result<void> check_padding(Covering& mesh, const CheckContext& context, Findings& findings) {
    if (!findings.wants("N724")) return {};
    const auto measure = measure_padding(context.stored, mesh.charts, context.execution);
    if (!measure) return measure.error();
    if (measure->level == 0) return {};
    const auto [width, height] = context.stored.extent();
    const Extent extent{std::max(1, width >> measure->level), std::max(1, height >> measure->level)};
    Finding& finding =
        findings.add("N724", "from level " + std::to_string(measure->level) + " (" + extent_text(extent) +
                                 ") on, charts mix with " + (measure->background ? "the background" : "each other") +
                                 " in " + percent(measure->share) + " of the texels on their borders");
    finding.figure = measure->share;
    finding.unit = "share";
    return {};
}

}  // namespace

Result<void> check_chart_rules(const CheckContext& context, Findings& findings) {
    const MeshPart& part = context.options.mesh->selected.part;
    check_mirrored(part, context.stored.extent(), findings);
    return no_throw([&]() -> Result<void> {
        auto coverage = CoverageMap::make(part, 0, context.stored.extent(), 0);
        if (!coverage) return coverage.error();
        Covering mesh{part, *std::move(coverage), charts_of(part, 0), Plane<std::int32_t>(context.stored.extent())};
        const auto all = sums_over(mesh, context);
        if (!all) return all.error();
        if (all->overlaps > 0) {
            Finding& finding =
                findings.add("N723", std::to_string(all->overlaps) + " times, a texel has one more triangle");
            finding.figure = static_cast<double>(all->overlaps);
            finding.unit = "texels";
        }
        judge_background(context, all->background, findings);
        check_object_space(*all, findings);
        return check_padding(mesh, context, findings);
    });
}

}  // namespace tex::inline v1
