// SPDX-License-Identifier: Apache-2.0

#include "surface/horizon_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "rows/border.h"

namespace tex::inline v1 {
namespace {

// Rows whose horizons are found together, with one search of each hull.
constexpr int kRowsTogether = kMostRows;

// The hull of a line holds what is farther than so many rows from the first of those. Mean error of occlusion on all
// maps of occlusion_bench: 0.00074 with 4 rows, 0.00068 with 6.
constexpr int kNearRows = 6;

// Hulls get one point of so many rows at a time: with 4, a tenth less time, and 0.0020 instead of 0.0015 on the
// roughest map. In the run-in, which is far away from most texels, 8 change nothing.
constexpr int kPushedTogether = 2;
constexpr int kFarPushedTogether = 8;
constexpr int kFarAway = 64;

// What did not pay: one hull for two lines (a quarter less time, but half a texel beside a groove its occlusion is
// wrong by 0.016); three searches, for the lowest, the middle and the highest texel (slower, and no nearer); four
// vectors searched together.

constexpr int kMargin = 8;                              // columns of a window beside the lines of a band
constexpr int kWindow = kBandLines + 2 * kMargin + 16;  // and room for a whole vector
constexpr int kHeld = 32;                               // windows: a power of two
static_assert(kHeld >= kRowsTogether + kNearRows + kFarPushedTogether);
static_assert(kMostNearPoints >= kNearRows + kRowsTogether + 1);

// The steps before the first texels: as many as the field is long, and at least so many that what repeats of a small
// field looks the same from everywhere.
int run_in_of(int height) { return (std::max(height, 256) + kFarPushedTogether - 1) & -kFarPushedTogether; }

int floor_of(double x) { return static_cast<int>(std::floor(x)); }

void fetch_floats(const float* from, int count) {
#if defined(__GNUC__)
    for (int i = 0; i < count; i += 16) __builtin_prefetch(from + i);
#else
    (void)from, (void)count;
#endif
}

}  // namespace

SkyRow SkySums::at(int row, int column) {
    const auto in = [&](Plane<float>& plane) { return plane.empty() ? nullptr : plane.row(row) + column; };
    return {in(occlusion), in(sky), in(x), in(y), in(z), in(horizon)};
}

HorizonSweep::Stacks::Stacks(Extent extent) {
    const int longest = std::max(extent.width, extent.height);
    points_ = Plane<float>({2 * kBandLines, (longest + run_in_of(longest)) / kPushedTogether + kHeld});
    hulls_.points = points_.row(0);
    kept_ = Plane<float>({kBandLines, longest});
}

// One direction of a band: from the run-in, whose rows only hide, to the last step in which a line meets a texel.
class HorizonSweep::Band {
public:
    Band(const HorizonSweep& sweep, int which, int first_line, int lines, Stacks& stacks)
        : sweep_(sweep), field_(sweep.field_), plan_(sweep.plan_), which_(which),
          upwards_(plan_.directions[which].upwards), hulls_(stacks.hulls_), kept_(stacks.kept_),
          first_line_(first_line), lines_(lines), ahead_slant_(upwards_ ? -plan_.slant : plan_.slant) {
        find_steps();
    }

    void run() {
        if (first_ == end_) return;
        clear_hulls(hulls_);
        const int start = first_ - run_in_of(field_.extent().height);
        int pushed = start;  // rows before this one are in the hulls
        for (int step = start; step < end_; step += kRowsTogether) {
            const int end = std::min(step + kRowsTogether, end_);
            for (int k = step; k < end; ++k) open_window(k);
            const int group = step < first_ - kFarAway ? kFarPushedTogether : kPushedTogether;
            for (; step - kNearRows - pushed >= group; pushed += group) push(pushed, pushed + group, start, step);
            if (step + kRowsTogether >= first_) fetch_next(step + kRowsTogether);
            if (step < first_) continue;
            measure(step, end, start, pushed);
            if (is_last()) {
                for (int k = step; k < end; ++k) add_row(k);
            }
        }
    }

private:
    [[nodiscard]] bool is_last() const { return which_ == plan_.count - 1; }

    // The row of a step, which may lie outside the field, and the one inside whose heights it has.
    [[nodiscard]] int row_of(int step) const { return upwards_ ? field_.extent().height - 1 - step : step; }
    [[nodiscard]] int row_in_field(int step) const {
        return border_index(field_.down, row_of(step), field_.extent().height);
    }
    [[nodiscard]] int shift_at(int step) const { return sweep_.shift_at(row_of(step)); }

    // The steps in which one of the lines is in the field.
    void find_steps() {
        const Extent extent = field_.extent();
        first_ = 0;
        end_ = extent.height;
        if (sweep_.repeats_) return;
        const auto is_outside = [&](int step) {
            const int column = first_line_ + shift_at(step);
            return column + lines_ <= 0 || column >= extent.width;
        };
        while (first_ < end_ && is_outside(first_)) ++first_;
        while (end_ > first_ && is_outside(end_ - 1)) --end_;
        first_ &= -kRowsTogether;  // in all bands the same rows are measured together
    }

    // The heights of a row, from kMargin columns before the first line on.
    void open_window(int step) {
        const Extent extent = field_.extent();
        const float* const row = field_.heights.row(row_in_field(step));
        int column = first_line_ + shift_at(step) - kMargin;
        if (sweep_.repeats_) column = wrap_around(column, extent.width);
        const auto place = static_cast<std::size_t>(step & (kHeld - 1));
        if (column >= 0 && column + kWindow <= extent.width) {
            windows_[place] = row + column;
            return;
        }
        float* const copy = copies_[place].data();
        for (int i = 0; i < kWindow;) {
            const int from = border_index(field_.across, column + i, extent.width);
            const bool is_inside = sweep_.repeats_ || from == column + i;
            const int count = is_inside ? std::min(kWindow - i, extent.width - from) : 1;
            std::copy_n(row + from, count, copy + i);
            i += count;
        }
        windows_[place] = copy;
    }
    // Asks for the texels of some steps, whose rows lie far apart: processors foresee only what goes on along a row.
    // Without it, a fifth more time.
    void fetch_next(int begin) const {
        for (int step = begin; step < std::min(begin + kRowsTogether, end_); ++step) fetch(step);
    }
    void fetch(int step) const {
        const int width = field_.extent().width, row = row_in_field(step);
        int column = first_line_ + shift_at(step);
        if (sweep_.repeats_) column = wrap_around(column, width);
        const int begin = std::clamp(column, 0, width), end = std::clamp(column + lines_, 0, width);
        fetch_floats(field_.heights.row(row) + begin, end - begin);
        if (!is_last()) return;
        const SkySums& sums = sweep_.sums_;
        for (const Plane<float>* const plane :
             {&field_.p, &field_.q, &sums.occlusion, &sums.sky, &sums.x, &sums.y, &sums.z, &sums.horizon}) {
            if (!plane->empty()) fetch_floats(plane->row(row) + begin, end - begin);
        }
    }
    // The height of line 0 of the band in a step, rounded.
    [[nodiscard]] const float* window(int step) const {
        return windows_[static_cast<std::size_t>(step & (kHeld - 1))] + kMargin;
    }

    // One of steps [begin, end): the highest as seen from step `seen`.
    void push(int begin, int end, int start, int seen) {
        LineRow rows[kHeld];
        int count = 0;
        for (int step = begin; step < end; ++step) {
            rows[count++] = line_row(step, start);
        }
        const TexelRow from{window(seen), line_row(seen, start), nullptr, 0, nullptr};
        push_highest(hulls_, rows, count, from, plan_.bend);
    }

    // Where the lines are in a step.
    [[nodiscard]] LineRow line_row(int step, int start) const {
        const double column = plan_.slant * row_of(step);
        const int left = floor_of(column);
        return {window(step) + (left - shift_at(step)), static_cast<float>(column - left),
                static_cast<float>(step - start)};
    }

    // The horizons of steps [begin, end).
    void measure(int begin, int end, int start, int pushed) {
        NearPoint points[kRowsTogether][kMostNearPoints];
        TexelRow rows[kRowsTogether];
        for (int step = begin; step < end; ++step) {
            const int k = step - begin;
            const int count = find_near(step, pushed, points[k]);
            rows[k] = {window(step), line_row(step, start), points[k], count, horizons_of(step)};
        }
        find_horizons(hulls_, rows, end - begin, plan_.bend);
    }
    [[nodiscard]] float* horizons_of(int step) {
        return is_last() ? horizons_[step & (kRowsTogether - 1)] : kept_.row(row_of(step));
    }
    // Points near the texels of a step: what lies next to them, the nearest rows, and where the view crosses the next
    // column.
    int find_near(int step, int pushed, NearPoint* points) const {
        const double steep = std::abs(ahead_slant_);
        const int side = ahead_slant_ > 0.0 ? -1 : 1;
        const auto behind = [&](int rows, int columns) {
            return window(step - rows) + (shift_at(step) - shift_at(step - rows) + columns);
        };
        int count = 0;
        points[count++] = {behind(0, side), behind(1, 0), static_cast<float>(steep), 1.0f, 0.0f};
        for (int rows = 1; rows <= step - pushed; ++rows) {
            const double column = -ahead_slant_ * rows;
            const int left = floor_of(column);
            points[count++] = point(behind(rows, left), behind(rows, left + 1), column - left, rows);
        }
        if (steep > 0.5) {
            const double rows = 1.0 / steep;
            points[count++] = point(behind(1, side), behind(2, side), rows - 1.0, rows);
        }
        return count;
    }
    [[nodiscard]] NearPoint point(const float* a, const float* b, double part, double rows) const {
        return {a, b, static_cast<float>((1.0 - part) / rows), static_cast<float>(part / rows),
                static_cast<float>(static_cast<double>(plan_.bend) * rows)};
    }

    void add_row(int step) {
        const int width = field_.extent().width;
        int column = first_line_ + shift_at(step);
        if (!sweep_.repeats_) {
            add(step, column, std::max(0, -column), std::min(lines_, width - column));
            return;
        }
        column = wrap_around(column, width);
        const int before_border = std::min(lines_, width - column);
        add(step, column, 0, before_border);
        add(step, column - width, before_border, lines_);
    }
    // Lines [begin, end), of which line 0 is in `column`.
    void add(int step, int column, int begin, int end) {
        if (begin >= end) return;
        const int row = row_of(step), first = column + begin;
        const auto slopes = [&](const Plane<float>& plane) { return plane.empty() ? nullptr : plane.row(row) + first; };
        const SkyView own{horizons_of(step) + begin, plan_.directions[which_].sky};
        const SkyView views[2] = {own, {kept_.row(row) + begin, plan_.directions[0].sky}};
        add_sky(views, plan_.count, slopes(field_.p), slopes(field_.q), end - begin, sweep_.sums_.at(row, first));
    }

    const HorizonSweep& sweep_;
    const HorizonField& field_;
    const SweepLines& plan_;
    const int which_;
    const bool upwards_;
    HullBand& hulls_;
    Plane<float>& kept_;
    const int first_line_, lines_;
    const double ahead_slant_;  // columns from step to step
    int first_ = 0, end_ = 0;
    std::array<const float*, kHeld> windows_{};
    std::array<std::array<float, kWindow>, kHeld> copies_;
    alignas(64) float horizons_[kRowsTogether][kBandLines];
};

HorizonSweep::HorizonSweep(const HorizonField& field, const SweepLines& lines, SkySums& sums)
    : field_(field), plan_(lines), sums_(sums), repeats_(field.across == Wrap::repeat) {
    const Extent extent = field.extent();
    lines_ = extent.width;
    run_in_ = run_in_of(extent.height);
    shifts_.reserve(static_cast<std::size_t>(2 * run_in_ + extent.height));
    for (int row = -run_in_; row < extent.height + run_in_; ++row) shifts_.push_back(floor_of(lines.slant * row + 0.5));
    if (!repeats_) {
        const int last = shift_at(extent.height - 1);
        first_line_ = std::min(0, -last);
        lines_ += std::abs(last);
    }
    bands_ = (lines_ + kBandLines - 1) / kBandLines;
}

void HorizonSweep::sweep(int band, Stacks& stacks) const {
    const int first = band * kBandLines;
    for (int k = 0; k < plan_.count; ++k)
        Band(*this, k, first_line_ + first, std::min(kBandLines, lines_ - first), stacks).run();
}

}  // namespace tex::inline v1
