// SPDX-License-Identifier: Apache-2.0
// High meshes whose nodes show one mesh again and again.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/transfer_fixture.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

class TransferPlaces : public TransferTest {
protected:
    // 36 nodes that show a mesh of 8,192 triangles, as one mesh (places) or as one for each node (copies).
    void write_high(const std::string& name, bool in_places) {
        constexpr int kCells = 64, kNodes = 36;
        GltfMaker maker;
        std::vector<float> positions, colors;
        std::vector<std::uint16_t> indices;
        for (int j = 0; j <= kCells; ++j) {
            for (int i = 0; i <= kCells; ++i) {
                const float x = static_cast<float>(i) / kCells - 0.5f, y = static_cast<float>(j) / kCells - 0.5f;
                positions.insert(positions.end(), {x, y, 0.02f * std::sin(20.0f * x) * std::cos(17.0f * y)});
                colors.insert(colors.end(), {0.5f + x, 0.5f + y, 0.3f});
            }
        }
        for (int k = 0; k < kCells * kCells; ++k) {
            const int a = k / kCells * (kCells + 1) + k % kCells, c = a + kCells + 1;
            for (const int v : {a, a + 1, c + 1, a, c + 1, c}) indices.push_back(static_cast<std::uint16_t>(v));
        }
        const auto primitive = [&] {
            const int position = maker.add(positions, "VEC3", 5126), color = maker.add(colors, "VEC3", 5126),
                      index = maker.add(indices, "SCALAR", 5123);
            return fmt::format(R"({{"attributes":{{"POSITION":{},"COLOR_0":{}}},"indices":{}}})", position, color,
                               index);
        };
        std::string meshes = primitive(), nodes;
        for (int k = 0; k < kNodes; ++k) {
            if (k > 0 && !in_places) meshes += R"(]},{"primitives":[)" + primitive();
            const double size = k % 5 == 0 ? -0.9 : 0.8 + 0.01 * k;
            nodes += fmt::format(
                R"({}{{"mesh":{},"name":"n{}","translation":[{},{},{}],"rotation":[0,0,{},0.8],"scale":[{},{},0.5]}})",
                k == 0 ? "" : ",", in_places ? 0 : k, k, k % 6 / 2.5, k / 6 / 2.5, 0.001 * k, k % 2 == 0 ? 0.6 : -0.6,
                size, 1.0 - 0.005 * k);
        }
        scratch_.write(name, maker.glb(meshes, ",\"nodes\":[" + nodes + "]"));
    }
};

TEST_F(TransferPlaces, MakeWhatCopiesMake) {
    write_high("places.glb", true);
    write_high("copies.glb", false);
    std::vector<nlohmann::json> reports;
    for (const std::string name : {"places", "copies"}) {
        reports.push_back(this->reports({"sheet.obj",
                                         name + ".glb",
                                         "-o",
                                         name + ".png",
                                         "--front",
                                         "1",
                                         "--back",
                                         "1",
                                         "--height-out",
                                         name + "_h.exr",
                                         "--occlusion-out",
                                         name + "_ao.png",
                                         "--rays-per-hit",
                                         "8",
                                         "--id-out",
                                         name + "_id.png",
                                         "--id-by",
                                         "part",
                                         "--vertex-color-out",
                                         name + "_vc.png"}));
        const Ran automatic = go({"sheet.obj", name + ".glb", "-o", name + "_auto.png", "--report", name + ".html"});
        EXPECT_EQ(automatic.code, 0) << automatic.err;
        EXPECT_NE(automatic.err.find("17 of 9216 texels"), std::string::npos) << automatic.err;
    }
    for (const std::string out : {".png", "_h.exr", "_ao.png", "_id.png", "_vc.png", "_auto.png"})
        EXPECT_TRUE(scratch_.read("places" + out) == scratch_.read("copies" + out)) << out;
    const nlohmann::json &a = reports[0], &b = reports[1];
    EXPECT_EQ(a["triangles"]["high"], 36 * 8192);
    EXPECT_EQ(a["triangles"], b["triangles"]);
    EXPECT_EQ(a["rays"], b["rays"]);
    EXPECT_EQ(a["ids"]["legend"], b["ids"]["legend"]);
    EXPECT_EQ(a["ids"]["legend"].size(), 36u);
}

TEST_F(TransferPlaces, HaveALimit) {
    write_high("places.glb", true);
    refuses({"sheet.obj", "places.glb", "-o", "n.png", "--max-triangles", "575"}, 4,
            "places.glb: its 36 nodes make 294912 triangles of 8192: too many copies; --max-triangles allows more than "
            "575");
    does({"sheet.obj", "places.glb", "-o", "n.png", "--max-triangles", "576", "--front", "1", "--back", "1"});
}

}  // namespace
}  // namespace tex::cli
