// SPDX-License-Identifier: Apache-2.0

#include "pipeline/level_stage.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/axis_filter.h"
#include "base/border.h"
#include "kernels/mip.h"

namespace tex {
namespace {

bool needs_rows_beyond_the_end(const AxisFilter& y, int from) {
    return 2 * (std::max(1, from / 2) - 1) + y.first + y.taps > from;
}

// The first row of the smaller level that needs no row before position `start` of the larger one, whose rows come from there on.
int first_row(const AxisFilter& y, Wrap wrap, int from, int start) {
    if (wrap != Wrap::repeat && start == 0) return 0;
    return std::min(std::max(1, from / 2), (std::max(0, start - y.first) + 1) / 2);
}

// What the rows at the end, and those that were put off, need.
Keep rows_to_keep(const AxisFilter& y, int from, int start, int first) {
    Keep keep;
    const int beyond = needs_rows_beyond_the_end(y, from)
                           ? 2 * (std::max(1, from / 2) - 1) + y.first + y.taps - from : 0;
    keep.head = std::max(0, 2 * first + y.first + y.taps) + beyond;
    keep.tail = beyond + 1;
    keep.all = from <= 4 * y.taps + 2 * std::abs(y.first) + 2 * start + 8;
    if (first == 0 && beyond == 0) keep = {};
    return keep;
}

}  // namespace

// One level and the next.
struct LevelStage::Step {
    Step(Extent from_extent, int level, int start, const MipOptions& options)
        : from(from_extent), to(level_extent(from_extent, 1)), to_level(level + 1),
          halves(options.filter == MipFilter::box && from.width % 2 == 0 && from.height % 2 == 0),
          x(make_axis_filter(options.filter, from.width)), y(make_axis_filter(options.filter, from.height)),
          filter(x, y, options.wrap_x, from.width), first(first_row(y, options.wrap_y, from.height, start)),
          next(first), shelf(from.height, start, rows_to_keep(y, from.height, start, first)), rows(to.width, 3),
          window(static_cast<std::size_t>(y.taps)), wrap_y(options.wrap_y) {}

    // Where the window of the next row begins, as a position in the larger level.
    [[nodiscard]] int begin() const {
        return 2 * (next % to.height) + y.first + (next >= to.height ? from.height : 0);
    }
    // The row of the larger level that is the k-th in the window of the next row.
    [[nodiscard]] int source(int k) const {
        return border_index(wrap_y, 2 * (next % to.height) + y.first + k, from.height);
    }
    [[nodiscard]] bool is_ready() const {
        if (next == first + to.height) return false;
        for (int k = y.taps - 1; k >= 0; --k) {
            if (!shelf.has(source(k))) return false;
        }
        return true;
    }

    const Extent from;
    const Extent to;
    const int to_level;
    const bool halves;
    const AxisFilter x;
    const AxisFilter y;
    MipRows filter;
    const int first;  // the position of the first row that is made
    int next;         // of the next one
    RowShelf shelf;   // rows of `from`
    RowMaker rows;    // for rows of `to`
    std::vector<const float*> window;
    const Wrap wrap_y;
};

LevelStage::LevelStage(Extent base, int levels, int start, const MipOptions& options, Strips& strips)
    : options_(options), strips_(strips), width_(base.width) {
    if (options.domain == MipDomain::slope && levels > 1) slopes_ = std::make_unique<RowMaker>(base.width, 2);
    for (int k = 0; k + 1 < levels; ++k) {
        steps_.push_back(std::make_unique<Step>(level_extent(base, k), k, start, options));
        start = steps_.back()->first % steps_.back()->to.height;
    }
}

LevelStage::~LevelStage() = default;

void LevelStage::put(int j, const NormalRow& row, std::shared_ptr<const void> owner) {
    if (steps_.empty()) return;
    if (!slopes_) return put_row(0, j, {{row.x, row.y, row.z}, std::move(owner)});
    const std::shared_ptr<Plane<float>> slopes = slopes_->make();
    slopes_of_vectors(row.x, row.y, row.z, width_, slopes->row(0), slopes->row(1));
    put_row(0, j, {{slopes->row(0), slopes->row(1), nullptr}, slopes});
}

void LevelStage::put_row(std::size_t k, int j, ShelfRow row) {
    Step& step = *steps_[k];
    step.shelf.put(j, std::move(row));
    while (step.is_ready()) make_row(k);
}

// The averages stay until the next level has been made of them; what is stored is a finished copy.
void LevelStage::make_row(std::size_t k) {
    Step& step = *steps_[k];
    const int j = step.next % step.to.height;
    const int width = step.to.width;
    const int planes = options_.domain == MipDomain::vector ? 3 : 2;
    const bool last = k + 1 == steps_.size();
    const Strips::Place place = strips_.place(step.to_level, j);
    const NormalRow& stored = place.row;
    float* const outs[3] = {stored.x, stored.y, stored.z};
    ShelfRow averages;
    for (int plane = 0; plane < planes; ++plane) {
        for (int t = 0; t < step.y.taps; ++t) {
            step.window[static_cast<std::size_t>(t)] = step.shelf.at(step.source(t)).planes[plane];
        }
        if (step.halves) {
            halve_rows(step.window[0], step.window[1], width, outs[plane]);
        } else {
            step.filter.make(step.window.data(), j, outs[plane]);
        }
    }
    if (!last) {
        const std::shared_ptr<Plane<float>> kept = step.rows.make();
        for (int plane = 0; plane < planes; ++plane) {
            std::memcpy(kept->row(plane), outs[plane], static_cast<std::size_t>(width) * sizeof(float));
            averages.planes[plane] = kept->row(plane);
        }
        averages.owner = kept;
    }
    finish_row(stored, width, options_.domain, fade_at(options_.fade, step.to_level));
    strips_.finish(step.to_level, j);
    ++step.next;
    step.shelf.release_before(step.begin());
    if (!last) put_row(k + 1, j, std::move(averages));
}

}  // namespace tex
