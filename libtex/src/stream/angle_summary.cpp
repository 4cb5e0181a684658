// SPDX-License-Identifier: Apache-2.0

#include "stream/angle_summary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// This many sums run side by side, so that they do not wait for each other. The order is the same on every processor.
constexpr int kLanes = 8;

constexpr std::size_t kRanks = 3;
using Ranks = std::array<std::int64_t, kRanks>;
using Ranked = std::array<float, kRanks>;

using Bins = std::vector<std::int64_t>;

template <class Body>
void for_each_bits(const Plane<float>& values, int first, int end, const Body& body) {
    for (int j = first; j < end; ++j) {
        const float* row = values.row(j);
        for (int i = 0; i < values.extent().width; ++i) body(std::bit_cast<std::uint32_t>(row[i]), i);
    }
}

// Adds up what count(first, end) returns for parts of the rows: one for each thread, but few, because bins take memory.
// All results have `size` bins; their sum does not depend on the parts.
template <class Count>
Result<Bins> count_bins(Extent extent, std::size_t size, const Execution& execution, const Count& count) {
    constexpr std::int64_t kMostParts = 8, kLeastTexels = 1 << 14;
    const std::int64_t worth = std::clamp<std::int64_t>(extent.texels() / kLeastTexels, 1, kMostParts);
    const int parts = static_cast<int>(std::min<std::int64_t>(worth, thread_count(execution)));
    const int height = extent.height;
    const int rows = (height + parts - 1) / parts;
    std::vector<Bins> counted(static_cast<std::size_t>((height + rows - 1) / rows));
    const Execution silent = execution.quiet();
    const auto body = [&](int begin, int end) { counted[static_cast<std::size_t>(begin / rows)] = count(begin, end); };
    if (auto done = parallel_for(silent, height, rows, body); !done) return done.error();
    Bins all(size);
    for (const Bins& bins : counted) {
        for (std::size_t k = 0; k < size; ++k) all[k] += bins[k];
    }
    return all;
}

// Finds the bin that contains rank `rank`, and reduces `rank` to the rank within that bin.
std::uint32_t find_bin(std::span<const std::int64_t> bins, std::int64_t& rank) {
    std::uint32_t bin = 0;
    while (rank > bins[bin]) rank -= bins[bin++];
    return bin;
}

// Finds the values of 1-based ranks, exactly and without sorting. The bits of non-negative floats have the same order
// as their values. A histogram of the upper halves of the bits finds the bin of each rank; histograms of the lower
// halves in those bins find the value.
Result<Ranked> values_at(const Plane<float>& values, Ranks ranks, const Execution& execution) {
    constexpr std::size_t kUpper = std::size_t{1} << 15, kLower = std::size_t{1} << 16;
    const auto upper = count_bins(values.extent(), kUpper, execution, [&](int first, int end) {
        // Two tables are used in turn: neighbours often fall into one bin, and each increment would wait for the last
        // one.
        Bins bins(kUpper), other(kUpper);
        for_each_bits(values, first, end,
                      [&](std::uint32_t bits, int i) { ++(i % 2 == 0 ? bins : other)[bits >> 16]; });
        for (std::size_t k = 0; k < kUpper; ++k) bins[k] += other[k];
        return bins;
    });
    if (!upper) return upper.error();
    std::array<std::uint32_t, kRanks> bins{};
    for (std::size_t k = 0; k < kRanks; ++k) bins[k] = find_bin(*upper, ranks[k]);
    const auto lower = count_bins(values.extent(), kRanks * kLower, execution, [&](int first, int end) {
        Bins all(kRanks * kLower);
        for_each_bits(values, first, end, [&](std::uint32_t bits, int) {
            for (std::size_t k = 0; k < kRanks; ++k) {
                if (bits >> 16 == bins[k]) ++all[k * kLower + (bits & 0xffff)];
            }
        });
        return all;
    });
    if (!lower) return lower.error();
    Ranked found{};
    for (std::size_t k = 0; k < kRanks; ++k) {
        const std::span<const std::int64_t> part(lower->data() + k * kLower, kLower);
        found[k] = std::bit_cast<float>(bins[k] << 16 | find_bin(part, ranks[k]));
    }
    return found;
}

// ceil(count * thousandths / 1000), in whole numbers.
std::int64_t rank_of(std::int64_t count, int thousandths) { return (count * thousandths + 999) / 1000; }

}  // namespace

AngleSums sum_angles(const float* degrees, int count) {
    double sums[kLanes] = {}, squares[kLanes] = {};
    float most[kLanes];
    std::fill_n(most, kLanes, -1.0f);
    const auto add = [&](int i, int lane) {
        const double angle = degrees[i];
        sums[lane] += angle;
        squares[lane] += angle * angle;
        most[lane] = degrees[i] > most[lane] ? degrees[i] : most[lane];
    };
    int i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) add(i + lane, lane);
    }
    for (; i < count; ++i) add(i, i % kLanes);
    AngleSums row;
    for (int lane = 0; lane < kLanes; ++lane) {
        row.sum += sums[lane];
        row.squares += squares[lane];
        row.max = std::max(row.max, most[lane]);
    }
    row.max_column = static_cast<int>(std::find(degrees, degrees + count, row.max) - degrees);
    return row;
}

Result<AngularError> summarise_angles(const Plane<float>& degrees, const std::vector<AngleSums>& rows,
                                      std::int64_t left_out, const Execution& execution) {
    AngularError error;
    error.texels = degrees.extent().texels() - left_out;
    double sum = 0.0;
    double squares = 0.0;
    float max = -1.0f;
    for (std::size_t j = 0; j < rows.size(); ++j) {
        sum += rows[j].sum;
        squares += rows[j].squares;
        if (rows[j].max > max) {
            max = rows[j].max;
            error.max_column = rows[j].max_column;
            error.max_row = static_cast<int>(j);
        }
    }
    const auto count = static_cast<double>(error.texels);
    error.mean = sum / count;
    error.rms = std::sqrt(squares / count);
    error.max = max;
    // No angle is smaller than those that are left out.
    const Ranks ranks = {left_out + rank_of(error.texels, 500), left_out + rank_of(error.texels, 990),
                         left_out + rank_of(error.texels, 999)};
    const auto ranked = values_at(degrees, ranks, execution);
    if (!ranked) return ranked.error();
    error.p50 = (*ranked)[0];
    error.p99 = (*ranked)[1];
    error.p999 = (*ranked)[2];
    return error;
}

}  // namespace tex::inline v1
