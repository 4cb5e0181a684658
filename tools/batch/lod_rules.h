// SPDX-License-Identifier: Apache-2.0
// lod_rules.h: what becomes of the materials of a low mesh: maps in the model, or a picture for each.

#pragma once

#include <vector>

#include <tex/mesh.h>

#include "batch/plan.h"
#include "cli/command.h"
#include "options/rays.h"
#include "options/tangent_space.h"

namespace tex::cli {

// The options that decide about it.
struct LodOptions {
    const Command& command;
    const FileOptions& files;
    const TangentSpaceOptions& low;
    const TransferMaps& maps;
    ReadOptions read;
};

// Whether --material asks for all of them.
[[nodiscard]] bool takes_all_materials(const TangentSpaceOptions& low);

// If materials get maps, nothing else chooses parts of the low mesh. Guides are for one map, and so are reports of
// pictures. Throws UsageError.
void set_lod_rules(OutputRules& rules, const LodOptions& options);

}  // namespace tex::cli
