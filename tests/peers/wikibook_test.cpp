// SPDX-License-Identifier: Apache-2.0
// preview() against the wikibook's own shaders on Mesa's software OpenGL: the same light, camera and texture.

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "software_gl.h"
#include "wikibook_gl.h"

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr int kCodes = 2;            // that 8-bit pictures may differ by,
constexpr double kFraction = 0.001;  // but for this part of their pixels

// Bumps of several widths that tile, never tilted by more than 53 degrees.
tex::Plane<float> bumpy_heights(tex::Extent extent) {
    tex::Plane<float> height(extent);
    std::mt19937 engine(21);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double u = 2.0 * 180.0 * kDegree * i / extent.width, v = 2.0 * 180.0 * kDegree * j / extent.height;
            const double grain = static_cast<double>(engine() >> 8) / 16777216.0;
            height.at(i, j) = static_cast<float>(0.5 + 0.2 * std::sin(3.0 * u) * std::cos(2.0 * v) +
                                                 0.15 * std::sin(7.0 * v + u) + 0.01 * grain);
        }
    }
    return height;
}

struct Comparison {
    double over = 0.0;  // the part of the pixels that differ by more than kCodes
    int largest = 0;
    int compared = 0;
};

// Pixels that OpenGL drew, and all of whose neighbours it drew: outlines are smooth in ours and rough in GL's.
Comparison compare_pictures(const tex::Texture& ours, const std::vector<float>& gl) {
    const tex::Extent extent = ours.extent();
    const auto drawn = [&](int i, int j) {
        return i >= 0 && j >= 0 && i < extent.width && j < extent.height
                   ? gl[(static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) +
                         static_cast<std::size_t>(i)) *
                            4 +
                        3] == 1.0f
                   : true;
    };
    Comparison result;
    int over = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            bool inside = true;
            for (int b = -1; b <= 1; ++b) {
                for (int a = -1; a <= 1; ++a) inside = inside && drawn(i + a, j + b);
            }
            if (!inside) continue;
            const std::size_t at =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i);
            int worst = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const int theirs = static_cast<int>(std::floor(gl[at * 4 + c] * 255.0f + 0.5f));
                worst = std::max(worst, std::abs(std::to_integer<int>(ours.levels[0].bytes[at * 3 + c]) - theirs));
            }
            ++result.compared;
            over += worst > kCodes ? 1 : 0;
            result.largest = std::max(result.largest, worst);
        }
    }
    result.over = static_cast<double>(over) / std::max(1, result.compared);
    return result;
}

struct View {
    const char* name;
    tex::Extent map, picture;
    tex::Camera camera;
    tex::LightKind light = tex::LightKind::directional;
    bool mirror = false;
    float parallax = 0.0f;
};

// The scene for OpenGL; the camera is placed by the corners of the plane.
peers::GlScene gl_scene(const View& view, const tex::PreviewOptions& options) {
    const double yaw = view.camera.yaw * kDegree, pitch = view.camera.pitch * kDegree;
    const double toward[3] = {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
    const double right[3] = {std::cos(yaw), 0.0, -std::sin(yaw)};
    const double up[3] = {-std::sin(yaw) * std::sin(pitch), std::cos(pitch), -std::cos(yaw) * std::sin(pitch)};
    const double slope = std::tan(view.camera.field_of_view * kDegree / 2.0);
    const double half_width = static_cast<double>(view.map.width) / view.map.height;
    const double aspect = static_cast<double>(view.picture.width) / view.picture.height;
    double half_height = 0.0;
    for (const double x : {-half_width, half_width}) {
        for (const double y : {-1.0, 1.0}) {
            const double depth = slope * (x * toward[0] + y * toward[1]);
            half_height = std::max({half_height, std::abs(x * up[0] + y * up[1]) + depth,
                                    std::abs(x * right[0] + y * right[1]) / aspect + depth});
        }
    }
    const auto vec = [](const double(&v)[3], double s) {
        return peers::Vec3{static_cast<float>(v[0] * s), static_cast<float>(v[1] * s), static_cast<float>(v[2] * s)};
    };
    const auto rgb = [](const tex::Rgb& c) { return peers::Vec3{c.r, c.g, c.b}; };
    peers::GlScene scene;
    scene.picture = view.picture;
    scene.eye = vec(toward, half_height / slope);
    scene.right = vec(right, 1.0);
    scene.up = vec(up, 1.0);
    scene.toward = vec(toward, 1.0);
    scene.slope = static_cast<float>(slope);
    scene.half_width = static_cast<float>(half_width);
    scene.tangent = {view.mirror ? -1.0f : 1.0f, 0.0f, 0.0f};
    scene.tangent_w = view.mirror ? -1.0f : 1.0f;
    scene.light = {options.light.x, options.light.y, options.light.z};
    scene.point_light = view.light == tex::LightKind::point;
    scene.light_color = rgb(options.light.color);
    scene.ambient = rgb(options.ambient);
    scene.diffuse = rgb(options.material.albedo);
    scene.specular = rgb(options.material.specular);
    scene.shininess = options.material.shininess;
    scene.parallax = options.parallax.amount;
    scene.parallax_limit = options.parallax.limit;
    return scene;
}

class Wikibook : public testing::TestWithParam<View> {};

TEST_P(Wikibook, LightsAPlaneAsWeDo) {
    ASSERT_TRUE(peers::software_gl_works()) << "Mesa's off-screen OpenGL gave no context";
    const View& view = GetParam();
    tex::HeightField field;
    field.height = bumpy_heights(view.map);
    field.bumpiness_x = field.bumpiness_y = static_cast<float>(view.map.width) / 12.0f;
    auto normals = tex::bake(field);
    ASSERT_TRUE(normals);
    tex::MipOptions mip;
    mip.levels = view.camera.yaw == 0.0f && view.camera.pitch == 0.0f
                     ? 0
                     : 1;  // seen at a slant, drivers choose levels as they like
    const auto chain = tex::build_mip_chain(std::move(*normals), mip);
    ASSERT_TRUE(chain);

    tex::PreviewOptions options;
    options.size = view.picture;
    options.camera = view.camera;
    options.mirror = view.mirror;
    options.anisotropy = 1;
    options.light = {view.light, -0.7f, 0.9f, 1.1f, {1.0f, 0.95f, 0.8f}};
    options.ambient = {0.03f, 0.04f, 0.06f};
    options.material = {{0.6f, 0.5f, 0.4f}, {0.4f, 0.4f, 0.4f}, 17.0f, tex::SpecularModel::phong};
    options.parallax = {view.parallax, 0.04f, 0};
    tex::PreviewScene scene;
    scene.map = &*chain;
    scene.map_without_z = true;
    if (view.parallax != 0.0f) scene.height = &field.height;
    const auto ours = tex::preview(scene, options);
    ASSERT_TRUE(ours) << ours.error().message();

    peers::GlScene gl = gl_scene(view, options);
    gl.map = scene.map;
    gl.height = scene.height;
    const std::vector<float> theirs = peers::draw_wikibook_plane(gl);
    ASSERT_EQ(theirs.size(), static_cast<std::size_t>(view.picture.texels()) * 4) << "OpenGL refused the drawing";
    const Comparison compared = compare_pictures(*ours, theirs);
    RecordProperty("largest", compared.largest);
    EXPECT_GT(compared.compared, view.picture.texels() / 4);
    EXPECT_LE(compared.over, kFraction) << compared.largest << " codes at most, of " << compared.compared << " pixels";
}

INSTANTIATE_TEST_SUITE_P(
    Mesa, Wikibook,
    testing::Values(View{"TexelForPixel", {256, 192}, {256, 192}, {}},
                    View{"PointLight", {256, 256}, {256, 256}, {}, tex::LightKind::point},
                    View{"Magnified", {64, 48}, {320, 240}, {}}, View{"Halved", {256, 256}, {128, 128}, {}},
                    View{"Mirrored", {256, 128}, {256, 128}, {}, tex::LightKind::directional, true},
                    View{"AtASlant", {64, 64}, {400, 300}, {35.0f, 25.0f, 40.0f}, tex::LightKind::point},
                    View{"ParallaxAtASlant",
                         {64, 64},
                         {400, 300},
                         {-30.0f, 35.0f, 40.0f},
                         tex::LightKind::directional,
                         false,
                         0.08f},
                    View{"MirroredParallaxAtASlant",
                         {64, 64},
                         {400, 300},
                         {-30.0f, 35.0f, 40.0f},
                         tex::LightKind::directional,
                         true,
                         0.08f}),
    [](const auto& row) { return std::string(row.param.name); });

}  // namespace
