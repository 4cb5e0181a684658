// SPDX-License-Identifier: Apache-2.0

#include "formats/hgt/hgt.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "formats/raw/raw_rows.h"
#include "formats/size_limits.h"
#include "formats/words.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr Extent kHgtExtents[] = {{3601, 3601}, {1801, 3601}, {1201, 1201}};
constexpr float kHgtVoid = -32768.0f;

// A letter and a number of degrees at the start of a text, which they leave: "N46". The second letter means a negative
// number.
std::optional<double> take_degrees(std::string_view& text, std::string_view letters, std::size_t most_digits) {
    if (text.empty() || (text[0] != letters[0] && text[0] != letters[1])) return std::nullopt;
    const double sign = text[0] == letters[0] ? 1.0 : -1.0;
    text.remove_prefix(1);
    std::size_t digits = 0;
    double degrees = 0.0;
    while (digits < text.size() && digits < most_digits && text[digits] >= '0' && text[digits] <= '9')
        degrees = 10.0 * degrees + (text[digits++] - '0');
    if (digits == 0) return std::nullopt;
    text.remove_prefix(digits);
    return sign * degrees;
}

// A tile is called after its corner in the southwest: N46E007, or n46_e007. One degree lies between its first row and
// its last, both of which it shares with its neighbours.
GridPlace hgt_place(const std::string& path, Extent extent) {
    const std::string name = in_lower_case(path.substr(path.find_last_of("/\\") + 1));
    std::string_view rest = name;
    const std::optional<double> south = take_degrees(rest, "ns", 2);
    if (south && !rest.empty() && rest[0] == '_') rest.remove_prefix(1);
    const std::optional<double> west = south ? take_degrees(rest, "ew", 3) : std::nullopt;
    GridPlace place;
    place.model = west ? GridModel::geographic : GridModel::nowhere;
    place.unit = 1.0;
    place.height_metres = 1.0;
    place.column_east = 1.0 / (extent.width - 1);
    place.row_north = -1.0 / (extent.height - 1);
    place.east = west.value_or(0.0);
    place.north = south.value_or(0.0) + 1.0;
    return place;
}

}  // namespace

bool is_hgt(const InputFile& file, const ReadOptions&) { return has_extension(file.path(), ".hgt"); }

Result<std::unique_ptr<RowSource>> open_hgt(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        RawTexels place{.samples = {SampleKind::snorm, 16, true}, .has_place = true, .no_data = kHgtVoid};
        const auto* const found = std::find_if(std::begin(kHgtExtents), std::end(kHgtExtents),
                                               [&](Extent extent) { return extent.texels() * 2 == *file.size(); });
        if (found == std::end(kHgtExtents)) {
            return Error{ErrorCode::bad_data, file.path(),
                         std::to_string(*file.size()) +
                             " bytes are not an HGT file, which has 3601x3601, 1801x3601 or 1201x1201 heights; name "
                             "another extent in a raw layout, such as 7201x3601,s16be"};
        }
        const Result<Extent> extent = claimed_extent(file.path(), found->width, found->height, options);
        if (!extent) return extent.error();
        place.extent = *extent;
        place.place = hgt_place(file.path(), *extent);
        return open_raw_rows(file, std::move(place));
    });
}

}  // namespace tex::inline v1
