// SPDX-License-Identifier: Apache-2.0

#include <tex/blend.h>

#include <cmath>
#include <optional>

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tex/check.h>
#include <tex/mip.h>

#include "reference/blend.h"
#include "unit/fields.h"
#include "unit/normal_maps.h"

namespace tex {
namespace {

Layer layer_of(NormalMap detail) {
    Layer layer;
    layer.detail = chain_from(std::move(detail));
    return layer;
}

NormalMap blend_one(const NormalMap& base, Layer layer, const BlendOptions& options = {},
                    const Execution& execution = {}) {
    std::vector<Layer> layers;
    layers.push_back(std::move(layer));
    auto result = blend(chain_from(copy_of(base)), std::move(layers), options, execution);
    EXPECT_TRUE(result) << result.error().message();
    return result ? std::move(*result) : NormalMap{};
}

BlendOptions with_mode(BlendMode mode) {
    BlendOptions options;
    options.mode = mode;
    return options;
}

void expect_near(const NormalMap& a, const NormalMap& b, float tolerance, const std::string& what) {
    ASSERT_EQ(a.extent(), b.extent());
    for (int j = 0; j < a.extent().height; ++j) {
        for (int i = 0; i < a.extent().width; ++i) {
            ASSERT_NEAR(a.x.at(i, j), b.x.at(i, j), tolerance) << what << " " << i << "," << j;
            ASSERT_NEAR(a.y.at(i, j), b.y.at(i, j), tolerance) << what << " " << i << "," << j;
            ASSERT_NEAR(a.z.at(i, j), b.z.at(i, j), tolerance) << what << " " << i << "," << j;
        }
    }
}

// -- identities ----------------------------------------------------------------------------------------------

TEST(Blend, GivesTheOtherMapForAFlatPartner) {
    const NormalMap map = wavy_map({33, 21});
    for (const BlendMode mode : {BlendMode::whiteout, BlendMode::partial_derivative, BlendMode::rnm}) {
        const std::string name(name_of(kBlendModeNames, mode));
        expect_near(blend_one(map, layer_of(flat_map({33, 21})), with_mode(mode)), map, 1e-6f, name + ", flat detail");
        expect_near(blend_one(flat_map({33, 21}), layer_of(copy_of(map)), with_mode(mode)), map, 1e-6f,
                    name + ", flat base");
    }
    expect_near(blend_one(map, layer_of(flat_map({33, 21})), with_mode(BlendMode::udn)), map, 1e-6f,
                "udn, flat detail");
}

TEST(Blend, DoesNotMindTheOrderWhereItPromisesSo) {
    const NormalMap a = wavy_map({33, 21});
    const NormalMap b = wavy_map({33, 21}, 2.0);
    for (const BlendMode mode : {BlendMode::whiteout, BlendMode::partial_derivative, BlendMode::linear}) {
        expect_near(blend_one(a, layer_of(copy_of(b)), with_mode(mode)),
                    blend_one(b, layer_of(copy_of(a)), with_mode(mode)), 1e-6f,
                    std::string(name_of(kBlendModeNames, mode)));
    }
}

// Adding slopes must equal adding heights.
TEST(Blend, AddsSlopesInPartialDerivativeMode) {
    const NormalMap n =
        blend_one(uniform_map({1, 1}, 0.6f, 0.0f, 0.8f), layer_of(uniform_map({1, 1}, 0.0f, 0.8f, 0.6f)),
                  with_mode(BlendMode::partial_derivative));
    EXPECT_NEAR(n.x.at(0, 0) / n.z.at(0, 0), 0.75f, 1e-6f);
    EXPECT_NEAR(n.y.at(0, 0) / n.z.at(0, 0), 4.0f / 3.0f, 1e-6f);
}

// -- against the reference -----------------------------------------------------------------------------------

struct Case {
    const char* what;
    Extent base, detail;
    float tiling_x, tiling_y, offset_x, offset_y, rotation;
    Wrap wrap;
    Extent mask = {0, 0};  // none
};

// Values from below 0 to above 1.
Plane<float> wavy_mask(Extent extent) {
    Plane<float> mask(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i)
            mask.at(i, j) = 0.5f + 0.6f * std::sin(0.9f * static_cast<float>(i) - 0.4f * static_cast<float>(j));
    }
    return mask;
}

// Magnified, tiled, moved, rotated and shrunk (between levels), with masks, with every wrap and mode.
TEST(Blend, AgreesWithTheReference) {
    const Case cases[] = {
        {"same extent", {37, 29}, {37, 29}, 1, 1, 0, 0, 0, Wrap::repeat},
        {"magnified", {64, 48}, {9, 7}, 1, 1, 0, 0, 0, Wrap::clamp},
        {"tiled", {64, 64}, {16, 16}, 3, 2, 0.25f, -0.4f, 0, Wrap::repeat},
        {"mirrored", {64, 64}, {16, 16}, 3.5f, 2, 0.1f, 0.7f, 0, Wrap::mirror},
        {"clamped outside", {40, 40}, {16, 16}, 2, 2, -0.5f, -0.5f, 0, Wrap::clamp},
        {"turned", {48, 64}, {32, 16}, 1, 1, 0, 0, 30, Wrap::repeat},
        {"turned by a right angle", {32, 32}, {32, 32}, 1, 1, 0, 0, 90, Wrap::repeat},
        {"shrunk", {32, 32}, {64, 64}, 1.5f, 1.5f, 0.1f, 0, 0, Wrap::repeat},
        {"shrunk far", {32, 32}, {64, 64}, 300, 300, 0, 0, 0, Wrap::repeat},
        {"shrunk and turned", {32, 24}, {61, 45}, 2.2f, 1.1f, 0, 0.3f, -75, Wrap::mirror},
        {"wide, turned, under a small mask", {96, 17}, {23, 71}, 1.5f, 0.2f, 0.3f, -0.2f, 37, Wrap::repeat, {5, 11}},
        {"tall, shrunk, turned, under a large mask", {13, 80}, {64, 48}, 1, 4, 0, 0, 120, Wrap::clamp, {101, 40}},
        {"wide, shrunk on one axis, under a mask of one row", {80, 12}, {40, 90}, 1, 3, 0, 0, 0, Wrap::repeat, {9, 1}},
        {"tall, turned by a right angle, under a mask", {12, 50}, {50, 12}, 1, 1, 0, 0, 270, Wrap::mirror, {12, 50}},
    };
    for (const Case& c : cases) {
        for (const auto& row : kBlendModeNames) {
            const NormalMap base = wavy_map(c.base);
            MipOptions mip_options;
            mip_options.wrap_x = mip_options.wrap_y = c.wrap;
            const auto chain = build_mip_chain(wavy_map(c.detail, 1.0), mip_options);
            ASSERT_TRUE(chain);
            std::vector<reference::Grid<reference::Vector>> levels;
            for (const NormalMap& level : chain->levels) levels.push_back(reference::grid_of(level));

            Layer layer = layer_of(wavy_map(c.detail, 1.0));
            layer.scale = 0.7f;
            layer.tiling_x = c.tiling_x;
            layer.tiling_y = c.tiling_y;
            layer.offset_x = c.offset_x;
            layer.offset_y = c.offset_y;
            layer.rotation = c.rotation;
            layer.wrap_x = layer.wrap_y = c.wrap;
            layer.strength = 0.8f;
            if (c.mask.width > 0) layer.mask = wavy_mask(c.mask);
            BlendOptions options = with_mode(row.value);
            options.base_scale = 1.3f;
            const auto expected = reference::blend(reference::grid_of(base), levels, layer, options);
            const NormalMap result = blend_one(base, std::move(layer), options);
            double worst = 0;
            for (int j = 0; j < c.base.height; ++j) {
                for (int i = 0; i < c.base.width; ++i) {
                    const reference::Vector n{static_cast<double>(result.x.at(i, j)),
                                              static_cast<double>(result.y.at(i, j)),
                                              static_cast<double>(result.z.at(i, j))};
                    worst = std::max(worst, reference::angle_between(n, expected.at(i, j)));
                }
            }
            // Between levels, the code mixes in steps of 1/256. This changes the mixture by up to 1/512 of the levels'
            // difference.
            const bool between_levels =
                static_cast<float>(c.detail.width) * c.tiling_x > static_cast<float>(c.base.width) ||
                static_cast<float>(c.detail.height) * c.tiling_y > static_cast<float>(c.base.height) ||
                (c.rotation != 0 && c.base.width != c.base.height);
            EXPECT_LE(worst, between_levels ? 0.15 : 0.002) << c.what << ", " << row.name;
        }
    }
}

// -- how layers lie ------------------------------------------------------------------------------------------

// A rotation by a right angle moves every texel to the place of another one, and rotates its vector.
TEST(Blend, TurnsByRightAnglesExactly) {
    const NormalMap detail = wavy_map({16, 16});
    Layer layer = layer_of(copy_of(detail));
    layer.rotation = 90.0f;
    const NormalMap result = blend_one(flat_map({16, 16}), std::move(layer));
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i) {
            // Counter-clockwise: the right edge moves to the top.
            const int from_i = 15 - j;
            const int from_j = i;
            ASSERT_NEAR(result.x.at(i, j), -detail.y.at(from_i, from_j), 1e-6f);
            ASSERT_NEAR(result.y.at(i, j), detail.x.at(from_i, from_j), 1e-6f);
        }
    }
}

// v points upwards: a positive offset of a quarter moves the picture down by a quarter.
TEST(Blend, MovesTheDetailDownForAPositiveOffset) {
    const NormalMap detail = wavy_map({16, 16});
    Layer layer = layer_of(copy_of(detail));
    layer.offset_y = 0.25f;
    layer.offset_x = 0.125f;
    const NormalMap result = blend_one(flat_map({16, 16}), std::move(layer));
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i) {
            ASSERT_NEAR(result.x.at(i, j), detail.x.at((i + 2) % 16, (j + 12) % 16), 1e-6f);
        }
    }
}

TEST(Blend, ShowsALayerAsFarAsItsMaskAndStrength) {
    const NormalMap base = wavy_map({16, 8});
    const auto masked = [&](Plane<float> mask, float strength) {
        Layer layer = layer_of(wavy_map({16, 8}, 3.0));
        layer.mask = std::move(mask);
        layer.strength = strength;
        return blend_one(base, std::move(layer));
    };
    const NormalMap whole = masked({}, 1.0f);
    expect_near(masked(Plane<float>({16, 8}, 1.0f), 1.0f), whole, 1e-6f, "white mask");
    expect_near(masked(Plane<float>({3, 5}, 0.0f), 1.0f), base, 1e-6f, "black mask");
    expect_near(masked({}, 0.0f), base, 1e-6f, "no strength");
    expect_near(masked(Plane<float>({16, 8}, 0.5f), 1.0f), masked({}, 0.5f), 1e-6f, "half");
    Plane<float> halves({2, 1}, 0.0f);  // white on the right: a ramp between the centres of the texels
    halves.at(1, 0) = 1.0f;
    const NormalMap ramp = masked(std::move(halves), 1.0f);
    for (int j = 0; j < 8; ++j) {
        EXPECT_NEAR(ramp.x.at(0, j), base.x.at(0, j), 1e-6f);
        EXPECT_NEAR(ramp.x.at(15, j), whole.x.at(15, j), 1e-6f);
    }
}

TEST(Blend, AddsOneLayerAfterTheOther) {
    const NormalMap base = wavy_map({16, 8});
    const NormalMap first = blend_one(base, layer_of(wavy_map({16, 8}, 1.0)));
    const NormalMap second = blend_one(first, layer_of(wavy_map({16, 8}, 2.0)));
    std::vector<Layer> layers;
    layers.push_back(layer_of(wavy_map({16, 8}, 1.0)));
    layers.push_back(layer_of(wavy_map({16, 8}, 2.0)));
    const auto both = blend(chain_from(copy_of(base)), std::move(layers));
    ASSERT_TRUE(both);
    expect_near(*both, second, 1e-6f, "both");
}

TEST(Blend, GivesTheExtentThatIsAskedFor) {
    BlendOptions options;
    options.extent = {40, 10};
    const auto result = blend(chain_from(wavy_map({16, 8})), {}, options);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->extent(), (Extent{40, 10}));
    const auto same = blend(chain_from(wavy_map({16, 8})), {});
    expect_near(*same, wavy_map({16, 8}), 1e-6f, "no layers");
}

TEST(Blend, GivesTheSameBytesEverywhere) {
    for (const auto& row : kBlendModeNames) {
        for (const int width : {1, 2, 15, 16, 17, 33, 257}) {
            std::optional<std::uint64_t> expected;
            for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                for (const int threads : {1, 3}) {
                    Execution execution;
                    execution.threads = threads;
                    Layer layer = layer_of(wavy_map({31, 17}, 1.0));
                    layer.tiling_x = 2.5f;
                    layer.rotation = 20.0f;
                    layer.scale = 1.5f;
                    layer.mask = Plane<float>({2, 2}, 0.75f);
                    const NormalMap result =
                        blend_one(wavy_map({width, 9}), std::move(layer), with_mode(row.value), execution);
                    if (!expected) expected = fields::hash_of(result);
                    EXPECT_EQ(fields::hash_of(result), *expected) << row.name << " " << hwy::TargetName(target);
                }
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST(Blend, StopsWhenItIsCancelled) {
    Execution execution;
    execution.progress = [](double) { return false; };
    EXPECT_EQ(blend(chain_from(wavy_map({64, 64})), {}, {}, execution).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace tex
