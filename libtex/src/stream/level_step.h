// SPDX-License-Identifier: Apache-2.0
// level_step.h: the step from one level to the next: which rows of the larger level are needed, and for how long.

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

// Put rows of the larger level on the shelf in the order that row_shelf.h describes. While is_ready(), make row() of
// the smaller level from window(), then call advance().
struct LevelStep {
    // The step down from level `level`, whose rows begin with row `start`. Rows have up to `planes` planes.
    LevelStep(Extent from, int level, int planes, int start, const MipOptions& options);

    [[nodiscard]] bool is_ready() const;
    [[nodiscard]] int row() const { return next % to.height; }
    // The y.taps rows of one plane from which row() is made. They stay valid until the next call.
    const float* const* window(int plane);
    void advance();

    // The first row of the smaller level to make.
    [[nodiscard]] int start() const { return first % to.height; }

    const LevelFilter filter;
    const Extent to;
    const int to_level;
    MipRows maker;
    const int first;  // the position of the first row to make
    int next;         // the position of the next row to make
    RowShelf shelf;   // rows of `from`
    RowMaker rows;    // for rows of `to`

private:
    // The position in the larger level at which the window of the next row begins.
    [[nodiscard]] int begin() const;
    // The row of the larger level that is k-th in the window of the next row.
    [[nodiscard]] int source(int k) const { return filter.source(row(), k); }

    std::vector<const float*> window_;
};

// All steps from a base level to the smaller levels.
class LevelSteps {
public:
    // Makes row step.row() of the smaller level. Returns its averages, which the next step needs, unless this step is
    // the last.
    using MakeRow = std::function<ShelfRow(LevelStep& step, bool last)>;

    // Makes `levels` levels, including the base level. The other parameters are those of LevelStep.
    LevelSteps(Extent base, int levels, int planes, int start, const MipOptions& options, MakeRow make);

    [[nodiscard]] bool empty() const { return steps_.empty(); }

    // Adds row j of the base level. Makes every row of the other levels that this row completes.
    void put(int j, ShelfRow row) {
        if (!empty()) put(0, j, std::move(row));
    }

private:
    void put(std::size_t step, int j, ShelfRow row);

    std::vector<std::unique_ptr<LevelStep>> steps_;  // steps_[k] makes level k + 1 from level k
    const MakeRow make_;
};

}  // namespace tex
