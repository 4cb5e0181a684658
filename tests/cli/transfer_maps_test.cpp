// SPDX-License-Identifier: Apache-2.0
// transfer-normals: the maps beside the normals, and the files that guide rays.

#include <algorithm>
#include <cmath>

#include "cli/transfer_fixture.h"

namespace tex::cli {
namespace {

using TransferMaps = TransferTest;

TEST_F(TransferMaps, WritesHeightsPositionsAndObjectSpaceFromTheSameRays) {
    does({"crate_low.glb", "crate_high.glb", "-o", "n.exr", "--format", "float", "--mips", "none", "--subsamples", "2",
          "--height-out", "h.exr", "--object-out", "o.exr", "--position-out", "p.exr"});
    TransferOptions options;
    options.object = options.heights = options.positions = true;
    options.subsamples = 2;
    const auto maps = transferred(options);
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

TEST_F(TransferMaps, StoresHeightsFromZeroToOneAndReportsTheirRange) {
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

// The library makes the same maps of the same files.
TEST_F(TransferMaps, WritesOcclusionBentNormalsAndThickness) {
    const auto report =
        reports({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--occlusion-out", "a.exr", "--bent-out", "b.png",
                 "--thickness-out", "t.exr", "--rays-per-hit", "16", "--occlusion-distance", "50%", "--y", "down"});
    TransferOptions options;
    options.occlusion = options.bent = options.thickness = true;
    options.rays_per_hit = 16;
    options.occlusion_distance = {Reach::Unit::percent, 50.0};
    const auto maps = transferred(options);
    ASSERT_TRUE(maps);
    EXPECT_EQ(report["rays"], maps->rays);
    EXPECT_FLOAT_EQ(report["thickness"]["highest"].get<float>(), maps->thickest);
    const auto open = read_image(scratch_.path("a.exr")), thick = read_image(scratch_.path("t.exr")),
               bent = read_image(scratch_.path("b.png"));
    ASSERT_TRUE(open && thick && bent);
    for (const int i : {0, 17, 40, 95}) {
        EXPECT_EQ(open->planes[0].at(i, 30), maps->occlusion.at(i, 30));
        EXPECT_EQ(thick->planes[0].at(i, 30), maps->thickness.at(i, 30));
        EXPECT_NEAR(bent->planes[0].at(i, 30), 0.5f + 0.5f * maps->bent.x.at(i, 30), 0.01f);
        EXPECT_NEAR(bent->planes[1].at(i, 30), 0.5f - 0.5f * maps->bent.y.at(i, 30), 0.01f);
    }
    const Ran ran = does({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--occlusion-out", "a.png"});
    EXPECT_NE(ran.out.find(" million rays, "), std::string::npos) << ran.out;
    // The bar, which is drawn ten times a second at most, knows it, too.
    const Ran bar = go({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--bent-out", "a.png", "--progress", "always",
                        "--rays-per-hit", "512", "--threads", "1"});
    EXPECT_NE(bar.err.find(" M rays/s, crate_low.glb"), std::string::npos) << bar.err;
    const auto stored = reports({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--thickness-out", "t.png"});
    EXPECT_EQ(stored["thickness"]["stored"][1], stored["thickness"]["highest"]);
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n2.png", "--rays-per-hit", "8"}, 2,
            "--rays-per-hit needs --occlusion-out, --occlusion-into, --bent-out or --thickness-out");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n2.png", "--bent-out", "n2.png"}, 2, "n2.png");
    refuses({"crate_low.glb", "crate_high.glb", "-o", "n2.png", "--bent-out", "b2.png", "--rays-per-hit", "0"}, 2,
            "--rays-per-hit");
}

// Two sheets that lie on each other, and a part that only one of the meshes has.
TEST_F(TransferMaps, IsGuidedByCagesSkewAndOffsets) {
    const auto cage_at = [](double height) {  // without UVs and normals
        std::string cage;
        for (const std::string& line : lines_of(kSheetObj)) {
            if (line.starts_with("v ")) {
                const std::size_t z = line.rfind(' ');
                cage += line.substr(0, z + 1) + std::to_string(std::stod(line.substr(z)) + height) + "\n";
            } else if (line.starts_with("f ")) {
                std::string corners;
                for (std::size_t at = line.find(' '); at != std::string::npos; at = line.find(' ', at + 1))
                    corners += " " + line.substr(at + 1, line.find('/', at) - at - 1);
                cage += "f" + corners + "\n";
            }
        }
        return cage;
    };
    scratch_.write("sheet_cage.obj", cage_at(0.5));
    scratch_.write("sunk_cage.obj", cage_at(-0.5));
    const auto caged = reports({"sheet.obj", "sheet.obj", "-o", "a.png", "--cage", "{stem}_cage.obj"});
    EXPECT_NEAR(caged["reach"]["front"].get<double>(), 0.5, 1e-6);
    EXPECT_EQ(caged["missed"]["texels"], 0);
    does({"sheet.obj", "sheet.obj", "-o", "a.png", "--cage", "sheet.obj", "--back", "1"});
    refuses({"sheet.obj", "sheet.obj", "-o", "b.png", "--cage", "crate_low.glb"}, 4,
            "crate_low.glb: has 12 triangles, but the low mesh has 8: a cage is the low mesh, pushed outwards");
    // From a cage inside of it, rays meet the high mesh from behind.
    refuses({"sheet.obj", "sheet.obj", "-o", "b.png", "--cage", "sunk_cage.obj", "--quiet"}, 4,
            "The cage may lie inside");
    EXPECT_NE(go({"sheet.obj", "sheet.obj", "-o", "b.png", "--cage", "sunk_cage.obj", "--backfaces"})
                  .err.find("if it is not, move the cage outwards there"),
              std::string::npos);
    refuses({"sheet.obj", "sheet.obj", "-o", "b.png", "--cage", "none.obj"}, 3, "none.obj: ");
    refuses({"sheet.obj", "sheet.obj", "-o", "sheet_cage.obj", "--cage", "sheet_cage.obj"}, 2, "sheet_cage.obj");
    refuses({"sheet.obj", "sheet.obj", "-o", "b.png", "--cage", "c.obj", "--front", "1"}, 2, "--cage decides");
    refuses({"sheet.obj", "sheet.obj", "-o", "b.png", "--skew", "s.png", "--rays", "smooth"}, 2,
            "--skew needs --rays straight");
    refuses({"sheet.obj", "sheet.obj", "-o", "b.png", "--skew", "s.png", "--straight-width", "1"}, 2, "--skew decides");
    // White and black pictures are straight and smooth rays.
    const auto write_plane = [&](const std::string& name, float value) {
        RoughnessChain chain;
        chain.levels.emplace_back(Extent{2, 2}, value);
        const auto texture = pack_roughness(chain, Format::r8_unorm);
        ASSERT_TRUE(texture);
        const auto bytes = encode_file(*texture, Container::png);
        ASSERT_TRUE(bytes);
        scratch_.write(name, std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
    };
    write_plane("white.png", 1.0f);
    write_plane("black.png", 0.0f);
    does({"crate_low.glb", "crate_high.glb", "-o", "smooth.png"});
    does({"crate_low.glb", "crate_high.glb", "-o", "black_n.png", "--skew", "black.png"});
    EXPECT_EQ(scratch_.read("smooth.png"), scratch_.read("black_n.png"));
    EXPECT_EQ(go({"crate_low.glb", "crate_high.glb", "-o", "white_n.png", "--skew", "white.png"}).code, 0);
    EXPECT_NE(scratch_.read("smooth.png"), scratch_.read("white_n.png"));
    const auto offset = reports({"crate_low.glb", "crate_high.glb", "-o", "o.png", "--offset", "black.png"});
    EXPECT_LE(offset["heights"]["highest"].get<double>(), 1e-6);
    EXPECT_NE(go({"crate_low.glb", "crate_high.glb", "-o", "o.png", "--offset", "black.png"})
                  .err.find("raise the factors of --offset there, or --front"),
              std::string::npos);
}

TEST_F(TransferMaps, TakesPicturesOfTheHighMesh) {
    does({"sheet.obj", "sheet.obj", "-o", "flat.png"});
    does({"crate_low.glb", "crate_high.glb", "-o", "crate_n.png"});
    // The sheet's own map comes back.
    does({"sheet.obj", "sheet.obj", "-o", "again.png", "--high-normals", "crate_n.png", "--high-color", "crate_n.png",
          "--color-out", "c.png"});
    const auto a = read_image(scratch_.path("crate_n.png")), b = read_image(scratch_.path("again.png")),
               c = read_image(scratch_.path("c.png"));
    ASSERT_TRUE(a && b && c);
    for (int j = 0; j < 96; ++j) {
        for (int i = 0; i < 96; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_NEAR(a->planes[k].at(i, j), b->planes[k].at(i, j), 0.0045f) << i << " " << j;
                ASSERT_NEAR(a->planes[k].at(i, j), c->planes[k].at(i, j), 1e-6f);
            }
        }
    }
    const auto floats =
        reports({"sheet.obj", "sheet.obj", "-o", "n.png", "--high-color", "crate_n.png", "--color-out", "c.exr"});
    EXPECT_EQ(floats["colors"]["output"], "c.exr");
    refuses({"sheet.obj", "sheet.obj", "-o", "x.png", "--color-out", "c2.png"}, 2, "--color-out needs --high-color");
    refuses({"sheet.obj", "sheet.obj", "-o", "x.png", "--high-color", "crate_n.png"}, 2,
            "--high-color needs --color-out");
    refuses({"sheet.obj", "sheet.obj", "-o", "x.png", "--high-y", "down"}, 2, "--high-y needs --high-normals");
    refuses({"sheet.obj", "sheet.obj", "-o", "x.png", "--high-normals", "wood=crate_n.png"}, 4,
            "--high-normals: the high mesh has no material \"wood\"");
    refuses({"sheet.obj", "sheet.obj", "-o", "x.png", "--high-normals", "none.png"}, 3, "none.png: ");
    refuses({"sheet.obj", "sheet.obj", "-o", "crate_n.png", "--high-normals", "crate_n.png"}, 2, "crate_n.png");
    scratch_.write("bare.obj", "o bare\nv 0 0 0\nv 2 0 0\nv 2 2 0\nf 1 2 3\n");
    refuses({"sheet.obj", "bare.obj", "-o", "x.png", "--high-normals", "crate_n.png", "--quiet"}, 4,
            "part \"bare\" has no UVs, which --high-normals needs");
}

}  // namespace
}  // namespace tex::cli
