// SPDX-License-Identifier: Apache-2.0
// level_stage.h: from rows of the base level to rows of all mip levels, and to their targets. The same texels as
// build_mip_chain() and build_roughness_chain().

#pragma once

#include <functional>

#include <tex/mip.h>

#include "stream/flow.h"
#include "stream/material_roughness.h"
#include "stream/targets.h"

namespace tex::inline v1 {

// Called with rows that have been written, from any thread.
using WatchRows = std::function<void(const LevelRows& rows)>;

// The levels that are made from a base level.
struct MadeLevels {
    int first = 0;       // the level of the file that the base level is; below 0 if it and others are left out
    int count = 1;       // levels that are made, including the base level
    MipOptions options;  // counted from the base level: see counted_from_base()
    ExtraSet extras;     // that the base level has; smaller levels get them as options.blue and alpha say
};

// Adds what makes the levels from `normals` and writes them to `targets`. `seen` may be empty. All parameters but
// `levels` must outlive the flow.
void add_levels(Flow& flow, const Stage& normals, const MadeLevels& levels, Targets& targets,
                const WatchRows& seen = {});

// Adds the roughness that the normals of a level call for.
void add_roughness(Flow& flow, const Stage& normals, const MadeLevels& levels, RoughnessModel model,
                   const MaterialRoughness& own, Targets& targets);

}  // namespace tex::inline v1
