// SPDX-License-Identifier: Apache-2.0

#include "surface/debander.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/deband.h"
#include "rows/height_steps.h"
#include "surface/bending_grid.h"
#include "surface/bending_weights.h"

namespace tex {
namespace {

// Steps on each grid: more no longer change the angles of real maps (tests/bench/RESULTS.md).
constexpr int kSteps = 30;
constexpr int kCoarsestGrid = 8;  // texels of the longer side
// Grids have half the size of the one before: the work on all of them is 4/3 of that on the finest.
constexpr double kFinestPart = 0.75;

constexpr int kLooks = 64;  // strips whose different heights are collected: 64 KB each

struct Found {
    std::optional<HeightSteps> steps;
    std::int64_t terrace_texels = 0;
};

Result<Found> look_at(const Plane<float>& heights, const Execution& execution) {
    const Extent extent = heights.extent();
    const int rows = std::max(kBendingStrip, (extent.height + kLooks - 1) / kLooks);
    const auto strips = static_cast<std::size_t>((extent.height + rows - 1) / rows);
    std::vector<DistinctHeights> distinct(strips);
    std::vector<std::int64_t> terraces(strips);
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
    const Execution silent{execution.threads, {}};
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
Result<std::vector<BendingGrid>> grids_of(BendingGrid finest, const Execution& execution) {
    std::vector<BendingGrid> grids;
    grids.push_back(std::move(finest));
    while (std::max(grids.back().extent().width, grids.back().extent().height) > kCoarsestGrid) {
        auto half = halve(grids.back(), execution);
        if (!half) return half.error();
        grids.push_back(std::move(*half));
    }
    for (std::size_t k = 0; k < grids.size(); ++k) {
        const BendingGrid* const half = grids.size() > 1 ? &grids[1] : nullptr;
        auto weights = k == 0 ? finest_weights(grids[0], half, execution)
                              : coarser_weights(grids[k], grids[k - 1].weights, execution);
        if (!weights) return weights.error();
        grids[k].weights = std::move(*weights);
    }
    return grids;
}

// The coarsest heights are the codes; each finer grid begins with the heights of the one before.
Result<Plane<float>> solve(std::vector<BendingGrid>& grids, const Execution& execution, ProgressSpan span) {
    Plane<float> heights;
    double done = span.from;
    while (true) {
        const BendingGrid& grid = grids.back();
        if (heights.empty()) {
            heights = grid.codes.clone();
            Plane<float> bounds(Extent{grid.extent().width, 2});
            for (int j = 0; j < grid.extent().height; ++j) {
                const RowBounds row = bounds_of(grid, j, bounds.row(0), bounds.row(1));
                limit_row(row.low, row.high, grid.least, grid.extent().width, heights.row(j));
            }
        } else {
            auto finer = refine(heights, grid, execution);
            if (!finer) return finer.error();
            heights = std::move(*finer);
        }
        const double left =
            grids.size() == 1 ? 1.0 : std::pow(1.0 - kFinestPart, static_cast<double>(grids.size() - 1));
        const double to = std::max(done, span.from + (span.to - span.from) * left);
        if (auto relaxed = relax(grid, kSteps, heights, execution, {done, to}); !relaxed) return relaxed.error();
        done = to;
        if (grids.size() == 1) return heights;
        grids.pop_back();
    }
}

Result<void> in_strips(Extent extent, const Execution& execution, const std::function<void(int j)>& row) {
    const Execution silent{execution.threads, {}};
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
    grid.least = steps.lowest == 0.0f ? 0.0f : -1.0f;
    grid.greatest = reaches_one ? highest : highest + 1.0f;
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

}  // namespace tex
