// SPDX-License-Identifier: Apache-2.0

#include "options/map_pairs.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tex/mesh.h>

#include "cli/text.h"

namespace tex::cli {
namespace {

Result<std::vector<ComparedMap>> maps_of_file(const std::string& name, const std::string& material,
                                              const ReadOptions& read) {
    std::vector<ComparedMap> maps;
    for (Input& input : with_maps_of_models({{name}}, material, {read})) {
        if (input.model && input.model->error) return *input.model->error;
        if (input.model && !input.model->map)
            return Error{ErrorCode::unsupported, name, "no material uses a normal map"};
        maps.push_back({std::move(input.name), std::move(input.model)});
    }
    return maps;
}

std::string materials_of(const std::vector<ComparedMap>& maps) {
    std::vector<std::string> materials;
    for (const ComparedMap& map : maps) materials.push_back(printable(map.model->material));
    return join(materials);
}

// The map of the same material, if there is one.
const ComparedMap* partner_of(const ComparedMap& map, const std::vector<ComparedMap>& others) {
    const auto found = std::find_if(others.begin(), others.end(),
                                    [&](const ComparedMap& other) { return other.model->field == map.model->field; });
    return found == others.end() ? nullptr : &*found;
}

}  // namespace

Result<ReadOptions> ComparedMap::open(ReadOptions options) const {
    if (!model) return options;
    if (auto opened = model->open(options); !opened) return opened.error();
    return options;
}

Result<std::vector<MapPair>> map_pairs(
    const std::vector<std::string>& names, const std::string& material, const ReadOptions& read,
    const std::function<void(const std::string& file, const std::string& sentence)>& warn) {
    std::vector<ComparedMap> maps[2];
    for (std::size_t k = 0; k < 2; ++k) {
        auto found = maps_of_file(names[k], material, read);
        if (!found) return found.error();
        maps[k] = std::move(*found);
    }
    const auto word = [](const MapPair& pair) {
        const ComparedMap& named = pair.maps[0].model ? pair.maps[0] : pair.maps[1];
        return named.model ? named.model->material : std::string();
    };
    if (maps[0].size() == 1 && maps[1].size() == 1) {
        MapPair pair{{std::move(maps[0].front()), std::move(maps[1].front())}};
        pair.material = word(pair);
        return std::vector<MapPair>{std::move(pair)};
    }
    for (std::size_t k = 0; k < 2; ++k) {
        if (maps[1 - k].front().model) continue;
        return Error{ErrorCode::bad_option, names[k],
                     fmt::format("has {} normal maps, and {} is one: give --material, which is one of {}",
                                 maps[k].size(), names[1 - k], materials_of(maps[k]))};
    }
    std::vector<MapPair> pairs;
    for (const ComparedMap& map : maps[0]) {
        if (const ComparedMap* const partner = partner_of(map, maps[1])) {
            pairs.push_back({{map, *partner}, map.model->material});
        } else {
            warn(map.name(), fmt::format("is not compared: {} has no map of that material", names[1]));
        }
    }
    for (const ComparedMap& map : maps[1]) {
        if (partner_of(map, maps[0]) == nullptr)
            warn(map.name(), fmt::format("is not compared: {} has no map of that material", names[0]));
    }
    if (pairs.empty()) {
        return Error{ErrorCode::bad_option, names[1],
                     fmt::format("no material of {} with a normal map has the name of one here", names[0])};
    }
    return pairs;
}

}  // namespace tex::cli
