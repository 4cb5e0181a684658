// SPDX-License-Identifier: Apache-2.0
// preview(): mip levels, detail, albedo and bump scale.

#include <tex/preview.h>

#include <cmath>

#include <gtest/gtest.h>

#include "preview_pictures.h"

namespace tex {
namespace {

TEST(PreviewMaterial, SamplesTheLevelThatFitsThePixel) {
    MipChain chain = constant({64, 64}, 0.0f, 0.0f, 1.0f);
    for (int k = 1; k < 7; ++k) {
        const float x = static_cast<float>(k) / 10.0f;
        chain.levels.push_back(
            std::move(constant(level_extent({64, 64}, k), x, 0.0f, reconstruct_z(x, 0.0f)).levels[0]));
    }
    PreviewOptions options;
    options.show = Show::normals;
    for (int k = 0; k < 7; ++k) {
        options.size = {64 >> k, 64 >> k};
        EXPECT_NEAR(pixel(render_or_fail({.map = &chain}, options), 0, 0)[0], (k / 10.0 + 1.0) / 2.0 * 255.0, 0.51)
            << k;
    }
    options.size = {45, 45};  // log2(64 / 45) = 0.508
    EXPECT_NEAR(pixel(render_or_fail({.map = &chain}, options), 22, 22)[0], (0.0508 + 1.0) / 2.0 * 255.0, 0.6);
}

TEST(PreviewMaterial, DetailIsBlendedByWhiteoutAtItsOwnTiling) {
    const MipChain base = constant({8, 8}, 0.6f, 0.0f, 0.8f);
    MipChain detail = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    detail.levels[0].y.at(1, 0) = 0.6f;
    detail.levels[0].z.at(1, 0) = 0.8f;
    PreviewOptions options;
    options.show = Show::world_normals;
    options.detail.tiling_x = options.detail.tiling_y = 2.0f;  // texels of 8x8 and of 2 times 4x4 coincide
    const Texture picture = render_or_fail({.map = &base, .detail = &detail}, options);
    const double n = std::sqrt(0.6 * 0.6 + 0.6 * 0.6 + 0.64 * 0.64);
    for (const auto& [i, j] : {std::pair{1, 0}, {5, 0}, {1, 4}, {5, 4}}) {
        EXPECT_NEAR(pixel(picture, i, j)[1], (0.6 / n + 1) / 2 * 255, 0.51);
        EXPECT_NEAR(pixel(picture, i, j)[2], (0.64 / n + 1) / 2 * 255, 0.51);
    }
    EXPECT_EQ(pixel(picture, 2, 0)[0], 204);  // outside the detail's bump: the unchanged base
    options.show = Show::plain;
    EXPECT_EQ(
        difference(render_or_fail({.map = &base, .detail = &detail}, options), render_or_fail({.map = &base}, options)),
        0);
}

TEST(PreviewMaterial, AlbedoIsLinearAndGreyStandsForAllChannels) {
    const MipChain flat = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    Image grey;
    grey.planes.emplace_back(Extent{4, 4}, 0.5f);
    grey.names = {"Y"};
    PreviewOptions options;
    options.light = {LightKind::directional, 0.0f, 0.0f, 1.0f, {1.0f, 1.0f, 1.0f}};
    options.ambient = {};
    options.material = {{1.0f, 1.0f, 0.5f}, {}, 1.0f, SpecularModel::phong};
    const Pixel got = pixel(render_or_fail({.map = &flat, .albedo = &grey}, options), 1, 2);
    EXPECT_EQ(got, (Pixel{188, 188, 137}));  // sRGB of 0.5 and of 0.25
    grey.names = {"velocity"};
    grey.planes.emplace_back(Extent{4, 4}, 0.5f);
    grey.names.emplace_back("density");
    const auto refused = preview({.map = &flat, .albedo = &grey}, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_option);
}

TEST(PreviewMaterial, BumpScaleFollowsItsMode) {
    const MipChain map = constant({4, 4}, 0.6f, 0.0f, 0.8f);
    PreviewOptions options;
    options.show = Show::world_normals;
    options.bump_scale = 0.5f;
    EXPECT_NEAR(pixel(render_or_fail({.map = &map}, options), 1, 1)[0], (0.3 / std::sqrt(0.09 + 0.64) + 1) / 2 * 255,
                0.51);
    options.scale_mode = ScaleMode::xy;
    EXPECT_NEAR(pixel(render_or_fail({.map = &map}, options), 1, 1)[0], (0.3 + 1) / 2 * 255, 0.51);
}

TEST(PreviewMaterial, DetailAlbedoOfMiddleGreyChangesNothing) {
    const MipChain flat = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    Image grey;
    grey.planes.emplace_back(Extent{4, 4}, 0.21764f);  // 0.5 to the power of 2.2
    grey.names = {"Y"};
    PreviewOptions options;
    const Texture without = render_or_fail({.map = &flat}, options);
    EXPECT_LE(difference(render_or_fail({.map = &flat, .detail_albedo = &grey}, options), without), 1);
    grey.planes[0] = Plane<float>(Extent{4, 4}, 0.1f);
    EXPECT_LT(pixel(render_or_fail({.map = &flat, .detail_albedo = &grey}, options), 1, 1)[0], pixel(without, 1, 1)[0]);
}

}  // namespace
}  // namespace tex
