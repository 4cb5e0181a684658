// SPDX-License-Identifier: Apache-2.0

#include "surface/bending_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "kernels/deband.h"
#include "rows/straight_border.h"

namespace tex::inline v1 {
namespace {

// Smaller grids take less time for a step than threads take to wait for each other.
constexpr std::int64_t kWorthThreads = std::int64_t{256} * 256;

constexpr int kReach = kStraightApron;  // the squared Laplacian reaches two texels

// Steps of the projected gradient with momentum. Each reads the heights of the two steps before it, and writes over
// those of the older one. A strip therefore saves, before all others begin, the rows that it needs of its neighbours.
class Relaxation {
public:
    Relaxation(const BendingGrid& grid, Plane<float>& heights)
        : grid_(grid), extent_(grid.extent()), newer_(heights), older_(heights.clone()),
          strips_((extent_.height + kBendingStrip - 1) / kBendingStrip),
          saved_(Extent{kLead + extent_.width + kTail, 2 * kReach * strips_}) {}

    Result<void> step(float momentum, const Execution& execution, ProgressSpan span) {
        momentum_ = momentum;
        const Execution silent = execution.quiet();
        const auto save = [this](int begin, int end) {
            for (int s = begin; s < end; ++s) save_strip(s);
        };
        if (auto done = parallel_for(silent, strips_, 1, save); !done) return done;
        const auto move = [this](int begin, int end) {
            for (int s = begin; s < end; ++s) move_strip(s);
        };
        if (auto done = parallel_for(execution, strips_, 1, move, span); !done) return done;
        std::swap(newer_, older_);
        return {};
    }

private:
    static constexpr int kLead = 16;
    static constexpr int kTail = 64;

    [[nodiscard]] int begin_of(int strip) const { return strip * kBendingStrip; }
    [[nodiscard]] int end_of(int strip) const { return std::min(extent_.height, begin_of(strip) + kBendingStrip); }
    // Row k of the 2 kReach rows around a strip.
    [[nodiscard]] float* saved(int strip, int k) { return saved_.row(2 * kReach * strip + k) + kLead; }

    void save_strip(int strip) {
        ApronRow newer(extent_.width), older(extent_.width);
        for (int k = 0; k < 2 * kReach; ++k) {
            const int j = k < kReach ? begin_of(strip) - kReach + k : end_of(strip) + k - kReach;
            straight_row(newer_, grid_.wrap_y, j, newer.data());
            straight_row(older_, grid_.wrap_y, j, older.data());
            float* const out = saved(strip, k);
            extrapolate_row(newer.data(), older.data(), momentum_, extent_.width, out);
            continue_ends(out, extent_.width, grid_.wrap_x);
        }
    }

    void move_strip(int strip) {
        const int begin = begin_of(strip), end = end_of(strip), width = extent_.width;
        std::array<ApronRow, 5> ahead{ApronRow(width), ApronRow(width), ApronRow(width), ApronRow(width),
                                      ApronRow(width)};
        std::array<ApronRow, 3> bends{ApronRow(width), ApronRow(width), ApronRow(width)};
        ApronRow weights(2 * ((width + 1) / 2));
        const auto row = [&](auto& ring, int j) {
            return ring[static_cast<std::size_t>(j + kReach) % ring.size()].data();
        };
        for (int j = begin - kReach; j < end + kReach; ++j) {
            float* const heights = row(ahead, j);
            if (j >= begin && j < end) {
                extrapolate_row(newer_.row(j), older_.row(j), momentum_, width, heights);
                continue_ends(heights, width, grid_.wrap_x);
            } else {
                const float* from = saved(strip, j < begin ? j - begin + kReach : j - end + kReach);
                std::copy_n(from - kReach, width + 2 * kReach, heights - kReach);
            }
            if (j >= begin - kReach + 2)
                laplace_row(row(ahead, j - 2), row(ahead, j - 1), row(ahead, j), width, row(bends, j - 1));
            const int at = j - kReach;
            if (at < begin) continue;
            repeat_texels(grid_.weights.row(at / 2), (width + 1) / 2, weights.data());
            relax_row({row(bends, at - 1), row(bends, at), row(bends, at + 1), row(ahead, at), grid_.codes.row(at),
                       weights.data()},
                      grid_.range, width, older_.row(at));
        }
    }

    const BendingGrid& grid_;
    const Extent extent_;
    Plane<float>& newer_;
    Plane<float> older_;
    const int strips_;
    Plane<float> saved_;
    float momentum_ = 0.0f;
};

// Two rows of a plane, one below the other, of an even number of texels: the last one of an odd number occurs twice.
class EvenRows {
public:
    explicit EvenRows(int width) : width_(width), upper_(width), lower_(width) {}
    void take(const float* upper, const float* lower) {
        for (auto [from, to] : {std::pair(upper, upper_.data()), std::pair(lower, lower_.data())}) {
            std::copy_n(from, width_, to);
            to[width_] = to[width_ - 1];
        }
    }
    [[nodiscard]] const float* upper() const { return upper_.data(); }
    [[nodiscard]] const float* lower() const { return lower_.data(); }

private:
    int width_;
    ApronRow upper_, lower_;
};

void refine_rows(const Plane<float>& coarse, const BendingGrid& grid, int begin, int end, Plane<float>& out) {
    const int width = grid.extent().width, count = coarse.extent().width;
    std::array<ApronRow, 4> rows{ApronRow(count), ApronRow(count), ApronRow(count), ApronRow(count)};
    const float* const around[4] = {rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data()};
    ApronRow across(count), wide(2 * count);
    for (int j = begin; j < end; ++j) {
        if (j % 2 == 0) {
            std::copy_n(coarse.row(j / 2), count, across.data());
        } else {
            for (int k = 0; k < 4; ++k)
                straight_row(coarse, grid.wrap_y, j / 2 - 1 + k, rows[static_cast<std::size_t>(k)].data());
            between_rows(around, count, across.data());
        }
        continue_ends(across.data(), count, grid.wrap_x);
        double_row(across.data(), count, wide.data());
        std::copy_n(wide.data(), width, out.row(j));
        limit_row(grid.codes.row(j), grid.range, width, out.row(j));
    }
}

}  // namespace

Result<void> relax(const BendingGrid& grid, int steps, Plane<float>& heights, const Execution& execution,
                   ProgressSpan span) {
    Relaxation relaxation(grid, heights);
    Execution own = execution;
    if (grid.extent().texels() < kWorthThreads) own.threads = 1;
    double t = 1.0;  // Beck and Teboulle's sequence
    for (int k = 0; k < steps; ++k) {
        const double next = (1.0 + std::sqrt(1.0 + 4.0 * t * t)) / 2.0;
        const double part = (span.to - span.from) / steps;
        const ProgressSpan now{span.from + k * part, span.from + (k + 1) * part};
        if (auto done = relaxation.step(static_cast<float>((t - 1.0) / next), own, now); !done) return done;
        t = next;
    }
    return {};
}

Result<Plane<float>> halve(const Plane<float>& plane, HalveRows* halve_two, const Execution& execution) {
    const Extent full = plane.extent();
    Plane<float> out(Extent{(full.width + 1) / 2, (full.height + 1) / 2});
    const Execution silent = execution.quiet();
    const auto body = [&](int begin, int end) {
        EvenRows rows(full.width);
        for (int j = begin; j < end; ++j) {
            rows.take(plane.row(2 * j), plane.row(std::min(2 * j + 1, full.height - 1)));
            halve_two(rows.upper(), rows.lower(), out.extent().width, out.row(j));
        }
    };
    if (auto done = parallel_for(silent, out.extent().height, kBendingStrip, body); !done) return done.error();
    return out;
}

Result<Plane<float>> refine(const Plane<float>& coarse, const BendingGrid& grid, const Execution& execution) {
    Plane<float> out(grid.extent());
    const Execution silent = execution.quiet();
    const auto body = [&](int begin, int end) { refine_rows(coarse, grid, begin, end, out); };
    if (auto done = parallel_for(silent, grid.extent().height, kBendingStrip, body); !done) return done.error();
    return out;
}

}  // namespace tex::inline v1
