// SPDX-License-Identifier: Apache-2.0

#include "surface/nearest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "rows/border.h"

namespace tex::inline v1 {
namespace {

constexpr std::int32_t kNone = -1;

// The distance between texels i and k on an axis of n texels.
int axis_distance(int i, int k, int n, bool repeats) {
    const int straight = std::abs(i - k);
    return repeats ? std::min(straight, n - straight) : straight;
}

bool has_hole(const float* row, int count) {
    int holes = 0;  // all are counted, so that a vector of them is looked at together
    for (int i = 0; i < count; ++i) holes += std::isnan(row[i]) ? 1 : 0;
    return holes > 0;
}

// First pass: for columns [begin, end), finds the row of the nearest valid texel in the same column; the upper one if
// two are equally near. Rows without holes stay as they are, because nothing reads them.
void find_in_columns(PlaneView<const float> heights, const std::vector<std::uint8_t>& has_holes, bool repeats,
                     int begin, int end, Plane<std::int32_t>& nearest) {
    const int rows = heights.extent.height;
    std::vector<std::int32_t> last(static_cast<std::size_t>(end - begin));
    const auto is_full = [&](int row) { return has_holes[static_cast<std::size_t>(row)] == 0; };
    // Downwards: the valid texel above. On an axis that repeats, a second round lets texels at the bottom count for the
    // top.
    std::fill(last.begin(), last.end(), kNone);
    for (int j = repeats ? -rows : 0; j < rows; ++j) {
        const int row = wrap_around(j, rows);
        if (is_full(row)) {
            std::fill(last.begin(), last.end(), row);
            continue;
        }
        for (int i = begin; i < end; ++i) {
            std::int32_t& seen = last[static_cast<std::size_t>(i - begin)];
            if (!std::isnan(heights.at(i, row))) seen = row;
            nearest.at(i, row) = seen;
        }
    }
    // Upwards: the valid texel below, if it is nearer, or equally near and in a smaller row.
    std::fill(last.begin(), last.end(), kNone);
    for (int j = repeats ? 2 * rows - 1 : rows - 1; j >= 0; --j) {
        const int row = wrap_around(j, rows);
        if (is_full(row)) {
            std::fill(last.begin(), last.end(), row);
            continue;
        }
        for (int i = begin; i < end; ++i) {
            std::int32_t& seen = last[static_cast<std::size_t>(i - begin)];
            if (!std::isnan(heights.at(i, row))) seen = row;
            if (seen == kNone || j >= rows) continue;
            std::int32_t& best = nearest.at(i, row);
            const int below = axis_distance(row, seen, rows, repeats);
            const int above = best == kNone ? rows : axis_distance(row, best, rows, repeats);
            if (below < above || (below == above && seen < best)) best = seen;
        }
    }
}

// A valid texel as seen from one row.
struct Site {
    std::int64_t position;  // the column; column + k * columns for its repetitions
    std::int64_t square;    // of the distance from the row, in texels^2
    std::int32_t row;
    std::int32_t column;

    [[nodiscard]] bool before(const Site& other) const {
        return row != other.row ? row < other.row : column < other.column;
    }
};

// The first position from which `right` is nearer than `left`; right.position > left.position. The difference of their
// squared distances falls steadily. If both are equally near, the smaller row wins, then the smaller column.
std::int64_t takes_over(const Site& left, const Site& right) {
    const std::int64_t slope = 2 * (right.position - left.position);
    const std::int64_t rise =
        right.position * right.position - left.position * left.position + right.square - left.square;
    const std::int64_t quotient = rise / slope - (rise % slope < 0 ? 1 : 0);  // rounded down
    const bool tie = rise % slope == 0;
    return tie && right.before(left) ? quotient : quotient + 1;
}

// Second pass: the sites that are the nearest ones somewhere in a row, from left to right, each with the position at
// which it becomes the nearest.
class RowOfSites {
public:
    void clear() {
        sites_.clear();
        starts_.clear();
    }
    void add(const Site& site, std::int64_t columns) {
        while (!sites_.empty()) {
            const std::int64_t start = takes_over(sites_.back(), site);
            if (start > starts_.back()) {
                if (start < columns) push(site, start);
                return;
            }
            sites_.pop_back();
            starts_.pop_back();
        }
        push(site, 0);
    }
    // Calls fill(column, site) for columns 0, 1, ...
    template <class Fill>
    void for_each(int columns, Fill&& fill) const {
        std::size_t k = 0;
        for (int i = 0; i < columns; ++i) {
            while (k + 1 < sites_.size() && starts_[k + 1] <= i) ++k;
            fill(i, sites_[k]);
        }
    }

private:
    void push(const Site& site, std::int64_t start) {
        sites_.push_back(site);
        starts_.push_back(start);
    }
    std::vector<Site> sites_;
    std::vector<std::int64_t> starts_;
};

using Fill = std::function<void(const NearestTexel& hole)>;

void fill_row(PlaneView<const float> values, const Plane<std::int32_t>& nearest, int j, bool repeats_x, bool repeats_y,
              RowOfSites& sites, const Fill& fill) {
    const auto [columns, rows] = values.extent;
    sites.clear();
    // On an axis that repeats, the nearest texel is at most half the axis away on either side.
    const int margin = repeats_x ? columns / 2 + 1 : 0;
    for (int position = -margin; position < columns + margin; ++position) {
        const int column = wrap_around(position, columns);
        const std::int32_t row = nearest.at(column, j);
        if (row == kNone) continue;
        const std::int64_t distance = axis_distance(j, row, rows, repeats_y);
        sites.add({position, distance * distance, row, column}, columns);
    }
    sites.for_each(columns, [&](int i, const Site& site) {
        if (!std::isnan(values.at(i, j))) return;
        const std::int64_t across = site.position - i;
        fill({i, j, site.column, site.row, across * across + site.square});
    });
}

}  // namespace

Result<void> visit_holes(PlaneView<const float> values, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                         ProgressSpan span, const Fill& fill) {
    const Extent extent = values.extent;
    const bool repeats_x = wrap_x == Wrap::repeat, repeats_y = wrap_y == Wrap::repeat;
    const int rows_at_once = std::max(1, (1 << 15) / extent.width);
    std::vector<std::uint8_t> has_holes(static_cast<std::size_t>(extent.height));
    const auto look = [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            has_holes[static_cast<std::size_t>(j)] = has_hole(values.row(j), extent.width) ? 1 : 0;
    };
    if (auto done = parallel_for(execution.quiet(), extent.height, rows_at_once, look); !done) return done;
    Plane<std::int32_t> nearest(extent);
    const double half = (span.from + span.to) / 2;
    constexpr int kColumns = 256;
    const auto columns = [&](int begin, int end) {
        find_in_columns(values, has_holes, repeats_y, begin, end, nearest);
    };
    if (auto done = parallel_for(execution, extent.width, kColumns, columns, {span.from, half}); !done) return done;

    // A hole is written by the thread that processes its row. No thread reads holes, because sites are valid texels.
    const auto rows = [&](int begin, int end) {
        RowOfSites sites;
        for (int j = begin; j < end; ++j) {
            if (has_holes[static_cast<std::size_t>(j)] != 0)
                fill_row(values, nearest, j, repeats_x, repeats_y, sites, fill);
        }
    };
    return parallel_for(execution, extent.height, rows_at_once, rows, {half, span.to});
}

Result<void> fill_from_nearest(PlaneView<float> heights, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                               ProgressSpan span) {
    return visit_holes(heights, wrap_x, wrap_y, execution, span, [heights](const NearestTexel& hole) {
        heights.at(hole.i, hole.j) = heights.at(hole.column, hole.row);
    });
}

}  // namespace tex::inline v1
