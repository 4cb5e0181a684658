// SPDX-License-Identifier: Apache-2.0
// background.h: texels that hold no normal of the surface: those under alpha 0, and those around the charts of a map
// that no chart covers and nobody filled: black, grey, white.

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

// Texels that share a value that is no normal (its length is below 0.5 or above 1.25, unless it points straight
// outwards; or, without a stored z, x and y lie far outside the unit circle; or it is black or white, normalised, or
// points straight into the surface) and lie together; and texels that nobody sees, because alpha is 0 there. Rules
// about the vectors leave them out.
struct Background {
    std::array<float, 3> value{};         // x, y and z as stored; z is 0 if it is not stored
    std::int64_t texels = 0;              // that have the value; 0 if there is none
    std::int64_t transparent = 0;         // whose alpha is 0
    std::int64_t masked = 0;              // all, and beside them the texels whose vectors a filter mixed with the value
    int column = 0, row = 0;              // the first texel
    std::vector<std::uint8_t> mask = {};  // for each texel of the map, in rows from the top: not 0 if it is masked
    int width = 0;                        // of a row of `mask`

    [[nodiscard]] bool holds(int i, int j) const { return at(i, j) != 0; }
    [[nodiscard]] bool is_transparent(int i, int j) const { return at(i, j) == kTransparent; }
    [[nodiscard]] bool is_mixed(int i, int j) const { return at(i, j) == kMixed; }
    // Whether the value points straight into the surface, as blue 0 beside middle red and green does.
    [[nodiscard]] bool is_turned_over() const { return texels > 0 && is_turned_over(value[0], value[1], value[2]); }
    [[nodiscard]] static bool is_turned_over(float x, float y, float z) {
        constexpr float kNear = 3.0f / 127.5f;
        return z < kNear - 1.0f && x < kNear && x > -kNear && y < kNear && y > -kNear;
    }

    // In the mask.
    static constexpr std::uint8_t kValue = 1, kMixed = 2, kTransparent = 3;

private:
    [[nodiscard]] std::uint8_t at(int i, int j) const {
        return mask[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
    }
};

// The texels whose alpha is 0, if alpha holds no component. Nothing if there are none, or hardly others.
std::optional<Background> find_transparent(const Stored& stored);

// Finds the value of the background if it covers kLeastBackground or more, beside the transparent texels, and adds it
// to them. It looks at every texel twice; call it only if there are vectors that are not of unit length, or z below 0.
// Errors: out_of_memory, cancelled.
Result<std::optional<Background>> find_background(const Stored& stored, const Execution& execution,
                                                  std::optional<Background> transparent = {});

// "black", "grey", "white", or the components.
std::string background_name(const Background& background, const Stored& stored);

}  // namespace tex::inline v1
