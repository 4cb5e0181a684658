// SPDX-License-Identifier: Apache-2.0
// convert-normals with glTF models as its outputs.

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

using JsonValue = nlohmann::json;

}  // namespace

class ConvertedModels : public testing::Test {
protected:
    ConvertedModels() {
        does("cp " TEX_SOURCE_DIR "/samples/bricks.png .; bake-normals bricks.png -o n.png --bumpiness 12");
    }
    Ran go(const std::string& script) { return shell(scratch_, "set -e; " + script); }
    Ran does(const std::string& script) {
        Ran ran = go(script);
        EXPECT_EQ(ran.code, 0) << script << ": " << ran.err;
        return ran;
    }
    void refuses(const std::string& script, int code, const std::string& said) {
        const std::vector<std::string> before = scratch_.list();
        const Ran ran = go(script);
        EXPECT_EQ(ran.code, code) << script << ": " << ran.err;
        EXPECT_NE(ran.err.find(said), std::string::npos) << script << ": " << ran.err;
        EXPECT_EQ(scratch_.list(), before) << script;
    }
    // Two bent squares, of which the second one's UVs are mirrored. Tangents are turned from those of the UVs by this
    // angle; none: there are no tangents.
    void write_model_of(const std::string& name, const std::string& slot, std::optional<float> turn) {
        GltfMaker maker;
        std::string primitives;
        for (int k = 0; k < 2; ++k) {
            const float u = k == 0 ? 0.0f : 1.0f, w = k == 0 ? 1.0f : -1.0f, x = 2.0f * static_cast<float>(k);
            const int first =
                maker.add(std::vector<float>{x, 0, 0, x + 1, 0, 0, x + 1, 1, 0.3f, x, 1, 0}, "VEC3", 5126);
            maker.add(std::vector<float>{0, 0, 1, 0, -0.6f, 0.8f, 0, -0.6f, 0.8f, 0, 0, 1}, "VEC3", 5126);
            maker.add(std::vector<float>{u, 1, 1 - u, 1, 1 - u, 0, u, 0}, "VEC2", 5126);
            maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
            const float c = std::cos(turn.value_or(0.0f)) * w, s = std::sin(turn.value_or(0.0f));
            std::vector<float> tangents;
            for (int v = 0; v < 4; ++v) tangents.insert(tangents.end(), {c, s, 0, w});
            if (turn) maker.add(tangents, "VEC4", 5126);
            primitives += std::string(k == 0 ? "" : ",") + "{\"attributes\":{\"POSITION\":" + std::to_string(first) +
                          ",\"NORMAL\":" + std::to_string(first + 1) + ",\"TEXCOORD_0\":" + std::to_string(first + 2) +
                          (turn ? ",\"TANGENT\":" + std::to_string(first + 4) : "") +
                          "},\"indices\":" + std::to_string(first + 3) + ",\"material\":" + std::to_string(k) + "}";
        }
        scratch_.write(name, maker.glb(primitives, R"(,"materials":[{"name":"A","normalTexture":{"index":0)" + slot +
                                                       R"(}},{"name":"B","normalTexture":{"index":0}}],"textures":)"
                                                       R"([{"source":0}],"images":[{"uri":"n.png"}])"));
    }
    Model model(const std::string& name) {
        auto read = read_model(scratch_.path(name));
        EXPECT_TRUE(read) << read.error().message();
        return read ? std::move(*read) : Model{};
    }
    // What the material shows in object space, at all texels.
    ConvertedMap shown(const std::string& name, std::size_t index) {
        const Model read = model(name);
        const ModelMap& map = read.maps.at(index);
        const auto selected = select_part(read.mesh, selection_of(read, map));
        EXPECT_TRUE(selected);
        auto chain = unpack(*read_map(read, map));
        auto scaled = scale(std::move(chain->levels.front()), static_cast<float>(map.scale), ScaleMode::slope);
        return std::move(*to_object_space(*scaled, {selected->part, selected->tangents}));
    }
    double difference(const std::string& a, const std::string& b, std::size_t index) {
        const auto compared = compare(shown(a, index).map, shown(b, index).map);
        EXPECT_TRUE(compared);
        return compared ? compared->error.mean : 180.0;
    }
    Scratch scratch_;
};

TEST_F(ConvertedModels, GetTangentsAndKeepTheirMaps) {
    write_model_of("bare.glb", "", {});
    EXPECT_EQ(does("convert-normals bare.glb -o out.glb --tangents mikktspace").err, "");
    const Model before = model("bare.glb"), after = model("out.glb");
    EXPECT_TRUE(before.mesh.parts.at(0).tangents.empty());
    for (const MeshPart& part : after.mesh.parts) {
        const auto wanted = make_tangents(part);
        const auto got = stored_tangents(part);
        ASSERT_TRUE(wanted && got);
        for (std::size_t c = 0; c < got->size(); ++c) {
            EXPECT_EQ((*got)[c].x, (*wanted)[c].x);
            EXPECT_EQ((*got)[c].w, (*wanted)[c].w);
        }
    }
    EXPECT_LT(after.mesh.parts.at(1).tangents.at(0).w, 0.0f) << "mirrored UVs";
    EXPECT_EQ(after.maps.at(0).image, before.maps.at(0).image);
    EXPECT_EQ(after.images.size(), 1u) << "the picture stays where it is";
    // Again: nothing is left to change.
    does("convert-normals out.glb -o again.glb --tangents mikktspace; cmp out.glb again.glb");
    // One material alone.
    does("convert-normals bare.glb -o one.glb --tangents mikktspace --material B");
    EXPECT_TRUE(model("one.glb").mesh.parts.at(0).tangents.empty());
    EXPECT_FALSE(model("one.glb").mesh.parts.at(1).tangents.empty());
    // Wrong tangents, on which maps of MikkTSpace look wrong, become right ones.
    write_model_of("turned.glb", "", 1.2f);
    EXPECT_EQ(does("convert-normals turned.glb -o right.glb --tangents mikktspace").err, "");
    EXPECT_GT(difference("turned.glb", "out.glb", 0), 5.0);
    EXPECT_EQ(difference("right.glb", "out.glb", 0), 0.0);
}

TEST_F(ConvertedModels, CheckNormalsPrintsTheCommand) {
    write_model_of("bare.glb", "", {});
    write_model_of("turned.glb", "", 1.2f);
    const std::string bare = go("check-normals bare.glb --quiet").out;
    EXPECT_NE(bare.find("fix: convert-normals bare.glb --tangents mikktspace -o FIXED.glb"), std::string::npos) << bare;
    const std::string asked = go("check-normals bare.glb --quiet --for cesium").out;
    EXPECT_NE(asked.find("N808"), std::string::npos) << asked;
    EXPECT_NE(asked.find("fix: convert-normals bare.glb --tangents mikktspace -o FIXED.glb"), std::string::npos)
        << asked;
    does("convert-normals bare.glb --tangents mikktspace -o seen.glb");
    EXPECT_EQ(go("check-normals seen.glb --quiet --for cesium,filament").out.find("N808"), std::string::npos);
    const std::string turned = go("check-normals turned.glb --quiet").out;
    EXPECT_NE(turned.find("N705"), std::string::npos) << turned;
    const std::string command = "convert-normals turned.glb --material A --tangents mikktspace -o FIXED.glb";
    EXPECT_NE(turned.find("fix: " + command), std::string::npos) << turned;
    does(command + "; convert-normals FIXED.glb --material B --tangents mikktspace -o both.glb");
    const std::string fixed = go("check-normals both.glb --quiet").out;
    EXPECT_NE(fixed.find("0 errors, 0 warnings"), std::string::npos) << fixed;
    for (const char* const id : {"N701", "N705", "N706"}) EXPECT_EQ(fixed.find(id), std::string::npos) << fixed;
    const std::string in_one_run = "convert-normals turned.glb --tangents mikktspace -o FIXED.glb";
    EXPECT_NE(turned.find("turned.glb: all of these in one run: " + in_one_run + "\n"), std::string::npos) << turned;
    does(in_one_run + "; cmp FIXED.glb both.glb");
}

// Maps that were made for the tangents of the file look the same on others, with two maps in place of one.
TEST_F(ConvertedModels, MapsFollowTheirTangents) {
    write_model_of("m.glb", R"(,"scale":0.5)", 0.4f);
    does(
        "mkdir out; convert-normals m.glb -o out/m.glb --tangents-in file --tangents mikktspace --json --quiet > line");
    EXPECT_LT(difference("m.glb", "out/m.glb", 0), 0.4);
    EXPECT_LT(difference("m.glb", "out/m.glb", 1), 0.4);
    const Model after = model("out/m.glb");
    EXPECT_EQ(after.maps.at(0).scale, 1.0) << "it is in the map";
    EXPECT_NE(after.maps.at(0).image, after.maps.at(1).image);
    const auto line = JsonValue::parse(scratch_.read("line"));
    ASSERT_EQ(line["maps"].size(), 2u);
    EXPECT_EQ(line["maps"][1]["material"], "B");
    // The other way: tangents stay, and the map of MikkTSpace is made for them.
    does("mkdir back; convert-normals m.glb -o back/m.glb --tangents-in mikktspace --tangents file --quiet");
    EXPECT_EQ(model("back/m.glb").mesh.parts.at(0).tangents.at(0).x, model("m.glb").mesh.parts.at(0).tangents.at(0).x);
    write_model_of("bare.glb", R"(,"scale":0.5)", {});
    EXPECT_LT(difference("bare.glb", "back/m.glb", 0), 0.4);
    // And for another engine.
    does("mkdir godot; convert-normals bare.glb -o godot/m.glb --decoder godot --quiet");
    EXPECT_NE(scratch_.read("godot/n.png"), scratch_.read("n.png"));
    EXPECT_TRUE(model("godot/m.glb").mesh.parts.at(0).tangents.empty());
}

// UVs that a transform turns and mirrors need tangents that follow them.
TEST_F(ConvertedModels, TransformsCountInTangents) {
    write_model_of("m.glb", R"(,"extensions":{"KHR_texture_transform":{"rotation":1.5707963,"scale":[-1,1]}})", {});
    does("convert-normals m.glb -o out.glb --tangents mikktspace");
    const Model after = model("out.glb");
    const MeshPart& part = after.mesh.parts.at(0);
    const auto moved = with_moved_uvs(part, 0, after.maps.at(0).uv_transform);
    ASSERT_TRUE(moved);
    const auto wanted = make_tangents(*moved);
    const auto got = stored_tangents(part);
    ASSERT_TRUE(wanted && got);
    for (std::size_t c = 0; c < got->size(); ++c) EXPECT_EQ((*got)[c].y, (*wanted)[c].y);
    EXPECT_LT(got->at(0).w, 0.0f);
    EXPECT_NE(after.maps.at(0).uv_transform, UvTransform{}) << "the map stays where it is";
    const std::string said = go("check-normals out.glb --quiet").out;
    for (const char* const id : {"N701", "N705", "N706"}) EXPECT_EQ(said.find(id), std::string::npos) << said;
}

TEST_F(ConvertedModels, WhatCannotBeIsRefused) {
    write_model_of("m.glb", "", {});
    refuses("convert-normals m.glb -o x.glb", 2, "nothing changes: give --tangents");
    refuses("convert-normals m.glb -o x.glb --tangents file", 2, "nothing changes: give --tangents");
    refuses("convert-normals m.glb -o m.glb --tangents mikktspace", 2, "is the input");
    refuses("convert-normals m.glb -o x.glb --to object", 2, "--to is for one map, and not for models");
    refuses("convert-normals m.glb -o x.glb --mesh m.glb --tangents-in file --tangents mikktspace", 2,
            "--mesh is for one map, and not for models");
    refuses("convert-normals m.glb -o x.glb --tangents mikktspace --mips all", 2, "models hold no levels");
    refuses("convert-normals m.glb -o x.glb --tangents mikktspace --material C", 4, "has no material \"C\"");
    refuses("convert-normals m.glb -o x.glb --tangents-in file --tangents mikktspace", 4, "has no tangents");
    refuses("convert-normals n.png -o x.glb --tangents mikktspace", 4, "is not a glTF model");
}

}  // namespace tex::cli
