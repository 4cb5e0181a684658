// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

class TransferNormals : public testing::Test {
protected:
    TransferNormals() {
        for (const std::string name : {"crate_low.glb", "crate_high.glb"}) scratch_.add_sample(name, name);
        scratch_.write("sheet.obj", kSheetObj);
    }

    Ran go(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--size", "96", "--no-sync"});
        return run(scratch_, "transfer-normals", arguments);
    }
    Ran does(const std::vector<std::string>& arguments) const {
        Ran ran = go(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err, "");
        return ran;
    }
    nlohmann::json reports(std::vector<std::string> arguments, int code = 0) const {
        arguments.insert(arguments.end(), {"--json", "--quiet"});
        const Ran ran = go(arguments);
        EXPECT_EQ(ran.code, code) << ran.err;
        return nlohmann::json::parse(ran.out);
    }
    void refuses(const std::vector<std::string>& arguments, int code, const std::string& part) const {
        const auto before = scratch_.list();
        const Ran ran = go(arguments);
        EXPECT_EQ(ran.code, code) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(ran.err.find('\n'), ran.err.size() - 1) << ran.err;
        EXPECT_EQ(scratch_.list(), before);
    }
    NormalMap map(const std::string& name, std::size_t level = 0) const {
        const auto texture = read_texture(scratch_.path(name));
        EXPECT_TRUE(texture) << name;
        auto chain = unpack(*texture);
        EXPECT_TRUE(chain) << name;
        return std::move(chain->levels[level]);
    }

    Scratch scratch_;
};

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
                          {"crate_low.glb", "crate_high.glb", "-o", "-", "--container", "png", "--size", "96"});
    EXPECT_EQ(piped.out, scratch_.read("n.png"));
}

// The library makes the same maps of the same files.
TEST_F(TransferNormals, WritesHeightsPositionsAndObjectSpaceFromTheSameRays) {
    does({"crate_low.glb", "crate_high.glb", "-o", "n.exr", "--format", "float", "--mips", "none", "--subsamples", "2",
          "--height-out", "h.exr", "--object-out", "o.exr", "--position-out", "p.exr"});
    const auto low = read_mesh(scratch_.path("crate_low.glb"));
    auto high = read_mesh(scratch_.path("crate_high.glb"));
    ASSERT_TRUE(low && high);
    MeshSelection selection;
    selection.in_scene = true;
    const auto selected = select_part(*low, selection);
    const auto parts = parts_in_scene(std::move(*high));
    ASSERT_TRUE(selected && parts);
    TransferOptions options;
    options.object = options.heights = options.positions = true;
    options.subsamples = 2;
    const auto maps = transfer({96, 96}, {selected->part, selected->tangents}, *parts, options);
    ASSERT_TRUE(maps);
    const NormalMap made = map("n.exr");
    const auto heights = read_image(scratch_.path("h.exr")), positions = read_image(scratch_.path("p.exr"));
    ASSERT_TRUE(heights && positions);
    EXPECT_EQ(positions->normal_encoding, "");
    ASSERT_EQ(positions->planes.size(), 3u);
    for (const int i : {0, 17, 40, 95}) {
        EXPECT_NEAR(made.x.at(i, 30), maps->map.x.at(i, 30), 1e-6f);
        EXPECT_EQ(heights->planes[0].at(i, 30), maps->heights.at(i, 30));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(positions->planes[k].at(i, 30), maps->position[k].at(i, 30));
    }
    EXPECT_NEAR(map("o.exr").y.at(40, 30), maps->object.y.at(40, 30), 1e-3f);  // halves
}

TEST_F(TransferNormals, StoresHeightsFromZeroToOneAndReportsTheirRange) {
    const auto report = reports({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--height-out", "h.png"});
    EXPECT_EQ(report["heights"]["output"], "h.png");
    EXPECT_EQ(report["heights"]["stored"][0], report["heights"]["lowest"]);
    const auto heights = read_image(scratch_.path("h.png"));
    ASSERT_TRUE(heights);
    float low = 1.0f, high = 0.0f;
    for (int j = 0; j < 96; ++j) {
        for (int i = 0; i < 96; ++i) {
            low = std::min(low, heights->planes[0].at(i, j));
            high = std::max(high, heights->planes[0].at(i, j));
        }
    }
    EXPECT_EQ(low, 0.0f);
    EXPECT_EQ(high, 1.0f);
    EXPECT_EQ(report["missed"]["texels"], 0);
    EXPECT_EQ(report["triangles"]["low"], 12);
    EXPECT_EQ(report["triangles"]["high"], 6912);
    EXPECT_EQ(report["tangents"], "mikktspace");
    EXPECT_GT(report["reach"]["back"], 0.05);
}

TEST_F(TransferNormals, SaysWhatIsMissedAndHowFarRaysMustReach) {
    const std::vector<std::string> line = {"crate_low.glb", "crate_high.glb", "-o", "n.png", "--front", "1%", "--back",
                                           "0.02"};
    const Ran ran = go(line);
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("crate_low.glb: "), std::string::npos);
    EXPECT_NE(ran.err.find("are missed: no ray hits the high mesh; --front "), std::string::npos) << ran.err;
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
                           "--height-out old.exr --no-sync --size 256");
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
    EXPECT_NE(ran.err.find("twice.obj: several triangles cover the same texel in"), std::string::npos) << ran.err;
    refuses({"twice.obj", "sheet.obj", "-o", "y.png", "--overlap", "error"}, 4, "several triangles cover");
}

}  // namespace
}  // namespace tex::cli
