// SPDX-License-Identifier: Apache-2.0
// auto_levels.h: levels that an editor chose for each channel, so that all of them reach from black to white.

#pragma once

#include <optional>

#include <tex/check.h>

#include "checks/centre.h"
#include "checks/context.h"

namespace tex::inline v1 {

// Errors as in ToneFit.
struct AutoLevels {
    ChannelTones curves;
    double as_stored = 0.0, error = 0.0;
};

// The levels of x, y and z that make z follow from x and y, where each of the three reaches both ends as stored, and
// where no curve of all three explains z as well. Nothing elsewhere. Precondition: x, y and z are stored, unsigned.
std::optional<AutoLevels> find_auto_levels(const CheckContext& context, const Centre& centre);

}  // namespace tex::inline v1
