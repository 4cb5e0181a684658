// SPDX-License-Identifier: Apache-2.0
// Charts of a mesh, and the padding around them: N724.

#include "checks/padding.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/check.h>
#include <tex/mesh.h>
#include <tex/pack.h>

#include "mesh/charts.h"

namespace tex {
namespace {

// Squares in the map, each of two triangles: left, top and size in texels of a map of `map` texels.
struct Square {
    int left, top, size;
};

MeshPart part_of(const std::vector<Square>& squares, int map) {
    MeshPart part;
    part.v_axis = YAxis::down;
    part.uvs.resize(1);
    for (const Square& s : squares) {
        const auto first = static_cast<std::uint32_t>(part.positions.size());
        for (const int corner : {0, 1, 2, 3}) {
            const int x = s.left + (corner % 2) * s.size, y = s.top + (corner / 2) * s.size;
            part.uvs[0].push_back(
                {static_cast<float>(x) / static_cast<float>(map), static_cast<float>(y) / static_cast<float>(map)});
            part.positions.push_back({static_cast<float>(x), -static_cast<float>(y), 0.0f});
            part.normals.push_back({0.0f, 0.0f, 1.0f});
        }
        for (const std::uint32_t corner : {0U, 2U, 1U, 1U, 2U, 3U}) part.indices.push_back(first + corner);
    }
    return part;
}

// A map that leans by 30 degrees inside of the squares and up to `padding` texels around them; flat elsewhere.
Texture map_of(const std::vector<Square>& squares, int padding, int size, Encoding encoding = Encoding::rgb8) {
    NormalMap map({size, size});
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            bool lean = false;
            for (const Square& s : squares)
                lean |= i >= s.left - padding && i < s.left + s.size + padding && j >= s.top - padding &&
                        j < s.top + s.size + padding;
            map.x.at(i, j) = lean ? 0.5f : 0.0f;
            map.y.at(i, j) = 0.0f;
            map.z.at(i, j) = lean ? 0.8660254f : 1.0f;
        }
    }
    MipChain chain;
    chain.levels.push_back(std::move(map));
    auto texture = pack(chain, {encoding, YAxis::up, Effort::fast});
    EXPECT_TRUE(texture);
    return std::move(*texture);
}

// The message of N724, or nothing.
std::string message_of(const std::vector<Square>& squares, const Texture& texture) {
    SelectedPart selected;
    selected.part = part_of(squares, texture.extent().width);
    selected.tangents = *make_tangents(selected.part);
    const MeshToCheck mesh{selected, Decoder::gltf, "squares.glb"};
    CheckOptions options;
    options.mesh = &mesh;
    const auto report = check("map", texture, options);
    EXPECT_TRUE(report);
    for (const Finding& finding : report->findings) {
        if (finding.rule->id == "N724") return finding.message;
    }
    return {};
}

TEST(Charts, AreJoinedByPlacesOfTheMap) {
    // The second square touches the first at a corner; the third stands alone.
    const MeshPart part = part_of({{0, 0, 16}, {16, 16, 16}, {40, 0, 8}}, 64);
    EXPECT_EQ(charts_of(part, 0), (std::vector<std::int32_t>{0, 0, 0, 0, 1, 1}));
}

TEST(Padding, OfHalfALevelTexelIsTooSmall) {
    const std::vector<Square> squares{{63, 65, 130}, {291, 67, 130}, {65, 300, 100}};
    // 512: levels 1 and 2 (256 and 128 texels) must be clean, so 3 texels of padding suffice.
    EXPECT_EQ(message_of(squares, map_of(squares, 3, 512)), "");
    EXPECT_EQ(message_of(squares, map_of(squares, 2, 512)).substr(0, 60),
              "from level 2 (128x128) on, charts mix with the background in");
    EXPECT_EQ(message_of(squares, map_of(squares, 0, 512)).substr(0, 60),
              "from level 1 (256x256) on, charts mix with the background in");
    EXPECT_EQ(message_of(squares, map_of(squares, 3, 512, Encoding::bc5)), "");
}

TEST(Padding, IsNotNeededWhereTheBackgroundIsTheSame) {
    const std::vector<Square> squares{{63, 65, 130}, {291, 67, 130}};
    EXPECT_EQ(message_of(squares, map_of(squares, 512, 512)), "");  // all lean
    EXPECT_EQ(message_of(squares, map_of({}, 0, 512)), "");         // all flat
}

TEST(Padding, CannotKeepChartsApartThatAreTooClose) {
    const std::vector<Square> close{{62, 64, 128}, {191, 64, 128}};
    EXPECT_EQ(message_of(close, map_of(close, 512, 512)).substr(0, 58),
              "from level 2 (128x128) on, charts mix with each other in 3");
}

TEST(Padding, IsNotJudgedInSmallMapsOrWithoutCharts) {
    const std::vector<Square> squares{{15, 17, 30}};
    EXPECT_EQ(message_of(squares, map_of(squares, 0, 128)), "");
    const std::vector<Square> whole{{0, 0, 512}};
    EXPECT_EQ(message_of(whole, map_of(whole, 0, 512)), "");
}

TEST(Padding, IsMeasuredInMapsOfOddAndNarrowExtents) {
    const std::vector<Square> squares{{63, 65, 131}};
    EXPECT_NE(message_of(squares, map_of(squares, 0, 509)), "");
    Image image;
    for (int c = 0; c < 4; ++c) image.planes.emplace_back(Extent{1024, 1}, 0.5f);
    for (int i = 0; i < 510; ++i) image.planes[0].at(i, 0) = 0.75f;
    const Stored stored{&image, {Component::x, Component::y, Component::z, Component::one}, false, false};
    Plane<std::int32_t> charts({1024, 1}, kNoChart);
    for (int i = 1; i < 509; ++i) charts.at(i, 0) = 0;
    const auto measure = measure_padding(stored, charts, {});
    ASSERT_TRUE(measure);
    EXPECT_EQ(measure->level, 2);           // one texel of padding
    EXPECT_DOUBLE_EQ(measure->share, 0.5);  // at the right end
}

}  // namespace
}  // namespace tex
