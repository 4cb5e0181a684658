// SPDX-License-Identifier: Apache-2.0

#include "tiff_tags.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "geo_keys.h"

namespace tex::reader {
namespace {

constexpr std::uint32_t kGdalMetadata = 42112;
constexpr std::uint32_t kGdalNoData = 42113;
constexpr std::uint32_t kGeoTags[] = {33550, 33922, 34264, 34735};  // scale, tie points, transformation, keys

// The text of a tag that libtiff does not know; empty if there is none.
std::string text_of(TIFF* tiff, std::uint32_t tag) {
    const TIFFField* const field = TIFFFindField(tiff, tag, TIFF_ANY);
    if (field == nullptr || TIFFFieldDataType(field) != TIFF_ASCII || TIFFFieldPassCount(field) == 0) return {};
    std::uint32_t count = 0;
    const char* text = nullptr;
    const int found = TIFFFieldReadCount(field) == TIFF_VARIABLE2 ? TIFFGetField(tiff, tag, &count, &text) : 0;
    return found != 0 && text != nullptr ? std::string(text, strnlen(text, count)) : std::string();
}

// A finite number, with spaces around it.
std::optional<double> number_of(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" +");
    if (first == std::string_view::npos) return std::nullopt;
    const char* const end = text.data() + text.find_last_not_of(' ') + 1;
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data() + first, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

// The text of GDAL's item with this role, for the first sample: <Item name="SCALE" sample="0" role="scale">2</Item>
std::optional<std::string_view> item_of(std::string_view metadata, std::string_view role) {
    for (std::size_t at = 0; (at = metadata.find("<Item ", at)) != std::string_view::npos; ++at) {
        const std::size_t close = metadata.find('>', at);
        const std::size_t end = metadata.find('<', close);
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view tag = metadata.substr(at, close - at);
        const bool is_first = tag.find("sample=") == std::string_view::npos || tag.find("sample=\"0\"") != tag.npos;
        if (is_first && tag.find("role=\"" + std::string(role) + "\"") != tag.npos)
            return metadata.substr(close + 1, end - close - 1);
    }
    return std::nullopt;
}

std::optional<double> number_in_item(std::string_view metadata, std::string_view role) {
    const std::optional<std::string_view> text = item_of(metadata, role);
    return text ? number_of(*text) : std::nullopt;
}

// The unit of heights that GDAL names takes precedence over that of a vertical system.
void read_height_unit(std::string_view metadata, GridPlace& place) {
    const std::optional<std::string_view> unit = item_of(metadata, "unittype");
    if (!unit || unit->empty()) return;
    const std::size_t length = unit->copy(place.height_unit, sizeof place.height_unit - 1);
    place.height_unit[length] = '\0';
}

}  // namespace

void read_tags(TIFF* tiff, ReaderHeader& header) {
    const char* description = nullptr;
    if (TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description) != 0 && description != nullptr)
        std::strncpy(header.description, description, sizeof header.description - 1);
    std::uint16_t orientation = ORIENTATION_TOPLEFT;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &orientation);
    header.orientation = orientation;
    std::uint16_t count = 0;
    const std::uint16_t* extra = nullptr;
    if (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &extra) != 0 && count > 0) {
        header.is_multiplied = std::find(extra, extra + count, EXTRASAMPLE_ASSOCALPHA) == extra + count ? 0 : 1;
        header.has_alpha = extra[count - 1] == EXTRASAMPLE_UNSPECIFIED ? 0 : 1;
    }
    if (const std::optional<double> value = number_of(text_of(tiff, kGdalNoData))) {
        header.has_no_data = 1;
        header.no_data = *value;
    }
    for (int k = 0; k < TIFFGetTagListCount(tiff); ++k) {
        const std::uint32_t tag = TIFFGetTagListEntry(tiff, k);
        if (std::find(std::begin(kGeoTags), std::end(kGeoTags), tag) != std::end(kGeoTags)) header.stored.has_place = 1;
    }
    const std::string metadata = text_of(tiff, kGdalMetadata);
    const std::optional<double> scale = number_in_item(metadata, "scale");
    const std::optional<double> offset = number_in_item(metadata, "offset");
    header.stored.has_scale = scale || offset ? 1 : 0;
    header.stored.scale = scale.value_or(1.0);
    header.stored.offset = offset.value_or(0.0);
    header.stored.place = read_geo_keys(tiff);
    read_height_unit(metadata, header.stored.place);
}

}  // namespace tex::reader
