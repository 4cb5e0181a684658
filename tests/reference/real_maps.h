// SPDX-License-Identifier: Apache-2.0
// real_maps.h: the normal maps of ../shared/data, and the facts that are known about them without examining their curl.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/types.h>

namespace tex::reference {

// The source of a map's direction of green.
enum class LabelSource {
    name,      // its author named the file so (NormalDX, NormalGL), or documents it
    heights,   // the sign of its correlation with the height map beside it
    measured,  // SOURCES.md measured it, by a curl test like that of the check: not a label
};

inline const char* to_string(LabelSource source) {
    return source == LabelSource::name ? "name" : source == LabelSource::heights ? "heights" : "measured";
}

// True if this is a label: a statement by the author, or a correlation with the height map, which does not depend on
// the curl test.
inline bool is_label(LabelSource source) { return source != LabelSource::measured; }

struct RealMap {
    std::string path;        // below ../shared/data
    std::optional<YAxis> y;  // nullopt: SOURCES.md says that it cannot be determined
    LabelSource source = LabelSource::measured;
    bool intact = true;  // false: SOURCES.md names a damage, or it is not a tangent-space map
    bool tiles = false;  // both tiling ratios in SOURCES.md are below 2
};

// All of them. The files exist only if ../shared/data does.
const std::vector<RealMap>& real_maps();

// Half of the pictures set the thresholds; the other half is held out for reports. Pictures of intact maps are sorted
// by the FNV-1a hash (32 bits) of their names, and the first half sets the thresholds. Two files of one picture (GL and
// DX, TGA and ATI2) fall into the same half.
bool sets_thresholds(const RealMap& map);

}  // namespace tex::reference
