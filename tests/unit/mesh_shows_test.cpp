// SPDX-License-Identifier: Apache-2.0
// The pictures that only a mesh has: tangents, UVs and seams, at places computed by hand.

#include "preview/mesh_shows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "preview/legend.h"
#include "preview/tangent_lines.h"
#include "unit/mesh_pictures.h"

namespace tex {
namespace {

constexpr int kSize = 1024;  // lines are 3 pixels wide

Pixel pixel_of(render::Code code) { return {code.r, code.g, code.b}; }

const Pixel kTangent = pixel_of(render::kTangentColor), kBinormal = pixel_of(render::kBinormalColor),
            kNormal = pixel_of(render::kNormalColor);

Texture front_view(const MeshWithTangents& mesh, Show show, const MipChain& map, int size = kSize) {
    PreviewOptions options;
    options.show = show;
    options.camera = Camera{0.0f, 0.0f, 0.0f};
    options.size = {size, size};
    return mesh_picture(mesh, map, options);
}

const MipChain& flat() {
    static const MipChain map = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    return map;
}

TEST(MeshShows, TangentSpacesOfASquare) {
    const double corner = std::sqrt(0.5), length = 0.15;
    for (const float w : {1.0f, -1.0f}) {
        const Texture picture = front_view(quad(0.5f, w), Show::tangents, flat());
        for (const double x : {-corner, corner}) {
            for (const double y : {-corner, corner}) {
                const auto at = [&](double right, double up) {
                    return front_pixel(picture, kSize, x + right * length, y + up * length);
                };
                EXPECT_EQ(at(0.5, 0.0), kTangent);
                EXPECT_EQ(at(0.97, 0.0), kTangent);
                EXPECT_NE(at(1.08, 0.0), kTangent);
                EXPECT_NE(at(-0.5, 0.0), kTangent);
                EXPECT_EQ(at(0.0, 0.5 * static_cast<double>(w)), kBinormal);
                EXPECT_NE(at(0.0, -0.5 * static_cast<double>(w)), kBinormal);
                EXPECT_EQ(at(0.0, 0.0), kNormal);  // it points to the viewer
            }
        }
    }
}

// The lines of the vertices in front, in the middle of each line.
TEST(MeshShows, TangentSpacesOfASphere) {
    const MeshWithTangents mesh = fine_sphere(8);
    const Texture picture = front_view(mesh, Show::tangents, flat());
    int seen = 0;
    for (std::size_t k = 0; k < mesh.part.indices.size(); ++k) {
        const Float3 n = mesh.part.normals[mesh.part.indices[k]];
        if (n.z < 0.8f) continue;  // elsewhere lines of neighbours hide each other
        ++seen;
        const Float4 t = mesh.tangents[k];
        const double normal[3] = {double(n.x), double(n.y), double(n.z)},
                     tangent[3] = {double(t.x), double(t.y), double(t.z)};
        const double binormal[2] = {normal[1] * tangent[2] - normal[2] * tangent[1],
                                    normal[2] * tangent[0] - normal[0] * tangent[2]};
        const auto along = [&](double x, double y, double part) {
            const double raised = 1.015, length = 0.15 * part;
            return front_pixel(picture, kSize, raised * normal[0] + length * x, raised * normal[1] + length * y);
        };
        EXPECT_EQ(along(tangent[0], tangent[1], 0.6), kTangent) << k;
        EXPECT_EQ(along(binormal[0], binormal[1], 0.6), kBinormal) << k;
        EXPECT_EQ(along(normal[0], normal[1], 0.9), kNormal) << k;
    }
    EXPECT_GT(seen, 20);
}

TEST(MeshShows, HidesTheTangentSpacesBehindTheMesh) {
    MeshWithTangents mesh = quad(1.0f);
    // A second square behind the first, with other tangents.
    const MeshWithTangents back = quad(0.5f);
    for (const std::uint32_t v : back.part.indices) mesh.part.indices.push_back(v + 4);
    for (const Float3& p : back.part.positions) {
        mesh.part.positions.push_back({p.x, p.y, -0.4f});
        mesh.part.normals.push_back({0, 0, 1});
        mesh.part.uvs[0].push_back({0, 0});
    }
    mesh.tangents.insert(mesh.tangents.end(), back.tangents.begin(), back.tangents.end());
    const Texture picture = front_view(mesh, Show::tangents, flat(), 256);
    int colored = 0;
    for (int j = 64; j < 192; ++j) {
        for (int i = 64; i < 192; ++i) {
            const Pixel p = pixel(picture, i, j);
            colored += p[0] == p[1] && p[1] == p[2] ? 0 : 1;
        }
    }
    EXPECT_EQ(colored, 0);
}

// Two squares side by side. The map is tilted to +x; on the right square its charts are turned, so that it is tilted
// to +y there: the angle between both is acos(3 / 4).
TEST(MeshShows, SeamsHaveTheColourOfTheirAngle) {
    MeshWithTangents mesh;
    mesh.part.uvs.resize(1);
    for (const float side : {-1.0f, 0.0f}) {
        const auto first = static_cast<std::uint32_t>(mesh.part.positions.size());
        for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
            mesh.part.positions.push_back({side + x, y - 0.5f, 0.0f});
            mesh.part.normals.push_back({0, 0, 1});
            mesh.part.uvs[0].push_back(side < 0.0f ? Float2{0.4f * x, 0.4f * y}
                                                   : Float2{0.5f + 0.4f * y, 0.9f - 0.4f * x});
        }
        for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) {
            mesh.part.indices.push_back(first + k);
            mesh.tangents.push_back(side < 0.0f ? Float4{1, 0, 0, 1} : Float4{0, 1, 0, 1});
        }
    }
    const MipChain tilted = constant({16, 16}, 0.5f, 0.0f, std::sqrt(0.75f));
    const Texture picture = front_view(mesh, Show::seams, tilted, 400);
    EXPECT_EQ(picture.extent(), (Extent{400, 400 + render::kLegendRows}));
    const double degrees = std::acos(0.75) * 180.0 / 3.14159265358979;
    const render::Vec3 color = render::ColorScale{"", 0.0, 45.0}.color(degrees);
    const Pixel expected = {render::display_code(color.x), render::display_code(color.y),
                            render::display_code(color.z)};
    EXPECT_EQ(pixel(picture, 199, 200), expected);
    EXPECT_EQ(pixel(picture, 200, 200), expected);
    const Pixel beside = pixel(picture, 150, 200);
    EXPECT_EQ(beside[0], beside[1]);  // grey: edges inside of a chart are no seams
}

TEST(MeshShows, SaysThatThereAreNoSeams) {
    const Texture with = front_view(quad(), Show::seams, flat(), 128);
    EXPECT_EQ(with.extent(), (Extent{128, 128 + 18}));
}

TEST(MeshShows, UvLayoutOfASquare) {
    MeshWithTangents mesh = quad();
    for (Float2& uv : mesh.part.uvs[0]) uv = {0.25f + 0.5f * uv.x, 0.25f + 0.5f * uv.y};
    const Texture upright = front_view(mesh, Show::uv, flat(), 256);
    const Pixel outside = pixel(upright, 20, 20), inside = pixel(upright, 80, 100);
    EXPECT_EQ(outside, (Pixel{70, 70, 140}));  // 0.55 of the flat map's colours
    EXPECT_GT(inside[0], outside[0]);
    for (const int k : {66, 100, 150, 190}) {
        const int white = pixel(upright, 64, k)[0];  // half of the pixel is a line
        EXPECT_GT(white, 140) << k;
        EXPECT_EQ(pixel(upright, 63, k), outside) << k;
        EXPECT_GT(pixel(upright, k, 64)[0], 140) << k;
        EXPECT_GT(pixel(upright, 191, k)[0], 140) << k;
        EXPECT_EQ(pixel(upright, 192, k), outside) << k;
    }
    // Whole repeats of the map change nothing; v may point down.
    MeshWithTangents moved = mesh;
    for (Float2& uv : moved.part.uvs[0]) uv = {uv.x + 3.0f, 1.0f - (uv.y - 2.0f)};
    moved.part.v_axis = YAxis::down;
    EXPECT_EQ(difference(front_view(moved, Show::uv, flat(), 256), upright), 0);
    for (Float2& uv : mesh.part.uvs[0]) uv.x = 1.0f - uv.x;
    const Pixel mirrored = pixel(front_view(mesh, Show::uv, flat(), 256), 80, 100);
    EXPECT_GT(mirrored[0], mirrored[1]);
    EXPECT_EQ(inside[0], inside[1]);
}

TEST(MeshShows, UvLayoutRepeatsTrianglesThatLeaveTheMap) {
    MeshWithTangents mesh = quad();
    for (Float2& uv : mesh.part.uvs[0]) uv = {0.75f + 0.5f * uv.x, 0.25f + 0.5f * uv.y};
    const Texture picture = front_view(mesh, Show::uv, flat(), 64);
    const Pixel outside = pixel(picture, 32, 32);
    EXPECT_NE(pixel(picture, 60, 32), outside);
    EXPECT_NE(pixel(picture, 4, 32), outside);
    EXPECT_EQ(pixel(picture, 32, 4), outside);
}

TEST(MeshShows, UvLayoutRefusesManyTrianglesThatRepeatTheMap) {
    MeshWithTangents mesh = quad();
    for (Float2& uv : mesh.part.uvs[0]) uv = {15.5f * uv.x, 15.5f * uv.y};
    for (int k = 0; k < 12; ++k) {  // 2 triangles become 8192, of 256 repeats each
        mesh.part.indices.insert(mesh.part.indices.end(), mesh.part.indices.begin(), mesh.part.indices.end());
        mesh.tangents.insert(mesh.tangents.end(), mesh.tangents.begin(), mesh.tangents.end());
    }
    const TangentSpace space = mesh.space();
    PreviewOptions options;
    options.show = Show::uv;
    options.size = {16, 16};
    const auto picture = preview({.map = &flat(), .mesh = &space}, options);
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().reason, "triangles of the mesh cover more than 4 repeats of the map");
}

TEST(MeshShows, UvLayoutHasTheProportionsOfTheMap) {
    const MipChain map = constant({32, 16}, 0.0f, 0.0f, 1.0f);
    PreviewOptions options;
    options.show = Show::uv;
    options.size = {200, 0};
    options.legend = false;
    EXPECT_EQ(mesh_picture(quad(), map, options).extent(), (Extent{200, 100}));
}

}  // namespace
}  // namespace tex
