// SPDX-License-Identifier: Apache-2.0
// level_step.h: one level and the next: which rows of the larger one are needed, and for how long.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <tex/mip.h>

#include "rows/mip_rows.h"
#include "stream/row_shelf.h"

namespace tex {

// Rows of the larger level go to the shelf, in the order that row_shelf.h describes; while is_ready(), row() of the
// smaller one can be made of window(), and advance() follows.
struct LevelStep {
    // From level `level`, whose first row to come is `start`. Rows have up to `planes` planes.
    LevelStep(Extent from, int level, int planes, int start, const MipOptions& options);

    [[nodiscard]] bool is_ready() const;
    [[nodiscard]] int row() const { return next % to.height; }
    // The y.taps rows, of one plane, that it is made of. They stand until the next call.
    const float* const* window(int plane);
    void advance();

    // The first row of the smaller level that is made.
    [[nodiscard]] int start() const { return first % to.height; }

    const LevelFilter filter;
    const Extent to;
    const int to_level;
    MipRows maker;
    const int first;  // the position of the first row that is made
    int next;         // of the next one
    RowShelf shelf;   // rows of `from`
    RowMaker rows;    // for rows of `to`

private:
    // Where the window of the next row begins, as a position in the larger level.
    [[nodiscard]] int begin() const;
    // The row of the larger level that is the k-th in the window of the next row.
    [[nodiscard]] int source(int k) const { return filter.source(row(), k); }

    std::vector<const float*> window_;
};

// All steps down from a base level.
class LevelSteps {
public:
    // Makes row step.row() of the smaller level. Returns its averages, for the next step, unless `step` is the last.
    using MakeRow = std::function<ShelfRow(LevelStep& step, bool last)>;

    // To `levels` levels, the base level included. Otherwise as LevelStep.
    LevelSteps(Extent base, int levels, int planes, int start, const MipOptions& options, MakeRow make);

    [[nodiscard]] bool empty() const { return steps_.empty(); }

    // Row j of the base level. Makes all rows of other levels that can be made with it.
    void put(int j, ShelfRow row) {
        if (!empty()) put(0, j, std::move(row));
    }

private:
    void put(std::size_t step, int j, ShelfRow row);

    std::vector<std::unique_ptr<LevelStep>> steps_;  // [k] makes level k + 1 of level k
    const MakeRow make_;
};

}  // namespace tex
