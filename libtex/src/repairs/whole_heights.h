// SPDX-License-Identifier: Apache-2.0
// whole_heights.h: whole heights from whole slopes, without rounding.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// Differences of whole heights between the neighbours of each texel: right less left, and below less above.
struct WholeSlopes {
    Extent extent;
    std::vector<std::int16_t> across, down;

    static constexpr std::int16_t kUnknown = INT16_MIN;
    [[nodiscard]] std::size_t at(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i);
    }
    // Whether the way around this texel's diagonal neighbours comes back to the same height. Inside the border alone.
    [[nodiscard]] bool closes(int i, int j) const;
    // The share of such ways that close, of those that are not level.
    [[nodiscard]] double closing_share() const;
};

// The heights; nothing where no chain of slopes that close leads. Central differences link every other texel, so that
// there are four grids of them at least; each is put where the surface bends least.
[[nodiscard]] std::vector<std::optional<std::int32_t>> whole_heights(const WholeSlopes& slopes);

}  // namespace tex::inline v1
