// SPDX-License-Identifier: Apache-2.0
// bake-normals --tiles: the tiles of a terrain, which a pattern names.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/program.h"
#include "cli/usage_error.h"
#include "tasks/grid.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kSide = 16, kTiles = 3;

class Tiles : public testing::Test {
protected:
    // Raw heights: a part of the terrain, which is kTiles * kSide texels wide and high.
    void write_part(const std::string& name, int left, int top, int side) const {
        std::string bytes;
        for (int j = top; j < top + side; ++j) {
            for (int i = left; i < left + side; ++i) {
                const int height = (i * i * 37 + j * j * 91 + i * j * 53) % 65536;
                bytes += static_cast<char>(height & 0xff);
                bytes += static_cast<char>(height >> 8);
            }
        }
        scratch_.write(name, bytes);
    }
    // `name`: of the tile in column x and row y from the top.
    template <class Name>
    void write_tiles(const Name& name) const {
        for (int y = 0; y < kTiles; ++y) {
            for (int x = 0; x < kTiles; ++x) write_part(name(x, y), kSide * x, kSide * y, kSide);
        }
        write_part("whole.r16", 0, 0, kSide * kTiles);
    }
    [[nodiscard]] Ran bake(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(),
                         {"--format", "float", "--bumpiness", "9", "--wrap", "clamp", "--kernel", "sobel5"});
        return run(scratch_, "bake-normals", arguments);
    }
    void expect_part(const std::string& tile, const Image& whole, int x, int y) const {
        const auto image = read_image(scratch_.path(tile));
        ASSERT_TRUE(image) << image.error().message();
        ASSERT_EQ(image->extent(), (Extent{kSide, kSide}));
        for (std::size_t c = 0; c < 3; ++c) {
            for (int j = 0; j < kSide; ++j)
                ASSERT_EQ(std::memcmp(image->planes[c].row(j), whole.planes[c].row(kSide * y + j) + kSide * x,
                                      kSide * sizeof(float)),
                          0)
                    << tile << " row " << j;
        }
    }
    [[nodiscard]] Image whole() const {
        const Ran ran = bake({"whole.r16", "-o", "whole.exr"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        return std::move(*read_image(scratch_.path("whole.exr")));
    }

    const Scratch scratch_;
};

TEST_F(Tiles, HaveTheBytesOfTheWhole) {
    write_tiles([](int x, int y) { return fmt::format("h_{:02}_{}.r16", x, y); });
    const Ran ran = bake({"h_{x}_{y}.r16", "--tiles", "-o", "n_{y}_{x}.exr", "--depfile", "d", "--threads", "2"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Image expected = whole();
    for (int y = 0; y < kTiles; ++y) {
        for (int x = 0; x < kTiles; ++x) expect_part(fmt::format("n_{}_{:02}.exr", y, x), expected, x, y);
    }
    const std::string depfile = scratch_.read("d");
    const std::size_t corner = depfile.find("n_0_00.exr:");
    ASSERT_NE(corner, std::string::npos) << depfile;
    const std::string rule = depfile.substr(corner, depfile.find("n_0_01.exr:") - corner);
    EXPECT_NE(rule.find("h_01_1.r16"), std::string::npos) << rule;
    EXPECT_EQ(rule.find("h_02_0.r16"), std::string::npos) << rule;
}

TEST_F(Tiles, InFoldersAndFromTheBottom) {
    for (const int x : {-1, 0, 1}) std::filesystem::create_directory(scratch_.path(fmt::format("{}", x)));
    write_tiles([](int x, int y) { return fmt::format("{}/{}.r16", x - 1, 5 - y); });
    const Ran ran =
        bake({"{x}/{y}.r16", "--tiles", "--tile-y", "up", "--out-dir", "out", "--name", "{dir}/{stem}.exr"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const Image expected = whole();
    for (int y = 0; y < kTiles; ++y) {
        for (int x = 0; x < kTiles; ++x) expect_part(fmt::format("out/{}/{}.exr", x - 1, 5 - y), expected, x, y);
    }
}

TEST_F(Tiles, AnAbsolutePatternIsOne) {
    write_tiles([](int x, int y) { return fmt::format("h_{}_{}.r16", x, y); });
    const Ran ran = bake({scratch_.path("h_{x}_{y}.r16"), "--tiles", "-o", scratch_.path("n_{x}_{y}.exr")});
    ASSERT_EQ(ran.code, 0) << ran.err;
    expect_part("n_1_1.exr", whole(), 1, 1);
}

TEST_F(Tiles, WrongOptionsAreRefused) {
    write_tiles([](int x, int y) { return fmt::format("h_{}_{}.r16", x, y); });
    const auto refuses = [&](const std::vector<std::string>& arguments, const std::string& reason) {
        const Ran ran = run(scratch_, "bake-normals", arguments);
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    };
    refuses({"h_0_0.r16", "--tiles", "-o", "n.exr"}, "--tiles needs {x} and {y} in the name of the input");
    refuses({"h_{x}_{y}.r16", "--tiles", "-o", "n.exr"}, "-o takes one input, 9 are given");
    refuses({"h_{x}{y}.r16", "--tiles", "-o", "n_{x}_{y}.exr"}, "something must stand between {x} and {y}");
    refuses({"h_{x}_{y}.r16", "--tiles", "-o", "n_{x}_{y}.exr", "--deband", "on"}, "--tiles contradicts --deband");
    refuses({"h_{x}_{y}.r16", "--tiles", "-o", "n_{x}_{y}.exr", "--bumpiness", "auto"}, "--tiles contradicts");
    refuses({"whole.r16", "--tile-y", "up", "-o", "n.exr"}, "--tile-y has no effect without --tiles");
    write_part("h_01_0.r16", 0, 0, kSide);
    refuses({"h_{x}_{y}.r16", "--tiles", "-o", "n_{x}_{y}.exr"}, "are the same tile");
    const Ran none = run(scratch_, "bake-normals", {"g_{x}_{y}.r16", "--tiles", "-o", "n_{x}_{y}.exr"});
    EXPECT_EQ(none.code, 3);
    EXPECT_NE(none.err.find("no file has this name with numbers for {x} and {y}"), std::string::npos) << none.err;
}

// Sides that are powers of two: no texel of a smaller level reaches beyond its tile.
TEST_F(Tiles, SmallerLevelsHaveTheBytesOfTheWholeToo) {
    write_tiles([](int x, int y) { return fmt::format("h_{}_{}.r16", x, y); });
    ASSERT_EQ(bake({"h_{x}_{y}.r16", "--tiles", "-o", "n_{x}_{y}.ktx2"}).code, 0);
    ASSERT_EQ(bake({"whole.r16", "-o", "whole.ktx2"}).code, 0);
    const auto whole = read_texture(scratch_.path("whole.ktx2")), tile = read_texture(scratch_.path("n_1_2.ktx2"));
    ASSERT_TRUE(whole && tile);
    for (int level = 0; level < 5; ++level) {
        const auto of_whole = decode(*whole, level), of_tile = decode(*tile, level);
        ASSERT_TRUE(of_whole && of_tile);
        const int side = kSide >> level;
        ASSERT_EQ(of_tile->extent(), (Extent{side, side}));
        for (int j = 0; j < side; ++j)
            EXPECT_EQ(std::memcmp(of_tile->planes[0].row(j), of_whole->planes[0].row(2 * side + j) + side,
                                  static_cast<std::size_t>(side) * sizeof(float)),
                      0)
                << level;
    }
}

// Hills of 16 texels, so that horizons lie in other tiles. With the distance, no tile has to see farther than its
// neighbours.
TEST_F(Tiles, OcclusionSeesTheTilesAround) {
    const auto write = [&](const std::string& name, int left, int top, int side) {
        std::string bytes;
        for (int j = top; j < top + side; ++j) {
            for (int i = left; i < left + side; ++i) {
                const auto height =
                    static_cast<int>(20000.0 + 9000.0 * std::sin(0.4 * i) * std::cos(0.31 * j + 0.1 * i));
                bytes += static_cast<char>(height & 0xff);
                bytes += static_cast<char>(height >> 8);
            }
        }
        scratch_.write(name, bytes);
    };
    for (int y = 0; y < kTiles; ++y) {
        for (int x = 0; x < kTiles; ++x) write(fmt::format("h_{}_{}.r16", x, y), kSide * x, kSide * y, kSide);
    }
    write("whole.r16", 0, 0, kSide * kTiles);
    const auto with = [](std::vector<std::string> arguments, const char* distance) {
        arguments.insert(arguments.end(), {"--occlusion-out", "{stem}_ao.exr", "--bent-out", "{stem}_b.exr",
                                           "--horizon-out", "{stem}_hor.exr", "--occlusion-distance", distance});
        return arguments;
    };
    const Ran ran = bake(with({"h_{x}_{y}.r16", "--tiles", "-o", "n_{x}_{y}.exr", "--threads", "2"}, "12"));
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err.find("farther away"), std::string::npos) << ran.err;
    const Ran all = bake({"whole.r16", "-o", "whole.exr", "--occlusion-out", "whole_ao.exr", "--bent-out",
                          "whole_b.exr", "--horizon-out", "whole_hor.exr", "--occlusion-distance", "12"});
    ASSERT_EQ(all.code, 0) << all.err;
    const auto plane = [&](const std::string& name) { return std::move(read_image(scratch_.path(name))->planes[0]); };
    const Plane<float> whole_ao = plane("whole_ao.exr"), whole_bent = plane("whole_b.exr"),
                       whole_horizons = plane("whole_hor.exr");
    double sum = 0.0, bent_sum = 0.0, largest = 0.0, horizon_sum = 0.0;
    for (int y = 0; y < kTiles; ++y) {
        for (int x = 0; x < kTiles; ++x) {
            const Plane<float> ao = plane(fmt::format("h_{}_{}_ao.exr", x, y)),
                               bent = plane(fmt::format("h_{}_{}_b.exr", x, y)),
                               horizons = plane(fmt::format("h_{}_{}_hor.exr", x, y));
            ASSERT_EQ(ao.extent(), (Extent{kSide, kSide}));
            ASSERT_EQ(horizons.extent(), (Extent{kSide, 8 * kSide}));
            for (int j = 0; j < kSide; ++j) {
                for (int i = 0; i < kSide; ++i) {
                    const int column = kSide * x + i, row = kSide * y + j;
                    const double gap = std::abs(ao.at(i, j) - whole_ao.at(column, row));
                    sum += gap;
                    largest = std::max(largest, gap);
                    bent_sum += std::abs(bent.at(i, j) - whole_bent.at(column, row));
                    const int slice = 3;  // up and to the left
                    horizon_sum += std::abs(horizons.at(i, slice * kSide + j) -
                                            whole_horizons.at(column, slice * kSide * kTiles + row));
                }
            }
        }
    }
    constexpr double kTexels = kSide * kSide * kTiles * kTiles;
    EXPECT_LT(sum / kTexels, 0.003);  // lines lie differently between the texels
    EXPECT_LT(largest, 0.03);
    EXPECT_LT(bent_sum / kTexels, 0.01);
    EXPECT_LT(horizon_sum / kTexels, 0.01);
    // Without a distance, everything counts, and the tiles around one are all that it sees.
    const Ran far = bake(with({"h_{x}_{y}.r16", "--tiles", "-o", "f_{x}_{y}.exr", "--json"}, "0"));
    ASSERT_EQ(far.code, 0) << far.err;
    EXPECT_NE(far.err.find("occlusion is that of 16 texels around the tile"), std::string::npos) << far.err;
    EXPECT_NE(far.out.find("\"occlusion_reach\":16"), std::string::npos) << far.out;
}

// A rule of a manifest whose inputs are tiles; `more` are further steps.
std::string manifest_of(const std::string& match, const std::string& tiles, const std::string& more = "") {
    return fmt::format(
        "version = 1\n[[rule]]\nmatch = \"{}\"\nname = \"out/{{stem}}_n.exr\"\nsteps = [ {{ bake = {{ bumpiness = 9, "
        "kernel = \"sobel5\", wrap = \"clamp\"{} }} }}{} ]\noutputs = [ {{ format = \"float\" }} ]\n",
        match, tiles, more);
}

TEST_F(Tiles, AManifestMakesWhatTheCommandMakes) {
    fs::create_directory(scratch_.path("land"));
    write_tiles([](int x, int y) { return fmt::format("land/h_{}_{}.r16", x, y); });
    scratch_.write("land/h_old_1.r16", "no tile");
    scratch_.write("normals.toml", manifest_of("land/h_{x}_{y}.r16", ", tiles = true"));
    const auto build = [&] { return run(scratch_, "build-normals", {"--no-sync"}); };
    const Ran ran = build();
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(ran.out.ends_with("9 made, 0 up to date\n")) << ran.out;
    const Image expected = whole();
    for (int y = 0; y < kTiles; ++y) {
        for (int x = 0; x < kTiles; ++x) expect_part(fmt::format("out/h_{}_{}_n.exr", x, y), expected, x, y);
    }
    EXPECT_TRUE(build().out.ends_with("0 made, 9 up to date\n"));
    // The tiles around a tile are made again with it, and those around one that is new.
    write_part("land/h_0_0.r16", 5, 7, kSide);
    EXPECT_TRUE(build().out.ends_with("4 made, 5 up to date\n"));
    write_part("land/h_3_1.r16", 1, 2, kSide);
    EXPECT_TRUE(build().out.ends_with("4 made, 6 up to date\n"));
    // The command that --explain prints makes the same.
    const Ran explained = run(scratch_, "build-normals", {"--explain", "land/h_0_0.r16"});
    EXPECT_NE(explained.out.find("reads land/h_1_1.r16"), std::string::npos) << explained.out;
    const std::size_t at = explained.out.rfind("bake-normals ");
    ASSERT_NE(at, std::string::npos) << explained.out;
    const std::string made = scratch_.read("out/h_2_2_n.exr");
    fs::remove(scratch_.path("out/h_2_2_n.exr"));
    const Ran byhand = shell(scratch_, explained.out.substr(at, explained.out.find('\n', at) - at));
    EXPECT_EQ(byhand.code, 0) << byhand.err;
    EXPECT_TRUE(scratch_.read("out/h_2_2_n.exr") == made);
}

TEST_F(Tiles, AManifestRefusesWhatCannotBe) {
    write_part("h_0_0.r16", 0, 0, kSide);
    const auto fails = [&](const std::string& manifest, const std::string& reason) {
        scratch_.write("normals.toml", manifest);
        const Ran ran = run(scratch_, "build-normals", {});
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    };
    fails(manifest_of("h_*.r16", ", tiles = true"), "tiles needs {x} and {y} in match");
    fails(manifest_of("h_{x}_{y}.r16", ""), "{x} and {y} in match need bake = { tiles = true }");
    fails(manifest_of("**/h_{x}_{y}.r16", ", tiles = true"), "has no other wildcards");
    fails(manifest_of("h_{x}{y}.r16", ", tiles = true"), "something must stand between {x} and {y}");
    fails(manifest_of("h_{x}_{y}.r16", ", tiles = true", ", { mip = {} }"), "tiles are baked without other steps");
}

}  // namespace
}  // namespace tex::cli
