// SPDX-License-Identifier: Apache-2.0

#include <map>
#include <string>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class ScaleNormals : public testing::Test {
protected:
    ScaleNormals() { scratch_.add_sample("waves.png", "waves.png"); }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    NormalMap map_of(const std::string& name) {
        auto texture = read_texture(scratch_.path(name));
        EXPECT_TRUE(texture);
        auto chain = unpack(*texture);
        EXPECT_TRUE(chain);
        return std::move(chain->levels.front());
    }
    Scratch scratch_;
};

TEST_F(ScaleNormals, ScalingABakeIsBakingWithScaledBumpiness) {
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.exr", "--bumpiness", "4", "--format", "float"}).code, 0);
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "strong.exr", "--bumpiness", "10", "--format", "float"}).code, 0);
    ASSERT_EQ(go("scale-normals", {"n.exr", "-o", "scaled.exr", "--scale", "2.5"}).code, 0);
    const auto error = compare(map_of("strong.exr"), map_of("scaled.exr"));
    ASSERT_TRUE(error);
    EXPECT_LT(error->error.max, 1e-4);
}

TEST_F(ScaleNormals, KindEncodingAndLevelsStay) {
    const auto report = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--scale", "-1", "--json"});
        const Ran ran = go("scale-normals", arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return nlohmann::json::parse(ran.out);
    };
    for (const auto& [encoding, kept] :
         std::map<std::string, std::string>{{"dxt5nm", "dxt5nm"},
                                            {"bc5", "bc5"},
                                            {"bc5-snorm", "bc5-snorm"},
                                            {"rgb8", "rgb8"},
                                            {"rg8", "rg8"},
                                            {"rg16", "rg16"},
                                            {"half", "rgba16f"},
                                            {"float", "rgba32f"}}) {  // DDS has no floats without alpha
        ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.dds", "--bumpiness", "4", "--format", encoding}).code, 0);
        EXPECT_EQ(report({"n.dds", "-o", "x.dds"})["format"], kept);
        EXPECT_EQ(report({"n.dds", "-o", "x.dds"})["levels"], 8);
    }
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "4", "--format", "rgb16"}).code, 0);
    EXPECT_EQ(report({"n.png", "--out-dir", "out"})["output"], "out/n.png");
    EXPECT_EQ(report({"n.png", "-o", "x.png"})["format"], "rgb16");
    EXPECT_EQ(report({"n.png", "-o", "x.dds"})["format"], "dxt5nm");  // a picture becomes a texture
}

// Who reads ATI2 as it was meant first takes y from the first channel.
TEST_F(ScaleNormals, AnOrderThatChangesIsSaid) {
    ASSERT_EQ(go("bake-normals", {"waves.png", "-o", "n.dds", "--bumpiness", "4", "--format", "bc5"}).code, 0);
    const auto warns = [&](const std::string& output) {
        const Ran ran = go("scale-normals", {"n.dds", "-o", output, "--scale", "2", "--bc5-order", "yx"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        return ran.err.find("n.dds: y comes first, as in ATI2 of old, and x in the output, as in BC5") !=
               std::string::npos;
    };
    EXPECT_TRUE(warns("x.dds"));
    EXPECT_FALSE(warns("x.ktx2")) << "which has one order";
    EXPECT_EQ(go("scale-normals", {"n.dds", "-o", "x.dds", "--scale", "2"}).err, "");
}

TEST_F(ScaleNormals, TheScaleIsNeededAndFinite) {
    EXPECT_EQ(go("scale-normals", {"waves.png", "-o", "x.dds"}).err,
              "scale-normals: error: no scale: give --scale S\n");
    EXPECT_EQ(go("scale-normals", {"waves.png", "-o", "x.dds", "--scale", "inf"}).code, 2);
    EXPECT_EQ(go("scale-normals", {"waves.png", "-o", "x.dds", "--scale", "1e7"}).code, 2);
}

}  // namespace tex::cli
