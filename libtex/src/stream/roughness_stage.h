// SPDX-License-Identifier: Apache-2.0
// roughness_stage.h: turns rows of the base level's normals into rows of roughness of all levels.

#pragma once

#include <memory>

#include <tex/mip.h>
#include <tex/roughness.h>

#include "stream/level_step.h"
#include "stream/own_roughness.h"
#include "stream/row_shelf.h"
#include "stream/strips.h"

namespace tex {

// Makes the same values as build_roughness_chain().
class RoughnessStage {
public:
    // `own` is the material's roughness at the base level; it must outlive this object. Rows come from the top. The
    // other parameters are those of LevelStage.
    RoughnessStage(Extent base, int levels, const MipOptions& options, RoughnessModel model, const OwnRoughness& own,
                   Strips& strips);
    RoughnessStage(const RoughnessStage&) = delete;
    RoughnessStage& operator=(const RoughnessStage&) = delete;

    void put(int j, const NormalRow& row, std::shared_ptr<const void> owner);

private:
    ShelfRow make_row(LevelStep& step);

    const RoughnessModel model_;
    Strips& strips_;
    const OwnRoughness& own_;
    RowMaker alpha2_;
    LevelSteps steps_;  // of x, y, z and alpha^2
};

}  // namespace tex
