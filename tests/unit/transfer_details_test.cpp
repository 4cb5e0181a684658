// SPDX-License-Identifier: Apache-2.0
// What the high mesh has beside its shape: normal maps, colours, ids.

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "unit/transfers.h"

namespace tex {
namespace {

// The map of the high mesh comes back, where both meshes are the same. Coverage places corners on a grid within texels,
// so that hits lie up to a few thousandths of a texel beside the centres; the map turns by 10 degrees in a texel.
TEST(TransferDetails, NormalMapsOfTheHighMeshComeBack) {
    std::vector<MeshPart> parts = {wavy_part(9, true), square(0.0f, 1.0f)};
    for (const Solid& solid : {sphere(), torus(), smooth_cube()}) parts.push_back(solid.part);
    const Extent extent{96, 64};
    const NormalMap map = bumpy_map(extent);
    for (MeshPart& part : parts) {
        for (const auto& decoder : kDecoderNames) {
            const auto tangents = make_tangents(part);
            ASSERT_TRUE(tangents);
            TransferInputs inputs;
            inputs.high_details = {HighDetail{&map, &*tangents, decoder.value}};
            const TangentSpace space{part, *tangents, 0, decoder.value};
            const auto maps = transfer(extent, space, only(part), inputs, all_maps());
            ASSERT_TRUE(maps) << maps.error().message();
            const auto object = to_object_space(map, space);
            ASSERT_TRUE(object);
            double most = 0.0;
            const auto hits = for_hits(*maps, [&](int i, int j) {
                most = std::max(most, degrees_between(vector_at(maps->object, i, j), vector_at(object->map, i, j)));
                most = std::max(most, degrees_between(vector_at(maps->map, i, j), vector_at(map, i, j)));
            });
            EXPECT_GT(hits, 2500);
            EXPECT_LT(most, 0.04) << decoder.name;
        }
    }
}

// From other tangents and another decoder to those of the low mesh, as convert does it.
TEST(TransferDetails, NormalMapsChangeTheirTangentSpace) {
    const MeshPart part = torus().part;
    const Extent extent{96, 64};
    const NormalMap map = bumpy_map(extent);
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    std::vector<Float4> turned = *tangents;  // about the normals
    for (std::size_t c = 0; c < turned.size(); ++c) {
        const Float3 n = unit_vector(part.normals[part.indices[c]]), t{turned[c].x, turned[c].y, turned[c].z};
        turned[c] = {n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x, turned[c].w};
    }
    TransferInputs inputs;
    inputs.high_details = {HighDetail{&map, &turned, Decoder::unity_builtin}};
    const auto maps = transfer(extent, {part, *tangents}, only(part), inputs);
    const auto refitted = refit(map, {part, turned, 0, Decoder::unity_builtin}, {part, *tangents});
    ASSERT_TRUE(maps && refitted);
    EXPECT_LT(angles_between(maps->map, refitted->map, refitted->coverage).max, 1e-3);
}

TEST(TransferDetails, ColorsAreThoseOfTheTexture) {
    const Extent extent{16, 8};
    const MeshPart part = square(0.0f, 1.0f);
    Image picture;
    for (const char* const name : {"R", "G", "B", "A"}) {
        picture.planes.emplace_back(extent);
        picture.names.emplace_back(name);
    }
    for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 16; ++i) {
            for (std::size_t k = 0; k < 4; ++k)
                picture.planes[k].at(i, j) = static_cast<float>((i * 7 + j * 3 + static_cast<int>(k) * 5) % 16) / 16.0f;
        }
    }
    std::vector<MeshPart> high = only(part);
    for (Float2& uv : high[0].uvs[0]) uv = {uv.x + 3.0f, uv.y - 2.0f};  // pictures repeat
    TransferInputs inputs;
    inputs.high_details.resize(1);
    inputs.high_details[0].color = &picture;
    TransferOptions options;
    const auto maps = guided(part, high, extent, inputs, options);
    ASSERT_TRUE(maps) << maps.error().message();
    ASSERT_EQ(maps->color.planes.size(), 3u);
    for_hits(*maps, [&](int i, int j) {
        for (std::size_t k = 0; k < 3; ++k)
            ASSERT_NEAR(maps->color.planes[k].at(i, j), picture.planes[k].at(i, j), 1e-5f) << i << " " << j;
    });
    // A map of half of the size shows means.
    options.subsamples = 2;
    const auto half = guided(part, high, {8, 4}, inputs, options);
    ASSERT_TRUE(half);
    const Plane<float>& red = picture.planes[0];
    EXPECT_NEAR(half->color.planes[0].at(3, 2), 0.25f * (red.at(6, 4) + red.at(7, 4) + red.at(6, 5) + red.at(7, 5)),
                1e-5f);
    // Grey pictures, and parts without any.
    picture.planes.resize(1);
    picture.names.resize(1);
    high.push_back(lifted(part, 0.5f));
    for (Float3& p : high[1].positions) p.x += 0.5f;
    inputs.high_details.resize(2);
    options = {};
    options.front = length(1.0);
    const auto grey = guided(part, high, extent, inputs, options);
    ASSERT_TRUE(grey);
    EXPECT_NEAR(grey->color.planes[2].at(2, 3), red.at(2, 3), 1e-5f);
    EXPECT_EQ(grey->color.planes[2].at(12, 3), 1.0f);
}

TEST(TransferDetails, IdsAreThoseOfMostHits) {
    const Extent extent{8, 8};
    const MeshPart low = square(0.0f, 1.0f);
    std::vector<MeshPart> high = only(low);
    high.push_back(lifted(low, 0.25f));
    for (Float3& p : high[1].positions) p.x = 0.4375f + 0.5625f * p.x;  // from the middle of the fourth column
    high.push_back(lifted(high[1], 0.25f));
    for (Float3& p : high[2].positions) p.y = 0.4375f * p.y;
    TransferInputs inputs;
    inputs.high_ids = {9, 4, 0};
    TransferOptions options;
    options.front = options.back = length(1.0);
    options.subsamples = 4;
    const auto maps = guided(low, high, extent, inputs, options);
    ASSERT_TRUE(maps) << maps.error().message();
    EXPECT_EQ(maps->ids.at(0, 0), 9);
    EXPECT_EQ(maps->ids.at(3, 0), 4);  // half of it, and the smaller one
    EXPECT_EQ(maps->ids.at(4, 0), 4);
    EXPECT_EQ(maps->ids.at(4, 7), 0);
    EXPECT_EQ(maps->ids.at(4, 4), 0);
    EXPECT_EQ(maps->ids.at(3, 7), 0);
    EXPECT_EQ(maps->ids.at(2, 7), 9);
    options.padding = 0;
    const MeshPart small = square(0.25f, 0.75f);
    TransferInputs numbered;
    numbered.high_ids = {7};
    const auto island = guided(small, only(lifted(small, 0.1f)), {16, 16}, numbered, options);
    ASSERT_TRUE(island);
    EXPECT_EQ(island->ids.at(8, 8), 7);
    EXPECT_EQ(island->ids.at(0, 0), kNoId);
}

}  // namespace
}  // namespace tex
