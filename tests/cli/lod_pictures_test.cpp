// SPDX-License-Identifier: Apache-2.0
// transfer-normals where the low mesh is a model that has a normal map, and pictures are what it writes.

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/program.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

// A square with a material.
std::string square(const std::string& material, const std::string& more) {
    GltfMaker maker;
    maker.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126);
    maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
    maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
    return maker.glb(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0})",
                     R"(,"materials":[)" + material + "]" + more);
}

}  // namespace

TEST(LodPictures, TheCommandThatWritesTheModelIsNamed) {
    const Scratch scratch;
    scratch.write("bare.glb", square(R"({"name":"Skin"})", ""));
    scratch.write("lod.glb", square(R"({"name":"Skin","normalTexture":{"index":0}})",
                                    R"(,"textures":[{"source":0}],"images":[{"uri":"n.png"}])"));
    ASSERT_EQ(shell(scratch, "convert -size 16x16 'xc:rgb(128,128,255)' n.png").code, 0);
    const std::string base = " --high bare.glb --out-dir out --extent 16";
    const auto go = [&](const std::string& arguments) {
        Ran ran = shell(scratch, "transfer-normals " + arguments);
        EXPECT_EQ(ran.code, 0) << arguments << ": " << ran.err;
        return ran.err;
    };
    const std::string noted = go("lod.glb" + base);
    EXPECT_NE(noted.find("lod.glb: has a normal map, and its new map is written as a picture; --name '{stem}.glb' "
                         "writes the model itself (--container dds silences this warning)"),
              std::string::npos)
        << noted;
    // What it says is true.
    EXPECT_EQ(go("lod.glb" + base + " --container dds"), "");
    EXPECT_EQ(go("lod.glb" + base + " --name '{stem}.glb'"), "");
    const auto model = read_model(scratch.path("out/lod.glb"));
    ASSERT_TRUE(model);
    EXPECT_EQ(read_map(*model, model->maps.at(0))->extent(), (Extent{16, 16}));
    // Whoever names pictures wants them, and a mesh without a map gets one that is no part of it.
    EXPECT_EQ(go("lod.glb" + base + " --name '{stem}_n.png'"), "");
    EXPECT_EQ(go("lod.glb bare.glb -o n.png --extent 16"), "");
    EXPECT_EQ(go("bare.glb" + base), "");
}

// Viewers draw the map of a model with green up, wherever it points; what a bake makes must look like it.
TEST(LodPictures, TheMapOfTheHighModelIsReadAsViewersDrawIt) {
    const Scratch scratch;
    scratch.add_sample("bricks.png", "bricks.png");
    scratch.write("low.glb", square(R"({"name":"Skin"})", ""));
    scratch.write("high.glb", square(R"({"name":"Skin","normalTexture":{"index":0}})",
                                     R"(,"textures":[{"source":0}],"images":[{"uri":"n.png"}])"));
    const auto go = [&](const std::string& script) {
        Ran ran = shell(scratch, script);
        EXPECT_EQ(ran.code, 0) << script << ": " << ran.err;
        return ran.err;
    };
    go("bake-normals bricks.png -o n.png --bumpiness 3 --y down");
    const std::string bake = "transfer-normals low.glb high.glb -o baked.png --extent 512 --high-normals own";
    const std::string said = go(bake);
    EXPECT_NE(
        said.find("green is taken to point up, as viewers draw this normal map, but its texels show that it points "
                  "down; --high-y down bakes what they show"),
        std::string::npos)
        << said;
    EXPECT_EQ(go("compare-normals n.png baked.png --y-a up --y-b up --max-mean 1"), "");
    EXPECT_EQ(go(bake + " --high-y down"), "");
    EXPECT_EQ(go("compare-normals n.png baked.png --y-a down --y-b up --max-mean 1"), "");
}

}  // namespace tex::cli
