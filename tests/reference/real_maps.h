// SPDX-License-Identifier: Apache-2.0
// real_maps.h: the normal maps of ../shared/data, and what is known of them without looking at their curl.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/normal_map.h>

namespace tex::reference {

// Where a map's direction of green is known from.
enum class LabelSource {
    name,      // its author named the file so (NormalDX, NormalGL), or documents it
    heights,   // the sign of its correlation with the height map beside it
    measured,  // SOURCES.md measured it by a curl test as well: no label
};

inline const char* to_string(LabelSource source) {
    return source == LabelSource::name ? "name" : source == LabelSource::heights ? "heights" : "measured";
}

// Whether that is a label: a statement of the author, or one of the pair that the curl test has no part in.
inline bool is_label(LabelSource source) { return source != LabelSource::measured; }

struct RealMap {
    std::string path;        // below ../shared/data
    std::optional<YAxis> y;  // nullopt: SOURCES.md says that it cannot be told
    LabelSource source = LabelSource::measured;
    bool intact = true;  // false: SOURCES.md names a damage, or it is no tangent-space map
    bool tiles = false;  // both ratios of SOURCES.md below 2
};

// All of them; the files are there only where ../shared/data is.
const std::vector<RealMap>& real_maps();

// Half of the pictures set thresholds, the other half is held out and reports: pictures of intact maps sorted by the
// FNV-1a hash (32 bits) of their names, the first half sets. Two files of one picture (GL and DX, TGA and ATI2) fall
// into the same half.
bool sets_thresholds(const RealMap& map);

}  // namespace tex::reference
