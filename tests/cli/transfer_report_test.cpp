// SPDX-License-Identifier: Apache-2.0
// The page of transfer-normals --report, and the copies of large meshes in it.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/transfer_fixture.h"
#include "reports/html_mesh.h"
#include "reports/page_mesh.h"

namespace tex::cli {
namespace {

MeshPart page_mesh(const std::vector<MeshPart>& parts, std::size_t most) {
    return cli::page_mesh([&](const VisitPart& visit) { std::for_each(parts.begin(), parts.end(), visit); }, most);
}

class TransferPage : public TransferTest {
protected:
    void has(const std::string& text) const { EXPECT_NE(page_.find(text), std::string::npos) << text; }
    void lacks(const std::string& text) const { EXPECT_EQ(page_.find(text), std::string::npos) << text; }

    std::string page_;
};

TEST_F(TransferPage, ShowsBothMeshes) {
    does({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--report", "page.html", "--threads", "1"});
    page_ = scratch_.read("page.html");
    has("data-map=\"0\" data-mesh=\"0\"");
    has("data-map=\"0\" data-mesh=\"1\" data-beside");
    has("The high mesh, all 6,912 triangles.");
    has("crate_low.glb, 12 triangles");
    has("1 map; no texel of ");
    has("Nothing to warn of.");
    has("\"place\":[");  // of the high mesh in the sphere of the low one
    lacks("missed-0");
    lacks("http://");
    does({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--report", "again.html", "--threads", "2"});
    EXPECT_TRUE(scratch_.read("again.html") == page_);
}

TEST_F(TransferPage, ShowsMissedTexelsAndFailures) {
    const Ran ran = go({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--report", "page.html", "--front", "1%",
                        "--back", "1%", "--missed-out", "m.png", "--max-missed", "0.1"});
    EXPECT_EQ(ran.code, 1) << ran.err;
    page_ = scratch_.read("page.html");
    has("data-missed=\"missed-0\"");
    has("id=\"missed-0\"");
    has("missed texels are red");
    has("texels are missed");
    has("; of those that longer rays can hit, ");
    has("class=\"chip error\"");
    const auto picture = read_image(scratch_.path("m.png"));
    ASSERT_TRUE(picture);
    const auto missed = reports({"crate_low.glb", "crate_high.glb", "-o", "n.png", "--front", "1%", "--back", "1%"});
    int red = 0, hit = 0;
    for (int j = 0; j < 96; ++j) {
        for (int i = 0; i < 96; ++i) {
            const float r = picture->planes[0].at(i, j), g = picture->planes[1].at(i, j);
            red += r > 0.9f && g < 0.2f ? 1 : 0;
            hit += r > 0.3f && r == g ? 1 : 0;
        }
    }
    EXPECT_EQ(red, missed["missed"]["texels"]);
    EXPECT_EQ(red + hit, missed["covered"]);

    scratch_.write("a_low.obj", kSheetObj);
    scratch_.write("a_high.obj", kSheetObj);
    scratch_.write("b_low.obj", "v 0 0 0\n");
    scratch_.write("b_high.obj", kSheetObj);
    EXPECT_EQ(go({"a_low.obj", "b_low.obj", "--high", "{dir}/{stem:-_low}_high.obj", "--out-dir", "out", "--report",
                  "page.html", "--quiet"})
                  .code,
              4);
    page_ = scratch_.read("page.html");
    has("1 map; no texel of ");
    has("; 1 failed");
    has("out/b_low.dds");
    has("has no faces");
}

TEST_F(TransferPage, OfFailuresAloneReplacesNothing) {
    scratch_.write("low.obj", "v 0 0 0\n");
    scratch_.write("page.html", "of another run");
    for (const char* output : {"n.png", "n.glb"}) {
        EXPECT_NE(go({"low.obj", "crate_high.glb", "-o", output, "--report", "page.html"}).code, 0) << output;
        EXPECT_EQ(scratch_.read("page.html"), "of another run") << output;
    }
}

TEST_F(TransferPage, IsNoOtherFile) {
    const std::vector<std::string> pair = {"crate_low.glb", "crate_high.glb", "-o", "n.png"};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = pair;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    refuses(with({"--report", "n.png"}), 2, "--report: n.png is the file of the output");
    refuses(with({"--report", "crate_high.glb"}), 2, "--report: crate_high.glb is the input crate_high.glb");
    refuses(with({"--report", "h.exr", "--height-out", "h.exr"}), 2, "--report: h.exr");
    refuses(with({"--report", "d", "--depfile", "d"}), 2, "--report: d is the file of --depfile");
    refuses(with({"--report", "page.html", "--update"}), 2, "--report and --update contradict each other");
    EXPECT_EQ(go(with({"--report", "no/page.html"})).code, 3);
}

TEST_F(TransferPage, TakesColoursOfVertices) {
    // One mesh in three types of file. Assimp makes the FBX.
    const std::string corners[4] = {"0 0 0.1", "2 0 0.1", "2 2 0.1", "0 2 0.1"};
    const int colors[4][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 0}};
    std::string obj,
        ply =
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
            "property list uchar int vertex_indices\nend_header\n";
    for (std::size_t k = 0; k < 4; ++k) {
        obj += fmt::format("v {} {} {} {}\n", corners[k], colors[k][0] / 255, colors[k][1] / 255, colors[k][2] / 255);
        ply += fmt::format("{} {} {} {}\n", corners[k], colors[k][0], colors[k][1], colors[k][2]);
    }
    scratch_.write("c.obj", obj + "f 1 2 3\nf 1 3 4\n");
    scratch_.write("c.ply", ply + "3 0 1 2\n3 0 2 3\n");
    const Ran made = shell(scratch_, "assimp export c.ply c.fbx -ffbxa");
    ASSERT_TRUE(scratch_.has("c.fbx")) << made.out << made.err;
    for (const std::string name : {"obj", "ply", "fbx"}) {
        const auto report = reports({"sheet.obj", "c." + name, "-o", "n.png", "--vertex-color-out", name + ".png",
                                     "--front", "2", "--back", "2"});
        EXPECT_EQ(report["vertex_colors"]["output"], name + ".png");
    }
    EXPECT_EQ(scratch_.read("obj.png"), scratch_.read("ply.png"));
    EXPECT_EQ(scratch_.read("obj.png"), scratch_.read("fbx.png"));
    const auto picture = read_image(scratch_.path("obj.png"));
    ASSERT_TRUE(picture);
    EXPECT_GT(picture->planes[0].at(1, 94), 0.9f);  // red at the lower left
    EXPECT_GT(picture->planes[2].at(94, 1), 0.9f);  // blue at the upper right
    EXPECT_LT(picture->planes[0].at(94, 1), 0.1f);
    const Ran plain =
        run(scratch_, "transfer-normals", {"sheet.obj", "sheet.obj", "-o", "n.png", "--vertex-color-out", "white.png"});
    EXPECT_EQ(plain.code, 0);
    EXPECT_EQ(read_image(scratch_.path("white.png"))->planes[1].at(40, 40), 1.0f);
    EXPECT_NE(plain.err.find("no vertex colours, so that --vertex-color-out is white"), std::string::npos) << plain.err;
}

// A sphere of 2 n^2 triangles around (5, 0, 0), with a radius of 3.
MeshPart sphere(int n) {
    MeshPart part;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            const double around = 2.0 * std::numbers::pi * i / n, up = std::numbers::pi * (0.5 - 1.0 * j / n);
            const Float3 normal{static_cast<float>(std::cos(up) * std::sin(around)), static_cast<float>(std::sin(up)),
                                static_cast<float>(std::cos(up) * std::cos(around))};
            part.normals.push_back(normal);
            part.positions.push_back({5.0f + 3.0f * normal.x, 3.0f * normal.y, 3.0f * normal.z});
            if (i == n || j == n) continue;
            const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + static_cast<std::uint32_t>(n) + 1;
            part.indices.insert(part.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    }
    return part;
}

double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

TEST(PageMesh, KeepsTheShapeOfLargeMeshes) {
    for (const std::size_t most : {std::size_t{20'000}, std::size_t{2'000}}) {
        const MeshPart small = page_mesh({sphere(250)}, most);
        EXPECT_TRUE(check_part(small));
        EXPECT_LE(small.triangles(), most);
        EXPECT_GT(small.triangles(), most / 4);
        const double cell = 6.0 / std::sqrt(static_cast<double>(most) / 7.0);  // roughly
        double facing = 0.0;
        for (std::size_t k = 0; k < small.positions.size(); ++k) {
            const Float3 p = small.positions[k], n = small.normals[k];
            const double x = static_cast<double>(p.x) - 5.0, y = static_cast<double>(p.y), z = static_cast<double>(p.z);
            const double radius = length(x, y, z);
            EXPECT_NEAR(radius, 3.0, cell * cell / 3.0) << k;
            facing = static_cast<double>(n.x) * x + static_cast<double>(n.y) * y + static_cast<double>(n.z) * z;
            EXPECT_GT(facing / radius, std::cos(0.6 * cell)) << k;
        }
    }
    const MeshPart same = page_mesh({sphere(20)}, 10'000);
    EXPECT_EQ(same.triangles(), 800u);
    EXPECT_EQ(same.positions.size(), 441u);
}

TEST(PageMesh, TakesWhatIsHardToSimplify) {
    MeshPart bare = sphere(100);
    bare.normals.clear();  // triangles are flat then
    EXPECT_TRUE(check_part(page_mesh({bare}, 100'000)));
    EXPECT_LE(page_mesh({bare}, 5'000).triangles(), 5'000u);
    MeshPart needles;  // all within one cell but one
    needles.positions = {{0, 0, 0}, {1e-6f, 0, 0}, {0, 1e-6f, 0}, {1, 1, 1}};
    for (int k = 0; k < 50; ++k) needles.indices.insert(needles.indices.end(), {0, 1, 2});
    const MeshPart few = page_mesh({needles}, 10);
    EXPECT_TRUE(check_part(few));
    EXPECT_EQ(few.triangles(), 10u);
    MeshPart point;
    point.positions.assign(3, {2, 2, 2});
    for (int k = 0; k < 50; ++k) point.indices.insert(point.indices.end(), {0, 1, 2});
    EXPECT_TRUE(check_part(page_mesh({point}, 10)));
}

TEST(PageMesh, LiesInTheSphereOfTheOtherMesh) {
    const MeshPart high = page_mesh({sphere(40)}, 100'000);
    MeshPart low = high;
    for (Float3& p : low.positions) p = {p.x * 2.0f - 5.0f, p.y * 2.0f, p.z * 2.0f};  // around the same centre
    const std::vector<Float4> tangents(high.indices.size(), Float4{1, 0, 0, 1});
    const auto mesh = html_mesh_beside({high, tangents}, low);
    ASSERT_TRUE(mesh);
    EXPECT_NEAR(mesh->place[0], 0.0, 1e-6);
    EXPECT_NEAR(mesh->place[3], 0.5, 1e-6);
    EXPECT_EQ(mesh->json()["place"].size(), 4u);
    EXPECT_FALSE(html_mesh({high, tangents}, "")->json().contains("place"));
}

}  // namespace
}  // namespace tex::cli
