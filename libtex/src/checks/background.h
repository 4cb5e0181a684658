// SPDX-License-Identifier: Apache-2.0
// background.h: the texels around the charts of a map that no chart covers and nobody filled: black, grey, white.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/types.h>

#include "checks/stored.h"

namespace tex::inline v1 {

inline constexpr double kLeastBackground = 0.0005;  // share of the texels

// Texels that share a value that is no normal (its length is below 0.5 or above 1.25, or, without a stored z, x and y
// lie far outside the unit circle; or it is black or white, normalised) and lie together. Rules about the vectors leave
// them out.
struct Background {
    std::array<float, 3> value{};         // x, y and z as stored; z is 0 if it is not stored
    std::int64_t texels = 0;              // that have the value
    std::int64_t masked = 0;              // these, and beside them the texels whose vectors a filter mixed with it
    int column = 0, row = 0;              // the first texel
    std::vector<std::uint8_t> mask = {};  // for each texel of the map, in rows from the top: not 0 if it is masked
    int width = 0;                        // of a row of `mask`

    [[nodiscard]] bool holds(int i, int j) const {
        return mask[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)] != 0;
    }
};

// Finds the background if it covers kLeastBackground or more. It looks at every texel twice; call it only if there are
// vectors that are not of unit length. Errors: out_of_memory, cancelled.
Result<std::optional<Background>> find_background(const Stored& stored, const Execution& execution);

// "black", "grey", "white", or the components.
std::string background_name(const Background& background, const Stored& stored);

}  // namespace tex::inline v1
