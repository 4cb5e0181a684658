// SPDX-License-Identifier: Apache-2.0

#include "surface/bending_weights.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "kernels/deband.h"
#include "memory/lent_memory.h"
#include "rows/blur.h"
#include "rows/straight_border.h"

namespace tex::inline v1 {
namespace {

// What rounding adds to the square of a Laplacian: the weights of the stencil, squared, sum up to 20, and the variance
// is 1/12. The mean of 2x2 texels has a quarter of it, 0.42; 0.6 leaves room for chance. Less than 1 is no evidence.
constexpr float kNoise = 20.0f / 12.0f;
constexpr float kNoiseOfHalf = 0.6f;
constexpr float kSureOfHalf = 1.0f;
// The weight of an energy: the inverse of the variance of rounding.
constexpr float kPull = 12.0f;
// Grain that differs from texel to texel has a quarter of its energy left in the mean of 2x2 texels.
constexpr float kGrain = 4.0f;
// Energies are averaged over squares with this many neighbours to each side: of 10x10 texels, and 18x18.
constexpr int kNear = 2;
constexpr int kWide = 4;
// A grid of twice the distance between texels bends 4 times as much; its energy is 16 times as large.
constexpr float kCoarser = 16.0f;
// On coarse grids, hills that are smooth on fine ones look rough. What looks rough there counts for a tenth.
constexpr float kOwn = 0.1f;

Execution silent(const Execution& execution) { return execution.quiet(); }

// The squares of the Laplacians.
Result<Plane<float>> energies_of(const Plane<float>& codes, const BendingGrid& grid, const Execution& execution) {
    const Extent extent = codes.extent();
    Plane<float> out(extent);
    const auto body = [&](int begin, int end) {
        std::array<ApronRow, 3> rows{ApronRow(extent.width), ApronRow(extent.width), ApronRow(extent.width)};
        ApronRow bent(extent.width);
        const auto row = [&rows](int j) { return rows[static_cast<std::size_t>(j + 1) % 3].data(); };
        for (int j = begin - 1; j <= end; ++j) {
            straight_row(codes, grid.wrap_y, j, row(j));
            continue_ends(row(j), extent.width, grid.wrap_x);
            if (j <= begin) continue;
            laplace_row(row(j - 2), row(j - 1), row(j), extent.width, bent.data());
            std::copy_n(bent.data(), extent.width, out.row(j - 1));
            square_row(extent.width, out.row(j - 1));
        }
    };
    if (auto done = parallel_for(silent(execution), extent.height, kBendingStrip, body); !done) return done.error();
    return out;
}

// The mean of a square of 2 radius + 1 values around each one.
Result<void> average(const BendingGrid& grid, int radius, Plane<float>& plane, const Execution& execution) {
    // Energies have no slope that could continue beyond a border.
    const auto wrap = [](Wrap given) { return given == Wrap::clamp ? Wrap::mirror : given; };
    const WorkingVector<float> weights(static_cast<std::size_t>(radius) + 1, 1.0f / static_cast<float>(2 * radius + 1));
    const int height = plane.extent().height;
    Plane<float> across(plane.extent());
    const auto rows = [&](int begin, int end) {
        blur_across(plane.view(), weights, wrap(grid.wrap_x), begin, end, across);
    };
    if (auto done = parallel_for(silent(execution), height, kBendingStrip, rows); !done) return done;
    const auto columns = [&](int begin, int end) {
        blur_down(across.view(), weights, wrap(grid.wrap_y), begin, end, plane);
    };
    return parallel_for(silent(execution), height, kBendingStrip, columns);
}

// The mean energies around each square of 2x2 texels.
Result<Plane<float>> own_energies(const BendingGrid& grid, const Execution& execution) {
    const auto energies = energies_of(grid.codes, grid, execution);
    if (!energies) return energies.error();
    auto out = halve(*energies, halve_means, execution);
    if (!out) return out;
    if (auto done = average(grid, kNear, *out, execution); !done) return done.error();
    return out;
}

// Lowers the weights to those that the means of 2x2 texels confirm.
Result<void> confirm(const BendingGrid& grid, Plane<float>& weights, const Execution& execution) {
    const auto means = halve(grid.codes, halve_means, execution);
    if (!means) return means.error();
    auto confirmed = energies_of(*means, grid, execution);
    if (!confirmed) return confirmed.error();
    if (auto done = average(grid, kWide, *confirmed, execution); !done) return done;
    const Extent extent = weights.extent();
    for (int j = 0; j < extent.height; ++j) {
        weights_of_energy(kNoiseOfHalf, kSureOfHalf, kPull * kGrain, extent.width, confirmed->row(j));
        least_of(confirmed->row(j), extent.width, weights.row(j));
    }
    return {};
}

}  // namespace

Result<Plane<float>> bending_weights(const BendingGrid& grid, const Plane<float>* finer, const Execution& execution) {
    auto out = own_energies(grid, execution);
    if (!out) return out.error();
    const Extent extent = out->extent();
    for (int j = 0; j < extent.height; ++j) weights_of_energy(kNoise, kNoise, kPull, extent.width, out->row(j));
    if (auto done = confirm(grid, *out, execution); !done) return done.error();
    if (finer == nullptr) return out;
    const auto inherited = halve(*finer, halve_means, execution);
    if (!inherited) return inherited.error();
    for (int j = 0; j < extent.height; ++j) greatest_of(kOwn, kCoarser, inherited->row(j), extent.width, out->row(j));
    return out;
}

}  // namespace tex::inline v1
