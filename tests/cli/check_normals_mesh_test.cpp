// SPDX-License-Identifier: Apache-2.0
// check-normals --mesh.

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {

class CheckNormalsMesh : public testing::Test {
protected:
    CheckNormalsMesh() {
        EXPECT_EQ(shell(scratch_, "cp -r " TEX_SOURCE_DIR "/samples/broken/. .").code, 0);
        scratch_.write("sheet.obj", kSheetObj);
    }
    Scratch scratch_;
};

TEST_F(CheckNormalsMesh, PrintsSeamsAndTheSpaceThatFits) {
    const Ran ran = shell(scratch_, "check-normals --mesh meshes/N711.glb N711-other-tangent-space.png");
    EXPECT_EQ(ran.code, 1) << ran.out;
    EXPECT_NE(ran.out.find("green points down, or w of the tangents is flipped (12 seam edges: "), std::string::npos)
        << ran.out;
    EXPECT_NE(ran.out.find("N711-other-tangent-space.png: seams: visible: 12 edges of the mesh, mean "),
              std::string::npos)
        << ran.out;
    const Ran down = shell(
        scratch_,
        "check-normals --json --disable N304 --decoder unreal --mesh meshes/N711.glb N711-other-tangent-space.png");
    EXPECT_EQ(down.code, 0) << down.out;
    const auto report = nlohmann::json::parse(down.out);
    EXPECT_EQ(report["findings"].size(), 0u);
    EXPECT_EQ(report["seams"]["edges"], 12);
    EXPECT_LT(report["seams"]["mean"], 3.0);
}

TEST_F(CheckNormalsMesh, TangentsOfAnotherSourceAreNotTheFileS) {
    const std::string name = " N706-tangent-sign-opposite.png";
    EXPECT_EQ(shell(scratch_, "check-normals --mesh meshes/N706.glb" + name).code, 1);
    EXPECT_EQ(shell(scratch_, "check-normals --mesh meshes/N706.glb --tangents mikktspace" + name).code, 0);
}

TEST_F(CheckNormalsMesh, ReadsMeshesWithoutNormalMap) {
    const Ran ran = shell(scratch_, "check-normals --mesh sheet.obj N706-tangent-sign-opposite.png");
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(ran.out, "1 file: 0 errors, 0 warnings, 0 notes\n");
}

TEST_F(CheckNormalsMesh, NamesTheMeshThatCannotBeReadOnce) {
    scratch_.write("cut.glb", scratch_.read("meshes/N706.glb").substr(0, 200));
    const Ran cut = shell(scratch_, "check-normals --mesh cut.glb N701*.png N702*.png");
    EXPECT_EQ(cut.code, 4);
    EXPECT_EQ(cut.err.find("check-normals: error: cut.glb: "), 0u) << cut.err;
    EXPECT_EQ(cut.err.find('\n'), cut.err.size() - 1) << cut.err;
    const Ran missing = shell(scratch_, "check-normals --mesh none.glb N701*.png");
    EXPECT_EQ(missing.code, 3);
    EXPECT_NE(missing.err.find("none.glb: no such file"), std::string::npos) << missing.err;
}

TEST_F(CheckNormalsMesh, DocumentsNameTheMeshAndNeverReplaceIt) {
    const std::string command = "check-normals --mesh meshes/N706.glb --tangents mikktspace N706*.png ";
    EXPECT_EQ(shell(scratch_, command + "--report page.html --depfile page.d").code, 0);
    EXPECT_NE(scratch_.read("page.d").find("meshes/N706.glb"), std::string::npos);
    // The page shows how to see the map on the mesh with preview-normals, with every choice of the command line.
    EXPECT_EQ(shell(scratch_, command + "--uv-set 0 --primitive 0 --material 0 --report parts.html").code, 0);
    EXPECT_NE(scratch_.read("parts.html")
                  .find("--mesh meshes/N706.glb --material 0 --primitive 0 --uv-set 0 --tangents mikktspace"),
              std::string::npos);
    const std::string mesh = scratch_.read("meshes/N706.glb");
    EXPECT_EQ(shell(scratch_, command + "--sarif meshes/N706.glb").code, 2);
    EXPECT_EQ(scratch_.read("meshes/N706.glb"), mesh);
}

TEST_F(CheckNormalsMesh, RefusesMeshOptionsWithoutAMesh) {
    for (const char* option : {"--material 0", "--decoder unreal", "--tangents file", "--uv-set 0", "--node a"}) {
        const Ran ran = shell(scratch_, std::string("check-normals N701*.png ") + option);
        EXPECT_EQ(ran.code, 2) << option;
        EXPECT_NE(ran.err.find(" needs --mesh"), std::string::npos) << ran.err;
    }
    EXPECT_EQ(shell(scratch_, "check-normals --mesh - N701*.png").code, 2);
    EXPECT_EQ(shell(scratch_, "check-normals --mesh a.glb --list").code, 2);
}

}  // namespace tex::cli
