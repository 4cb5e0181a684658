// SPDX-License-Identifier: Apache-2.0
// check-normals with glTF models among its inputs.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "unit/gltf_files.h"

namespace tex::cli {

class CheckNormalsModel : public testing::Test {
protected:
    CheckNormalsModel() { EXPECT_EQ(shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/broken/N80*.glb .").code, 0); }
    Scratch scratch_;
};

TEST_F(CheckNormalsModel, FindingsNameModelMaterialAndImage) {
    const Ran ran = shell(scratch_, "check-normals N802-used-as-color.glb");
    EXPECT_EQ(ran.code, 1);
    EXPECT_NE(ran.out.find("N802-used-as-color.glb: stone: normals: error N802 used-as-color: The image is used as a "
                           "colour, too: it is also the baseColorTexture of stone\n"),
              std::string::npos)
        << ran.out;
    EXPECT_NE(ran.out.find("\n1 file: 1 error, 0 warnings, 0 notes\n"), std::string::npos) << ran.out;
}

// The first line of a map says them in full.
TEST_F(CheckNormalsModel, LongNamesAreSaidOnce) {
    const std::string file = scratch_.read("N805-double-sided-tangents.glb");
    std::uint32_t size = 0;
    std::memcpy(&size, file.data() + 12, 4);
    auto model = nlohmann::json::parse(file.substr(20, size));
    const std::string cut = "Material of a scan, \xC3\xBC\xC3\xBC", name = cut + std::string(60, 'x');
    model["materials"][0]["name"] = name;
    scratch_.write("long.glb", GltfMaker::glb_of(model.dump(), file.substr(28 + size)));
    const Ran ran = shell(scratch_, "check-normals long.glb");
    const std::vector<std::string> lines = lines_of(ran.out);
    ASSERT_GE(lines.size(), 3u) << ran.out;
    EXPECT_TRUE(lines[0].starts_with("long.glb: " + name + ": normals: ")) << ran.out;
    EXPECT_EQ(ran.out.find(name, name.size()), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("\nlong.glb: " + cut + "...: "), std::string::npos) << ran.out;
}

TEST_F(CheckNormalsModel, ModelsAndMapsGoTogether) {
    ASSERT_EQ(shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/broken/N402-mixed-y.png .").code, 0);
    const Ran ran = shell(scratch_, "check-normals --json '*.glb' N402-mixed-y.png");
    EXPECT_EQ(ran.code, 1);
    const std::vector<std::string> lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), 9u);
    const auto first = nlohmann::json::parse(lines[0]);
    EXPECT_EQ(first["maps"].size(), 1u);
    EXPECT_EQ(first["maps"][0]["material"], "stone");
    EXPECT_EQ(first["maps"][0]["slot"], "normal");
    EXPECT_EQ(first["maps"][0]["image"], "normals");
    EXPECT_EQ(first["maps"][0]["format"], "bc5-unorm");
    EXPECT_EQ(first["findings"][0]["id"], "N801");
    EXPECT_EQ(first["findings"][0]["map"], "stone: normals");
    EXPECT_EQ(nlohmann::json::parse(lines[8])["findings"][0]["id"], "N402");
}

TEST_F(CheckNormalsModel, DocumentsNameTheMaps) {
    const Ran ran =
        shell(scratch_,
              "check-normals N80*.glb --sarif a.sarif --junit a.xml --report a.html --baseline-write b.json "
              "--depfile a.d");
    EXPECT_EQ(ran.code, 0) << ran.err;
    const auto sarif = nlohmann::json::parse(scratch_.read("a.sarif"));
    const auto& results = sarif["runs"][0]["results"];
    ASSERT_EQ(results.size(), 10u);
    EXPECT_EQ(results[0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"],
              "N801-two-channel-in-model.glb");
    EXPECT_EQ(results[0]["locations"][0]["logicalLocations"][0]["name"], "stone: normals");
    EXPECT_NE(scratch_.read("a.xml").find("name=\"N803-uv-set-missing.glb: stone: normals\""), std::string::npos);
    const std::string page = scratch_.read("a.html");
    EXPECT_NE(page.find("N805-double-sided-tangents.glb: stone: normals"), std::string::npos);
    const Ran again = shell(scratch_, "check-normals N80*.glb --baseline b.json");
    EXPECT_EQ(again.code, 0);
    EXPECT_NE(again.out.find("8 files: 0 errors, 0 warnings, 0 notes; 10 known and accepted"), std::string::npos)
        << again.out;
}

TEST_F(CheckNormalsModel, OptionsAreForModelsToo) {
    EXPECT_EQ(shell(scratch_, "check-normals N804*.glb --material stone --decoder three --tangents mikktspace").code,
              0);
    const Ran none = shell(scratch_, "check-normals N804*.glb --material glass");
    EXPECT_EQ(none.code, 4);
    EXPECT_NE(none.err.find("has no material \"glass\""), std::string::npos) << none.err;
    const Ran mesh = shell(scratch_, "check-normals N804*.glb --mesh N804*.glb");
    EXPECT_EQ(mesh.code, 2);
    EXPECT_NE(mesh.err.find("is a model with meshes of its own"), std::string::npos) << mesh.err;
    ASSERT_EQ(shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/broken/N402-mixed-y.png .").code, 0);
    const Ran idle = shell(scratch_, "check-normals N402-mixed-y.png --material stone");
    EXPECT_EQ(idle.code, 2);
    EXPECT_NE(idle.err.find("--material needs --mesh, or a model"), std::string::npos) << idle.err;
}

TEST_F(CheckNormalsModel, DamagedModelsAndThoseWithoutMapsAreSaid) {
    scratch_.write("bad.glb", "glTF\2\0\0\0");
    scratch_.write("empty.gltf", R"({"asset":{"version":"2.0"}})");
    const Ran ran = shell(scratch_, "check-normals bad.glb empty.gltf");
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.out.find("bad.glb: error N101"), std::string::npos) << ran.out;
    ASSERT_EQ(shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/crate_high.glb .").code, 0);
    const Ran none = shell(scratch_, "check-normals crate_high.glb");
    EXPECT_EQ(none.code, 0);
    EXPECT_NE(none.out.find("crate_high.glb: no material uses a normal map\n"), std::string::npos) << none.out;
}

}  // namespace tex::cli
