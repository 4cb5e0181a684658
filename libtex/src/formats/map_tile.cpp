// SPDX-License-Identifier: Apache-2.0

#include "formats/map_tile.h"

#include <charconv>
#include <cstdint>

#include "files/path_names.h"
#include "formats/words.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr double kEquatorRadius = 6378137.0;  // of WGS 84, in metres
constexpr double kHalfWorld = math::kPi * kEquatorRadius;
constexpr std::uint32_t kLargestZoom = 24;  // texels of 256x256 tiles are then a centimetre wide
constexpr int kLeastSide = 128, kGreatestSide = 1024;

// The number that is the whole last name of a path, which it leaves.
std::optional<std::uint32_t> take_number(std::string_view& path) {
    const std::size_t begin = name_begin(path);
    std::uint32_t number = 0;
    const std::string_view name = path.substr(begin);
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
    path = path.substr(0, begin == 0 ? 0 : begin - 1);
    return number;
}

bool is_tile(Extent extent) {
    const int side = extent.width;
    return side == extent.height && side >= kLeastSide && side <= kGreatestSide && (side & (side - 1)) == 0;
}

}  // namespace

std::optional<GridPlace> map_tile_place(std::string_view path, Extent extent) {
    if (!is_tile(extent) || !(has_extension(path, ".png") || has_extension(path, ".webp"))) return std::nullopt;
    path = path.substr(0, path.rfind('.'));
    const std::optional<std::uint32_t> y = take_number(path);
    const std::optional<std::uint32_t> x = y ? take_number(path) : std::nullopt;
    const std::optional<std::uint32_t> zoom = x ? take_number(path) : std::nullopt;
    if (!zoom || *zoom > kLargestZoom || *x >= 1U << *zoom || *y >= 1U << *zoom) return std::nullopt;
    const double side = 2.0 * kHalfWorld / (1U << *zoom), texel = side / extent.width;
    GridPlace place;
    place.model = GridModel::mercator;
    place.unit = 1.0;
    place.height_metres = 1.0;
    place.column_east = texel;
    place.row_north = -texel;
    place.east = *x * side - kHalfWorld + 0.5 * texel;
    place.north = kHalfWorld - *y * side - 0.5 * texel;
    return place;
}

}  // namespace tex::inline v1
