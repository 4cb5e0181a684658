// SPDX-License-Identifier: Apache-2.0
// stored_samples.h: what a file says about its samples besides their values.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// What the coordinates of a grid are.
enum class GridModel : std::uint32_t {
    none,        // the file has no grid
    numbers,     // it does not say
    projected,   // lengths on a map
    geographic,  // angles of longitude and latitude
    mercator,    // metres of Web Mercator
    other,       // coordinates that no map has: of the centre of the Earth, or of a system that the file does not name
    nowhere,     // the file should say by its name where it lies, and does not
};

// Where the texels are, as a file states it. 0: the file does not state the number.
struct GridPlace {
    GridModel model = GridModel::none;
    // How far east and north a column and a row lead, and the middle of the first texel; in the unit of the grid.
    double column_east = 0, column_north = 0;
    double row_east = 0, row_north = 0;
    double east = 0, north = 0;
    double unit = 0;     // metres, or degrees, for the number 1; below 0: a unit that is not known here
    double equator = 0;  // the radii of the ellipsoid, in metres
    double pole = 0;
    double height_metres = 0;   // metres for the height 1; below 0: a unit that is not known here
    char height_unit[32] = {};  // the name of a unit of heights, which takes precedence
};

// The reader process hands over integers as they are stored; RowSource::store() makes them fractions of the largest
// one.
struct StoredSamples {
    std::uint32_t kind = 0;  // as TIFF numbers them: 1 unsigned, 2 signed, 3 floating; 0 if the file does not say
    std::uint32_t bits = 0;
    std::uint32_t has_place = 0;  // GeoTIFF: the picture has a place on the Earth, so its samples have a unit
    std::uint32_t has_scale = 0;  // GDAL: the value is scale * sample + offset
    double scale = 1;
    double offset = 0;
    GridPlace place = {};
};

}  // namespace tex::inline v1
