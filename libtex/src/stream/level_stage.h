// SPDX-License-Identifier: Apache-2.0
// level_stage.h: rows of the base level to rows of all mip levels, each of which keeps only the rows that its filter
// needs.

#pragma once

#include <memory>

#include <tex/mip.h>

#include "stream/level_step.h"
#include "stream/row_shelf.h"
#include "stream/strips.h"

namespace tex {

// The same texels as build_mip_chain().
class LevelStage {
public:
    // Rows of the base level will come in the order that row_shelf.h describes. `levels` is at least 1 and at most
    // level_count(base).
    LevelStage(Extent base, int levels, int start, const MipOptions& options, Strips& strips);

    LevelStage(const LevelStage&) = delete;
    LevelStage& operator=(const LevelStage&) = delete;

    // Row j of the base level is finished; it stays as it is while `owner` lives. Makes all rows of other levels that
    // can be made with it.
    void put(int j, const NormalRow& row, std::shared_ptr<const void> owner);

private:
    ShelfRow make_row(LevelStep& step, bool last);

    const MipOptions options_;
    Strips& strips_;
    std::unique_ptr<RowMaker> slopes_;  // of the base level, in the slope domain
    const int width_;
    LevelSteps steps_;
};

}  // namespace tex
