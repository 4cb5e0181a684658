// SPDX-License-Identifier: Apache-2.0
// background_fill.h: tries the fix of N215: which texels would change that are no background.

#pragma once

#include <cstdint>
#include <string>

#include <tex/types.h>

#include "checks/background.h"
#include "checks/stored.h"

namespace tex::inline v1 {

struct FillHarm {
    std::int64_t texels = 0;       // that hold normals of their own, and would get those of other texels
    double degrees = 0.0;          // the most by which one is turned
    int column = 0, row = 0;       // the first
    bool may_be_a_normal = false;  // the value of the background itself may be that of bevels

    // Single ones are what compression left.
    [[nodiscard]] bool is_any() const;
    [[nodiscard]] std::string text() const;
};

// Gives the background the normals of the nearest other texels, as --fill-background does, in memory. A texel beside
// the background is a mixture, and ought to change, if its direction lies between the background's value and a normal
// near it; and it is noise if fewer than two of its neighbours have nearly its direction. All others hold normals that
// the fix would destroy: bevels at the border, whose lengths some tool changed. Errors: out_of_memory, cancelled.
Result<FillHarm> harm_of_filling(const Stored& stored, const Background& background, const Execution& execution);

}  // namespace tex::inline v1
