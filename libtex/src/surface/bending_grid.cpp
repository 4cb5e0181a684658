// SPDX-License-Identifier: Apache-2.0

#include "surface/bending_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "kernels/deband.h"
#include "rows/straight_border.h"

namespace tex {
namespace {

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
        const Execution silent{execution.threads, {}};
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
        ApronRow weights(2 * ((width + 1) / 2)), low(width), high(width);
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
            const RowBounds bounds = bounds_of(grid_, at, low.data(), high.data());
            relax_row({row(bends, at - 1), row(bends, at), row(bends, at + 1), row(ahead, at), grid_.codes.row(at),
                       weights.data(), bounds.low, bounds.high},
                      width, older_.row(at));
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

void halve_rows(const BendingGrid& grid, int begin, int end, BendingGrid& out) {
    const auto [width, height] = grid.extent();
    const int count = (width + 1) / 2;
    EvenRows codes(width), low(width), high(width);
    ApronRow low0(width), high0(width), low1(width), high1(width);
    for (int j = begin; j < end; ++j) {
        const int upper = 2 * j, lower = std::min(2 * j + 1, height - 1);
        codes.take(grid.codes.row(upper), grid.codes.row(lower));
        halve_codes(codes.upper(), codes.lower(), count, out.codes.row(j));
        const RowBounds a = bounds_of(grid, upper, low0.data(), high0.data());
        const RowBounds b = bounds_of(grid, lower, low1.data(), high1.data());
        low.take(a.low, b.low);
        high.take(a.high, b.high);
        halve_bounds({low.upper(), high.upper()}, {low.lower(), high.lower()}, count, out.low.row(j), out.high.row(j));
    }
}

void refine_rows(const Plane<float>& coarse, const BendingGrid& grid, int begin, int end, Plane<float>& out) {
    const int width = grid.extent().width, count = coarse.extent().width;
    ApronRow near(count), far(count), wide(2 * count), low(width), high(width);
    for (int j = begin; j < end; ++j) {
        straight_row(coarse, grid.wrap_y, j / 2, near.data());
        straight_row(coarse, grid.wrap_y, j / 2 + (j % 2 == 0 ? -1 : 1), far.data());
        extrapolate_row(near.data(), far.data(), -0.25f, count, near.data());
        continue_ends(near.data(), count, grid.wrap_x);
        double_row(near.data(), count, wide.data());
        std::copy_n(wide.data(), width, out.row(j));
        const RowBounds bounds = bounds_of(grid, j, low.data(), high.data());
        limit_row(bounds.low, bounds.high, grid.least, width, out.row(j));
    }
}

}  // namespace

RowBounds bounds_of(const BendingGrid& grid, int j, float* low, float* high) {
    if (!grid.low.empty()) return {grid.low.row(j), grid.high.row(j)};
    bounds_of_codes(grid.codes.row(j), grid.least, grid.greatest, grid.extent().width, low, high);
    return {low, high};
}

Result<void> relax(const BendingGrid& grid, int steps, Plane<float>& heights, const Execution& execution,
                   ProgressSpan span) {
    Relaxation relaxation(grid, heights);
    double t = 1.0;  // Beck and Teboulle's sequence
    for (int k = 0; k < steps; ++k) {
        const double next = (1.0 + std::sqrt(1.0 + 4.0 * t * t)) / 2.0;
        const double part = (span.to - span.from) / steps;
        const ProgressSpan own{span.from + k * part, span.from + (k + 1) * part};
        if (auto done = relaxation.step(static_cast<float>((t - 1.0) / next), execution, own); !done) return done;
        t = next;
    }
    return {};
}

Result<BendingGrid> halve(const BendingGrid& grid, const Execution& execution) {
    const Extent extent{(grid.extent().width + 1) / 2, (grid.extent().height + 1) / 2};
    BendingGrid half{Plane<float>(extent), Plane<float>(extent), Plane<float>(extent), {},
                     grid.wrap_x,          grid.wrap_y,          grid.least,           grid.greatest};
    const Execution silent{execution.threads, {}};
    const auto body = [&](int begin, int end) { halve_rows(grid, begin, end, half); };
    if (auto done = parallel_for(silent, extent.height, kBendingStrip, body); !done) return done.error();
    return half;
}

Result<Plane<float>> refine(const Plane<float>& coarse, const BendingGrid& grid, const Execution& execution) {
    Plane<float> out(grid.extent());
    const Execution silent{execution.threads, {}};
    const auto body = [&](int begin, int end) { refine_rows(coarse, grid, begin, end, out); };
    if (auto done = parallel_for(silent, grid.extent().height, kBendingStrip, body); !done) return done.error();
    return out;
}

}  // namespace tex
