// SPDX-License-Identifier: Apache-2.0
// wild_maps.h: clean maps of ../shared/data/wild4, into which benchmarks plant damage.

#pragma once

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <tex/tex.h>

#include "reference/damage.h"

namespace tex::reference {

inline const std::string kWildMaps = TEX_SOURCE_DIR "/../shared/data/wild4/";

// The maps that labels.tsv calls normal and that have no finding there, sorted by name: `count` of them, evenly spread.
inline std::vector<std::string> clean_maps(std::size_t count) {
    std::vector<std::string> all;
    std::ifstream in(kWildMaps + "labels.tsv");
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        std::string file, kind, findings;
        std::getline(fields, file, '\t');
        std::getline(fields, kind, '\t');
        std::getline(fields, findings, '\t');
        if (kind == "normal" && findings.empty()) all.push_back(file);
    }
    std::sort(all.begin(), all.end());
    std::vector<std::string> some;
    for (std::size_t k = 0; k < count && !all.empty(); ++k) some.push_back(all[k * all.size() / count]);
    return some;
}

// The middle of the map, a square of at most 512 texels, as it is stored. Nothing if it is too small.
inline std::optional<Codes> middle_of(const std::string& file) {
    constexpr int kMost = 512;
    auto texture = read_texture(kWildMaps + file);
    if (!texture) return std::nullopt;
    UnpackOptions options;
    options.y_axis = YAxis::up;
    options.keep_length = true;
    texture->levels.resize(1);
    auto chain = unpack(*texture, options);
    if (!chain) return std::nullopt;
    const NormalMap& map = chain->levels.front();
    const int side = std::min({map.extent().width, map.extent().height, kMost}) / 8 * 8;
    if (side < 64) return std::nullopt;
    const int x = (map.extent().width - side) / 16 * 8, y = (map.extent().height - side) / 16 * 8;
    return codes_of(crop(map, x, y, {side, side}));
}

}  // namespace tex::reference
