// SPDX-License-Identifier: Apache-2.0
// transfer-normals for the UDIM tiles of a low mesh: <UDIM> in the names of outputs.

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/transfer_fixture.h"

namespace tex::cli {
namespace {

// Two sheets side by side, each with the UVs of its own tile: 1001 and 1012.
std::string two_sheets() {
    std::string positions, normals, uvs, faces;
    for (int k = 0; k < 2; ++k) {
        for (const std::string& line : lines_of(kSheetObj)) {
            if (line.starts_with("v ")) {
                positions += "v " + std::to_string(2.0 * k + std::stod(line.substr(2))) + line.substr(3) + "\n";
            } else if (line.starts_with("vn ")) {
                normals += line + "\n";
            } else if (line.starts_with("vt ")) {
                std::size_t end = 0;
                const double u = std::stod(line.substr(3), &end), v = std::stod(line.substr(3 + end));
                uvs += "vt " + std::to_string(u + k) + " " + std::to_string(v + k) + "\n";
            } else if (line.starts_with("f ")) {
                std::string face = "f";
                for (const char* corner = line.c_str() + 2; *corner != '\0'; corner += corner[5] == ' ' ? 6 : 5) {
                    const std::string number = std::to_string(*corner - '0' + 9 * k);
                    face += " " + number + "/" + number + "/" + number;
                }
                faces += face + "\n";
            }
        }
    }
    return positions + normals + uvs + faces;
}

class TransferUdim : public TransferTest {
protected:
    TransferUdim() {
        scratch_.write("low.obj", two_sheets());
        scratch_.write("high.obj", two_sheets());
    }
    static std::vector<nlohmann::json> lines_as_json(const Ran& ran) {
        std::vector<nlohmann::json> lines;
        for (const std::string& line : lines_of(ran.out)) lines.push_back(nlohmann::json::parse(line));
        return lines;
    }
};

TEST_F(TransferUdim, MakesWhatEachTileAloneMakes) {
    const Ran ran = does({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--height-out", "h.<UDIM>.exr", "--json",
                          "--front", "0.5", "--back", "0.5"});
    const auto lines = lines_as_json(ran);
    ASSERT_EQ(lines.size(), 2u) << ran.out;
    for (std::size_t k = 0; k < 2; ++k) {
        const std::string tile = k == 0 ? "1001" : "1012";
        EXPECT_EQ(lines[k]["input"], "low.obj");
        EXPECT_EQ(lines[k]["output"], "n." + tile + ".png");
        EXPECT_EQ(std::to_string(lines[k]["tile"].get<int>()), tile);
        EXPECT_EQ(lines[k]["missed"]["texels"], 0);
        EXPECT_EQ(lines[k]["overlaps"], 0) << "the other tile is not in the map";
        EXPECT_EQ(lines[k]["triangles"]["low"], 8);
        does({"low.obj", "high.obj", "-o", "one.png", "--tile", tile, "--height-out", "one.exr", "--front", "0.5",
              "--back", "0.5"});
        EXPECT_EQ(scratch_.read("n." + tile + ".png"), scratch_.read("one.png"));
        EXPECT_EQ(scratch_.read("h." + tile + ".exr"), scratch_.read("one.exr"));
    }
    EXPECT_FALSE(scratch_.has("n.<UDIM>.png"));
}

// The second sheet is 0.2 above its own low one, and the first 0.1 below.
TEST_F(TransferUdim, StoresHeightsOfAllTilesInOneRange) {
    std::string high;
    int vertex = 0;
    for (const std::string& line : lines_of(two_sheets())) {
        if (!line.starts_with("v ")) {
            high += line + "\n";
            continue;
        }
        const std::size_t last = line.rfind(' ');
        high += line.substr(0, last) + fmt::format(" {}\n", std::stod(line.substr(last)) + (vertex++ < 9 ? -0.1 : 0.2));
    }
    scratch_.write("high.obj", high);
    const Ran ran = go({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--height-out", "h.<UDIM>.png", "--json"});
    const auto lines = lines_as_json(ran);
    ASSERT_EQ(lines.size(), 2u) << ran.out;
    const double low = lines[0]["heights"]["stored"][0], top = lines[0]["heights"]["stored"][1];
    EXPECT_EQ(lines[0]["heights"]["stored"], lines[1]["heights"]["stored"]);
    EXPECT_NEAR(low, -lines[0]["reach"]["back"].get<double>(), 1e-6);
    EXPECT_NEAR(top, lines[0]["reach"]["front"].get<double>(), 1e-6);
    for (const auto& [tile, height] : {std::pair{"1001", -0.1}, std::pair{"1012", 0.2}}) {
        const auto picture = read_image(scratch_.path(fmt::format("h.{}.png", tile)));
        ASSERT_TRUE(picture);
        EXPECT_NEAR(low + (top - low) * static_cast<double>(picture->planes[0].at(48, 48)), height, 2e-3);
    }
    const Ran said = go({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--height-out", "h.<UDIM>.png"});
    EXPECT_NE(said.out.find("h.1012.png: heights from -"), std::string::npos) << said.out;
}

TEST_F(TransferUdim, FollowsTileNameAndManyInputs) {
    does({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--tile", "1012"});
    EXPECT_TRUE(scratch_.has("n.1012.png") && !scratch_.has("n.1001.png"));
    scratch_.write("b_low.obj", two_sheets());
    scratch_.write("b_high.obj", two_sheets());
    scratch_.write("a_low.obj", kSheetObj);
    scratch_.write("a_high.obj", kSheetObj);
    does({"a_low.obj", "b_low.obj", "--high", "{dir}/{stem:-_low}_high.obj", "--out-dir", "out", "--name",
          "{stem:-_low}_n.<UDIM>.png", "--cage", "{dir}/{stem}.obj", "--depfile", "d"});
    EXPECT_TRUE(scratch_.has("out/a_n.1001.png") && scratch_.has("out/b_n.1001.png") &&
                scratch_.has("out/b_n.1012.png"));
    EXPECT_NE(scratch_.read("d").find("b_n.1012.png"), std::string::npos) << scratch_.read("d");
    const Ran again = does({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--update", "--json"});
    EXPECT_NE(again.out.find("\"made\""), std::string::npos) << again.out;
    const Ran current = does({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--update", "--json"});
    EXPECT_EQ(current.out.find("\"made\""), std::string::npos) << current.out;
}

TEST_F(TransferUdim, WarnsOfTrianglesThatLeaveTheirTiles) {
    // One beside all tiles, and one that reaches from tile 1001 into 1002.
    scratch_.write("low.obj", two_sheets() + "vt -1 -1\nvt -2 -1\nvt -1 -2\nvt 0.9 0.1\nvt 1.2 0.1\nvt 0.7 0.4\n" +
                                  "f 1/19/1 2/20/2 5/21/5\nf 1/22/1 2/23/2 5/24/5\n");
    const Ran ran = go({"low.obj", "high.obj", "-o", "n.<UDIM>.png"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    for (const char* part :
         {"low.obj: 1 triangle is in no UDIM tile", "low.obj: 1 triangle reaches out of the UDIM tile",
          "low.obj (tile 1001): UVs overlap in"}) {
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(ran.err.find(part), ran.err.rfind(part)) << "once: " << ran.err;
    }
    const Ran one = go({"low.obj", "high.obj", "-o", "n.png", "--tile", "1001"});
    EXPECT_NE(one.err.find("low.obj: 1 triangle reaches out of the UDIM tile"), std::string::npos) << one.err;
}

TEST_F(TransferUdim, LimitsMissedTexelsTileByTile) {
    scratch_.write("high.obj", kSheetObj);  // nothing is above the second sheet
    const Ran ran =
        go({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--max-missed", "1", "--front", "0.1", "--back", "0.1"});
    EXPECT_EQ(ran.code, 4) << ran.err;
    EXPECT_NE(ran.err.find("low.obj"), std::string::npos) << ran.err;
    EXPECT_TRUE(scratch_.has("n.1001.png")) << "a failure does not stop the others";
    EXPECT_FALSE(scratch_.has("n.1012.png"));
}

TEST_F(TransferUdim, MistakesAreExplained) {
    refuses({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--height-out", "h.png"}, 2,
            "--height-out: h.png: needs <UDIM>, as the output has it: each tile has its own file");
    refuses({"low.obj", "high.obj", "-o", "n.png", "--id-out", "i.<UDIM>.png"}, 2,
            "--id-out: i.<UDIM>.png: <UDIM> needs it in the name of the output, too");
    refuses({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--height-out", "n.<UDIM>.png"}, 2, "n.1001.png");
    refuses({"low.obj", "high.obj", "-o", "n.<UDIM>.png", "--tile", "1005"}, 4, "has no triangle in UDIM tile 1005");
    refuses({"missing.obj", "high.obj", "-o", "n.<UDIM>.png", "--height-out", "h.<UDIM>.exr"}, 3, "missing.obj: ");
    std::string outside = kSheetObj;
    for (std::size_t at = outside.find("vt "); at != std::string::npos; at = outside.find("vt ", at + 1))
        outside.insert(at + 3, "-");
    for (std::size_t at = outside.find("vt -0 "); at != std::string::npos; at = outside.find("vt -0 "))
        outside.replace(at, 6, "vt -2 ");
    scratch_.write("outside.obj", outside);
    refuses({"outside.obj", "high.obj", "-o", "n.<UDIM>.png"}, 4, "has no triangle in a UDIM tile");
}

}  // namespace
}  // namespace tex::cli
