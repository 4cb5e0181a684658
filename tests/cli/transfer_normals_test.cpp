// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/transfer_fixture.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

using TransferNormals = TransferTest;

TEST_F(TransferNormals, MakesEveryFileThatPackNormalsMakes) {
    for (const std::string name : {"n.dds", "n.ktx2", "n.png", "n.exr", "n.tif", "n.tga", "n.bmp", "n.jpg"}) {
        const Ran ran = does({"crate_low.glb", "crate_high.glb", "-o", name});
        EXPECT_NE(ran.out.find(name + ": rays reach 0."), std::string::npos) << ran.out;
        const NormalMap made = map(name);
        EXPECT_EQ(made.extent(), (Extent{96, 96}));
        EXPECT_GT(made.z.at(10, 24), 0.9f) << name;  // beside the knob
    }
    EXPECT_EQ(read_texture(scratch_.path("n.dds"))->levels.size(), 7u);
    does({"crate_low.glb", "crate_high.glb", "-o", "ue.png", "--for", "unreal"});
    EXPECT_EQ(read_texture(scratch_.path("ue.png"))->y_axis, YAxis::down);
    const Ran piped = run(scratch_, "transfer-normals",
                          {"crate_low.glb", "crate_high.glb", "-o", "-", "--container", "png", "--extent", "96"});
    EXPECT_EQ(piped.out, scratch_.read("n.png"));
}

// Nodes that show a mesh again and again multiply its triangles.
TEST_F(TransferNormals, LimitsWhatNodesMultiply) {
    GltfMaker maker;
    const int positions = maker.add(std::vector<float>{-9, -9, 0, 9, -9, 0, 0, 9, 0}, "VEC3", 5126);
    std::string nodes = "{\"mesh\":0}";
    for (int k = 1; k < 100; ++k) nodes += ",{\"mesh\":0}";
    scratch_.write("high.glb", maker.glb("{\"attributes\":{\"POSITION\":" + std::to_string(positions) + "}}",
                                         ",\"nodes\":[" + nodes + "]"));
    refuses({"sheet.obj", "high.glb", "-o", "n.png", "--max-triangles", "1K"}, 4,
            "high.glb: its 100 nodes make 100 triangles of 1: too many copies; --max-triangles allows more than 1K");
    does({"sheet.obj", "high.glb", "-o", "n.png", "--max-triangles", "2K", "--front", "1", "--back", "1"});
    does({"sheet.obj", "high.glb", "-o", "n.png", "--front", "1", "--back", "1"});
}

// The translation of a node was lost in one of the files.
TEST_F(TransferNormals, SaysThatMeshesOfOneSizeLieApart) {
    std::istringstream lines(kSheetObj);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string word;
        double x = 0.0, y = 0.0, z = 0.0;
        words >> word >> x >> y >> z;
        if (word == "v") line = fmt::format("v {} {} {}", x + 0.25, y, z - 0.5);
        text += line + "\n";
    }
    scratch_.write("moved.obj", text);
    const Ran moved = go({"sheet.obj", "moved.obj", "-o", "n.png"});
    EXPECT_NE(moved.err.find("the meshes have one size and do not lie on each other: the high one is off by (0.25, 0, "
                             "-0.5); is the translation of a node missing"),
              std::string::npos)
        << moved.err;
    EXPECT_EQ(go({"sheet.obj", "sheet.obj", "-o", "n.png"}).err.find("do not lie on each other"), std::string::npos);
}

// The sheet in centimetres, and with y up.
TEST_F(TransferNormals, PlacesHighMeshesOfAnotherUnitAndOtherAxes) {
    std::istringstream lines(kSheetObj);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string word;
        double x = 0.0, y = 0.0, z = 0.0;
        words >> word >> x >> y >> z;
        if (word == "v") line = fmt::format("v {} {} {}", 100.0 * x, 100.0 * z, -100.0 * y);
        if (word == "vn") line = fmt::format("vn {} {} {}", x, z, -y);
        text += line + "\n";
    }
    scratch_.write("other.obj", text);
    const Ran far = go({"sheet.obj", "other.obj", "-o", "n.png"});
    EXPECT_NE(far.code, 0);
    EXPECT_NE(far.err.find("both meshes differ in unit or axes, and would fit with --high-scale 0.01 --high-up y"),
              std::string::npos)
        << far.err;
    does({"sheet.obj", "other.obj", "-o", "n.png", "--high-scale", "0.01", "--high-up", "y"});
    does({"sheet.obj", "sheet.obj", "-o", "same.png"});
    const NormalMap moved = map("n.png"), same = map("same.png");
    for (int j = 0; j < 96; ++j) {
        for (int i = 0; i < 96; ++i) {
            ASSERT_NEAR(moved.x.at(i, j), same.x.at(i, j), 0.01f);
            ASSERT_NEAR(moved.y.at(i, j), same.y.at(i, j), 0.01f);
        }
    }
    const Ran turned = go({"other.obj", "sheet.obj", "-o", "n.png"});
    EXPECT_NE(turned.err.find("--high-scale 100 --high-up z"), std::string::npos) << turned.err;
    refuses({"sheet.obj", "other.obj", "-o", "n.png", "--high-scale", "0"}, 2, "--high-scale");
}

// The library makes the same maps of the same files.
TEST_F(TransferNormals, MatchesPartsByName) {
    const auto sheet = [](const std::string& name, float height, int first, bool with_uvs, float x = 0.0f) {
        std::string text = "o " + name + "\nusemtl " + name.substr(0, 1) + "\n";
        for (int k = 0; k < 4; ++k) {
            const int right = k == 1 || k == 2 ? 1 : 0, up = k / 2;
            text += "v " + std::to_string(x + static_cast<float>(right)) + " " + std::to_string(up) + " " +
                    std::to_string(height) + "\n";
            if (with_uvs)
                text += "vt " + std::to_string((x + static_cast<float>(right)) / 2.0f) + " " + std::to_string(up) +
                        "\nvn 0 0 1\n";
        }
        text += "f";
        for (int k = first; k < first + 4; ++k)
            text += " " + std::to_string(k) + (with_uvs ? "/" + std::to_string(k) + "/" + std::to_string(k) : "");
        return text + "\n";
    };
    std::string low = sheet("a_low", 0, 1, true) + sheet("b_low", 0, 5, true, 1.0f);
    for (std::size_t at = low.find("usemtl"); at != std::string::npos; at = low.find("usemtl")) low.erase(at, 9);
    scratch_.write("low.obj", low);
    scratch_.write("high.obj", sheet("B_high", 0.25f, 1, false) + sheet("B_high_more", 0.5f, 5, false, 1.0f) +
                                   sheet("a_high.001", 0.125f, 9, false) + sheet("c_high", 0.5f, 13, false));
    const std::vector<std::string> line = {"low.obj",      "high.obj", "-o",       "n.png", "--front", "1",
                                           "--back",       "1",        "--id-out", "i.png", "--match", "name",
                                           "--height-out", "h.exr"};
    const Ran ran = go(line);
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find("no part of the low mesh belongs to \"c_high\" of the high one: no ray meets them"),
              std::string::npos)
        << ran.err;
    EXPECT_NE(ran.out.find(" a_high.001 ("), std::string::npos) << ran.out;
    const auto heights = read_image(scratch_.path("h.exr")), ids = read_image(scratch_.path("i.png"));
    ASSERT_TRUE(heights && ids);
    EXPECT_EQ(heights->planes[0].at(20, 50), 0.125f);
    EXPECT_EQ(heights->planes[0].at(70, 50), 0.5f);
    const auto report = reports(line);
    ASSERT_EQ(report["ids"]["legend"].size(), 4u);
    const auto color_at = [&](int i) {
        std::string text = "#";
        for (const Plane<float>& plane : ids->planes)
            text += fmt::format("{:02x}", static_cast<int>(255.0f * plane.at(i, 50) + 0.5f));
        return text;
    };
    EXPECT_EQ(report["ids"]["legend"][2]["color"], color_at(20));
    EXPECT_EQ(report["ids"]["legend"][1]["color"], color_at(70));
    EXPECT_EQ(report["ids"]["legend"][1]["texels"], 48 * 96);
    EXPECT_EQ(report["ids"]["legend"][3]["texels"], 0);
    EXPECT_EQ(report["match"]["lone_high"][0], "c_high");
    // The other parts of one file.
    scratch_.write("b.obj", sheet("b_high", 0.25f, 1, false, 1.0f));
    const Ran lone = go({"low.obj", "b.obj", "-o", "n.png", "--match", "name", "--front", "1", "--max-missed", "10"});
    EXPECT_EQ(lone.code, 1);
    EXPECT_NE(lone.err.find("no part of the high mesh belongs to \"a_low\": their texels are missed"),
              std::string::npos)
        << lone.err;
    scratch_.write("d.obj", sheet("d", 0.25f, 1, false, 1.0f));
    refuses({"low.obj", "d.obj", "-o", "x.png", "--match", "name"}, 4,
            "low.obj: no part has a partner: the low mesh has \"a_low\", \"b_low\", the high one \"d\"");
    const auto materials =
        reports({"low.obj", "high.obj", "-o", "n.png", "--front", "1", "--id-out", "i.png", "--id-by", "material"});
    EXPECT_EQ(materials["ids"]["legend"].size(), 3u);
    const auto files = reports(
        {"low.obj", "high.obj", "b.obj", "-o", "n.png", "--front", "1", "--id-out", "i.png", "--id-by", "mesh"});
    EXPECT_EQ(files["ids"]["legend"][1]["name"], "b.obj");
    refuses({"low.obj", "high.obj", "-o", "x.png", "--id-by", "mesh"}, 2, "--id-by needs --id-out");
}

TEST_F(TransferNormals, SaysWhatIsMissedAndHowFarRaysMustReach) {
    const std::vector<std::string> line = {"crate_low.glb", "crate_high.glb", "-o", "n.png", "--front", "1%", "--back",
                                           "0.02"};
    const Ran ran = go(line);
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("crate_low.glb: "), std::string::npos);
    EXPECT_NE(ran.err.find("are missed: no ray hits the high mesh; of those that longer rays can hit, --front "),
              std::string::npos)
        << ran.err;
    const auto report = reports(line);
    EXPECT_GT(report["missed"]["percent"], 1.0);
    const double back = report["missed"]["needed"][1];
    EXPECT_GT(back, 0.02);
    auto limited = line;
    limited.insert(limited.end(), {"--max-missed", "0.5"});
    EXPECT_EQ(go(limited).code, 1);
    EXPECT_TRUE(scratch_.has("n.png"));
    limited[5] = "0.1";
    limited[7] = "0.2";
    EXPECT_EQ(go(limited).code, 0);
}

TEST_F(TransferNormals, TakesManyLowMeshesAndAPatternOfHighOnes) {
    std::filesystem::create_directory(scratch_.path("a"));
    for (const std::string kind : {"low", "high"})
        scratch_.write("a/box_" + kind + ".glb", scratch_.read("crate_" + kind + ".glb"));
    does({"crate_low.glb", "a/box_low.glb", "--high", "{dir}/{stem:-_low}_high.glb", "--out-dir", "out", "--name",
          "{stem:-_low}_n.png", "--height-out", "{stem}_h.exr", "--depfile", "d"});
    EXPECT_EQ(scratch_.read("out/box_n.png"), scratch_.read("out/crate_n.png"));
    EXPECT_TRUE(scratch_.has("out/box_low_h.exr"));
    EXPECT_NE(scratch_.read("d").find("a/box_high.glb"), std::string::npos);
    const auto update = reports({"a/box_low.glb", "--high", "a/box_high.glb", "-o", "u.png", "--update"});
    EXPECT_EQ(update["status"], "made");
    EXPECT_EQ(reports({"a/box_low.glb", "--high", "a/box_high.glb", "-o", "u.png", "--update"})["status"], "current");
}

// Several files and copies are hit together: the nearer one wins.
TEST_F(TransferNormals, HitsAllHighMeshes) {
    const std::string lifted = [] {
        std::string text = kSheetObj;
        for (const char* const from : {"v 1 1 0.4", "v 1 0 0.2", "v 1 2 0.2"}) {
            const std::size_t at = text.find(from);
            text.replace(at, 9, std::string(from, 6) + "0.5");
        }
        return text;
    }();
    scratch_.write("lifted.obj", lifted);
    const auto alone = reports({"sheet.obj", "sheet.obj", "-o", "a.exr"});
    const auto both = reports({"sheet.obj", "sheet.obj", "lifted.obj", "-o", "b.exr"});
    EXPECT_LT(std::abs(alone["heights"]["highest"].get<double>()), 1e-6);
    EXPECT_GT(both["heights"]["highest"], 0.05);
    EXPECT_EQ(both["triangles"]["high"], 16);
}

TEST_F(TransferNormals, RefusesContradictions) {
    refuses({"crate_low.glb", "-o", "n.png"}, 2, "no high mesh: give LOW HIGH... -o FILE, or --high PATTERN");
    refuses({"crate_low.glb", "crate_high.glb", "--out-dir", "out"}, 2, "no high mesh");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--front", "-1"}, 2, "--front");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--front", "near"}, 2, "--front");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--straight-angle", "20"}, 2, "needs --rays straight");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--position-out", "p.png"}, 2, "hold floats");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--height-out", "n.png"}, 2, "n.png");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "crate_low.glb"}, 2, "crate_low.glb");
    refuses({"crate_low.glb", "--high", "-", "-o", "n.png"}, 2, "--high");
    refuses({"crate_low.glb", "--high", "{level}.glb", "-o", "n.png"}, 2, "{level}");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--rays", "staight"}, 2, "did you mean straight?");
}

TEST_F(TransferNormals, ExplainsWhatIsWrongWithTheMeshes) {
    refuses({"crate_low.glb", "missing.glb", "-o", "n.png"}, 3, "missing.glb: ");
    refuses({"missing.glb", "crate_high.glb", "-o", "n.png"}, 3, "missing.glb: ");
    scratch_.write("empty.obj", "");
    refuses({"crate_low.glb", "empty.obj", "-o", "n.png"}, 4, "empty.obj: ");
    scratch_.write("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
    refuses({"crate_low.glb", "nan.obj", "-o", "n.png"}, 4, "nan.obj: ");
    // They have changed places.
    refuses({"crate_high.glb", "crate_low.glb", "-o", "n.png"}, 4, "is it the high mesh? The low one comes first");
    scratch_.write("one.obj", "v -9 -9 1\nv 9 -9 1\nv 0 9 1\nf 1 2 3\n");
    const Ran swapped = go({"crate_low.glb", "one.obj", "-o", "n.png"});
    EXPECT_NE(swapped.err.find("has more triangles, 12, than the high mesh, 1"), std::string::npos) << swapped.err;
    // Nowhere near, and in another unit.
    scratch_.write("far.obj", "v 100 0 0\nv 101 0 0\nv 100 1 0\nf 1 2 3\n");
    refuses({"sheet.obj", "far.obj", "-o", "x.png", "--quiet"}, 4, "both must be in the same place and unit");
    scratch_.write("flat.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nf 1 3 2\n");
    refuses({"sheet.obj", "flat.obj", "-o", "x.png", "--back", "1", "--quiet"}, 4, "face the other way");
    // Nothing to hit, or nowhere to start.
    scratch_.write("point.obj", "v 1 1 0\nv 1 1 0\nv 1 1 0\nf 1 2 3\n");
    refuses({"sheet.obj", "point.obj", "-o", "x.png", "--quiet"}, 4, "no triangle of the high mesh has an area");
    scratch_.write("dot.obj", "v 1 1 0\nv 1 1 0\nv 1 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    refuses({"dot.obj", "sheet.obj", "-o", "x.png", "--quiet"}, 4, "all corners of its triangles are in one place");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "x.png", "--high-color", "none.png", "--color-out", "c.png"}, 4,
            "crate_high.glb: part \"crate_high\" has no UVs, which --high-color needs");
    scratch_.write("materials.obj", std::string(kSheetObj) + "usemtl wood\nf 1/1/1 2/2/2 5/5/5\n");
    refuses({"materials.obj", "sheet.obj", "-o", "x.png"}, 4, "--material chooses one");
}

TEST_F(TransferNormals, MakesOneUdimTile) {
    std::string moved;  // the sheet in tile 1002
    for (const std::string& line : lines_of(kSheetObj)) {
        const std::size_t v = line.rfind(' ');
        if (line.starts_with("vt "))
            moved += "vt " + std::to_string(1.0 + std::stod(line.substr(3))) + line.substr(v) + "\n";
        else
            moved += line + "\n";
    }
    scratch_.write("moved.obj", moved);
    does({"sheet.obj", "sheet.obj", "-o", "a.png"});
    does({"moved.obj", "sheet.obj", "-o", "b.png", "--tile", "1002"});
    EXPECT_EQ(scratch_.read("a.png"), scratch_.read("b.png"));
    refuses({"moved.obj", "sheet.obj", "-o", "c.png", "--tile", "1001"}, 4, "has no triangle in UDIM tile 1001");
}

TEST_F(TransferNormals, OutputsThatCannotBeWrittenAreAnError) {
    scratch_.write("old.png", "old");
    scratch_.write("old.exr", "old");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "no/such/folder.png"}, 3, "no/such/folder.png: ");
    const auto before = scratch_.list();
    const Ran full = shell(scratch_,
                           "ulimit -f 1; transfer-normals crate_low.glb crate_high.glb -o old.png --quiet "
                           "--height-out old.exr --no-sync --extent 256");
    EXPECT_EQ(full.code, 3) << full.err;
    EXPECT_EQ(lines_of(full.err).size(), 1u) << full.err;
    EXPECT_EQ(scratch_.read("old.png"), "old");
    EXPECT_EQ(scratch_.read("old.exr"), "old");
    EXPECT_EQ(scratch_.list(), before);
}

TEST_F(TransferNormals, OverlapsAreAWarningOrAnError) {
    scratch_.write("twice.obj", std::string(kSheetObj) + "f 1/1/1 2/2/2 5/5/5\n");
    const Ran ran = go({"twice.obj", "sheet.obj", "-o", "x.png"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("twice.obj: UVs overlap in"), std::string::npos) << ran.err;
    refuses({"twice.obj", "sheet.obj", "-o", "y.png", "--overlap", "error"}, 4, "UVs overlap in");
}

}  // namespace
}  // namespace tex::cli
