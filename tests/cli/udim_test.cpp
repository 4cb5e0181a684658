// SPDX-License-Identifier: Apache-2.0
// UDIM tiles: <UDIM> in the names of inputs and of -o, and the triangles in a tile.

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

// Two quads: one in tile 1001 whose normal is z, one in tile 1012 (u = 1, v = 1) whose normal is x.
constexpr const char* kTwoTilesObj = R"(o tiles
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 -1
v 0 1 -1
vn 0 0 1
vn 1 0 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vt 2 1
vt 2 2
vt 1 2
f 1/1/1 2/2/1 3/3/1 4/4/1
f 1/3/2 5/5/2 6/6/2 4/7/2
)";

class Udim : public testing::Test {
protected:
    Udim() {
        scratch_.write("tiles.obj", kTwoTilesObj);
        scratch_.add_sample("waves.png", "h.png");
        for (const char* name : {"n.1001.png", "n.1012.png"})
            EXPECT_EQ(go("bake-normals", {"h.png", "-o", name, "--bumpiness", "0"}).code, 0);
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    // The middle of a map.
    Float3 middle(const std::string& name) {
        SourceOptions options;
        const auto texture = read_texture(scratch_.path(name));
        if (!texture) return {};
        const auto chain = unpack(*texture);
        if (!chain) return {};
        const NormalMap& map = chain->levels.front();
        const int i = map.extent().width / 2, j = map.extent().height / 2;
        return {map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)};
    }
    Scratch scratch_;
};

TEST_F(Udim, EachTileHasItsOwnTriangles) {
    const Ran ran =
        go("convert-normals", {"n.<UDIM>.png", "-o", "o.<UDIM>.exr", "--mesh", "tiles.obj", "--to", "object"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    EXPECT_NEAR(middle("o.1001.exr").z, 1.0f, 0.02f);
    EXPECT_NEAR(middle("o.1012.exr").x, 1.0f, 0.02f);
    // Without the mark, tiles lie on top of each other.
    const Ran plain = go("convert-normals", {"n.1001.png", "-o", "p.exr", "--mesh", "tiles.obj", "--to", "object"});
    EXPECT_EQ(plain.err, "") << "the tile from 0 to 1 decides";
    EXPECT_NEAR(middle("p.exr").z, 1.0f, 0.02f);
}

TEST_F(Udim, NamesStandForTheFilesThatExist) {
    scratch_.write("n.1003.png.txt", "");
    scratch_.write("n.999.png", "");
    scratch_.write("n.1000.png", "");
    const Ran baked = go("pack-normals", {"n.<UDIM>.png", "--out-dir", "out", "--format", "bc5"});
    EXPECT_EQ(baked.code, 0) << baked.err;
    EXPECT_EQ(scratch_.has("out/n.1001.dds") && scratch_.has("out/n.1012.dds"), true);
    // In the order of their numbers, whatever the order of the folder is.
    for (const char* name : {"n.1011.png", "n.1002.png", "n.1021.png"})
        EXPECT_EQ(go("bake-normals", {"h.png", "-o", name, "--bumpiness", "0"}).code, 0);
    const Ran all = go("pack-normals", {"n.<UDIM>.png", "--out-dir", "out", "--format", "bc5", "--json"});
    std::vector<std::string> inputs;
    for (const std::string& line : lines_of(all.out)) {
        const std::size_t at = line.find("n.1");
        if (at != std::string::npos) inputs.push_back(line.substr(at, 6));
    }
    EXPECT_EQ(inputs, (std::vector<std::string>{"n.1001", "n.1002", "n.1011", "n.1012", "n.1021"}));
    for (const char* name : {"n.1011.png", "n.1002.png", "n.1021.png"}) std::filesystem::remove(scratch_.path(name));
    // Names that are shorter than what comes before the number.
    EXPECT_EQ(go("pack-normals", {"a-name-longer-than-others.<UDIM>.png", "--out-dir", "out"}).code, 3);
    const Ran checked = run(scratch_, "check-normals", {"n.<UDIM>.png", "--mesh", "tiles.obj"});
    EXPECT_NE(checked.out.find("n.1012.png"), std::string::npos) << checked.out;
    EXPECT_EQ(checked.out.find("N723"), std::string::npos) << checked.out;  // charts-overlap
}

TEST_F(Udim, MistakesAreExplained) {
    const auto refuses = [&](std::vector<std::string> arguments, int code, const std::string& part) {
        const auto before = scratch_.list();
        const Ran ran = go("pack-normals", std::move(arguments));
        EXPECT_EQ(ran.code, code) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before);
    };
    refuses({"x.<UDIM>.png", "--out-dir", "out"}, 3,
            "x.<UDIM>.png: no file has this name with the number of a UDIM tile");
    refuses({"x/n.<UDIM>.png", "--out-dir", "out"}, 3, "x: cannot be read: no such file or directory");
    refuses({"<UDIM>/n.png", "--out-dir", "out"}, 2, "in the name of a file, not of a folder");
    refuses({"n.<UDIM>.png", "-o", "o.png"}, 2, "-o takes one input");
    refuses({"n.1001.png", "-o", "o.<UDIM>.png"}, 2, "needs <UDIM> in the input");
    EXPECT_EQ(go("bake-normals", {"h.png", "-o", "n.1002.png", "--bumpiness", "0"}).code, 0);
    const Ran ran =
        go("convert-normals", {"n.<UDIM>.png", "-o", "o.<UDIM>.exr", "--mesh", "tiles.obj", "--to", "object"});
    EXPECT_EQ(ran.code, 4) << ran.err;
    EXPECT_NE(ran.err.find("tiles.obj: has no triangle in UDIM tile 1002"), std::string::npos) << ran.err;
    EXPECT_TRUE(scratch_.has("o.1012.exr"));  // a failure does not stop the others
}

}  // namespace
}  // namespace tex::cli
