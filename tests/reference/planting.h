// SPDX-License-Identifier: Apache-2.0
// planting.h: plants every damage of damage.h into one map, with the rule that should find it.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

namespace tex::reference {

struct Planted {
    std::string damage;  // "JPEG, quality 50"
    std::string rules;   // ids, separated by blanks; one of them should be found
    Texture damaged;
    std::shared_ptr<const Texture> intact;  // the same texture without that damage; several may share one
    std::optional<YAxis> y;                 // required of both textures
    bool tiles = false;                     // required of both textures
    bool visible = true;  // false: in this map 8 bits cannot hold the damage, or the map's own steps are larger
};

// `map` holds unit vectors with y as in the file. `y` is its direction, if known. `tiles` says whether the map tiles.
// `blocks` says whether it was decoded from blocks; then blocks are not planted as a damage.
std::vector<Planted> plant_all(const NormalMap& map, std::optional<YAxis> y, bool tiles, bool blocks);

}  // namespace tex::reference
