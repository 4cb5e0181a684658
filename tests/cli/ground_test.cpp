// SPDX-License-Identifier: Apache-2.0
// bake-normals on elevation models that state the size of their texels.

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDegrees =
    "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
    "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]";
constexpr const char* kFeet = "Projection UTM\nUnits FEET\nZunits METERS\n";

int height_at(int i, int j) { return (i * 37 + j * 53 + i * j * 11) % 97; }

class OnTheGround : public testing::Test {
protected:
    // The columns and rows [left, left + width) x [top, top + height) of a grid whose corner in the northwest is
    // at 7 E, 46 N, or at this place in metres.
    void write_grid(const std::string& name, double step, int left, int top, int width, int height) const {
        const double west = step < 1.0 ? 7.0 : 500000.0, north = step < 1.0 ? 46.0 : 5100000.0;
        std::string text = fmt::format("ncols {}\nnrows {}\nxllcorner {:.15g}\nyllcorner {:.15g}\ncellsize {:.15g}\n",
                                       width, height, west + step * left, north - step * (top + height), step);
        for (int j = top; j < top + height; ++j) {
            for (int i = left; i < left + width; ++i) text += fmt::format("{} ", height_at(i, j));
            text += "\n";
        }
        scratch_.write(name, text);
    }
    // Like "h.asc", without a place.
    void write_pfm(const std::string& name, int width, int height) const {
        std::string pfm = fmt::format("Pf\n{} {}\n-1.0\n", width, height);
        for (int j = height - 1; j >= 0; --j) {
            for (int i = 0; i < width; ++i) {
                const auto value = static_cast<float>(height_at(i, j));
                pfm.append(reinterpret_cast<const char*>(&value), sizeof value);
            }
        }
        scratch_.write(name, pfm);
    }
    [[nodiscard]] Ran bake(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--format", "float", "--wrap", "clamp"});
        return run(scratch_, "bake-normals", arguments);
    }
    [[nodiscard]] std::string baked(const std::vector<std::string>& arguments) const {
        std::vector<std::string> all = arguments;
        all.insert(all.end(), {"-o", "x.exr"});
        const Ran ran = bake(all);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return scratch_.read("x.exr");
    }
    [[nodiscard]] double slope_at(const std::string& name, int i, int j) const {
        const auto image = read_image(scratch_.path(name));
        EXPECT_TRUE(image) << image.error().message();
        return std::acos(static_cast<double>(image->planes[static_cast<std::size_t>(image->find("B"))].at(i, j))) *
               57.29577951308232;
    }

    const Scratch scratch_;
};

// What gdaldem 3.6.2 prints of the slope of the middle texel: see tests/unit/ground_test.cpp.
TEST_F(OnTheGround, DegreesGiveTheSlopesOfGdaldem) {
    const double step = 1.0 / 1200.0;
    std::string text =
        fmt::format("ncols 5\nnrows 5\nxllcenter 7\nyllcenter {:.15g}\ncellsize {:.15g}\n", 46.0 - 2.0 * step, step);
    for (int k = 0; k < 25; ++k) text += fmt::format("{} ", height_at(k % 5, k / 5));
    scratch_.write("h.asc", text);
    scratch_.write("h.prj", kDegrees);
    const Ran ran = bake({"h.asc", "-o", "n.exr", "--kernel", "sobel"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.out, "h.asc: 64.6 x 92.6 m a texel at 46.0 north, heights taken as metres\n");
    EXPECT_NEAR(slope_at("n.exr", 2, 2), 9.339346, 1e-3);
    EXPECT_NEAR(slope_at("n.exr", 4, 2), 12.024531, 1e-3);
    const Ran gdal = bake({TEX_SOURCE_DIR "/tests/unit/geotiff/point.tif", "-o", "n.exr", "--kernel", "sobel", "--json",
                           "--heights", "stored"});
    ASSERT_EQ(gdal.code, 0) << gdal.err;
    const auto report = nlohmann::json::parse(gdal.out);
    EXPECT_EQ(report["ground"]["used"], true);
    EXPECT_EQ(report["ground"]["unit"], "degree");
    EXPECT_NEAR(report["ground"]["latitude"], 46.002083, 1e-6);
    EXPECT_NEAR(report["ground"]["texel"][0], 64.5503, 1e-3);
    EXPECT_NEAR(slope_at("n.exr", 2, 2), 9.339346, 2e-3);  // 250 m further north
}

TEST_F(OnTheGround, MetresHaveTheBytesOfTheirWorldSize) {
    write_grid("h.asc", 32.0, 0, 0, 9, 6);
    write_pfm("h.pfm", 9, 6);
    const std::string expected = baked({"h.pfm", "--height-range", "1", "--world-size", "288x192"});
    EXPECT_EQ(baked({"h.asc"}), expected);
    EXPECT_EQ(baked({"h.pfm", "--height-range", "1", "--world-size", "288x192", "--vertical-scale", "2"}),
              baked({"h.asc", "--vertical-scale", "2"}));
    EXPECT_EQ(baked({"h.pfm", "--height-range", "2", "--world-size", "288x192"}),
              baked({"h.asc", "--vertical-scale", "2"}));
    const Ran ran = bake({"h.asc", "-o", "n.exr"});
    EXPECT_EQ(ran.out,
              "h.asc: 32 x 32 m a texel, heights taken as metres; its coordinates were taken as metres, because no "
              ".prj file beside it says what they are\n");
    scratch_.write("h.prj", kFeet);
    EXPECT_EQ(bake({"h.asc", "-o", "n.exr", "--vertical-scale", "3"}).out,
              "h.asc: 9.75 x 9.75 m a texel, heights in metres, 3 times as steep\n");
    // Nobody asks for a terrain that repeats.
    EXPECT_EQ(run(scratch_, "bake-normals", {"h.asc", "-o", "n.exr"}).out,
              "h.asc: 9.75 x 9.75 m a texel, heights in metres; without --wrap clamp, heights repeat beyond the "
              "border\n");
    EXPECT_EQ(baked({"h.asc", "--depfile", "d"}),
              baked({"h.pfm", "--height-range", "1", "--world-size", "87.7824x58.5216"}));
    EXPECT_EQ(scratch_.read("d"), "x.exr: \\\n  h.asc \\\n  h.prj\n");
}

TEST_F(OnTheGround, AnOptionTakesPrecedenceAndALineSaysSo) {
    write_grid("h.asc", 32.0, 0, 0, 9, 6);
    write_pfm("h.pfm", 9, 6);
    const std::vector<std::vector<std::string>> options = {{"--bumpiness", "3"},
                                                           {"--uv-height", "0.5"},
                                                           {"--height-range", "1", "--world-size", "300"},
                                                           {"--bumpiness", "auto"}};
    for (const std::vector<std::string>& option : options) {
        std::vector<std::string> asc = {"h.asc"}, pfm = {"h.pfm"};
        asc.insert(asc.end(), option.begin(), option.end());
        pfm.insert(pfm.end(), option.begin(), option.end());
        EXPECT_EQ(baked(asc), baked(pfm));
        asc.insert(asc.end(), {"-o", "n.exr"});
        const std::string name = option[0] == "--height-range" ? "--world-size" : option[0];
        EXPECT_NE(bake(asc).out.find("h.asc: " + name +
                                     " is used, not the 32 x 32 m a texel that the file states (288 x 192 m in all)\n"),
                  std::string::npos)
            << bake(asc).out;
    }
    const Ran ran = bake({"h.asc", "-o", "n.exr", "--bumpiness", "auto", "--vertical-scale", "2"});
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("--vertical-scale contradicts --bumpiness auto"), std::string::npos) << ran.err;
}

TEST_F(OnTheGround, WhatIsNotKnownIsSaidAndNothingIsScaled) {
    write_pfm("h.pfm", 9, 6);
    std::string text = "ncols 9\nnrows 6\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n";
    for (int k = 0; k < 54; ++k) text += fmt::format("{} ", height_at(k % 9, k / 9));
    scratch_.write("h.asc", text);
    EXPECT_EQ(baked({"h.asc"}), baked({"h.pfm"}));
    EXPECT_NE(bake({"h.asc", "-o", "n.exr"})
                  .err.find("h.asc: the size of its texels was not used, because its "
                            "coordinates could be degrees or metres"),
              std::string::npos);
    EXPECT_EQ(bake({"h.asc", "-o", "n.exr", "--bumpiness", "1"}).err.find("size of its texels"), std::string::npos);
}

// A world file beside a picture of fractions of a range means nothing for their slopes.
// Tiles of the web state no place.
TEST_F(OnTheGround, MetresInColoursNeedAWidth) {
    scratch_.add_sample("report.png", "tile.png");
    const std::string bake = "bake-normals tile.png -o n.png --channel terrarium";
    const std::string assumed = "nothing says how wide a texel is: 1 m is assumed; --height-range 1 --world-size W";
    EXPECT_NE(shell(scratch_, bake).err.find(assumed), std::string::npos);
    const Ran told = shell(scratch_, bake + " --height-range 1 --world-size 40000");
    EXPECT_EQ(told.code, 0) << told.err;
    EXPECT_EQ(told.err.find(assumed), std::string::npos);
}

// Tiles of the web lie where their path says.
TEST_F(OnTheGround, MapTilesHaveAPath) {
    fs::create_directories(scratch_.path("dem/10/486"));
    const std::string hills =
        "from PIL import Image\n"
        "tile = Image.new('RGB', (256, 256))\n"
        "for y in range(256):\n"
        "    for x in range(256):\n"
        "        h = int((11500 - 10 * ((x - 128) ** 2 + (y - 128) ** 2) ** 0.5) * 10)\n"
        "        tile.putpixel((x, y), (h >> 16, h >> 8 & 255, h & 255))\n"
        "tile.save('dem/10/486/332.png')\n"
        "tile.save('332.png')\n";
    scratch_.write("hills.py", hills);
    ASSERT_EQ(shell(scratch_, "/usr/bin/python3 hills.py").code, 0);
    const Ran found = bake({"dem/10/486/332.png", "-o", "n.exr"});
    EXPECT_EQ(found.code, 0) << found.err;
    // 156543.03392 m cos(53.2256) / 2^10 are 91.5 m on a sphere; along a parallel, the Earth is wider there.
    EXPECT_NE(found.out.find("332.png: 91.7 x 91.5 m a texel at 53.2 north, heights in metres"), std::string::npos)
        << found.out;
    EXPECT_EQ(found.err.find("nothing says how wide"), std::string::npos) << found.err;
    EXPECT_NE(bake({"332.png", "-o", "m.exr"}).err.find("nothing says how wide"), std::string::npos);
}

TEST_F(OnTheGround, FractionsOfARangeHaveNoUnit) {
    fs::copy_file(TEX_SOURCE_DIR "/samples/waves.png", scratch_.path("w.png"));
    const std::string plain = baked({"w.png"});
    scratch_.write("w.pgw", "30\n0\n0\n-30\n500015\n5099985\n");
    EXPECT_EQ(baked({"w.png"}), plain);
    EXPECT_EQ(bake({"w.png", "-o", "n.exr"}).out, "");
    const Ran ran = bake({"w.png", "-o", "n.exr", "--heights", "stored"});
    EXPECT_NE(ran.out.find("w.png: 30 x 30 m a texel, heights taken as metres"), std::string::npos) << ran.out;
    const std::string tiff = TEX_SOURCE_DIR "/tests/unit/geotiff/utm.tif";
    EXPECT_EQ(bake({tiff, "-o", "n.exr"}).out, tiff + ": 30 x 30 m a texel, heights in metres\n");
}

TEST_F(OnTheGround, AnHgtIsWhereItsNameSays) {
    std::string heights(std::size_t{2} * 1201 * 1201, '\0');
    for (std::size_t k = 0; k < heights.size(); k += 2) heights[k + 1] = static_cast<char>(k / 2 % 1201 % 100);
    const std::vector<std::pair<std::string, std::string>> names = {
        {"N46E007.hgt", "64 x 92.6 m a texel at 46.5 north"},
        {"s34_e018_3arc.hgt", "77.4 x 92.4 m a texel at 33.5 south"},
        {"N00W001.SRTMGL3.hgt", "92.8 x 92.1 m a texel at 0.5 north"}};
    for (const auto& [name, text] : names) {
        scratch_.write(name, heights);
        const Ran ran = run(scratch_, "bake-normals", {name, "-o", "n.png", "--wrap", "clamp"});
        EXPECT_EQ(ran.out, name + ": " + text + ", heights in metres\n") << ran.err;
        fs::remove(scratch_.path(name));
    }
    scratch_.write("alps.hgt", heights);
    const Ran ran = run(scratch_, "bake-normals", {"alps.hgt", "-o", "n.png"});
    EXPECT_NE(ran.err.find("its name does not say where it lies, as N46E007 does"), std::string::npos) << ran.err;
}

// Each row of a tile lies where the file of the tile says, and so do the rows around it.
TEST_F(OnTheGround, TilesHaveTheBytesOfTheWhole) {
    const double step = 1.0 / 240.0;
    write_grid("whole.asc", step, 0, 0, 30, 40);
    scratch_.write("whole.prj", kDegrees);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
            write_grid(fmt::format("h_{}_{}.asc", x, y), step, 15 * x, 20 * y, 15, 20);
            scratch_.write(fmt::format("h_{}_{}.prj", x, y), kDegrees);
        }
    }
    ASSERT_EQ(bake({"whole.asc", "-o", "whole.exr", "--kernel", "sobel5"}).code, 0);
    const Ran ran = bake({"h_{x}_{y}.asc", "--tiles", "-o", "n_{x}_{y}.exr", "--kernel", "sobel5"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err.find("another size"), std::string::npos) << ran.err;
    const auto whole = read_image(scratch_.path("whole.exr"));
    ASSERT_TRUE(whole);
    for (int k = 0; k < 4; ++k) {
        const int x = k % 2, y = k / 2;
        const auto tile = read_image(scratch_.path(fmt::format("n_{}_{}.exr", x, y)));
        ASSERT_TRUE(tile);
        for (std::size_t c = 0; c < 3; ++c) {
            for (int j = 0; j < 20; ++j)
                ASSERT_EQ(
                    std::memcmp(tile->planes[c].row(j), whole->planes[c].row(20 * y + j) + 15 * x, 15 * sizeof(float)),
                    0)
                    << k << " row " << j;
        }
    }
    write_grid("h_1_0.asc", step / 2, 15, 0, 15, 20);
    const Ran other = bake({"h_{x}_{y}.asc", "--tiles", "-o", "n_{x}_{y}.exr"});
    EXPECT_NE(other.err.find("h_0_0.asc: h_1_0.asc, the tile beside it, states another size of its texels"),
              std::string::npos)
        << other.err;
    const Ran explicitly = bake({"h_{x}_{y}.asc", "--tiles", "-o", "n_{x}_{y}.exr", "--bumpiness", "2"});
    EXPECT_EQ(explicitly.err, "");
}

TEST_F(OnTheGround, ManifestsTakeTheSame) {
    write_grid("h.asc", 1.0 / 240.0, 0, 0, 12, 12);
    scratch_.write("h.prj", kDegrees);
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"*.asc\"\nname = \"{stem}_n.exr\"\nsteps = [ { bake = { "
                   "vertical-scale = 2, format = \"float\", wrap = \"clamp\" } } ]\n");
    const Ran ran = run(scratch_, "build-normals", {"normals.toml"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("323 x 463 m a texel at 46.0 north, heights taken as metres, 2 times as steep"),
              std::string::npos)
        << ran.out;
    EXPECT_EQ(scratch_.read("h_n.exr"), baked({"h.asc", "--vertical-scale", "2"}));
    scratch_.write("h.prj", kFeet);
    EXPECT_EQ(run(scratch_, "build-normals", {"normals.toml"}).code, 0);
    EXPECT_EQ(scratch_.read("h_n.exr"), baked({"h.asc", "--vertical-scale", "2"}));
    // With a step after it, too.
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"*.asc\"\nname = \"{stem}_m.exr\"\nsteps = [ { bake = { "
                   "wrap = \"clamp\" } }, { scale = { scale = 1, format = \"float\" } } ]\n");
    const Ran steps = run(scratch_, "build-normals", {"normals.toml"});
    ASSERT_EQ(steps.code, 0) << steps.err;
    EXPECT_NE(steps.out.find("a texel"), std::string::npos) << steps.out;
}

// The functions on whole pictures and the command give the same bytes.
TEST_F(OnTheGround, VerbsInMemoryDoTheSame) {
    write_grid("h.asc", 1.0 / 240.0, 0, 0, 37, 41);
    scratch_.write("h.prj", kDegrees);
    const auto image = read_image(scratch_.path("h.asc"));
    ASSERT_TRUE(image && image->ground);
    HeightOptions options;
    options.wrap_x = options.wrap_y = Wrap::clamp;
    auto field = height_field(*image, options);
    ASSERT_TRUE(field);
    EXPECT_EQ(field->ground, image->ground);
    EXPECT_EQ(field->report.ground, image->ground);
    MipChain chain;
    chain.levels.push_back(std::move(*tex::bake(*field)));
    const auto packed = pack(chain, {Encoding::float_});
    ASSERT_TRUE(packed);
    ASSERT_TRUE(write_texture(scratch_.path("y.exr"), *packed));
    EXPECT_EQ(scratch_.read("y.exr"), baked({"h.asc"}));
}

}  // namespace
}  // namespace tex::cli
