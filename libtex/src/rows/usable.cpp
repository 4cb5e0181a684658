// SPDX-License-Identifier: Apache-2.0

#include "rows/usable.h"

#include <string>

#include "rows/extra_rows.h"

namespace tex::inline v1 {
namespace {

Error wrong_level(std::size_t level) {
    return bad_option("level " + std::to_string(level) + " does not have the extent that follows from the base level");
}

}  // namespace

Error bad_option(std::string_view reason) { return {ErrorCode::bad_option, {}, std::string(reason)}; }

Result<void> check_usable(Extent extent, std::string_view what) {
    if (extent.width < 1 || extent.height < 1) return bad_option(std::string(what) + " has no texels");
    if (extent.width <= kMaxExtent && extent.height <= kMaxExtent) return {};
    return bad_option(std::string(what) + " is larger than " + std::to_string(kMaxExtent) + " texels in a direction");
}

Result<void> check_usable(const NormalMap& map) {
    const auto fits = [&map](const Plane<float>& plane) { return plane.extent() == map.x.extent(); };
    bool all_fit = fits(map.y) && fits(map.z);
    for (const Extra extra : kExtras) all_fit = all_fit && (map[extra].empty() || fits(map[extra]));
    if (!all_fit) return bad_option("the planes of the map have different extents");
    return check_usable(map.x.extent(), "the map");
}

Result<void> check_usable(const Image& image) {
    if (image.planes.empty() || image.planes.size() != image.names.size())
        return bad_option("the picture does not have a name for each of its planes");
    for (const Plane<float>& plane : image.planes) {
        if (plane.extent() != image.extent()) return bad_option("the planes of the picture have different extents");
    }
    return check_usable(image.extent(), "the picture");
}

Result<void> check_usable(const MipChain& chain) {
    if (chain.levels.empty()) return bad_option("the chain has no level");
    for (std::size_t k = 0; k < chain.levels.size(); ++k) {
        if (auto usable = check_usable(chain.levels[k]); !usable) return usable;
        if (chain.levels[k].extent() != level_extent(chain.levels[0].extent(), static_cast<int>(k)))
            return wrong_level(k);
    }
    return {};
}

Result<void> check_usable(const Texture& texture) {
    if (texture.levels.empty()) return bad_option("the texture has no level");
    if (auto known = check_known("format", kFormatNames, texture.format); !known) return known;
    for (std::size_t k = 0; k < texture.levels.size(); ++k) {
        const Level& level = texture.levels[k];
        if (auto usable = check_usable(level.extent, "the texture"); !usable) return usable;
        if (level.extent != level_extent(texture.extent(), static_cast<int>(k))) return wrong_level(k);
        if (level.bytes.size() != level_bytes(texture.format, level.extent))
            return bad_option("level " + std::to_string(k) + " does not have the bytes of its format and extent");
    }
    return {};
}

}  // namespace tex::inline v1
