// SPDX-License-Identifier: Apache-2.0
// preview() of meshes against Mesa's software OpenGL: the same light, camera and map.
//
// OpenGL draws 4 by 4 times as many pixels, whose light is averaged: these are the 16 samples that preview() takes.
// Counted are all pixels that show the mesh, with those on outlines and edges. preview() computes the light once for
// each triangle that a pixel shows, and OpenGL at every sample, so the map is no finer than the pixels.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "mesh_gl.h"
#include "software_gl.h"
#include "unit/solids.h"

namespace {

namespace fs = std::filesystem;

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr int kCodes = 3;
constexpr double kFraction = 0.01;  // that may differ by more
constexpr tex::Extent kPicture{420, 360};
constexpr int kSide = 4;  // samples of a pixel
constexpr tex::Camera kCamera{30.0f, 20.0f, 30.0f};

peers::Vec3 scaled(const double (&v)[3], double s) {
    return {static_cast<float>(v[0] * s), static_cast<float>(v[1] * s), static_cast<float>(v[2] * s)};
}

// The camera that preview.h describes, whose picture just contains a sphere of the radius 1.06.
peers::GlScene gl_scene(const tex::PreviewOptions& options) {
    const double yaw = double{kCamera.yaw} * kDegree, pitch = double{kCamera.pitch} * kDegree;
    const double toward[3] = {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
    const double right[3] = {std::cos(yaw), 0.0, -std::sin(yaw)};
    const double up[3] = {-std::sin(yaw) * std::sin(pitch), std::cos(pitch), -std::cos(yaw) * std::sin(pitch)};
    const double slope = std::tan(double{kCamera.field_of_view} * kDegree / 2.0);
    const double aspect = static_cast<double>(kPicture.width) / kPicture.height;
    const double narrow = std::min(1.0, aspect);
    const auto rgb = [](const tex::Rgb& c) { return peers::Vec3{c.r, c.g, c.b}; };
    peers::GlScene scene;
    scene.picture = {kPicture.width * kSide, kPicture.height * kSide};
    scene.eye = scaled(toward, 1.06 * std::sqrt(1.0 / (narrow * narrow) + slope * slope) / slope);
    scene.right = scaled(right, 1.0);
    scene.up = scaled(up, 1.0);
    scene.toward = scaled(toward, 1.0);
    scene.slope = static_cast<float>(slope);
    scene.light = {options.light.x, options.light.y, options.light.z};
    scene.light_color = rgb(options.light.color);
    scene.ambient = rgb(options.ambient);
    scene.diffuse = rgb(options.material.albedo);
    scene.specular = rgb(options.material.specular);
    scene.shininess = options.material.shininess;
    return scene;
}

// The mesh with the centre of its box at the origin, and its farthest corner 1 away.
peers::GlMesh gl_mesh(const tex::TangentSpace& space) {
    double low[3] = {1e30, 1e30, 1e30}, high[3] = {-1e30, -1e30, -1e30};
    const auto coordinates = [&](std::uint32_t v, double(&p)[3]) {
        const tex::Float3& q = space.part.positions[v];
        p[0] = double{q.x}, p[1] = double{q.y}, p[2] = double{q.z};
    };
    double p[3];
    for (const std::uint32_t v : space.part.indices) {
        coordinates(v, p);
        for (int c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], p[c]);
            high[c] = std::max(high[c], p[c]);
        }
    }
    double farthest = 0.0;
    for (const std::uint32_t v : space.part.indices) {
        coordinates(v, p);
        double square = 0.0;
        for (int c = 0; c < 3; ++c) square += (p[c] - (low[c] + high[c]) / 2.0) * (p[c] - (low[c] + high[c]) / 2.0);
        farthest = std::max(farthest, square);
    }
    const double centre[3] = {low[0] + high[0], low[1] + high[1], low[2] + high[2]};
    return {&space, scaled(centre, 0.5), static_cast<float>(1.0 / std::sqrt(farthest))};
}

struct MeshComparison {
    double over = 0.0;  // the part of the pixels that differ by more than kCodes
    int largest = 0, compared = 0;
};

double srgb(double c) {
    c = std::clamp(c, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

double linear(double c) { return std::pow((c + 0.055) / 1.055, 2.4); }  // of values above 0.04

// RGBA of a pixel: the mean light of its samples, and the part of them that show the mesh.
std::array<double, 4> mean_of(const std::vector<float>& samples, int i, int j) {
    std::array<double, 4> mean{};
    for (int k = 0; k < kSide * kSide; ++k) {
        const int x = i * kSide + k % kSide, y = j * kSide + k / kSide;
        const auto at = static_cast<std::size_t>(y * kPicture.width * kSide + x) * 4;
        for (std::size_t c = 0; c < 4; ++c) mean[c] += std::clamp(double{samples[at + c]}, 0.0, 4.0) / (kSide * kSide);
    }
    return mean;
}

MeshComparison compare_pictures(const tex::Texture& ours, const std::vector<float>& gl) {
    constexpr double kGround[3] = {38.0, 40.0, 44.0};
    MeshComparison result;
    int over = 0;
    for (int j = 0; j < kPicture.height; ++j) {
        for (int i = 0; i < kPicture.width; ++i) {
            const auto mean = mean_of(gl, i, j);
            if (mean[3] == 0.0) continue;
            int worst = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const double light = mean[c] + (1.0 - mean[3]) * linear(kGround[c] / 255.0);
                const int theirs = static_cast<int>(std::floor(srgb(light) * 255.0 + 0.5));
                const auto at = static_cast<std::size_t>(j * kPicture.width + i) * 3 + c;
                worst = std::max(worst, std::abs(std::to_integer<int>(ours.levels[0].bytes[at]) - theirs));
            }
            ++result.compared;
            over += worst > kCodes ? 1 : 0;
            result.largest = std::max(result.largest, worst);
        }
    }
    result.over = static_cast<double>(over) / std::max(1, result.compared);
    return result;
}

void expect_equal_pictures(const tex::TangentSpace& space, peers::Binormal binormal, const tex::MipChain& map) {
    tex::PreviewOptions options;
    options.size = kPicture;
    options.camera = kCamera;
    options.anisotropy = 1;
    options.light = {tex::LightKind::directional, -0.7f, 0.9f, 1.1f, {1.0f, 0.95f, 0.8f}};
    const auto ours = tex::preview({.map = &map, .mesh = &space}, options);
    ASSERT_TRUE(ours) << ours.error().message();
    peers::GlScene scene = gl_scene(options);
    scene.map = &map;
    peers::GlMesh mesh = gl_mesh(space);
    mesh.binormal = binormal;
    const std::vector<float> theirs = peers::draw_mesh(scene, mesh);
    ASSERT_EQ(theirs.size(), static_cast<std::size_t>(scene.picture.texels()) * 4) << "OpenGL refused the drawing";
    const MeshComparison compared = compare_pictures(*ours, theirs);
    EXPECT_GT(compared.compared, 5000);
    EXPECT_LE(compared.over, kFraction) << compared.largest << " codes at most, of " << compared.compared << " pixels";
    testing::Test::RecordProperty("per_mille_over", static_cast<int>(1000.0 * compared.over));
}

// The level of a map that has at most so many texels a side.
tex::MipChain level_of(tex::NormalMap map, int most) {
    auto chain = tex::build_mip_chain(std::move(map));
    EXPECT_TRUE(chain);
    tex::MipChain one;
    for (tex::NormalMap& level : chain->levels) {
        if (!one.levels.empty() || level.extent().width > most) continue;
        one.levels.push_back(std::move(level));
    }
    return one;
}

tex::MipChain waves() {
    tex::HeightField field;
    field.height = tex::Plane<float>({64, 64});
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const double u = 6.283185307 * i / 64.0, v = 6.283185307 * j / 64.0;
            field.height.at(i, j) = static_cast<float>(std::sin(3.0 * u) * std::cos(2.0 * v));
        }
    }
    field.bumpiness_x = field.bumpiness_y = 2.0f;
    auto normals = tex::bake(field);
    EXPECT_TRUE(normals);
    return level_of(std::move(*normals), 64);
}

struct EngineCase {
    const char* name;
    tex::Decoder decoder;
    peers::Binormal binormal;
};

class MeshOnMesa : public testing::TestWithParam<EngineCase> {
protected:
    void SetUp() override { ASSERT_TRUE(peers::software_gl_works()) << "Mesa's off-screen OpenGL gave no context"; }
};

TEST_P(MeshOnMesa, SolidsFromFormulas) {
    const tex::MipChain map = waves();
    for (const tex::Solid& solid : {tex::sphere(), tex::torus(), tex::smooth_cube()}) {
        SCOPED_TRACE(solid.name);
        const auto tangents = tex::make_tangents(solid.part);
        ASSERT_TRUE(tangents);
        expect_equal_pictures({solid.part, *tangents, 0, GetParam().decoder}, GetParam().binormal, map);
    }
}

TEST_P(MeshOnMesa, ModelsOfOthersWithTheirMaps) {
    const fs::path data = fs::path(TEX_SOURCE_DIR) / "../shared/data/mesh";
    if (!fs::exists(data)) GTEST_SKIP() << data << " is not there";
    struct Model {
        const char *mesh, *material, *map;
    };
    for (const Model& model : {Model{"Suzanne/02_suzanne.gltf", "0", "Suzanne/02_suzanne_Normal.png"},
                               Model{"FlightHelmet/FlightHelmet.gltf", "LeatherPartsMat",
                                     "FlightHelmet/FlightHelmet_Materials_LeatherPartsMat_Normal.png"},
                               Model{"FlightHelmet/FlightHelmet.gltf", "GlassPlasticMat",
                                     "FlightHelmet/FlightHelmet_Materials_GlassPlasticMat_Normal.png"}}) {
        SCOPED_TRACE(model.map);
        const auto mesh = tex::read_mesh((data / model.mesh).string());
        ASSERT_TRUE(mesh) << mesh.error().message();
        tex::MeshSelection selection;
        selection.material = model.material;
        const auto selected = tex::select_part(*mesh, selection);
        ASSERT_TRUE(selected) << selected.error().message();
        const auto image = tex::read_image((data / model.map).string());
        ASSERT_TRUE(image) << image.error().message();
        auto normals = tex::unpack(*image);
        ASSERT_TRUE(normals) << normals.error().message();
        expect_equal_pictures({selected->part, selected->tangents, 0, GetParam().decoder}, GetParam().binormal,
                              level_of(std::move(*normals), 64));
    }
}

INSTANTIATE_TEST_SUITE_P(Decoders, MeshOnMesa,
                         testing::Values(EngineCase{"PerFragment", tex::Decoder::gltf, peers::Binormal::per_fragment},
                                         EngineCase{"PerVertex", tex::Decoder::unity_builtin,
                                                    peers::Binormal::per_vertex},
                                         EngineCase{"Three", tex::Decoder::three, peers::Binormal::normalized}),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
