// SPDX-License-Identifier: Apache-2.0

#include "stream/level_step.h"

#include <algorithm>
#include <cstdlib>

#include <tex/mip_chain.h>

#include "rows/border.h"

namespace tex {
namespace {

bool needs_rows_beyond_the_end(const AxisFilter& y, int from) {
    return 2 * (std::max(1, from / 2) - 1) + y.first + y.taps > from;
}

// The first row of the smaller level that needs no row before position `start` of the larger one, whose rows come from
// there on.
int first_row(const AxisFilter& y, Wrap wrap, int from, int start) {
    if (wrap != Wrap::repeat && start == 0) return 0;
    return std::min(std::max(1, from / 2), (std::max(0, start - y.first) + 1) / 2);
}

// What the rows at the end, and those that were put off, need.
Keep rows_to_keep(const AxisFilter& y, int from, int start, int first) {
    Keep keep;
    const int beyond =
        needs_rows_beyond_the_end(y, from) ? 2 * (std::max(1, from / 2) - 1) + y.first + y.taps - from : 0;
    keep.head = std::max(0, 2 * first + y.first + y.taps) + beyond;
    keep.tail = beyond + 1;
    keep.all = from <= 4 * y.taps + 2 * std::abs(y.first) + 2 * start + 8;
    if (first == 0 && beyond == 0) keep = {};
    return keep;
}

}  // namespace

LevelStep::LevelStep(Extent from_extent, int level, int planes, int start, const MipOptions& options)
    : from(from_extent), to(level_extent(from_extent, 1)), to_level(level + 1),
      halves(options.filter == MipFilter::box && from.width % 2 == 0 && from.height % 2 == 0),
      x(make_axis_filter(options.filter, from.width)), y(make_axis_filter(options.filter, from.height)),
      filter(x, y, options.wrap_x, from.width), first(first_row(y, options.wrap_y, from.height, start)), next(first),
      shelf(from.height, start, rows_to_keep(y, from.height, start, first)), rows(to.width, planes),
      window_(static_cast<std::size_t>(y.taps)), wrap_y_(options.wrap_y) {}

int LevelStep::begin() const { return 2 * row() + y.first + (next >= to.height ? from.height : 0); }

int LevelStep::source(int k) const { return border_index(wrap_y_, 2 * row() + y.first + k, from.height); }

bool LevelStep::is_ready() const {
    if (next == first + to.height) return false;
    for (int k = y.taps - 1; k >= 0; --k) {
        if (!shelf.has(source(k))) return false;
    }
    return true;
}

const float* const* LevelStep::window(int plane) {
    for (int k = 0; k < y.taps; ++k) window_[static_cast<std::size_t>(k)] = shelf.at(source(k)).planes[plane];
    return window_.data();
}

void LevelStep::advance() {
    ++next;
    shelf.release_before(begin());
}

}  // namespace tex
