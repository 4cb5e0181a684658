// SPDX-License-Identifier: Apache-2.0
// y_verdict.h: what the curl of a map says about green. check() and whatever measures y of an input decide by it, so
// that one map has one direction everywhere.

#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tex/check.h>

#include "checks/curl.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// Regions of both directions: maps of both conventions were pasted together.
struct MixedY {
    YAxis y = YAxis::up;          // the direction of fewer regions,
    std::vector<Region> regions;  // which are these
    std::size_t clear = 0;        // the number of regions that show a direction
    std::vector<Region> streaks;  // regions that have no say: padding

    [[nodiscard]] double share() const { return static_cast<double>(regions.size()) / static_cast<double>(clear); }
    [[nodiscard]] std::string text() const;  // "24 of 155 regions point down, the others up"
};

struct YVerdict {
    std::optional<YAxis> y;  // nullopt: it does not show clearly, or is mixed
    std::optional<MixedY> mixed;
};

// The direction of the whole, if that is clear.
[[nodiscard]] std::optional<YAxis> clear_y(const Curl& curl);

// The slopes of a part of the map.
using SlopesAt = std::function<Slopes(const Rect& part)>;

// Decides about a map of this extent. Asks for slopes where regions differ: streaks of padding have no say.
[[nodiscard]] YVerdict verdict_of(const Curl& curl, Extent extent, const SlopesAt& slopes_at);

[[nodiscard]] constexpr YAxis opposite_of(YAxis y) { return y == YAxis::up ? YAxis::down : YAxis::up; }

}  // namespace tex::inline v1
