// SPDX-License-Identifier: Apache-2.0
// preview-normals --mesh.

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"
#include "unit/gltf_files.h"

namespace tex::cli {

class PreviewNormalsMesh : public testing::Test {
protected:
    PreviewNormalsMesh() {
        scratch_.add_sample("hemisphere.png", "height.png");
        scratch_.write("sheet.obj", kSheetObj);
        EXPECT_EQ(shell(scratch_, "bake-normals height.png -o map.png --y up --no-sync").code, 0);
    }
    Ran preview(std::vector<std::string> arguments) {
        for (const char* more : {"--no-sync", "--quiet"}) arguments.emplace_back(more);
        return run(scratch_, "preview-normals", arguments);
    }
    // Expects one sentence that contains `part`, and no output.
    void refuses(const std::vector<std::string>& arguments, const std::string& part, int code) {
        const auto before = scratch_.list();
        const Ran ran = preview(arguments);
        EXPECT_EQ(ran.code, code) << part;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(ran.err.find('\n'), ran.err.size() - 1) << ran.err;
        EXPECT_EQ(scratch_.list(), before) << part;
    }
    Extent extent_of(const std::string& name) {
        const auto image = read_image(scratch_.path(name));
        EXPECT_TRUE(image) << name;
        return image ? image->extent() : Extent{};
    }
    Scratch scratch_;
};

TEST_F(PreviewNormalsMesh, ShowsEverythingThatHasAName) {
    for (const auto& row : kShowNames) {
        const std::string name = "show_" + std::string(row.name) + ".png";
        const Ran ran = preview({"map.png", "-o", name, "--mesh", "sheet.obj", "--show", std::string(row.name),
                                 "--height", "height.png", "--size", "40"});
        ASSERT_EQ(ran.code, 0) << row.name << ": " << ran.err;
        EXPECT_GE(extent_of(name).width, 40) << row.name;
    }
}

// Two squares in the same place, of which a node moves one to the right.
TEST_F(PreviewNormalsMesh, ShowsSeveralMeshesWhereTheirNodesPlaceThem) {
    GltfMaker maker;
    const int positions = maker.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126),
              normals = maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126),
              uvs = maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126),
              indices = maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
    const std::string square =
        fmt::format("{{\"attributes\":{{\"POSITION\":{},\"NORMAL\":{},\"TEXCOORD_0\":{}}},\"indices\":{}}}", positions,
                    normals, uvs, indices);
    scratch_.write("two.glb", maker.glb(square + "]},{\"name\":\"k\",\"primitives\":[" + square,
                                        ",\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0,\"name\":\"a\"},"
                                        "{\"mesh\":1,\"name\":\"b\",\"translation\":[1.5,0,0]}]"));
    ASSERT_EQ(preview({"map.png", "-o", "two.png", "--mesh", "two.glb", "--camera", "0,0", "--size", "60"}).code, 0);
    const auto picture = read_image(scratch_.path("two.png"));
    ASSERT_TRUE(picture);
    const auto green = [&](int i) { return picture->planes[1].at(i, 30); };
    EXPECT_EQ(green(30), green(0)) << "there is a gap between them";
    EXPECT_NE(green(14), green(0));
    EXPECT_NE(green(45), green(0));
}

TEST_F(PreviewNormalsMesh, ReportsWhereTangentsComeFromAndDependsOnTheMesh) {
    const Ran ran = preview({"map.png", "-o", "look.png", "--mesh", "sheet.obj", "--show", "lit,tangents,seams",
                             "--camera", "30,20", "--size", "50", "--json", "--depfile", "d"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto report = nlohmann::json::parse(ran.out);
    EXPECT_EQ(report["tangents"], "mikktspace");
    EXPECT_EQ(scratch_.read("d"), "look.png: \\\n  map.png \\\n  sheet.obj\n");
    EXPECT_EQ(extent_of("look.png").height, 50 + 18 + 14 + 16);  // with a key and a caption
}

TEST_F(PreviewNormalsMesh, DrawsOneMeshForManyMapsAndTurnsIt) {
    scratch_.write("second.png", scratch_.read("map.png"));
    ASSERT_EQ(preview({"map.png", "second.png", "--out-dir", "out", "--mesh", "sheet.obj", "--size", "24"}).code, 0);
    EXPECT_TRUE(scratch_.has("out/map.png"));
    EXPECT_TRUE(scratch_.has("out/second.png"));
    ASSERT_EQ(preview({"map.png", "-o", "turn.png", "--mesh", "sheet.obj", "--size", "24", "--turntable", "3"}).code,
              0);
    EXPECT_NE(scratch_.read("turn.png").find("acTL"), std::string::npos);
    const auto drawn = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"map.png", "-o", "x.png", "--mesh", "sheet.obj", "--size", "48"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(preview(arguments).code, 0);
        return scratch_.read("x.png");
    };
    const std::string straight = drawn({});
    EXPECT_EQ(drawn({"--camera", "30,20,30", "--decoder", "blender", "--threads", "3"}), straight);
    EXPECT_NE(drawn({"--decoder", "godot"}), straight);
    EXPECT_NE(drawn({"--camera", "0,0"}), straight);
}

TEST_F(PreviewNormalsMesh, RefusesWhatHasNoMeaning) {
    for (const std::string show : {"tangents", "uv", "lit,seams"})
        refuses({"map.png", "-o", "x.png", "--show", show}, "needs --mesh", 2);
    refuses({"map.png", "-o", "x.png", "--decoder", "unreal"}, "--decoder needs --mesh", 2);
    refuses({"map.png", "-o", "x.png", "--mesh", "sheet.obj", "--shape", "cube"}, "--shape has no meaning with --mesh",
            2);
    refuses({"map.png", "-o", "x.png", "--mesh", "sheet.obj", "--mirror"}, "--mirror has no meaning with --mesh", 2);
    for (const char* tile : {"t.1001.png", "t.1002.png"}) scratch_.write(tile, scratch_.read("map.png"));
    refuses({"t.<UDIM>.png", "-o", "x.png", "--mesh", "sheet.obj"}, "give --out-dir", 2);
    refuses({"map.png", "-o", "sheet.obj", "--container", "png", "--mesh", "sheet.obj"}, "sheet.obj", 2);
}

TEST_F(PreviewNormalsMesh, NamesTheMeshThatItCannotDraw) {
    refuses({"map.png", "-o", "x.png", "--mesh", "none.obj"}, "none.obj: no such file", 3);
    const std::vector<std::string> with = {"map.png", "map.png", "-o", "x.png", "--mesh", "bad.obj"};
    scratch_.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
    refuses(with, "bad.obj: ", 4);
    refuses(with, "UV", 4);
    scratch_.write("bad.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\n");
    refuses(with, "bad.obj: ", 4);
    scratch_.write("bad.obj", "");
    refuses(with, "bad.obj: ", 4);
    scratch_.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 40 0\nvt 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    std::vector<std::string> layout = with;
    layout.insert(layout.end(), {"--show", "uv"});
    refuses(layout, "bad.obj: a triangle of the mesh covers more than 16 repeats of the map", 4);
}

TEST_F(PreviewNormalsMesh, DrawsTrianglesWithoutAreaAndHugeCoordinates) {
    scratch_.write("thin.obj",
                   "v -1e38 0 0\nv 1e38 0 0\nv 0 1e38 0\nv 0 0 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
                   "f 1/1/1 2/2/1 3/3/1\nf 4/1/1 4/1/1 4/1/1\nf 1/1/1 2/2/1 4/3/1\n");
    EXPECT_EQ(preview({"map.png", "-o", "x.png", "--mesh", "thin.obj", "--size", "60", "--show",
                       "lit,tangents,uv,seams,world-normals"})
                  .code,
              0);
}

}  // namespace tex::cli
