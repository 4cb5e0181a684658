// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kMeshes = fs::path(TEX_SOURCE_DIR) / ".." / "shared" / "data" / "mesh";

class ConvertNormals : public testing::Test {
protected:
    ConvertNormals() {
        scratch_.add_sample("waves.png", "waves.png");
        scratch_.write("sheet.obj", kSheetObj);
        does("bake-normals", {"waves.png", "-o", "n.exr", "--bumpiness", "4", "--format", "float"});
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    Ran does(const std::string& command, const std::vector<std::string>& arguments) {
        const Ran ran = go(command, arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(without_notes(ran.err), "");
        return ran;
    }
    void refuses(std::vector<std::string> arguments, int code, const std::string& part) {
        const auto before = scratch_.list();
        const Ran ran = go("convert-normals", std::move(arguments));
        EXPECT_EQ(ran.code, code) << part;
        EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before);
    }
    NormalMap map(const std::string& name, std::size_t level = 0) {
        auto chain = unpack(*read_texture(scratch_.path(name)));
        EXPECT_TRUE(chain);
        return std::move(chain->levels.at(level));
    }
    AngularError angle(const std::string& a, const std::string& b) {
        const auto compared = compare(map(a), map(b));
        EXPECT_TRUE(compared);
        return compared->error;
    }
    Scratch scratch_;
};

TEST_F(ConvertNormals, GoesToObjectSpaceAndBack) {
    does("convert-normals", {"n.exr", "-o", "obj.exr", "--mesh", "sheet.obj", "--to", "object", "--format", "float"});
    does("convert-normals", {"obj.exr", "-o", "b.exr", "--mesh", "sheet.obj", "--from", "object", "--format", "float"});
    EXPECT_LT(angle("n.exr", "b.exr").max, 1e-4);
    EXPECT_GT(angle("n.exr", "obj.exr").max, 5.0);
    does("convert-normals", {"n.exr", "-o", "obj.png", "--mesh", "sheet.obj", "--to", "object"});
    does("convert-normals", {"obj.png", "-o", "b.png", "--mesh", "sheet.obj", "--from", "object"});
    EXPECT_LT(angle("n.exr", "b.png").mean, 0.4);  // rounded twice
}

TEST_F(ConvertNormals, MakesMapsFitOtherDecodersTangentsAndMeshes) {
    const auto object = [&](const std::string& input, const std::string& output, const std::string& mesh,
                            const std::string& decoder, const std::string& tangents) {
        does("convert-normals", {input, "-o", output, "--mesh", mesh, "--to", "object", "--format", "float",
                                 "--decoder", decoder, "--tangents", tangents});
    };
    std::string other = kSheetObj;
    other.replace(other.find("v 1 1 0.4"), 9, "v 1 1 0.9");
    other.replace(other.find("vn -0.3 -0.1 1"), 14, "vn -0.1 -0.5 1");
    scratch_.write("other.obj", other);
    object("n.exr", "wanted.exr", "sheet.obj", "unreal", "mikktspace");
    does("convert-normals",
         {"n.exr", "-o", "fit.exr", "--mesh", "sheet.obj", "--to-mesh", "other.obj", "--decoder-in", "unreal",
          "--decoder", "godot", "--tangents-in", "mikktspace", "--tangents", "meshopt", "--format", "float"});
    object("fit.exr", "got.exr", "other.obj", "godot", "meshopt");
    EXPECT_LT(angle("wanted.exr", "got.exr").max, 1e-4);
    object("n.exr", "unfit.exr", "other.obj", "godot", "meshopt");
    EXPECT_GT(angle("wanted.exr", "unfit.exr").max, 1.0);
}

TEST_F(ConvertNormals, KeepsTheSignOfZInObjectSpace) {
    std::string behind = kSheetObj;  // seen from below: every normal points down
    for (std::size_t at = 0; (at = behind.find(" 1\nv", at)) != std::string::npos; at += 4) {
        const std::size_t line = behind.rfind('\n', at) + 1;
        if (behind.compare(line, 2, "vn") == 0) behind.replace(at, 3, " -1\n"), ++at;
    }
    scratch_.write("behind.obj", behind);
    const Ran ran =
        does("convert-normals", {"n.exr", "-o", "obj.ktx2", "--mesh", "behind.obj", "--to", "object", "--json"});
    const auto report = nlohmann::json::parse(ran.out);
    EXPECT_EQ(report["format"], "rgb8");
    EXPECT_EQ(report["tangents"], "mikktspace");
    EXPECT_EQ(report["overlaps"], 0);
    const int levels = report["levels"];
    EXPECT_GT(levels, 5);
    for (int k = 0; k < levels; ++k) {
        const NormalMap level = map("obj.ktx2", static_cast<std::size_t>(k));
        EXPECT_LT(level.z.at(0, 0), -0.3f) << k;
    }
    does("convert-normals", {"obj.ktx2", "-o", "back.exr", "--mesh", "behind.obj", "--from", "object"});
    EXPECT_LT(angle("n.exr", "back.exr").mean, 0.4);
}

TEST_F(ConvertNormals, FlipsYAsAsked) {
    does("pack-normals", {"n.exr", "-o", "down.exr", "--y", "down", "--format", "float"});
    does("convert-normals",
         {"down.exr", "-o", "obj.exr", "--mesh", "sheet.obj", "--to", "object", "--format", "float"});
    does("convert-normals", {"n.exr", "-o", "same.exr", "--mesh", "sheet.obj", "--to", "object", "--format", "float"});
    EXPECT_TRUE(scratch_.read("obj.exr") == scratch_.read("same.exr"));
    does("convert-normals",
         {"obj.exr", "-o", "ue.dds", "--mesh", "sheet.obj", "--from", "object", "--y", "down", "--format", "rgb8"});
    EXPECT_LT(angle("n.exr", "ue.dds").mean, 0.3);
    EXPECT_EQ(read_texture(scratch_.path("ue.dds"))->y_axis, YAxis::down);
}

TEST_F(ConvertNormals, WritesWhatPackNormalsWrites) {
    for (const std::string name : {"x.dds", "x.ktx2", "x.png", "x.exr", "x.tif", "x.tga", "x.bmp", "x.jpg"}) {
        does("convert-normals", {"n.exr", "-o", name, "--mesh", "sheet.obj", "--decoder-in", "godot"});
        EXPECT_LT(angle("n.exr", name).mean, 6.0) << name;
    }
    does("convert-normals", {"n.exr", "--out-dir", "levels", "--name", "{stem}_{level}.png", "--mesh", "sheet.obj",
                             "--decoder-in", "godot", "--mips", "3"});
    EXPECT_TRUE(scratch_.has("levels/n_2.png"));
    EXPECT_FALSE(scratch_.has("levels/n_3.png"));
    EXPECT_EQ(map("levels/n_2.png").extent().width * 4, map("n.exr").extent().width);
    does("convert-normals", {"n.exr", "-o", "zstd.ktx2", "--mesh", "sheet.obj", "--decoder-in", "godot",
                             "--supercompress", "zstd", "--format", "bc5", "--effort", "fast", "--depfile", "d"});
    EXPECT_EQ(scratch_.read("d"), "zstd.ktx2: \\\n  n.exr \\\n  sheet.obj\n");
    does("convert-normals", {"n.exr", "-o", "same.exr", "--mesh", "sheet.obj", "--to-mesh", "sheet.obj", "--tangents",
                             "meshopt", "--depfile", "d"});
    EXPECT_EQ(scratch_.read("d"), "same.exr: \\\n  n.exr \\\n  sheet.obj\n");
    does("convert-normals",
         {"n.exr", "--out-dir", "named", "--name", "{stem}_{format}.dds", "--mesh", "sheet.obj", "--to", "object"});
    EXPECT_TRUE(scratch_.has("named/n_rgb8.dds"));
    const auto same = go("convert-normals", {"-", "-o", "-", "--container", "png", "--mesh", "sheet.obj"});
    EXPECT_EQ(same.code, 2);
}

TEST_F(ConvertNormals, UpdatesIfABufferBesideTheMeshHasChanged) {
    const auto made = [this] {
        const Ran ran = does("convert-normals", {"n.exr", "-o", "o.exr", "--mesh", "m.gltf", "--to", "object",
                                                 "--update", "--depfile", "d", "--json"});
        return nlohmann::json::parse(ran.out).value("status", std::string());
    };
    const auto write_mesh = [this](float tilt) {
        GltfMaker maker;
        maker.add(std::vector<float>{0, 0, 0, 1, 0, tilt, 0, 1, 0}, "VEC3", 5126);
        maker.add(std::vector<float>{-tilt, 0, 1, -tilt, 0, 1, -tilt, 0, 1}, "VEC3", 5126);
        maker.add(std::vector<float>{0, 1, 1, 1, 0, 0}, "VEC2", 5126);
        maker.uri = R"("uri":"m.bin",)";
        scratch_.write("m.bin", maker.binary);
        return maker.json(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}})");
    };
    scratch_.write("m.gltf", write_mesh(0.0f));
    EXPECT_EQ(made(), "made");
    EXPECT_NE(scratch_.read("d").find("m.bin"), std::string::npos);
    EXPECT_EQ(made(), "current");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    write_mesh(0.5f);
    EXPECT_EQ(made(), "made");
}

TEST_F(ConvertNormals, WarnsOfOverlapsOrRefusesThem) {
    std::string twice = kSheetObj;
    twice += "f 1/1/1 2/2/2 5/5/5\n";
    scratch_.write("twice.obj", twice);
    const std::vector<std::string> line = {"n.exr", "-o", "x.png", "--mesh", "twice.obj", "--to", "object"};
    const Ran ran = go("convert-normals", line);
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("twice.obj: UVs overlap in"), std::string::npos) << ran.err;
    std::vector<std::string> strict = line;
    strict[2] = "y.png";
    strict.insert(strict.end(), {"--overlap", "error"});
    refuses(strict, 4, "twice.obj: UVs overlap in");
}

TEST_F(ConvertNormals, ExplainsWhatTheMeshLacks) {
    const auto without = [](const std::string& kind) {
        std::string text;
        for (std::string line : lines_of(kSheetObj)) {
            if (line.starts_with(kind + " ")) continue;
            if (line.starts_with("f ")) {
                std::string face;
                for (std::size_t k = 0; k < line.size(); ++k) {
                    const std::size_t end = line.find(' ', k);
                    const std::string word = line.substr(k, end == std::string::npos ? end : end - k);
                    const std::size_t a = word.find('/'), b = word.rfind('/');
                    face += face.empty()   ? "f"
                            : kind == "vt" ? " " + word.substr(0, a) + "/" + word.substr(b)
                                           : " " + word.substr(0, b);
                    if (end == std::string::npos) break;
                    k = end;
                }
                line = face;
            }
            text += line + "\n";
        }
        return text;
    };
    scratch_.write("no_uvs.obj", without("vt"));
    scratch_.write("no_normals.obj", without("vn"));
    scratch_.write("empty.obj", "");
    scratch_.write("materials.obj", std::string(kSheetObj) + "usemtl wood\nf 1/1/1 2/2/2 5/5/5\n");
    const auto line = [](const std::string& mesh, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments = {"n.exr", "-o", "x.png", "--to", "object", "--mesh", mesh};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    refuses(line("no_uvs.obj"), 4, "no_uvs.obj: \"sheet\" has no UVs, which say where the map is");
    refuses(line("no_normals.obj"), 4, "no_normals.obj: \"sheet\" has no normals, which tangent space needs");
    refuses(line("empty.obj"), 4, "empty.obj: ");
    refuses(line("missing.obj"), 3, "missing.obj: ");
    refuses(line("waves.png"), 4, "waves.png: ");
    refuses(line("materials.obj"), 4, "has 2 materials: no material, \"wood\"; --material chooses one");
    refuses(line("sheet.obj", {"--material", "glass"}), 4, "sheet.obj: has no material \"glass\"");
    refuses(line("sheet.obj", {"--primitive", "7"}), 4, "sheet.obj: has no part with this material");
    refuses(line("sheet.obj", {"--uv-set", "1"}), 4, "has no UV set 1; the last one is 0");
    refuses(line("sheet.obj", {"--tangents", "file"}), 4, "has no tangents; make them with --tangents mikktspace");
    does("convert-normals", line("materials.obj", {"--material", "wood"}));
}

TEST_F(ConvertNormals, RefusesContradictions) {
    const auto line = [](std::vector<std::string> more) {
        more.insert(more.begin(), {"n.exr", "-o", "x.png"});
        return more;
    };
    refuses(line({}), 2, "no mesh: give --mesh FILE");
    refuses(line({"--mesh", "-", "--to", "object"}), 2, "a mesh cannot come from standard input");
    refuses(line({"--mesh", "sheet.obj"}), 2, "nothing changes: give --from object");
    refuses(line({"--mesh", "sheet.obj", "--from", "object", "--to", "object"}), 2, "nothing changes");
    refuses(line({"--mesh", "sheet.obj", "--to", "object", "--to-mesh", "sheet.obj"}), 2, "--to-mesh needs tangent");
    refuses(line({"--mesh", "sheet.obj", "--from", "object", "--decoder-in", "godot"}), 2, "needs --from tangent");
    refuses(line({"--mesh", "sheet.obj", "--from", "object", "--y-in", "measured"}), 2, "needs --from tangent");
    refuses(line({"--mesh", "sheet.obj", "--to", "object", "--fade", "1,2"}), 2, "need tangent space");
    refuses(line({"--mesh", "sheet.obj", "--decoder", "unrea"}), 2, "did you mean unreal?");
    refuses({"n.exr", "-o", "x.dds", "--mesh", "sheet.obj", "--to", "object", "--format", "bc5"}, 2, "stores no z");
    does("pack-normals", {"n.exr", "-o", "n.dds", "--effort", "fast"});
    refuses({"n.dds", "-o", "x.png", "--mesh", "sheet.obj", "--from", "object"}, 4, "n.dds: stores no z");
    refuses({"n.exr", "-o", "sheet.obj", "--mesh", "sheet.obj", "--to", "object"}, 2, "sheet.obj");
}

struct Differences {
    int texels = 0, far = 0;
    double mean = 0.0;  // degrees
};

// Between the texels of two maps that are not exactly flat in `covered`: those are background.
Differences differences(const NormalMap& a, const NormalMap& b, const NormalMap& covered) {
    Differences result;
    for (int j = 0; j < a.extent().height; ++j) {
        for (int i = 0; i < a.extent().width; ++i) {
            if (covered.x.at(i, j) == 0.0f && covered.y.at(i, j) == 0.0f) continue;
            const float dx = a.x.at(i, j) - b.x.at(i, j), dy = a.y.at(i, j) - b.y.at(i, j),
                        dz = a.z.at(i, j) - b.z.at(i, j), chord = std::sqrt(dx * dx + dy * dy + dz * dz);
            ++result.texels;
            if (chord > 1.75e-6f) ++result.far;  // 0.0001 degrees
            result.mean += static_cast<double>(chord) * 57.29577951308232;
        }
    }
    result.mean /= std::max(1, result.texels);
    return result;
}

// Real models with their normal maps: there and back, only rounding to 8 bits changes a normal.
TEST_F(ConvertNormals, RealModelsGoToObjectSpaceAndBack) {
    if (!fs::exists(kMeshes)) GTEST_SKIP() << "no shared data";
    struct Model {
        const char *mesh, *map, *material, *decoder;
    };
    const Model models[] = {
        {"FlightHelmet/FlightHelmet.gltf", "FlightHelmet/FlightHelmet_Materials_LeatherPartsMat_Normal.png",
         "LeatherPartsMat", "gltf"},
        {"FlightHelmet/FlightHelmet.gltf", "FlightHelmet/FlightHelmet_Materials_RubberWoodMat_Normal.png",
         "RubberWoodMat", "three"},
        {"Suzanne/02_suzanne.gltf", "Suzanne/02_suzanne_Normal.png", "0", "unity-builtin"},
        {"NormalTangentTest.glb", "FlightHelmet/FlightHelmet_Materials_GlassPlasticMat_Normal.png", "0", "unreal"},
    };
    for (const Model& model : models) {
        SCOPED_TRACE(model.map);
        const std::vector<std::string> shared = {
            "--mesh", (kMeshes / model.mesh).string(), "--decoder", model.decoder, "--material", model.material,
            "--quiet"};
        const auto convert = [&](const std::string& from, const std::string& to, std::vector<std::string> more) {
            more.insert(more.begin(), {from, "-o", to});
            more.insert(more.end(), shared.begin(), shared.end());
            return does("convert-normals", more);
        };
        const std::string input = (kMeshes / model.map).string();
        convert(input, "obj.exr", {"--to", "object", "--format", "float"});
        convert(input, "obj.png", {"--to", "object"});
        convert("obj.exr", "exact.exr", {"--from", "object", "--format", "float", "--padding", "0"});
        convert("obj.exr", "rounded.png", {"--from", "object", "--padding", "0"});
        convert("obj.png", "from8.exr", {"--from", "object", "--format", "float", "--padding", "0"});
        does("pack-normals", {input, "-o", "input.exr", "--format", "float"});
        const NormalMap before = map("input.exr"), after = map("exact.exr");
        const auto near = differences(before, after, after), rounded = differences(before, map("rounded.png"), after),
                   from8 = differences(before, map("from8.exr"), after);
        EXPECT_GT(near.texels, 10000);
        EXPECT_LE(near.far, near.texels / 1000);  // slivers, whose vectors lie nearly in one plane
        EXPECT_LE(rounded.mean, 0.16);
        // Vectors of all directions lose 0.162 in object space, and frames that are not perpendicular add to it.
        EXPECT_LE(from8.mean, 0.175);
    }
}

}  // namespace
}  // namespace tex::cli
