// SPDX-License-Identifier: Apache-2.0

#include "stream/level_step.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <tex/mip_chain.h>

namespace tex {
namespace {

bool needs_rows_beyond_the_end(const AxisFilter& y, int from) {
    return 2 * (std::max(1, from / 2) - 1) + y.first + y.taps > from;
}

// The first row of the smaller level that needs no row before position `start` of the larger one. The rows of the
// larger level begin there.
int first_row(const AxisFilter& y, Wrap wrap, int from, int start) {
    if (wrap != Wrap::repeat && start == 0) return 0;
    return std::min(std::max(1, from / 2), (std::max(0, start - y.first) + 1) / 2);
}

// What must be kept for the rows at the end and for the rows that were postponed.
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

LevelStep::LevelStep(Extent from, int level, int planes, int start, const MipOptions& options)
    : filter(from, options), to(filter.to), to_level(level + 1), maker(filter),
      first(first_row(filter.y, options.wrap_y, from.height, start)), next(first),
      shelf(from.height, start, rows_to_keep(filter.y, from.height, start, first)), rows(to.width, planes),
      window_(static_cast<std::size_t>(filter.y.taps)) {}

int LevelStep::begin() const { return 2 * row() + filter.y.first + (next >= to.height ? filter.from.height : 0); }

bool LevelStep::is_ready() const {
    if (next == first + to.height) return false;
    for (int k = filter.y.taps - 1; k >= 0; --k) {
        if (!shelf.has(source(k))) return false;
    }
    return true;
}

const float* const* LevelStep::window(int plane) {
    for (int k = 0; k < filter.y.taps; ++k) window_[static_cast<std::size_t>(k)] = shelf.at(source(k)).planes[plane];
    return window_.data();
}

void LevelStep::advance() {
    ++next;
    shelf.release_before(begin());
}

LevelSteps::LevelSteps(Extent base, int levels, int planes, int start, const MipOptions& options, MakeRow make)
    : make_(std::move(make)) {
    for (int k = 0; k + 1 < levels; ++k) {
        steps_.push_back(std::make_unique<LevelStep>(level_extent(base, k), k, planes, start, options));
        start = steps_.back()->start();
    }
}

void LevelSteps::put(std::size_t k, int j, ShelfRow row) {
    LevelStep& step = *steps_[k];
    const bool last = k + 1 == steps_.size();
    step.shelf.put(j, std::move(row));
    while (step.is_ready()) {
        const int made = step.row();
        ShelfRow averages = make_(step, last);
        step.advance();
        if (!last) put(k + 1, made, std::move(averages));
    }
}

}  // namespace tex
