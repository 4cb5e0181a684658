// SPDX-License-Identifier: Apache-2.0
// Compares preview() with the wikibook's shaders and with geometry computed by hand, and checks that its bytes never
// vary.

#include <tex/preview.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "preview_pictures.h"
#include "reference/wikibook_shader.h"

namespace tex {
namespace {

struct ShaderCase {
    const char* name;
    LightKind light;
    SpecularModel model;
    float field_of_view;
};

class PreviewPlane : public testing::TestWithParam<ShaderCase> {};

TEST_P(PreviewPlane, IsLitAsTheWikibooksShaderDoes) {
    const ShaderCase& setup = GetParam();
    const MipChain map = random_map({48, 32}, 7);
    PreviewOptions options;
    options.camera = Camera{0.0f, 0.0f, setup.field_of_view};
    options.light = {setup.light, -0.7f, 0.9f, 1.3f, {1.0f, 0.9f, 0.7f}};
    options.ambient = {0.02f, 0.03f, 0.05f};
    options.material = {{0.5f, 0.4f, 0.3f}, {0.3f, 0.2f, 0.4f}, 12.5f, setup.model};
    const Texture picture = render_or_fail({.map = &map}, options);
    ASSERT_EQ(picture.extent(), (Extent{48, 32}));

    reference::ShaderInput in{};
    in.tangent = {1, 0, 0};
    in.binormal = {0, 1, 0};
    in.normal = {0, 0, 1};
    in.parallel_view = setup.field_of_view == 0.0f;
    in.camera = {0, 0, in.parallel_view ? 1.0 : 1.0 / std::tan(setup.field_of_view * 3.14159265358979 / 360.0)};
    in.light = {-0.7f, 0.9f, 1.3f};
    in.point_light = setup.light == LightKind::point;
    in.light_color = {1.0f, 0.9f, 0.7f};
    in.ambient = {0.02f, 0.03f, 0.05f};
    in.diffuse_color = {0.5f, 0.4f, 0.3f};
    in.specular_color = {0.3f, 0.2f, 0.4f};
    in.shininess = 12.5;
    in.blinn = setup.model == SpecularModel::blinn;
    int largest = 0;
    for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 48; ++i) {
            const NormalMap& n = map.levels[0];
            in.local_coords = {n.x.at(i, j), n.y.at(i, j), n.z.at(i, j)};
            in.position = {((i + 0.5) / 48 * 2 - 1) * 1.5, 1 - (j + 0.5) / 32 * 2, 0};
            const reference::Vec3 light = reference::light_bumpy_surface(in);
            const Pixel got = pixel(picture, i, j);
            for (std::size_t c = 0; c < 3; ++c) {
                const int want = static_cast<int>(std::floor(reference::encode_srgb(light[c]) * 255.0 + 0.5));
                largest = std::max(largest, std::abs(got[c] - want));
            }
        }
    }
    EXPECT_EQ(largest, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Shaders, PreviewPlane,
    testing::Values(ShaderCase{"DirectionalPhong", LightKind::directional, SpecularModel::phong, 30.0f},
                    ShaderCase{"PointPhong", LightKind::point, SpecularModel::phong, 45.0f},
                    ShaderCase{"DirectionalBlinnParallel", LightKind::directional, SpecularModel::blinn, 0.0f},
                    ShaderCase{"PointBlinn", LightKind::point, SpecularModel::blinn, 60.0f}),
    [](const auto& row) { return std::string(row.param.name); });

TEST(Preview, LightFromTheUpperLeftRaisesABump) {
    MipChain bump = constant({33, 33}, 0.0f, 0.0f, 1.0f);
    for (int j = 0; j < 33; ++j) {
        for (int i = 0; i < 33; ++i) {
            const float x = static_cast<float>(i - 16) / 24.0f, y = static_cast<float>(16 - j) / 24.0f;
            if (x * x + y * y > 0.4f) continue;
            bump.levels[0].x.at(i, j) = x;
            bump.levels[0].y.at(i, j) = y;
            bump.levels[0].z.at(i, j) = reconstruct_z(x, y);
        }
    }
    const Texture picture = render_or_fail({.map = &bump}, {});
    EXPECT_GT(pixel(picture, 8, 8)[0], pixel(picture, 0, 0)[0]);
    EXPECT_LT(pixel(picture, 24, 24)[0], pixel(picture, 32, 32)[0]);
}

TEST(Preview, MirroredUvsLightCorrectly) {
    // One surface twice: unchanged, and with a mirrored texture and reversed UVs.
    const MipChain map = random_map({32, 16}, 3);
    MipChain mirrored = constant({32, 16}, 0.0f, 0.0f, 1.0f);
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 32; ++i) {
            mirrored.levels[0].x.at(i, j) = -map.levels[0].x.at(31 - i, j);
            mirrored.levels[0].y.at(i, j) = map.levels[0].y.at(31 - i, j);
            mirrored.levels[0].z.at(i, j) = map.levels[0].z.at(31 - i, j);
        }
    }
    PreviewOptions options, turned;
    turned.mirror = true;
    EXPECT_LE(difference(render_or_fail({.map = &map}, options), render_or_fail({.map = &mirrored}, turned)), 1);
}

TEST(Preview, SphereHasTheNormalsOfASphere) {
    const MipChain flat = constant({8, 8}, 0.0f, 0.0f, 1.0f);
    PreviewOptions options;
    options.show = Show::world_normals;
    options.shape = Shape::sphere;
    options.size = {101, 101};
    options.camera = Camera{0.0f, 0.0f, 0.0f};
    const Texture picture = render_or_fail({.map = &flat}, options);
    for (const auto& [i, j] : {std::pair{50, 50}, {75, 50}, {50, 20}, {30, 70}}) {
        // The picture is 2.12 high: the sphere and its margin.
        const double x = ((i + 0.5) / 101 * 2 - 1) * 1.06, y = (1 - (j + 0.5) / 101 * 2) * 1.06,
                     z = std::sqrt(1 - x * x - y * y);
        const Pixel got = pixel(picture, i, j);
        EXPECT_NEAR(got[0], (x + 1) / 2 * 255, 0.51) << i << "," << j;
        EXPECT_NEAR(got[1], (y + 1) / 2 * 255, 0.51) << i << "," << j;
        EXPECT_NEAR(got[2], (z + 1) / 2 * 255, 0.51) << i << "," << j;
    }
    EXPECT_EQ(pixel(picture, 0, 0), (Pixel{38, 40, 44}));
}

// The world normal in the middle of a shape whose map leans to +x or +y everywhere.
Pixel middle(Shape shape, float x, float y, bool mirror, std::optional<Camera> camera = {}) {
    const MipChain leaning = constant({8, 8}, x, y, reconstruct_z(x, y));
    PreviewOptions options;
    options.show = Show::world_normals;
    options.shape = shape;
    options.size = {65, 65};
    options.mirror = mirror;
    options.camera = camera.value_or(Camera{});
    return pixel(render_or_fail({.map = &leaning}, options), 32, 32);
}

TEST(Preview, TangentFramesPointWhereUAndVGrow) {
    for (const Shape shape : {Shape::plane, Shape::sphere, Shape::cube}) {
        EXPECT_EQ(middle(shape, 0.28f, 0.0f, false), (Pixel{163, 128, 250})) << "x leans right";
        EXPECT_EQ(middle(shape, 0.0f, 0.28f, false), (Pixel{128, 163, 250})) << "y leans up";
        EXPECT_EQ(middle(shape, 0.28f, 0.0f, true), (Pixel{92, 128, 250})) << "mirrored, x leans left";
        EXPECT_EQ(middle(shape, 0.0f, 0.28f, true), (Pixel{128, 163, 250})) << "mirrored, y still leans up";
    }
    // From the right, a cube shows its face +x, whose u points towards -z.
    EXPECT_EQ(middle(Shape::cube, 0.28f, 0.0f, false, Camera{90.0f, 0.0f, 30.0f}), (Pixel{250, 128, 92}));
}

TEST(Preview, SpinTurnsTheShapeAndNotTheLight) {
    const MipChain leaning = constant({8, 8}, 0.28f, 0.0f, 0.96f);
    PreviewOptions options;
    options.show = Show::world_normals;
    options.shape = Shape::cube;
    options.size = {65, 65};
    options.camera = Camera{};
    options.spin = 90.0f;  // now face -x faces the viewer; u still points to the right
    EXPECT_EQ(pixel(render_or_fail({.map = &leaning}, options), 32, 32), (Pixel{163, 128, 250}));
}

TEST(Preview, SizesKeepTheProportionsOfThePlane) {
    const MipChain map = constant({40, 20}, 0.0f, 0.0f, 1.0f);
    PreviewOptions options;
    const auto extent = [&] { return render_or_fail({.map = &map}, options).extent(); };
    EXPECT_EQ(extent(), (Extent{40, 20}));
    options.tiles_y = 3;
    EXPECT_EQ(extent(), (Extent{40, 60}));
    options.size = {30, 0};
    EXPECT_EQ(extent(), (Extent{20, 30}));
    options.size = {7, 9};
    EXPECT_EQ(extent(), (Extent{7, 9}));
    options.shape = Shape::cube;
    options.size = {};
    EXPECT_EQ(extent(), (Extent{512, 512}));
    options.shape = Shape::plane;
    EXPECT_EQ(render_or_fail({.map = &map}, options).extent(), (Extent{40, 60}));
}

TEST(Preview, GivesTheSameBytesForAnyNumberOfThreads) {
    const MipChain map = random_map({40, 40}, 11);
    const Plane<float> height(Extent{40, 40}, 0.7f);
    for (const auto& row : kShowNames) {
        if (row.value == Show::tangents || row.value == Show::uv || row.value == Show::seams) continue;  // of a mesh
        PreviewOptions options;
        options.show = row.value;
        options.shape = Shape::sphere;
        options.size = {64, 64};
        const PreviewScene scene{.map = &map, .detail = &map, .height = &height};
        const Texture one = render_or_fail(scene, options, on_threads(1)),
                      four = render_or_fail(scene, options, on_threads(4));
        EXPECT_EQ(one.levels[0].bytes, four.levels[0].bytes) << row.name;
    }
}

TEST(Preview, GivesTheseBytesInEveryBuild) {
    // The FNV-1a hash of a picture that uses every feature. If pictures change on purpose, put the new number here.
    const MipChain map = random_map({64, 64}, 5);
    Plane<float> height(Extent{64, 64});
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) height.at(i, j) = static_cast<float>((i * 7 + j * 3) % 64) / 63.0f;
    }
    PreviewOptions options;
    options.size = {96, 80};
    options.shape = Shape::cube;
    options.light.kind = LightKind::point;
    options.light.z = 2.5f;
    options.parallax = {0.1f, 0.1f, 16};
    options.detail.tiling_x = 3.0f;
    const Texture picture = render_or_fail({.map = &map, .detail = &map, .height = &height}, options);
    std::uint64_t hash = 14695981039346656037u;
    for (const std::byte b : picture.levels[0].bytes)
        hash = (hash ^ std::to_integer<std::uint64_t>(b)) * 1099511628211u;
    EXPECT_EQ(hash, 0x10cd84ecdcc05b1bu) << std::hex << hash;
}

TEST(Preview, RefusesOptionsOutOfRange) {
    const MipChain map = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    const auto refused = [&](auto change) {
        PreviewOptions options;
        change(options);
        const auto result = preview({.map = &map}, options);
        return !result && result.error().code == ErrorCode::bad_option && !result.error().reason.empty();
    };
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.light.x = o.light.y = o.light.z = 0.0f; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.light.x = std::nanf(""); }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.ambient.g = -1.0f; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.material.shininess = 0.0f; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.size = {0, 5}; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.size = {20000, 5}; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.tiles_y = 0; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.anisotropy = 17; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.parallax.steps = -1; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.parallax.limit = -0.1f; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.bump_scale = INFINITY; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.camera = Camera{0.0f, 90.0f, 30.0f}; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.camera = Camera{0.0f, 0.0f, 121.0f}; }));
    EXPECT_TRUE(refused([](PreviewOptions& o) { o.show = Show::height; })) << "no height map";
    for (const float white : {0.0f, -1.0f, std::nanf("")})
        EXPECT_EQ(preview({.map = &map, .white = white}, {}).error().code, ErrorCode::bad_option);
}

TEST(Preview, ProgressNeverRunsBackwards) {
    const MipChain map = random_map({40, 40}, 11);
    const Plane<float> height(Extent{40, 40}, 0.7f);
    for (const auto& row : kShowNames) {
        if (row.value == Show::tangents || row.value == Show::uv || row.value == Show::seams) continue;  // of a mesh
        PreviewOptions options;
        options.show = row.value;
        double last = 0.0;
        bool forwards = true;
        Execution execution = on_threads(2);
        execution.progress = [&](double fraction) {
            forwards = forwards && fraction >= last && fraction <= 1.0;
            last = fraction;
            return true;
        };
        render_or_fail({.map = &map, .detail = &map, .height = &height}, options, execution);
        EXPECT_TRUE(forwards) << row.name;
    }
}

TEST(Preview, StopsWhenItIsCancelled) {
    const MipChain map = constant({64, 64}, 0.0f, 0.0f, 1.0f);
    Execution execution = on_threads(1);
    execution.progress = [](double) { return false; };
    const auto result = preview({.map = &map}, {}, execution);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace tex
