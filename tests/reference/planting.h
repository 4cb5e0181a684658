// SPDX-License-Identifier: Apache-2.0
// planting.h: every damage of damage.h, planted into one map, with the rule that should find it.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/normal_map.h>
#include <tex/texture.h>

namespace tex::reference {

struct Planted {
    std::string damage;  // "JPEG, quality 50"
    std::string rules;   // ids, separated by blanks: one of them should be found
    Texture damaged;
    std::shared_ptr<const Texture> intact;  // the same texture without that damage; several may share one
    std::optional<YAxis> y;                 // required of both
    bool tiles = false;                     // required of both
    bool visible = true;  // false: in this map the damage is below what 8 bits hold, or below the map's own steps
};

// `map` holds unit vectors, y as in the file; `y` is its direction, where it is known; `tiles` whether it tiles;
// `blocks` whether it was decoded from blocks, so that blocks are no damage to plant.
std::vector<Planted> plant_all(const NormalMap& map, std::optional<YAxis> y, bool tiles, bool blocks);

}  // namespace tex::reference
