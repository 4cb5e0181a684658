// SPDX-License-Identifier: Apache-2.0
// Colours of vertices: read from meshes, and transferred.

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "mesh/gltf.h"
#include "mesh/obj.h"

namespace tex {
namespace {

const LoadBeside kNothingBeside = [](const std::string&) -> Result<std::vector<std::byte>> {
    return Error{ErrorCode::io, {}, "nothing"};
};

Result<Mesh> parsed_gltf(const std::string& text, bool colors) {
    return parse_gltf({reinterpret_cast<const std::byte*>(text.data()), text.size()}, kNothingBeside, {}, colors);
}

// One triangle whose colours are the accessor `description` of the bytes in `base64`, 48 bytes long.
std::string colored_gltf(const std::string& description, const std::string& base64) {
    return R"({"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1}}]}],)"
           R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
           R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"},{"byteLength":48,)"
           R"("uri":"data:application/octet-stream;base64,)" +
           base64 +
           R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":1,"byteLength":48}],"accessors":[)"
           R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"count":3,)" +
           description + "}]}";
}

// Bytes 0, 51, 102, 153 and so on: multiples of a fifth of 255, which wrap.
const std::string kFifths = "ADNmmcz/ADNmmcz/ADNmmcz/ADNmmcz/ADNmmcz/ADNmmcz/ADNmmcz/ADNmmcz/";

TEST(VertexColors, AreReadFromGltfAsFractions) {
    const auto bytes =
        parsed_gltf(colored_gltf(R"("componentType":5121,"normalized":true,"type":"VEC4")", kFifths), true);
    ASSERT_TRUE(bytes) << bytes.error().message();
    const std::vector<Float3>& colors = bytes->parts[0].colors;
    ASSERT_EQ(colors.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
        const float channels[3] = {colors[k].x, colors[k].y, colors[k].z};
        for (std::size_t c = 0; c < 3; ++c)  // alpha is passed over
            EXPECT_FLOAT_EQ(channels[c], static_cast<float>((4 * k + c) % 6) / 5.0f);
    }
    const auto rgb =
        parsed_gltf(colored_gltf(R"("componentType":5123,"normalized":true,"type":"VEC3")", kFifths), true);
    ASSERT_TRUE(rgb) << rgb.error().message();
    EXPECT_FLOAT_EQ(rgb->parts[0].colors[0].x, static_cast<float>(51 * 256) / 65535.0f);
    EXPECT_TRUE(parsed_gltf(colored_gltf(R"("componentType":5126,"type":"VEC3")", std::string(64, 'A')), true));
}

TEST(VertexColors, AreLeftAloneUnlessSomebodyAsks) {
    const std::string damaged = colored_gltf(R"("componentType":5121,"type":"VEC4")", kFifths);  // not normalised
    const auto without = parsed_gltf(damaged, false);
    ASSERT_TRUE(without) << without.error().message();
    EXPECT_TRUE(without->parts[0].colors.empty());
    const auto with = parsed_gltf(damaged, true);
    ASSERT_FALSE(with);
    EXPECT_NE(with.error().reason.find("COLOR_0 has numbers of the wrong type"), std::string::npos);
    // Not a number.
    const auto nan = parsed_gltf(colored_gltf(R"("componentType":5126,"type":"VEC3")", std::string(64, '/')), true);
    ASSERT_FALSE(nan);
    EXPECT_NE(nan.error().reason.find("color 0 is not a finite number"), std::string::npos) << nan.error().reason;
}

TEST(VertexColors, AreTheNumbersAfterPositionsInObj) {
    const std::string rest = "f 1 2 3\n";
    const auto mesh = parse_obj("v 0 0 0 1 0.5 0.25\nv 1 0 0 0 0 0\nv 0 1 0 .1 .2 .3\n" + rest, true);
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->parts[0].colors.size(), 3u);
    EXPECT_EQ(mesh->parts[0].colors[0].y, 0.5f);
    EXPECT_EQ(mesh->parts[0].colors[2].z, 0.3f);
    // A weight is no colour; neither are words. Not all vertices have one.
    for (const char* const third : {"v 0 1 0", "v 0 1 0 1", "v 0 1 0 1 1", "v 0 1 0 r g b"}) {
        const auto other = parse_obj("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\n" + std::string(third) + "\n" + rest, true);
        ASSERT_TRUE(other) << third;
        EXPECT_TRUE(other->parts[0].colors.empty()) << third;
    }
    EXPECT_TRUE(parse_obj("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n" + rest)->parts[0].colors.empty());
}

// A square in x and y from 0 to 1, whose corners have the colours (x, y, 0.5).
MeshPart square(float z, bool colored) {
    MeshPart part;
    part.positions = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
    part.normals.assign(4, {0, 0, 1});
    part.uvs = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    part.indices = {0, 1, 2, 0, 2, 3};
    if (colored) part.colors = {{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}};
    return part;
}

TEST(VertexColors, AreInterpolatedAtHits) {
    const MeshPart low = square(0.0f, false);
    const std::vector<Float4> tangents(6, Float4{1, 0, 0, 1});
    TransferOptions options;
    options.vertex_colors = true;
    options.subsamples = 2;
    const auto maps = transfer({16, 16}, {low, tangents}, {square(0.1f, true)}, options);
    ASSERT_TRUE(maps) << maps.error().message();
    ASSERT_EQ(maps->vertex_color.planes.size(), 3u);
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i) {
            EXPECT_NEAR(maps->vertex_color.planes[0].at(i, j), (i + 0.5) / 16.0, 1e-6);
            EXPECT_NEAR(maps->vertex_color.planes[1].at(i, j), 1.0 - (j + 0.5) / 16.0, 1e-6);  // rows go down
            EXPECT_NEAR(maps->vertex_color.planes[2].at(i, j), 0.5, 1e-6);
        }
    }
    const auto white = transfer({16, 16}, {low, tangents}, {square(0.1f, false)}, options);
    ASSERT_TRUE(white);
    EXPECT_EQ(white->vertex_color.planes[1].at(3, 3), 1.0f);
    options.vertex_colors = false;
    EXPECT_TRUE(transfer({16, 16}, {low, tangents}, {square(0.1f, true)}, options)->vertex_color.planes.empty());
    MeshPart few = square(0.1f, true);
    few.colors.pop_back();
    EXPECT_EQ(transfer({16, 16}, {low, tangents}, {few}, options).error().code, ErrorCode::bad_data);
}

}  // namespace
}  // namespace tex
