// SPDX-License-Identifier: Apache-2.0

#include "surface/debander.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "kernels/deband.h"
#include "memory/lent_memory.h"
#include "rows/height_steps.h"
#include "surface/bending_grid.h"
#include "surface/bending_weights.h"

namespace tex::inline v1 {
namespace {

// Steps on the finest grid, where real maps gain no more from further ones, and on those of half its size, of a
// quarter, and so on: twice as many on each, because what the coarse ones leave is beyond the reach of the finer ones,
// and because they cost half as much as those of the grid before nevertheless.
constexpr int kFinestSteps = 20;
constexpr int kHalfSteps = 60;
constexpr int kMostSteps = 480;
constexpr int kCoarsestGrid = 8;        // texels of the longer side
constexpr std::size_t kMostGrids = 20;  // down from kMaxExtent
constexpr int kLooks = 64;              // strips whose different heights are collected: 64 KB each

struct Found {
    std::optional<HeightSteps> steps;
    std::int64_t terrace_texels = 0;
};

Result<Found> look_at(const Plane<float>& heights, const Execution& execution) {
    const Extent extent = heights.extent();
    const int rows = std::max(kBendingStrip, (extent.height + kLooks - 1) / kLooks);
    const auto strips = static_cast<std::size_t>((extent.height + rows - 1) / rows);
    WorkingVector<DistinctHeights> distinct(strips);
    WorkingVector<std::int64_t> terraces(strips);
    const auto body = [&](int begin, int end) {
        const auto strip = static_cast<std::size_t>(begin / rows);
        for (int j = begin; j < end; ++j) {
            distinct[strip].add(heights.row(j), extent.width);
            if (distinct[strip].too_many()) return;
            const float* above = j > 0 ? heights.row(j - 1) : nullptr;
            const float* below = j + 1 < extent.height ? heights.row(j + 1) : nullptr;
            terraces[strip] += count_terraces(above, heights.row(j), below, extent.width);
        }
    };
    const Execution silent = execution.quiet();
    if (auto done = parallel_for(silent, extent.height, rows, body); !done) return done.error();
    Found found;
    for (std::size_t k = 1; k < strips; ++k) distinct.front().add(distinct[k]);
    if (distinct.front().too_many()) return found;
    found.steps = find_steps(distinct.front().sorted());
    if (!found.steps) return found;
    for (const std::int64_t texels : terraces) found.terrace_texels += texels;
    return found;
}

// The grids, from the finest to the coarsest, all with their weights.
Result<WorkingVector<BendingGrid>> grids_of(BendingGrid finest, const Execution& execution) {
    WorkingVector<BendingGrid> grids;
    grids.reserve(kMostGrids);
    grids.push_back(std::move(finest));
    while (true) {
        BendingGrid& grid = grids.back();
        const Plane<float>* const finer = grids.size() > 1 ? &grids[grids.size() - 2].weights : nullptr;
        auto weights = bending_weights(grid, finer, execution);
        if (!weights) return weights.error();
        grid.weights = std::move(*weights);
        if (std::max(grid.extent().width, grid.extent().height) <= kCoarsestGrid) break;
        auto codes = halve(grid.codes, halve_codes, execution);
        if (!codes) return codes.error();
        grids.push_back({std::move(*codes), {}, grid.wrap_x, grid.wrap_y, grid.range});
    }
    return grids;
}

int steps_on(std::size_t grid) {
    return grid == 0 ? kFinestSteps : std::min(kMostSteps, kHalfSteps << std::min<std::size_t>(grid - 1, 8));
}

// The coarsest heights are the codes; each finer grid begins with the heights of the one before. Progress: the share of
// each grid is that of its texels, times its steps.
Result<Plane<float>> solve(WorkingVector<BendingGrid>& grids, const Execution& execution, ProgressSpan span) {
    double work = 0.0, done = 0.0;
    const auto work_on = [&](std::size_t k) { return static_cast<double>(steps_on(k)) * std::pow(0.25, k); };
    for (std::size_t k = 0; k < grids.size(); ++k) work += work_on(k);
    const auto at = [&](double part) { return span.from + (span.to - span.from) * std::min(1.0, part / work); };
    Plane<float> heights;
    while (true) {
        const BendingGrid& grid = grids.back();
        if (heights.empty()) {
            heights = grid.codes.clone();
            for (int j = 0; j < grid.extent().height; ++j)
                limit_row(grid.codes.row(j), grid.range, grid.extent().width, heights.row(j));
        } else {
            auto finer = refine(heights, grid, execution);
            if (!finer) return finer.error();
            heights = std::move(*finer);
        }
        const std::size_t level = grids.size() - 1;
        const ProgressSpan own{at(done), level == 0 ? span.to : at(done + work_on(level))};
        if (auto relaxed = relax(grid, steps_on(level), heights, execution, own); !relaxed) return relaxed.error();
        done += work_on(level);
        if (level == 0) return heights;
        grids.pop_back();
    }
}

template <class RowBody>
Result<void> in_strips(Extent extent, const Execution& execution, const RowBody& row) {
    const Execution silent = execution.quiet();
    const auto body = [&](int begin, int end) {
        for (int j = begin; j < end; ++j) row(j);
    };
    return parallel_for(silent, extent.height, kBendingStrip, body);
}

// There is nothing to do, so all of it is done.
Result<DebandReport> unchanged(const DebandReport& report, const Execution& execution, ProgressSpan span) {
    if (execution.progress && !execution.progress(span.to)) return Error{ErrorCode::cancelled, {}, "cancelled"};
    return report;
}

}  // namespace

Result<DebandReport> deband_heights(Plane<float>& heights, Wrap wrap_x, Wrap wrap_y, Deband when,
                                    const Execution& execution, ProgressSpan span) {
    DebandReport report;
    if (when == Deband::off) return report;
    const auto found = look_at(heights, execution);
    if (!found) return found.error();
    if (!found->steps) return unchanged(report, execution, span);
    const HeightSteps steps = *found->steps;
    const Extent extent = heights.extent();
    report.step = steps.step;
    report.codes = steps.codes;
    report.terrace_texels = found->terrace_texels;
    report.applied = when == Deband::on || report.terrace_texels >= (extent.texels() + 9) / 10;
    if (!report.applied) return unchanged(report, execution, span);

    // In steps from the lowest height; where the input ends at 0 or 1, so do the heights.
    const auto highest = static_cast<float>(steps.codes - 1);
    const bool reaches_one = std::abs(steps.lowest + highest * steps.step - 1.0f) < 0.01f * steps.step;
    BendingGrid grid;
    grid.wrap_x = wrap_x;
    grid.wrap_y = wrap_y;
    grid.range.least = steps.lowest == 0.0f ? 0.0f : -1.0f;
    grid.range.greatest = reaches_one ? highest : highest + 1.0f;
    const auto to_codes = [&](int j) { codes_of_heights(steps.lowest, steps.step, extent.width, heights.row(j)); };
    if (auto done = in_strips(extent, execution, to_codes); !done) return done.error();
    grid.codes = std::move(heights);
    auto grids = grids_of(std::move(grid), execution);
    if (!grids) return grids.error();
    auto smooth = solve(*grids, execution, span);
    if (!smooth) return smooth.error();
    const Plane<float>& codes = grids->front().codes;
    const auto to_heights = [&](int j) {
        heights_of_codes(codes.row(j), steps.lowest, steps.step, extent.width, smooth->row(j));
    };
    if (auto done = in_strips(extent, execution, to_heights); !done) return done.error();
    heights = std::move(*smooth);
    return report;
}

}  // namespace tex::inline v1
