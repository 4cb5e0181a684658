// SPDX-License-Identifier: Apache-2.0
// repair_plan.h: which steps may undo a finding.

#pragma once

#include <optional>
#include <vector>

#include <tex/repair.h>

namespace tex::inline v1 {

// What somebody knows who may choose among repairs.
struct KnownOfMap {
    bool y = false;  // the direction of green is required or stated
    std::optional<MirroredChannel> mirrored = {};
    bool bumpiness = false;
    std::optional<TurnedPicture> turned = {};
    bool heights = false;
};

// The steps to try for this row of rule_repairs(), the likeliest first; none if it does not concern the finding, or if
// the layout has no room for the result. A step whose class is `choice` is one of several that nothing chose.
[[nodiscard]] std::vector<RepairStep> steps_for(const RuleRepair& row, const Finding& finding,
                                                const CheckReport& report, const KnownOfMap& known);

// The first of these steps, of all rows.
[[nodiscard]] std::optional<RepairStep> first_step(const Finding& finding, const CheckReport& report,
                                                   const KnownOfMap& known);

// The steps that may undo one of two damages that hide each other. `rule` is the one that found no normal map.
[[nodiscard]] std::vector<RepairStep> guesses_for(const Rule& rule, const CheckReport& report);

}  // namespace tex::inline v1
