// SPDX-License-Identifier: Apache-2.0
// transfer-normals with models as its outputs, and with an output for each material.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
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

constexpr double kPi = 3.14159265358979323846;

// A sphere of radius 1 whose UVs are longitude and latitude or, with a ring of that radius, a torus.
std::string sphere(int columns, int rows, const std::string& material, double ring = 0.0) {
    GltfMaker maker;
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint16_t> indices;
    const bool is_torus = ring > 0.0;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const double u = double(i) / columns, v = double(j) / rows;
            const double a = 2.0 * kPi * u, b = (is_torus ? 2.0 : 1.0) * kPi * v;
            const double n[] = {std::sin(b) * std::cos(a), std::cos(b), -std::sin(b) * std::sin(a)};
            const double centre[] = {ring * std::cos(a), 0.0, -ring * std::sin(a)};
            for (int k = 0; k < 3; ++k) {
                positions.push_back(static_cast<float>(centre[k] + (is_torus ? 0.4 : 1.0) * n[k]));
                normals.push_back(static_cast<float>(n[k]));
            }
            uvs.insert(uvs.end(), {static_cast<float>(u), static_cast<float>(v)});
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int a = j * (columns + 1) + i, b = a + columns + 1;
            if (is_torus || j < rows - 1)
                for (const int k : {a, b, b + 1}) indices.push_back(static_cast<std::uint16_t>(k));
            if (is_torus || j > 0)
                for (const int k : {a, b + 1, a + 1}) indices.push_back(static_cast<std::uint16_t>(k));
        }
    }
    maker.add(positions, "VEC3", 5126);
    maker.add(normals, "VEC3", 5126);
    maker.add(uvs, "VEC2", 5126);
    maker.add(indices, "SCALAR", 5123);
    return maker.glb(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0})",
                     ",\"materials\":[" + material + "]");
}

}  // namespace

class Lods : public testing::Test {
protected:
    Lods() {
        scratch_.write("low.glb", sphere(16, 8, R"({"name":"Skin"})"));
        scratch_.write("high.glb", sphere(128, 64, R"({"name":"Skin"})"));
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
    // Squares from z = 0 beside each other, each with a material, whose JSON is given.
    void write_squares(const std::string& name, const std::vector<std::string>& materials, const std::string& more,
                       const std::vector<float>& n = {0, 0, 1}) {
        GltfMaker maker;
        std::string primitives, list;
        for (std::size_t k = 0; k < materials.size(); ++k) {
            const auto x = static_cast<float>(2 * k);
            const int first = maker.add(std::vector<float>{x, 0, 0, x + 1, 0, 0, x + 1, 1, 0, x, 1, 0}, "VEC3", 5126);
            maker.add(std::vector<float>{n[0], n[1], n[2], n[0], n[1], n[2], n[0], n[1], n[2], n[0], n[1], n[2]},
                      "VEC3", 5126);
            maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
            maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
            primitives += std::string(k == 0 ? "" : ",") + "{\"attributes\":{\"POSITION\":" + std::to_string(first) +
                          ",\"NORMAL\":" + std::to_string(first + 1) + ",\"TEXCOORD_0\":" + std::to_string(first + 2) +
                          "},\"indices\":" + std::to_string(first + 3) +
                          (materials[k].empty() ? "" : ",\"material\":" + std::to_string(k)) + "}";
            list += (k == 0 ? "" : ",") + materials[k];
        }
        const std::string listed = list.empty() ? "" : ",\"materials\":[" + list + "]";
        scratch_.write(name, maker.glb(primitives, listed + more));
    }
    // A picture with these codes everywhere.
    void write_flat(const std::string& name, const std::string& codes) {
        does("convert -size 16x16 'xc:rgb(" + codes + ")' " + name);
    }
    Model model(const std::string& name) {
        auto read = read_model(scratch_.path(name));
        EXPECT_TRUE(read) << read.error().message();
        return read ? std::move(*read) : Model{};
    }
    NormalMap map_of(const Model& model, std::size_t index = 0) {
        const auto texture = read_map(model, model.maps.at(index));
        EXPECT_TRUE(texture) << texture.error().message();
        return std::move(unpack(*texture)->levels.front());
    }

    Scratch scratch_;
};

namespace {

// The mean angle between the map of a coarse body, decoded as a viewer does, and the formula of the body at the places
// that rays hit, in degrees.
double angle_from_formula(const Model& lod, const NormalMap& map, const Image& hits, double ring) {
    const auto part = select_part(lod.mesh, {});
    EXPECT_TRUE(part);
    EXPECT_EQ(part->source, TangentSource::file);
    const auto decoded = to_object_space(map, {part->part, part->tangents});
    EXPECT_TRUE(decoded);
    double sum = 0.0;
    int count = 0;
    for (int j = 0; j < 128; ++j) {
        for (int i = 0; i < 128; ++i) {
            if (decoded->coverage.at(i, j) != Coverage::triangle) continue;
            double x = hits.planes[0].at(i, j), y = hits.planes[1].at(i, j), z = hits.planes[2].at(i, j);
            const double around = std::sqrt(x * x + z * z), nearer = ring > 0.0 ? 1.0 - ring / around : 1.0;
            x *= nearer;
            z *= nearer;
            const NormalMap& seen = decoded->map;
            const double cosine =
                (x * seen.x.at(i, j) + y * seen.y.at(i, j) + z * seen.z.at(i, j)) / std::sqrt(x * x + y * y + z * z);
            sum += std::acos(std::min(1.0, cosine)) * 180.0 / kPi;
            ++count;
        }
    }
    EXPECT_GT(count, 14000);
    return sum / count;
}

}  // namespace

TEST_F(Lods, ShowTheNormalsOfASphereAndATorus) {
    for (const double ring : {0.0, 1.0}) {
        scratch_.write("low.glb", sphere(ring > 0.0 ? 32 : 16, ring > 0.0 ? 16 : 8, R"({"name":"Skin"})", ring));
        scratch_.write("high.glb", sphere(ring > 0.0 ? 256 : 128, ring > 0.0 ? 128 : 64, R"({"name":"Skin"})", ring));
        does(
            "transfer-normals low.glb high.glb -o lod.glb --extent 128 --format rgb16 --quiet; "
            "transfer-normals low.glb high.glb -o n.png --position-out p.exr --extent 128 --quiet --hit nearest");
        const Model lod = model("lod.glb");
        ASSERT_EQ(lod.maps.size(), 1u);
        EXPECT_EQ(lod.mesh.parts[0].tangents.size(), lod.mesh.parts[0].positions.size());
        const auto hits = read_image(scratch_.path("p.exr"));
        ASSERT_TRUE(hits);
        EXPECT_LT(angle_from_formula(lod, map_of(lod), *hits, ring), 0.3) << ring;
    }
}

// The original, and the low model with its old map, here none, and the new one.
TEST_F(Lods, ReportsShowThemBesideTheirOriginal) {
    const Ran ran =
        does("transfer-normals low.glb high.glb -o lod.glb --extent 128 --report page.html --json --no-sync");
    const JsonValue seen = JsonValue::parse(ran.out)["seen"][0];
    EXPECT_EQ(seen["material"], "Skin");
    // A smooth sphere needs no map: what both leave is the shape's.
    EXPECT_GT(seen["old"]["codes"].get<double>(), 0.5) << ran.out;
    EXPECT_NEAR(seen["new"]["codes"].get<double>(), seen["old"]["codes"].get<double>(), 0.5) << ran.out;
    EXPECT_NEAR(seen["new"]["degrees"].get<double>(), seen["old"]["degrees"].get<double>(), 0.5) << ran.out;
    const std::string page = scratch_.read("page.html");
    for (const std::string text :
         {"1 model", "data-map=\"0\" data-mesh=\"", "data-map=\"2\" data-mesh=\"", "\" data-follows", "\" data-leads",
          "<figcaption>the original</figcaption>", "<figcaption>the LOD with the old map</figcaption>",
          "<figcaption>the LOD with the new map</figcaption>"})
        EXPECT_NE(page.find(text), std::string::npos) << text;
    refuses("transfer-normals low.glb high.glb -o lod2.glb --report high.glb", 2, "high.glb");
    refuses("transfer-normals low.glb high.glb -o lod2.glb --report lod2.glb", 2, "lod2.glb");
}

// x of 0.6 is a slope of 0.75; half of it is what the material shows.
TEST_F(Lods, TheHighModelsOwnMapsCount) {
    write_flat("n.png", "204,128,230");
    const std::string more = R"(,"textures":[{"source":0}],"images":[{"uri":"n.png"}])";
    write_squares("high.glb", {R"({"name":"Skin","normalTexture":{"index":0,"scale":0.5}})"}, more);
    write_squares("low.glb", {R"({"name":"Skin"})"}, "");
    const Ran ran = does("transfer-normals low.glb high.glb -o lod.glb");
    EXPECT_EQ(ran.err, "");
    const Model lod = model("lod.glb");
    EXPECT_EQ(lod.maps.at(0).scale, 1.0);
    const NormalMap map = map_of(lod);
    EXPECT_EQ(map.extent(), (Extent{16, 16})) << "as the high model's";
    EXPECT_NEAR(map.x.at(8, 8) / map.z.at(8, 8), 0.375, 0.02);
    EXPECT_NEAR(map.y.at(8, 8), 0.0, 0.01);
    does("transfer-normals low.glb high.glb -o flat.glb --high-normals off --extent 16 --quiet");
    EXPECT_NEAR(map_of(model("flat.glb")).x.at(8, 8), 0.0, 0.01);
    // A picture is made as always, with a word about them.
    const Ran noted = does("transfer-normals low.glb high.glb -o n2.png --extent 16");
    EXPECT_NE(noted.err.find("normal maps of its own, which are not used (material \"Skin\"); --high-normals own uses"),
              std::string::npos)
        << noted.err;
    EXPECT_EQ(does("transfer-normals low.glb high.glb -o n3.png --extent 16 --high-normals own").err, "");
    const auto named = read_texture(scratch_.path("n3.png"));
    ASSERT_TRUE(named);
    EXPECT_NEAR(unpack(*named)->levels[0].x.at(8, 8), map.x.at(8, 8), 0.01);
    EXPECT_EQ(does("transfer-normals low.glb high.glb -o n4.png --extent 16 --high-normals off").err, "");
}

TEST_F(Lods, EveryMaterialGetsItsMap) {
    write_flat("right.png", "204,128,230");
    write_flat("left.png", "52,128,230");
    const std::string more =
        R"(,"textures":[{"source":0},{"source":1}],"images":[{"uri":"right.png"},{"uri":"left.png"}])";
    const std::string a = R"({"name":"A","normalTexture":{"index":0}})",
                      b = R"({"name":"b","normalTexture":{"index":1}})";
    write_squares("high.glb", {a, b}, more);
    // Both show one picture, so that they need two from now on.
    write_squares(
        "low.glb",
        {R"({"name":"A","normalTexture":{"index":0,"scale":3}})", R"({"name":"B","normalTexture":{"index":0}})"},
        R"(,"textures":[{"source":0}],"images":[{"uri":"right.png"}])");
    does("mkdir out; transfer-normals low.glb high.glb -o out/lod.glb --json > line");
    const Model lod = model("out/lod.glb");
    ASSERT_EQ(lod.maps.size(), 2u);
    EXPECT_GT(map_of(lod, 0).x.at(8, 8), 0.5f);
    EXPECT_LT(map_of(lod, 1).x.at(8, 8), -0.5f);
    EXPECT_EQ(lod.maps[0].scale, 1.0);
    const auto line = JsonValue::parse(scratch_.read("line"));
    ASSERT_EQ(line["maps"].size(), 2u);
    EXPECT_EQ(line["maps"][1]["material"], "B");
    EXPECT_EQ(line["maps"][1]["extent"], JsonValue::parse("[16,16]"));
    EXPECT_FALSE(scratch_.has("out/left.png"));
    // One alone leaves the other as it is.
    does("mkdir one; transfer-normals low.glb high.glb -o one/one.glb --material B --quiet");
    EXPECT_EQ(model("one/one.glb").maps[0].scale, 3.0);
    // Pictures of all.
    does(
        "transfer-normals low.glb high.glb --material all --out-dir maps --name '{stem}_{material}.png' --extent 16 "
        "--height-out 'h_{material}.png' --high-normals own --quiet");
    for (const char* name : {"maps/low_A.png", "maps/low_B.png", "maps/h_A.png", "maps/h_B.png"})
        EXPECT_TRUE(scratch_.has(name)) << name;
    const auto left = read_texture(scratch_.path("maps/low_B.png"));
    ASSERT_TRUE(left);
    EXPECT_LT(unpack(*left)->levels[0].x.at(8, 8), -0.5f);
    // Names that nothing has: all parts count, which is said.
    write_squares("low.glb", {R"({"name":"C"})"}, "");
    const Ran noted = does("transfer-normals low.glb high.glb -o out/c.glb");
    EXPECT_NE(
        noted.err.find("low.glb: C: the high mesh has no material of this name, and so rays meet all of its parts"),
        std::string::npos)
        << noted.err;
}

// gltfpack's UVs need their transform, and one that repeats the old map has no meaning for the new one.
TEST_F(Lods, TransformsStayWhereUvsNeedThem) {
    write_flat("n.png", "128,128,255");
    const std::string more = R"(,"textures":[{"source":0}],"images":[{"uri":"n.png"}],"extensionsUsed":)"
                             R"(["KHR_texture_transform"])";
    const auto material = [](const std::string& scale) {
        return R"({"name":"Skin","normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[)" + scale +
               "," + scale + "]}}}}";
    };
    write_squares("high.glb", {R"({"name":"Skin"})"}, "");
    write_squares("tiled.glb", {material("4")}, more);
    write_squares("half.glb", {material("0.5")}, more);
    does("for f in tiled half; do transfer-normals $f.glb high.glb -o out_$f.glb --quiet; done");
    EXPECT_EQ(model("out_tiled.glb").maps.at(0).uv_transform, UvTransform{});
    EXPECT_EQ(model("out_half.glb").maps.at(0).uv_transform.scale_x, 0.5);
}

// A leaf over a floor: both lean to other sides. What the leaf's picture leaves out shows the floor.
TEST_F(Lods, RaysPassWhereAMaskHasHoles) {
    write_flat("left.png", "52,128,230");
    write_flat("right.png", "204,128,230");
    does(
        "convert -size 16x16 xc:white \\( -size 8x16 xc:black -size 8x16 xc:white +append \\) -alpha off "
        "-compose CopyOpacity -composite -define png:color-type=6 leaf.png");
    const auto write_high = [&](const std::string& alpha) {
        GltfMaker maker;
        for (const float z : {0.0f, 0.1f}) {
            maker.add(std::vector<float>{0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z}, "VEC3", 5126);
            maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
            maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
            maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
        }
        scratch_.write(
            "high.glb",
            maker.glb(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0},)"
                      R"({"attributes":{"POSITION":4,"NORMAL":5,"TEXCOORD_0":6},"indices":7,"material":1})",
                      R"(,"materials":[{"name":"floor","normalTexture":{"index":0}},{"name":"leaf","normalTexture":)"
                      R"({"index":1},"pbrMetallicRoughness":{"baseColorTexture":{"index":2}})" +
                          alpha +
                          R"(}],"textures":[{"source":0},{"source":1},{"source":2}],"images":[{"uri":"left.png"},)"
                          R"({"uri":"right.png"},{"uri":"leaf.png"}])"));
    };
    write_squares("low.glb", {R"({"name":"ground"})"}, "");
    const auto x_at = [&](const std::string& more, int i) {
        const Ran ran = does(
            "transfer-normals low.glb high.glb -o n.png --extent 16 --high-normals own --front 1 --back 1 " + more);
        EXPECT_EQ(ran.err, "") << more;
        const auto read = read_texture(scratch_.path("n.png"));
        return read ? unpack(*read)->levels.front().x.at(i, 8) : 0.0f;
    };
    write_high(R"(,"alphaMode":"MASK")");
    EXPECT_LT(x_at("", 4), -0.5f);
    EXPECT_GT(x_at("", 12), 0.5f);
    EXPECT_GT(x_at("--high-alpha off", 4), 0.5f);
    write_high(R"(,"alphaMode":"MASK","alphaCutoff":0)");
    EXPECT_GT(x_at("", 4), 0.5f) << "nothing is below 0";
    write_high(R"(,"alphaMode":"OPAQUE")");
    EXPECT_GT(x_at("", 4), 0.5f);
    EXPECT_LT(x_at("--high-alpha leaf=leaf.png", 4), -0.5f);
    write_high(R"(,"alphaMode":"BLEND")");
    const Ran noted = does("transfer-normals low.glb high.glb -o n.png --extent 16 --high-normals own --json");
    const auto line = JsonValue::parse(noted.out);
    ASSERT_FALSE(line["warnings"].empty());
    EXPECT_NE(line["warnings"][0]["message"].get<std::string>().find("as if it were solid (material \"leaf\")"),
              std::string::npos);
    // A depfile knows the picture, and a model as the output reads the same.
    write_high(R"(,"alphaMode":"MASK")");
    does(
        "transfer-normals low.glb high.glb -o lod.glb --extent 16 --front 1 --back 1 --hit outermost --depfile d "
        "--quiet");
    EXPECT_NE(scratch_.read("d").find("leaf.png"), std::string::npos);
    EXPECT_LT(map_of(model("lod.glb")).x.at(4, 8), -0.5f);
    refuses("transfer-normals low.glb high.glb -o x.png --high-alpha stem=leaf.png", 4, "has no material \"stem\"");
    refuses("transfer-normals low.glb high.glb -o x.png --high-alpha off --high-alpha leaf.png", 2,
            "contradict each other");
}

// An OBJ file has its materials in another file: map_d is 0 in its left half.
TEST_F(Lods, RaysPassWhereMapDHasHoles) {
    write_squares("low.glb", {R"({"name":"ground"})"}, "");
    does("mkdir mtl; convert -size 8x16 xc:black -size 8x16 xc:white +append 'mtl/leaf d.png'");
    // The floor leans to the left, the leaf to the right.
    scratch_.write("high.obj",
                   "mtllib no.mtl mtl/of high.mtl\n"
                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 .1\nv 1 0 .1\nv 1 1 .1\nv 0 1 .1\n"
                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn -.6 0 .8\nvn .6 0 .8\n"
                   "usemtl floor\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl leaf\nf 5/1/2 6/2/2 7/3/2 8/4/2\n");
    const auto x_at = [&](const std::string& mtl, const std::string& more, int i) {
        scratch_.write("high.mtl", "newmtl floor\nd 1.0\nnewmtl leaf\n" + mtl + "\n");
        does("transfer-normals low.glb high.obj -o n.png --extent 16 --front 1 --back 1 --depfile d --quiet " + more);
        const auto read = read_texture(scratch_.path("n.png"));
        return read ? unpack(*read)->levels.front().x.at(i, 8) : 0.0f;
    };
    scratch_.write("mtl/of", "");
    for (const std::string mtl : {"map_d mtl/leaf d.png", "map_d -clamp on -s 1 1 1 -imfchan l mtl\\leaf d.png\r"}) {
        EXPECT_LT(x_at(mtl, "", 4), -0.5f) << mtl;
        EXPECT_GT(x_at(mtl, "", 12), 0.5f) << mtl;
        const std::string files = scratch_.read("d");
        EXPECT_NE(files.find("high.mtl"), std::string::npos) << files;
        EXPECT_NE(files.find("leaf"), std::string::npos) << files;
        EXPECT_GT(x_at(mtl, "--high-alpha off", 4), 0.5f) << mtl;
    }
    for (const std::string mtl :
         {"d 1", "map_d absent.png", "map_d ../mtl/leaf d.png", "map_d", "map_Kd mtl/leaf d.png"})
        EXPECT_GT(x_at(mtl, "", 4), 0.5f) << mtl;
    EXPECT_LT(x_at("d 0.4\nmap_d mtl/leaf d.png", "", 12), -0.5f) << "d multiplies map_d";
    scratch_.write("high.mtl", "newmtl leaf\nd 0.4\n");
    const auto line = JsonValue::parse(does("transfer-normals low.glb high.obj -o n.png --extent 16 --json").out);
    EXPECT_NE(line["warnings"].dump().find("as if it were solid"), std::string::npos);
}

// Red is what transfer-normals writes beside a picture; green and blue stay.
TEST_F(Lods, OcclusionGoesIntoTheModel) {
    does(
        "convert -size 16x16 gradient:'rgb(9,20,30)-rgb(7,200,31)' -depth 8 -define png:color-type=2 orm.png; "
        "convert -size 8x8 'xc:rgb(1,2,3)' n.png");
    const std::string more = R"(,"textures":[{"source":0},{"source":1}],"images":[{"uri":"orm.png"},{"uri":"n.png"}])";
    write_squares("high.glb", {R"({"name":"A"})", R"({"name":"B"})"}, "");
    write_squares("low.glb",
                  {R"({"name":"A","pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}}})",
                   R"({"name":"B","normalTexture":{"index":1}})"},
                  more);
    const std::string pair = "transfer-normals low.glb high.glb --extent 16 --rays-per-hit 16 --quiet ";
    does("mkdir out; " + pair + "-o out/lod.glb --occlusion-into model");
    const std::string file = scratch_.read("out/lod.glb");
    std::uint32_t size = 0;
    std::memcpy(&size, file.data() + 12, 4);
    const JsonValue document = JsonValue::parse(file.substr(20, size));
    const JsonValue materials = document["materials"], images = document["images"], textures = document["textures"];
    EXPECT_EQ(materials[0]["occlusionTexture"]["index"],
              materials[0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"]);
    ASSERT_TRUE(materials[1].contains("occlusionTexture"));
    const auto picture_at = [&](const JsonValue& slot) {
        const JsonValue image = images[textures[slot["index"].get<std::size_t>()]["source"].get<std::size_t>()];
        if (image.contains("uri")) return read_image(scratch_.path("out/" + image["uri"].get<std::string>()));
        MeshReadOptions all;
        all.images = true;
        const auto read = read_model_maps(scratch_.path("out/lod.glb"), all);
        const auto number = textures[slot["index"].get<std::size_t>()]["source"].get<std::size_t>();
        return read_image(read->images.at(number).bytes, "picture");
    };
    const auto orm = picture_at(materials[0]["occlusionTexture"]), before = read_image(scratch_.path("orm.png"));
    ASSERT_TRUE(orm && before);
    ASSERT_EQ(orm->planes.size(), 3u);
    does(pair + "-o n2.png --material A --occlusion-out ao.png");
    const auto wanted = read_image(scratch_.path("ao.png"));
    ASSERT_TRUE(wanted);
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i) {
            ASSERT_NEAR(orm->planes[0].at(i, j), wanted->planes[0].at(i, j), 1.0 / 255.0);
            ASSERT_EQ(orm->planes[1].at(i, j), before->planes[1].at(i, j)) << "to the code";
            ASSERT_EQ(orm->planes[2].at(i, j), before->planes[2].at(i, j));
        }
    }
    const auto own = picture_at(materials[1]["occlusionTexture"]);
    ASSERT_TRUE(own);
    EXPECT_EQ(own->planes.size(), 1u);
    EXPECT_EQ(own->planes[0].at(3, 3), 1.0f) << "nothing stands above a square";
    refuses(pair + "-o x.png --material A --occlusion-into model", 2, "a model is no output here");
    refuses(pair + "-o x.glb --occlusion-into red", 2, "must be model");
}

TEST_F(Lods, WhatCannotBeIsRefused) {
    write_flat("n.png", "128,128,255");
    write_squares("high.glb", {R"({"name":"Skin","normalTexture":{"index":0}})"},
                  R"(,"textures":[{"source":0}],"images":[{"uri":"n.png"}])");
    write_squares("low.glb", {R"({"name":"Skin"})"}, "");
    const std::string pair = "transfer-normals low.glb high.glb ";
    refuses(pair + "-o low.glb", 2, "the output low.glb is the input low.glb");
    refuses(pair + "-o high.glb", 2, "the output high.glb is the input high.glb");
    does("ln high.glb hard.glb; ln -s low.glb soft.glb; mkdir out");
    refuses(pair + "-o hard.glb", 2, "is the input");
    refuses(pair + "-o soft.glb", 2, "is the input");
    refuses(pair + "-o x.glb --depfile n.png", 2, "the output n.png is the input n.png");
    refuses(pair + "-o x.glb --height-out h.png", 2, "--height-out is for one map, and not for models");
    refuses(pair + "-o x.glb --cage low.glb", 2, "--cage is for one map, and not for models");
    refuses(pair + "-o x.glb --mips all", 2, "models hold no levels");
    refuses(pair + "-o x.glb --format bc5", 2, "models hold normals as");
    refuses(pair + "-o x.glb --material glass", 4, "has no material \"glass\"");
    refuses("transfer-normals low.glb -o x.glb", 2, "no high mesh");
    refuses(pair + "--material all --node a --out-dir out", 2, "--material all and --node contradict each other");
    refuses(pair + "-o x.png --high-normals own --high-normals n.png", 2, "contradict each other");
    scratch_.write("bad.glb", std::string("glTF\2\0\0\0", 8));
    refuses("transfer-normals bad.glb high.glb -o x.glb", 4, "bad.glb: truncated");
    refuses("transfer-normals low.glb bad.glb -o x.glb", 4, "bad.glb: truncated");
    does(pair + "-o x.glb --quiet");
    refuses(pair + "-o x.glb --no-clobber", 3, "exists, and --no-clobber is given");
    scratch_.write("n.png", std::string("These are words."));
    refuses(pair + "-o y.glb", 4, "n.png");
}

// Low meshes of one run share what was read and made of the high one: with their own maps and with pictures.
TEST_F(Lods, SeveralLowMeshesAreWhatEachIsAlone) {
    scratch_.write("mid.glb", sphere(32, 16, R"({"name":"Skin"})"));
    write_flat("n.png", "160,128,251");
    does("cp high.glb h.glb");
    does("transfer-normals low.glb mid.glb --high h.glb --out-dir lods --name '{stem}.glb' --extent 32 --quiet");
    does(
        "transfer-normals low.glb mid.glb --high h.glb --out-dir maps --extent 32 --high-normals n.png "
        "--occlusion-out '{stem}_ao.png' --quiet");
    for (const std::string stem : {"low", "mid"}) {
        does("transfer-normals " + stem + ".glb h.glb -o alone.glb --extent 32 --quiet; cmp alone.glb lods/" + stem +
             ".glb");
        does("transfer-normals " + stem +
             ".glb h.glb -o alone.dds --extent 32 --high-normals n.png --occlusion-out "
             "ao.png --quiet; cmp alone.dds maps/" +
             stem + ".dds; cmp ao.png maps/" + stem + "_ao.png");
    }
}

// Simplifiers drop materials, and quantise normals.
TEST_F(Lods, WhatSimplifiedModelsLackIsSaidAndMade) {
    write_squares("plain.glb", {""}, "");
    write_squares("one.glb", {R"({"name":"Skin"})"}, "");
    for (const std::string name : {"a.glb", "a.gltf"}) {
        const Ran made = does("transfer-normals plain.glb one.glb -o " + name + " --extent 16");
        EXPECT_NE(made.err.find("its triangles have no material; they get one"), std::string::npos) << made.err;
        const JsonValue report = JsonValue::parse(does("check-normals " + name + " --json || true").out);
        EXPECT_NE(report.dump().find("material"), std::string::npos);
        does("preview-normals " + name + " --out-dir seen --quiet");
    }
    EXPECT_EQ(does("transfer-normals one.glb plain.glb -o b.glb --extent 16").err, "");
    write_squares("coarse.glb", {R"({"name":"Skin"})"}, "", {0.0f, 9.0f / 127.0f, 126.0f / 127.0f});
    const Ran coarse = does("transfer-normals coarse.glb one.glb -o c.glb --extent 16");
    EXPECT_NE(coarse.out.find("normals have 8 bits"), std::string::npos) << coarse.out;
    EXPECT_EQ(does("transfer-normals one.glb coarse.glb -o d.glb --extent 16").out.find("8 bits"), std::string::npos);
    refuses("transfer-normals plain.glb one.glb -o x.glb --material Skin", 4, "has no material \"Skin\"");
}

}  // namespace tex::cli
