// SPDX-License-Identifier: Apache-2.0

#include "geo_keys.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>

namespace tex::reader {
namespace {

// Tags.
constexpr std::uint32_t kPixelScale = 33550, kTiePoint = 33922, kTransformation = 34264, kKeyDirectory = 34735,
                        kDoubleParameters = 34736, kTextParameters = 34737;

// Keys.
constexpr std::uint16_t kModelType = 1024, kRasterType = 1025, kCitation = 1026, kGeodeticSystem = 2048,
                        kAngularUnit = 2054, kAngularUnitSize = 2055, kEquator = 2057, kPole = 2058,
                        kInverseFlattening = 2059, kProjectedSystem = 3072, kProjectedCitation = 3073,
                        kLinearUnit = 3076, kLinearUnitSize = 3077, kVerticalSystem = 4096, kVerticalUnit = 4099;
constexpr std::uint16_t kProjectedModel = 1, kGeographicModel = 2, kPixelIsPoint = 2, kUserDefined = 32767;

struct Unit {
    std::uint16_t code;  // of EPSG
    double size;         // metres or degrees
};

constexpr double kDegree = 0.017453292519943295, kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;
// From EPSG's registry, version 10.
constexpr Unit kLengths[] = {
    {1025, 0.001},
    {1033, 0.01},
    {9001, 1.0},
    {9002, kFoot},
    {9003, kSurveyFoot},
    {9005, 0.3047972654},
    {9030, 1852.0},
    {9036, 1000.0},
    {9037, 0.9143917962},
    {9040, 0.9143984146160287},
    {9041, 0.3047994715386762},
    {9042, 20.116765121552632},
    {9070, 0.30480083333333335},
    {9080, 0.30479951024814694},
    {9084, 0.9143985307444408},
    {9093, 1609.344},
    {9094, 0.3047997101815088},
    {9095, 0.3048007491},
    {9096, 0.9144},
    {9301, 20.116756},
};
constexpr Unit kAngles[] = {
    {9101, 1.0 / kDegree}, {9102, 1.0}, {9103, 1.0 / 60.0}, {9104, 1.0 / 3600.0}, {9105, 0.9}, {9106, 0.9}, {9122, 1.0},
};
// Systems of heights in feet, whose files need not say so again.
constexpr Unit kHeightSystems[] = {
    {5702, kSurveyFoot}, {6130, kFoot}, {6131, kFoot}, {6132, kFoot},       {6360, kSurveyFoot},
    {8050, kFoot},       {8228, kFoot}, {5703, 1.0},   {8052, kSurveyFoot},
};
constexpr std::uint16_t kWebMercators[] = {3857, 3785};

std::optional<double> size_of(std::span<const Unit> units, std::uint16_t code) {
    const auto found = std::find_if(units.begin(), units.end(), [code](const Unit& unit) { return unit.code == code; });
    return found == units.end() ? std::nullopt : std::optional(found->size);
}

// The numbers of a tag that libtiff does not know; empty if there are none.
template <class Number>
std::span<const Number> numbers_of(TIFF* tiff, std::uint32_t tag, TIFFDataType type) {
    const TIFFField* const field = TIFFFindField(tiff, tag, TIFF_ANY);
    if (field == nullptr || TIFFFieldDataType(field) != type || TIFFFieldPassCount(field) == 0) return {};
    if (TIFFFieldReadCount(field) != TIFF_VARIABLE2) return {};
    std::uint32_t count = 0;
    const Number* numbers = nullptr;
    if (TIFFGetField(tiff, tag, &count, &numbers) == 0 || numbers == nullptr) return {};
    return {numbers, count};
}

class GeoKeys {
public:
    explicit GeoKeys(TIFF* tiff)
        : directory_(numbers_of<std::uint16_t>(tiff, kKeyDirectory, TIFF_SHORT)),
          doubles_(numbers_of<double>(tiff, kDoubleParameters, TIFF_DOUBLE)),
          text_(numbers_of<char>(tiff, kTextParameters, TIFF_ASCII)) {}

    [[nodiscard]] bool empty() const { return directory_.size() < 2 * kEntry; }
    // A number of 16 bits; 0 if the key is not there.
    [[nodiscard]] std::uint16_t code(std::uint16_t key) const {
        const auto entry = entry_of(key);
        return entry.empty() || entry[1] != 0 ? std::uint16_t{0} : entry[3];
    }
    [[nodiscard]] std::optional<double> number(std::uint16_t key) const {
        const auto entry = entry_of(key);
        if (entry.empty() || entry[1] != kDoubleParameters || entry[3] >= doubles_.size()) return std::nullopt;
        return doubles_[entry[3]];
    }

    [[nodiscard]] std::string_view text(std::uint16_t key) const {
        const auto entry = entry_of(key);
        if (entry.empty() || entry[1] != kTextParameters || entry[3] >= text_.size()) return {};
        return std::string_view(text_.data(), text_.size()).substr(entry[3], entry[2]);
    }

private:
    static constexpr std::size_t kEntry = 4;  // a key, the tag of its value, how many there are, the value or its place

    [[nodiscard]] std::span<const std::uint16_t> entry_of(std::uint16_t key) const {
        for (std::size_t at = kEntry; at + kEntry <= directory_.size(); at += kEntry) {
            if (directory_[at] == key) return directory_.subspan(at, kEntry);
        }
        return {};
    }

    std::span<const std::uint16_t> directory_;
    std::span<const double> doubles_;
    std::span<const char> text_;
};

// The size of a unit that a key names, or that another one gives the size of; 0 if neither is there, below 0 if the
// unit is not known.
double unit_of(const GeoKeys& keys, std::uint16_t key, std::uint16_t size_key, std::span<const Unit> units,
               double size_of_own) {
    const std::uint16_t code = keys.code(key);
    if (code == 0) return 0.0;
    if (code != kUserDefined) return size_of(units, code).value_or(-1.0);
    const std::optional<double> size = size_key == 0 ? std::nullopt : keys.number(size_key);
    return size && *size > 0.0 ? *size * size_of_own : -1.0;
}

// EPSG's registry says the unit of a system whose number a file has, and GDAL then leaves it out. The names in the
// registry tell it, and so do the numbers of the state planes of 1927, which are all in feet. 0: unknown.
double unit_of_system(const GeoKeys& keys) {
    struct Range {
        std::uint16_t first, last;
    };
    constexpr Range kStatePlanes[] = {{26729, 26813}, {32001, 32058}};
    const std::uint16_t system = keys.code(kProjectedSystem);
    for (const Range& range : kStatePlanes) {
        if (system >= range.first && system <= range.last) return kSurveyFoot;
    }
    for (const std::uint16_t key : {kProjectedCitation, kCitation}) {
        std::string_view name = keys.text(key);
        name = name.substr(0, name.find(" + "));  // of heights
        if (name.find("(ftUS)") != std::string_view::npos) return kSurveyFoot;
        if (name.find("(ft)") != std::string_view::npos) return kFoot;
        if (name.find("UTM zone") != std::string_view::npos) return 1.0;
    }
    return 0.0;
}

GridModel model_of(const GeoKeys& keys) {
    if (keys.empty()) return GridModel::numbers;
    const std::uint16_t system = keys.code(kProjectedSystem);
    if (std::find(std::begin(kWebMercators), std::end(kWebMercators), system) != std::end(kWebMercators))
        return GridModel::mercator;
    switch (keys.code(kModelType)) {
        case kProjectedModel: return GridModel::projected;
        case kGeographicModel: return GridModel::geographic;
        case 0: break;
        default: return GridModel::other;
    }
    if (system != 0) return GridModel::projected;
    return keys.code(kGeodeticSystem) != 0 ? GridModel::geographic : GridModel::other;
}

void read_steps(TIFF* tiff, double to_middle, GridPlace& place) {
    const auto matrix = numbers_of<double>(tiff, kTransformation, TIFF_DOUBLE);
    if (matrix.size() >= 8) {
        place.column_east = matrix[0];
        place.column_north = matrix[4];
        place.row_east = matrix[1];
        place.row_north = matrix[5];
        place.east = matrix[3] + (matrix[0] + matrix[1]) * to_middle;
        place.north = matrix[7] + (matrix[4] + matrix[5]) * to_middle;
        return;
    }
    const auto scale = numbers_of<double>(tiff, kPixelScale, TIFF_DOUBLE);
    if (scale.size() < 2 || scale[0] == 0.0 || scale[1] == 0.0) {
        place.model = GridModel::none;
        return;
    }
    place.column_east = scale[0];
    place.row_north = -std::abs(scale[1]);
    const auto tie = numbers_of<double>(tiff, kTiePoint, TIFF_DOUBLE);
    if (tie.size() < 6) {
        if (place.model != GridModel::projected) place.model = GridModel::none;  // no latitude
        return;
    }
    place.east = tie[3] + (to_middle - tie[0]) * place.column_east;
    place.north = tie[4] + (to_middle - tie[1]) * place.row_north;
}

void read_ellipsoid(const GeoKeys& keys, GridPlace& place) {
    const std::optional<double> equator = keys.number(kEquator), pole = keys.number(kPole),
                                inverse = keys.number(kInverseFlattening);
    if (!equator || (!pole && !inverse)) return;
    place.equator = *equator;
    place.pole = pole ? *pole : *inverse == 0.0 ? *equator : *equator * (1.0 - 1.0 / *inverse);
}

}  // namespace

GridPlace read_geo_keys(TIFF* tiff) {
    const GeoKeys keys(tiff);
    GridPlace place;
    place.model = model_of(keys);
    read_steps(tiff, keys.code(kRasterType) == kPixelIsPoint ? 0.0 : 0.5, place);
    if (place.model == GridModel::geographic)
        place.unit = unit_of(keys, kAngularUnit, kAngularUnitSize, kAngles, 1.0 / kDegree);
    else if (place.model == GridModel::projected)
        place.unit = unit_of(keys, kLinearUnit, kLinearUnitSize, kLengths, 1.0);
    if (place.model == GridModel::projected && place.unit == 0.0) place.unit = unit_of_system(keys);
    read_ellipsoid(keys, place);
    place.height_metres = unit_of(keys, kVerticalUnit, 0, kLengths, 1.0);
    if (place.height_metres < 0.0)
        std::snprintf(place.height_unit, sizeof place.height_unit, "EPSG unit %d", keys.code(kVerticalUnit));
    if (place.height_metres == 0.0)
        place.height_metres = size_of(kHeightSystems, keys.code(kVerticalSystem)).value_or(0.0);
    return place;
}

}  // namespace tex::reader
