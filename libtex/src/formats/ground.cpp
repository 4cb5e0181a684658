// SPDX-License-Identifier: Apache-2.0

#include "formats/ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

#include "files/beside.h"
#include "files/path_names.h"
#include "formats/map_tile.h"
#include "formats/prj.h"
#include "formats/words.h"
#include "rows/ground.h"

namespace tex::inline v1 {
namespace {

constexpr double kTurned = 1e-3;                          // of a step may lead along the other axis
constexpr double kLeastSize = 1e-6, kGreatestSize = 1e7;  // of a texel, in metres

// The text of a file beside the picture with one of these extensions; empty if there is none that can be read.
std::string text_beside(const std::string& path, const std::vector<std::string>& extensions) {
    constexpr std::int64_t kLongest = std::int64_t{1} << 16;
    const std::string name = path.substr(name_begin(path));
    const std::size_t dot = name.find_last_of('.');
    if (dot == std::string::npos) return {};
    for (const std::string& extension : extensions) {
        const Result<std::vector<std::byte>> text = read_beside(path, name.substr(0, dot) + extension, kLongest);
        if (text) return {reinterpret_cast<const char*>(text->data()), text->size()};
    }
    return {};
}

std::string world_file_text(const std::string& path) {
    constexpr std::pair<std::string_view, std::array<const char*, 3>> kWorldFiles[] = {
        {".tif", {".tfw", ".TFW", ".wld"}},
        {".tiff", {".tfw", ".tifw", ".wld"}},
        {".png", {".pgw", ".PGW", ".wld"}},
    };
    for (const auto& [extension, names] : kWorldFiles) {
        if (has_extension(path, extension)) return text_beside(path, {names.begin(), names.end()});
    }
    return {};
}

double length_of(double east, double north) { return std::sqrt(east * east + north * north); }

// How far the middles of the first and the last texels are apart, from the least coordinate to the greatest.
struct Bounds {
    double west, east, south, north;
};

Bounds bounds_of(const GridPlace& place, Extent extent) {
    const double columns = extent.width - 1, rows = extent.height - 1;
    const double east = place.column_east * columns, east2 = place.row_east * rows;
    const double north = place.column_north * columns, north2 = place.row_north * rows;
    return {place.east + std::min(east, 0.0) + std::min(east2, 0.0),
            place.east + std::max(east, 0.0) + std::max(east2, 0.0),
            place.north + std::min(north, 0.0) + std::min(north2, 0.0),
            place.north + std::max(north, 0.0) + std::max(north2, 0.0)};
}

// Decides what the numbers of a grid are, if only they can tell. Grids of degrees have steps that are small fractions
// of one, and lie where the Earth has coordinates; grids of metres that begin at zero could look like that.
std::string guess_unit(GridPlace& place, Extent extent) {
    constexpr double kMostDegrees = 0.1, kOutside = 0.001;
    const Bounds at = bounds_of(place, extent);
    const double step =
        std::max(length_of(place.column_east, place.column_north), length_of(place.row_east, place.row_north));
    const bool is_on_earth = at.west >= -180.0 - kOutside && at.east <= 360.0 + kOutside &&
                             at.south >= -90.0 - kOutside && at.north <= 90.0 + kOutside;
    if (!is_on_earth) {
        place.model = GridModel::projected;
        place.unit = 1.0;
        return "its coordinates were taken as metres, because no .prj file beside it says what they are";
    }
    const bool is_at_zero = std::abs(at.west) <= step && (std::abs(at.south) <= step || std::abs(at.north) <= step);
    if (step <= kMostDegrees && !is_at_zero) {
        place.model = GridModel::geographic;
        place.unit = 1.0;
        return "its coordinates were taken as degrees, because no .prj file beside it says what they are";
    }
    return "the size of its texels was not used, because its coordinates could be degrees or metres, and no .prj file "
           "beside it says which";
}

GroundFound unused(const std::string& reason) {
    return {std::nullopt, "the size of its texels was not used: " + reason};
}

// Sides of texels on a map of metres.
GroundFound on_map(const GridPlace& place, double unit, Ground ground, std::string remark) {
    ground.width = length_of(place.column_east, place.column_north) * unit;
    ground.height = length_of(place.row_east, place.row_north) * unit;
    const double along = (place.column_east * place.row_east + place.column_north * place.row_north) * unit * unit;
    if (std::abs(along) > kTurned * ground.width * ground.height)
        return unused("its rows and columns are not at right angles");
    return {ground, std::move(remark)};
}

// Rows are parallels, and columns meridians.
GroundFound on_globe(const GridPlace& place, double unit, Ground ground, Extent extent, std::string remark) {
    ground.width = std::abs(place.column_east) * unit;
    ground.height = std::abs(place.row_north) * unit;
    ground.north = place.north * unit;
    ground.north_up = place.row_north <= 0.0;
    if (std::abs(place.column_north) > kTurned * std::abs(place.column_east) ||
        std::abs(place.row_east) > kTurned * std::abs(place.row_north))
        return unused("its rows are not parallels of latitude");
    const double last = ground.north + (ground.north_up ? -ground.height : ground.height) * (extent.height - 1);
    constexpr double kPole = 90.0 + 1e-3;
    if (ground.unit == GroundUnit::degree && !(std::abs(ground.north) <= kPole && std::abs(last) <= kPole))
        return unused("its latitudes lie beyond the poles");
    return {ground, std::move(remark)};
}

GroundFound in_metres(GridPlace place, Extent extent) {
    std::string remark;
    if (place.model == GridModel::numbers) {
        remark = guess_unit(place, extent);
        if (place.model == GridModel::numbers) return {std::nullopt, remark};
    }
    if (place.model == GridModel::nowhere) return unused("its name does not say where it lies, as N46E007 does");
    if (place.model == GridModel::other) return unused("its coordinate system is not known");
    if (place.unit < 0.0) return unused("its coordinates are in a unit that is not known");
    Ground ground;
    if (place.equator > 0.0 && place.pole > 0.0) {
        ground.equator_radius = place.equator;
        ground.pole_radius = place.pole;
    }
    ground.has_height_unit = place.height_metres > 0.0;
    if (ground.has_height_unit) ground.height_metres = place.height_metres;
    const double unit = place.unit > 0.0 ? place.unit : 1.0;
    switch (place.model) {
        case GridModel::geographic: ground.unit = GroundUnit::degree; break;
        case GridModel::mercator: ground.unit = GroundUnit::mercator; break;
        default:
            if (place.unit == 0.0)
                remark = "its coordinates were taken as metres, because the file does not state the unit of its map";
            return on_map(place, unit, ground, std::move(remark));
    }
    return on_globe(place, unit, ground, extent, std::move(remark));
}

bool are_finite(const GridPlace& place) {
    const double numbers[] = {place.column_east, place.column_north, place.row_east, place.row_north,
                              place.east,        place.north,        place.unit,     place.equator,
                              place.pole,        place.height_metres};
    return std::all_of(std::begin(numbers), std::end(numbers), [](double number) { return std::isfinite(number); });
}

// Text of a file that a message shows.
std::string plain(const char* text, std::size_t most) {
    std::string shown(text, strnlen(text, most));
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return shown;
}

}  // namespace

std::optional<GridPlace> world_file_place(const std::string& text) {
    std::array<double, 6> numbers{};
    std::string_view rest = text;
    for (double& number : numbers) {
        const auto* const first = std::find_if_not(rest.begin(), rest.end(), is_blank);
        const auto* const end = std::find_if(first, rest.end(), is_blank);
        const std::optional<double> read = number_in(std::string_view(first, static_cast<std::size_t>(end - first)));
        if (!read || !std::isfinite(*read)) return std::nullopt;
        number = *read;
        rest.remove_prefix(static_cast<std::size_t>(end - rest.begin()));
    }
    GridPlace place;
    place.model = GridModel::numbers;
    place.column_east = numbers[0];
    place.column_north = numbers[1];
    place.row_east = numbers[2];
    place.row_north = numbers[3];
    place.east = numbers[4];
    place.north = numbers[5];
    return place;
}

GroundFound ground_of(const GridPlace& given, Extent extent, const std::string& projection) {
    if (given.model == GridModel::none) return {};
    if (given.model > GridModel::nowhere || !are_finite(given)) return unused("it is not a number");
    GridPlace place = given;
    if (place.model == GridModel::numbers && !projection.empty()) {
        read_prj(projection, place);
        if (!are_finite(place)) return unused("the .prj file beside it states no sound unit");
    }
    const std::string unit = plain(given.height_unit, sizeof given.height_unit);
    if (!unit.empty()) place.height_metres = metres_of(unit) > 0.0 ? metres_of(unit) : -1.0;
    if (place.height_metres < 0.0) return unused("the unit of its heights, \"" + unit + "\", is not known");
    GroundFound found = in_metres(place, extent);
    if (!found.ground) return found;
    const auto is_size = [](double metres) { return metres >= kLeastSize && metres <= kGreatestSize; };
    const TexelSize size = texel_size(*found.ground, 0.5 * (extent.height - 1));
    if (!is_size(size.width) || !is_size(size.height) || !is_size(found.ground->equator_radius * 1e-3) ||
        !is_size(found.ground->pole_radius * 1e-3))
        return unused("it is too small or too large");
    return found;
}

GroundFound ground_of(const RowSource& rows, const InputFile& file) {
    const std::string path = file.whole_file() ? file.path() : std::string();
    GridPlace place = rows.head().samples.place;
    const bool has_numbers = rows.head().sample == SampleKind::floating;
    if (place.model == GridModel::none && has_numbers) {
        const std::string text = world_file_text(path);
        if (!text.empty()) place = world_file_place(text).value_or(GridPlace());
    }
    if (place.model == GridModel::none && !has_numbers)
        place = map_tile_place(path, rows.extent()).value_or(GridPlace());
    if (place.model == GridModel::none) return {};
    if (rows.head().orientation != 1) return unused("the picture was turned or mirrored");
    const bool needs_unit = place.model == GridModel::numbers;
    return ground_of(place, rows.extent(), needs_unit ? text_beside(path, {".prj", ".PRJ"}) : std::string());
}

}  // namespace tex::inline v1
