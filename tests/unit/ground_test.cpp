// SPDX-License-Identifier: Apache-2.0
// The size of texels on the ground, and slopes that follow from it. Sizes are compared with published lengths and with
// slopes of gdaldem; an analytic hill on the ellipsoid is the oracle of everything together.

#include "rows/ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/file.h>

#include "formats/ground.h"
#include "formats/map_tile.h"

namespace tex {
namespace {

constexpr double kRadian = 0.017453292519943295;

Ground of_degrees(double step, double north) {
    Ground ground;
    ground.unit = GroundUnit::degree;
    ground.width = ground.height = step;
    ground.north = north;
    return ground;
}

// National Geospatial-Intelligence Agency, "Length of a degree of latitude and longitude", in kilometres, WGS 84.
TEST(Ground, DegreesHaveTheirPublishedLengths) {
    struct Row {
        double latitude, along, across;
    };
    constexpr Row kRows[] = {{0, 110.574, 111.320}, {15, 110.649, 107.550}, {30, 110.852, 96.486},
                             {45, 111.132, 78.847}, {60, 111.412, 55.800},  {75, 111.618, 28.902},
                             {90, 111.694, 0.0}};
    for (const Row& row : kRows) {
        for (const double latitude : {row.latitude, -row.latitude}) {
            const TexelSize size = texel_size(of_degrees(1.0, latitude), 0.0);
            EXPECT_NEAR(size.height, 1000.0 * row.along, 0.51) << latitude;
            EXPECT_NEAR(size.width, 1000.0 * row.across, 0.51) << latitude;
        }
    }
}

TEST(Ground, RowsGoSouthOrNorth) {
    Ground ground = of_degrees(0.5, 46.0);
    EXPECT_EQ(latitude_of(ground, 4), 44.0);
    ground.north_up = false;
    EXPECT_EQ(latitude_of(ground, 4), 48.0);
    EXPECT_EQ(texel_size(ground, 4).width, texel_size(of_degrees(0.5, 48.0), 0).width);
}

// Slopes of "gdaldem slope -compute_edges" of GDAL 3.6.2, of a grid in metres whose cells have the size of 1/1200
// degree at the latitude, as distances in space give it. They are those of the middle row.
TEST(Ground, SlopesAreThoseOfGdaldem) {
    struct Row {
        double latitude;
        float slopes[5];
    };
    constexpr Row kRows[] = {{0, {7.027609f, 2.324949f, 6.604957f, 10.370287f, 8.431110f}},
                             {46, {9.634567f, 2.535797f, 9.339346f, 12.222075f, 12.024531f}},
                             {70, {18.443058f, 3.585126f, 18.306568f, 19.769646f, 23.368662f}},
                             {-33, {8.157739f, 2.408378f, 7.801362f, 11.133814f, 10.012889f}}};
    for (const Row& row : kRows) {
        HeightField field{Plane<float>(Extent{5, 5}), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp};
        for (int j = 0; j < 5; ++j) {
            for (int i = 0; i < 5; ++i) field.height.at(i, j) = static_cast<float>((i * 37 + j * 53 + i * j * 11) % 97);
        }
        field.ground = of_degrees(1.0 / 1200.0, row.latitude + 2.0 / 1200.0);
        const auto map = bake(field, {GradientKernel::sobel});
        ASSERT_TRUE(map) << map.error().reason;
        for (int i = 0; i < 5; ++i) {
            const double slope = std::acos(static_cast<double>(map->z.at(i, 2))) / kRadian;
            EXPECT_NEAR(slope, static_cast<double>(row.slopes[i]), 1e-3) << row.latitude << ", column " << i;
        }
    }
}

// A ground whose heights are h(u, v), with u and v in radians of longitude and latitude from the middle.
struct Hill {
    double latitude, reach;  // of the middle, and how far it extends: radians

    [[nodiscard]] double height(double u, double v) const {
        return 2000.0 * std::exp(-(u * u * 2.0 + v * v + u * v) / (reach * reach));
    }
    // Rises per metre to the east and to the north.
    [[nodiscard]] std::pair<double, double> slopes(double u, double v) const {
        constexpr double kA = 6378137.0, kE2 = 0.00669437999014;
        const double phi = latitude * kRadian + v, w = 1.0 - kE2 * std::sin(phi) * std::sin(phi);
        const double east = kA / std::sqrt(w) * std::cos(phi), north = kA * (1.0 - kE2) / (w * std::sqrt(w));
        const double h = height(u, v) / (reach * reach);
        return {-h * (4.0 * u + v) / east, -h * (2.0 * v + u) / north};
    }
};

double degrees_between(const NormalMap& map, int i, int j, std::pair<double, double> slopes) {
    const double length = std::sqrt(slopes.first * slopes.first + slopes.second * slopes.second + 1.0);
    const double dot = static_cast<double>(map.x.at(i, j)) * -slopes.first +
                       static_cast<double>(map.y.at(i, j)) * -slopes.second + static_cast<double>(map.z.at(i, j));
    return std::acos(std::min(dot / length, 1.0)) / kRadian;
}

TEST(Ground, AHillOnTheEllipsoidHasItsSlopes) {
    constexpr int kSide = 257;
    constexpr double kStep = 1.0 / 3600.0;
    for (const double latitude : {0.0, 46.0, 70.0, -33.0}) {
        const Hill hill{latitude, 60 * kStep * kRadian};
        HeightField field{Plane<float>(Extent{kSide, kSide}), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp};
        const auto place = [&](int texel) { return (texel - kSide / 2) * kStep * kRadian; };
        for (int j = 0; j < kSide; ++j) {
            for (int i = 0; i < kSide; ++i)
                field.height.at(i, j) = static_cast<float>(hill.height(place(i), -place(j)));
        }
        field.ground = of_degrees(kStep, latitude + kSide / 2 * kStep);
        const auto map = bake(field);
        ASSERT_TRUE(map) << map.error().reason;
        double worst = 0.0;
        for (int j = 1; j < kSide - 1; ++j) {
            for (int i = 1; i < kSide - 1; ++i)
                worst = std::max(worst, degrees_between(*map, i, j, hill.slopes(place(i), -place(j))));
        }
        EXPECT_LT(worst, 0.05) << latitude;
        EXPECT_LT(map->z.at(kSide / 2 + 40, kSide / 2 + 40), 0.9f);
    }
}

// One hill on Web Mercator, whose rows are not equally far apart in latitude.
TEST(Ground, WebMercatorIsNotTakenForMetres) {
    constexpr int kSide = 257;
    constexpr double kA = 6378137.0, kStep = 40.0;
    const double latitude = 60.0, middle = kA * std::log(std::tan((45.0 + latitude / 2.0) * kRadian));
    const Hill hill{latitude, 60 * kStep / kA};
    HeightField field{Plane<float>(Extent{kSide, kSide}), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp};
    const auto u = [&](int i) { return (i - kSide / 2) * kStep / kA; };
    const auto v = [&](int j) {
        const double north = middle - (j - kSide / 2) * kStep;
        return 2.0 * std::atan(std::exp(north / kA)) - 90.0 * kRadian - latitude * kRadian;
    };
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) field.height.at(i, j) = static_cast<float>(hill.height(u(i), v(j)));
    }
    Ground ground;
    ground.unit = GroundUnit::mercator;
    ground.width = ground.height = kStep;
    ground.north = middle + kSide / 2 * kStep;
    field.ground = ground;
    EXPECT_NEAR(latitude_of(ground, kSide / 2), latitude, 1e-9);
    const auto map = bake(field);
    ASSERT_TRUE(map) << map.error().reason;
    double worst = 0.0;
    for (int j = 1; j < kSide - 1; ++j) {
        for (int i = 1; i < kSide - 1; ++i)
            worst = std::max(worst, degrees_between(*map, i, j, hill.slopes(u(i), v(j))));
    }
    EXPECT_LT(worst, 0.05);
}

// Bumpiness multiplies the slopes of the ground, and equal texels give the bytes of one bumpiness.
TEST(Ground, BumpinessMultipliesIt) {
    const auto field_with = [](float bumpiness, std::optional<Ground> ground) {
        HeightField field{Plane<float>(Extent{19, 7}), bumpiness, bumpiness, Wrap::repeat, Wrap::mirror, ground};
        for (int j = 0; j < 7; ++j) {
            for (int i = 0; i < 19; ++i) field.height.at(i, j) = static_cast<float>((i * i + 3 * j * i) % 23);
        }
        return field;
    };
    Ground ground;
    ground.width = ground.height = 8.0;
    ground.height_metres = 2.0;
    for (const GradientKernel kernel : {GradientKernel::central, GradientKernel::forward, GradientKernel::sobel5}) {
        const auto one = bake(field_with(4.0f, ground), {kernel}), other = bake(field_with(1.0f, {}), {kernel});
        ASSERT_TRUE(one && other);
        for (int j = 0; j < 7; ++j) EXPECT_EQ(std::memcmp(one->x.row(j), other->x.row(j), 19 * sizeof(float)), 0) << j;
    }
}

TEST(Ground, BytesDoNotDependOnThreads) {
    HeightField field{Plane<float>(Extent{33, 900}), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp, of_degrees(0.01, 71.0)};
    for (int j = 0; j < 900; ++j) {
        for (int i = 0; i < 33; ++i) field.height.at(i, j) = static_cast<float>((i * 31 + j * 17) % 1009);
    }
    Execution one, many;
    one.threads = 1;
    many.threads = 5;
    const auto a = bake(field, {}, one), b = bake(field, {}, many);
    ASSERT_TRUE(a && b);
    for (int j = 0; j < 900; ++j) ASSERT_EQ(std::memcmp(a->z.row(j), b->z.row(j), 33 * sizeof(float)), 0) << j;
}

TEST(Ground, WhatIsUnsoundIsRefused) {
    HeightField field{Plane<float>(Extent{2, 2}, 1.0f)};
    field.ground = of_degrees(0.0, 1.0);
    EXPECT_EQ(bake(field).error().reason, "ground: sizes must be above 0");
    field.ground = of_degrees(1.0, std::nan(""));
    EXPECT_EQ(bake(field).error().reason, "ground: north must be finite");
}

// -- what files say ------------------------------------------------------------------------------------------------

// GeoTIFFs that gdal_translate 3.6.2 wrote; the sizes and corners are those that gdalinfo prints.
TEST(Ground, WhatGdalWritesIsRead) {
    const auto read = [](const std::string& name) {
        auto image = read_image(TEX_SOURCE_DIR "/tests/unit/geotiff/" + name);
        EXPECT_TRUE(image) << image.error().message();
        EXPECT_TRUE(image->ground) << name << ": " << image->ground_remark;
        EXPECT_EQ(image->ground_remark, "") << name;
        return image->ground.value_or(Ground());
    };
    constexpr double kSurveyFoot = 1200.0 / 3937.0;
    Ground ground = read("degrees.tif");  // EPSG:4326
    EXPECT_EQ(ground.unit, GroundUnit::degree);
    EXPECT_NEAR(ground.width, 0.000833333334, 1e-15);
    EXPECT_NEAR(ground.height, 0.00083333334, 1e-15);
    EXPECT_NEAR(ground.north, 46.0041666667 - 0.5 * 0.00083333334, 1e-12);
    EXPECT_TRUE(ground.north_up);
    EXPECT_FALSE(ground.has_height_unit);
    // The corner that gdalinfo prints is that of a cell around the point.
    EXPECT_NEAR(read("point.tif").north, 46.00416666666667 - 0.5 / 1200.0, 1e-12);
    ground = read("survey_feet.tif");  // EPSG:2263
    EXPECT_EQ(ground.unit, GroundUnit::metre);
    EXPECT_NEAR(ground.width, 10.0 * kSurveyFoot, 1e-9);
    EXPECT_FALSE(ground.has_height_unit);
    // In GeoTIFF 1.1, GDAL writes the numbers of the systems and no units: EPSG:2263+6360.
    ground = read("feet_high.tif");
    EXPECT_NEAR(ground.width, 10.0 * kSurveyFoot, 1e-9);
    EXPECT_NEAR(ground.height_metres, kSurveyFoot, 1e-12);
    EXPECT_TRUE(ground.has_height_unit);
    ground = read("tm_feet.tif");  // +proj=tmerc +units=ft
    EXPECT_NEAR(ground.width, 30.0 * 0.3048, 1e-9);
    ground = read("utm.tif");  // EPSG:32632+5703
    EXPECT_EQ(ground.width, 30.0);
    EXPECT_EQ(ground.height_metres, 1.0);
    EXPECT_TRUE(ground.has_height_unit);
    ground = read("mercator.tif");  // EPSG:3857
    EXPECT_EQ(ground.unit, GroundUnit::mercator);
    EXPECT_EQ(ground.north, 5780350.0);
    EXPECT_NEAR(latitude_of(ground, -0.5), 46.000317, 1e-5);  // 46d 0' 1.14"N
    ground = read("moon.tif");
    EXPECT_EQ(ground.equator_radius, 1737400.0);
    EXPECT_EQ(ground.pole_radius, 1737400.0);
}

GridPlace grid(double step, double east, double north) {
    GridPlace place;
    place.model = GridModel::numbers;
    place.column_east = step;
    place.row_north = -step;
    place.east = east;
    place.north = north;
    return place;
}

constexpr Extent kGrid{100, 100};

// The corner of 10/486/332 is an example in the documentation of mercantile.
TEST(Ground, MapTilesLieWhereTheirPathSays) {
    for (const char* path : {"10/486/332.png", "/srv/dem/10/486/332.webp"}) {
        const std::optional<GridPlace> place = map_tile_place(path, {256, 256});
        ASSERT_TRUE(place) << path;
        const std::optional<Ground> ground = ground_of(*place, {256, 256}, {}).ground;
        ASSERT_TRUE(ground) << path;
        EXPECT_NEAR(latitude_of(*ground, -0.5), 53.33087298301705, 1e-9);
        EXPECT_NEAR(latitude_of(*ground, 255.5), 53.12040528310657, 1e-9);
    }
    for (const char* path : {"332.png", "486/332.png", "a/486/332.png", "10/1024/332.png", "10/486/1024.png",
                             "10/486/332.jpg", "10/486/-332.png", "10/486/332a.png", "40/486/332.png", "10//332.png"})
        EXPECT_FALSE(map_tile_place(path, {256, 256})) << path;
    for (const Extent extent : {Extent{256, 128}, Extent{300, 300}, Extent{2048, 2048}})
        EXPECT_FALSE(map_tile_place("10/486/332.png", extent));
}

TEST(Ground, CoordinatesSayWhatTheyAreIfTheyCanBeNothingElse) {
    struct Row {
        GridPlace place;
        const char* unit;  // or nothing
        const char* remark;
    };
    const Row rows[] = {
        {grid(30.0, 500000, 5100000), "metre", "taken as metres"},
        {grid(1.0 / 1200.0, 7, 47), "degree", "taken as degrees"},
        {grid(1.0, 0.5, 99.5), "metre", "taken as metres"},            // 100 m, beyond a pole
        {grid(0.01, 0.005, 0.995), "", "could be degrees or metres"},  // a stone, or the sea off Africa
        {grid(0.5, -30, 60), "", "could be degrees or metres"},
        {grid(1e-13, 7, 47), "", "too small or too large"},
    };
    for (const Row& row : rows) {
        const GroundFound found = ground_of(row.place, kGrid, {});
        EXPECT_EQ(found.ground ? name_of(kGroundUnitNames, found.ground->unit) : "", row.unit) << found.remark;
        EXPECT_NE(found.remark.find(row.remark), std::string::npos) << found.remark;
    }
}

TEST(Ground, ProjectionFilesSayWhatCoordinatesAre) {
    struct Row {
        const char* text;
        GroundUnit unit;
        double width, height_metres;
    };
    constexpr double kSurveyFoot = 1200.0 / 3937.0;
    // The first four are what GDAL 3.6.2 and ArcGIS write.
    const Row rows[] = {
        {R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],)"
         R"(PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])",
         GroundUnit::degree, 0.01, 1.0},
        {R"(PROJCS["NAD_1983_StatePlane_New_York_Long_Island_FIPS_3104_Feet",GEOGCS["GCS_North_American_1983",)"
         R"(DATUM["D_North_American_1983",SPHEROID["GRS_1980",6378137.0,298.257222101]],PRIMEM["Greenwich",0.0],)"
         R"(UNIT["Degree",0.0174532925199433]],PROJECTION["Lambert_Conformal_Conic"],)"
         R"(PARAMETER["False_Easting",984250.0],UNIT["Foot_US",0.304800609601219]],)"
         R"(VERTCS["NAVD88_height_ftUS",VDATUM["x"],PARAMETER["Direction",1.0],UNIT["Foot_US",0.304800609601219]])",
         GroundUnit::metre, 0.01 * kSurveyFoot, kSurveyFoot},
        {R"(PROJCS["WGS_1984_Web_Mercator_Auxiliary_Sphere",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",)"
         R"(SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],)"
         R"(PROJECTION["Mercator_Auxiliary_Sphere"],UNIT["Meter",1.0]])",
         GroundUnit::mercator, 0.01, 1.0},
        {"Projection    GEOGRAPHIC\r\nDatum         WGS84\r\nSpheroid      WGS84\r\nUnits         DD\r\nZunits NO\r\n",
         GroundUnit::degree, 0.01, 1.0},
        {"Projection UTM\nZone 32\nUnits METERS\nZunits FEET\nParameters\n", GroundUnit::metre, 0.01, 0.3048},
        {R"(GEOGCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563,)"
         R"(LENGTHUNIT["metre",1]]],CS[ellipsoidal,2],AXIS["lat",north],AXIS["lon",east],)"
         R"(ANGLEUNIT["degree",0.0174532925199433]])",
         GroundUnit::degree, 0.01, 1.0},
    };
    for (const Row& row : rows) {
        const GroundFound found = ground_of(grid(0.01, 7, 47), kGrid, row.text);
        ASSERT_TRUE(found.ground) << row.text << found.remark;
        EXPECT_EQ(found.ground->unit, row.unit) << row.text;
        EXPECT_NEAR(found.ground->width, row.width, 1e-10) << row.text;
        EXPECT_NEAR(found.ground->height_metres, row.height_metres, 1e-9) << row.text;
        EXPECT_EQ(found.remark, "") << row.text;
    }
}

TEST(Ground, WhatCannotBeUsedIsSaid) {
    const auto remark = [](GridPlace place) {
        const GroundFound found = ground_of(place, kGrid, {});
        EXPECT_FALSE(found.ground);
        return found.remark.substr(std::min<std::size_t>(found.remark.size(), 36));
    };
    GridPlace place = grid(0.01, 7, 47);
    place.model = GridModel::geographic;
    place.column_north = 0.001;
    EXPECT_EQ(remark(place), " its rows are not parallels of latitude");
    place = grid(0.01, 7, 95);
    place.model = GridModel::geographic;
    EXPECT_EQ(remark(place), " its latitudes lie beyond the poles");
    place = grid(10, 500000, 5000000);
    place.model = GridModel::projected;
    place.row_east = 5;
    EXPECT_EQ(remark(place), " its rows and columns are not at right angles");
    place.row_east = 0;
    place.unit = -1;
    EXPECT_EQ(remark(place), " its coordinates are in a unit that is not known");
    place.unit = 1;
    std::strcpy(place.height_unit, "kPa\n");
    EXPECT_EQ(remark(place), " the unit of its heights, \"kPa?\", is not known");
    std::strcpy(place.height_unit, "ft");
    EXPECT_EQ(ground_of(place, kGrid, {}).ground->height_metres, 0.3048);
    place.unit = 0;
    EXPECT_NE(ground_of(place, kGrid, {}).remark.find("taken as metres"), std::string::npos);
    place.east = std::nan("");
    EXPECT_EQ(remark(place), " it is not a number");
}

TEST(Ground, WorldFilesHaveSixNumbers) {
    const auto place = world_file_place("2.5\n0\n0\n-2.5\n500001.25\r\n5100000\n");
    ASSERT_TRUE(place);
    EXPECT_EQ(place->column_east, 2.5);
    EXPECT_EQ(place->row_north, -2.5);
    EXPECT_EQ(place->east, 500001.25);
    EXPECT_EQ(place->north, 5100000.0);
    EXPECT_FALSE(world_file_place("2.5 0 0 -2.5 1"));
    EXPECT_FALSE(world_file_place("2.5 0 0 -2.5 1 x"));
    EXPECT_FALSE(world_file_place("2.5 0 0 -2.5 1 nan"));
}

}  // namespace
}  // namespace tex
