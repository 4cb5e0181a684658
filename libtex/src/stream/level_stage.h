// SPDX-License-Identifier: Apache-2.0
// level_stage.h: turns rows of the base level into rows of all mip levels. Each level keeps only the rows that its
// filter needs.

#pragma once

#include <memory>

#include <tex/mip.h>

#include "stream/level_step.h"
#include "stream/row_shelf.h"
#include "stream/strips.h"

namespace tex {

// Makes the same texels as build_mip_chain().
class LevelStage {
public:
    // Rows of the base level arrive in the order that row_shelf.h describes. `levels` is at least 1 and at most
    // level_count(base).
    LevelStage(Extent base, int levels, int start, const MipOptions& options, Strips& strips);

    LevelStage(const LevelStage&) = delete;
    LevelStage& operator=(const LevelStage&) = delete;

    // Adds row j of the base level, which is finished and does not change while `owner` lives. Makes every row of the
    // other levels that this row completes.
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
