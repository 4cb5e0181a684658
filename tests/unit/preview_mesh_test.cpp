// SPDX-License-Identifier: Apache-2.0
// preview() with a mesh: against the shapes that are rendered by rays, and against geometry computed by hand.

#include <tex/preview.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "unit/mesh_pictures.h"

namespace tex {
namespace {

constexpr Pixel kGroundPixel = {38, 40, 44};

PreviewOptions from_the_front(Show show, int size = 64) {
    PreviewOptions options;
    options.show = show;
    options.camera = Camera{0.0f, 0.0f, 0.0f};
    options.size = {size, size};
    options.legend = false;
    return options;
}

// Whether the pixel and its neighbours show the shape.
bool is_inside(const Texture& picture, int i, int j) {
    for (int b = -1; b <= 1; ++b) {
        for (int a = -1; a <= 1; ++a) {
            if (pixel(picture, i + a, j + b) == kGroundPixel) return false;
        }
    }
    return true;
}

// The part of the pixels that differ by more than 3 codes, of those inside of the shape in both pictures.
double part_that_differs(const Texture& a, const Texture& b) {
    int compared = 0, over = 0;
    for (int j = 1; j + 1 < a.extent().height; ++j) {
        for (int i = 1; i + 1 < a.extent().width; ++i) {
            if (!is_inside(a, i, j) || !is_inside(b, i, j)) continue;
            const Pixel p = pixel(a, i, j), q = pixel(b, i, j);
            ++compared;
            for (std::size_t c = 0; c < 3; ++c) {
                if (std::abs(p[c] - q[c]) > 3) {
                    ++over;
                    break;
                }
            }
        }
    }
    EXPECT_GT(compared, a.extent().width * a.extent().height / 4);
    return static_cast<double>(over) / std::max(1, compared);
}

TEST(PreviewMesh, SphereOfTrianglesLooksLikeTheSphereOfRays) {
    MipChain map = random_map({64, 32}, 3);
    for (Plane<float>* plane : {&map.levels[0].x, &map.levels[0].y}) {
        for (int j = 0; j < 32; ++j) {
            for (int i = 0; i < 64; ++i) plane->at(i, j) *= 0.3f;
        }
    }
    for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 64; ++i)
            map.levels[0].z.at(i, j) = reconstruct_z(map.levels[0].x.at(i, j), map.levels[0].y.at(i, j));
    }
    const MeshWithTangents mesh = fine_sphere(64);
    for (const Show show : {Show::lit, Show::normals, Show::world_normals, Show::channels}) {
        PreviewOptions options;
        options.show = show;
        options.shape = Shape::sphere;
        options.camera = Camera{25.0f, 30.0f, 40.0f};
        options.size = {240, 240};
        options.spin = 50.0f;
        options.legend = false;
        const Texture rays = render_or_fail({.map = &map}, options);
        EXPECT_LE(part_that_differs(mesh_picture(mesh, map, options), rays), 0.01) << static_cast<int>(show);
    }
}

TEST(PreviewMesh, GodotIgnoresTheZOfTheMap) {
    const MeshWithTangents mesh = quad();
    const MipChain map = constant({4, 4}, 0.5f, 0.6f, std::sqrt(0.39f)), other = constant({4, 4}, 0.5f, 0.6f, 0.1f);
    const auto drawn = [&](const MipChain& chain, Decoder decoder) {
        const TangentSpace space = mesh.space(decoder);
        return render_or_fail({.map = &chain, .mesh = &space}, from_the_front(Show::world_normals, 65));
    };
    EXPECT_EQ(difference(drawn(map, Decoder::godot), drawn(other, Decoder::godot)), 0);
    EXPECT_GT(difference(drawn(map, Decoder::gltf), drawn(other, Decoder::gltf)), 20);
}

TEST(PreviewMesh, HasTheSameBytesForAnyNumberOfThreads) {
    const MeshWithTangents mesh = fine_sphere(12);
    const MipChain map = random_map({32, 16}, 5);
    for (const auto& row : kShowNames) {
        if (row.value == Show::height) continue;
        PreviewOptions options;
        options.show = row.value;
        options.size = {70, 53};
        const Texture one = mesh_picture(mesh, map, options, on_threads(1));
        for (const int threads : {2, 4})
            EXPECT_EQ(difference(one, mesh_picture(mesh, map, options, on_threads(threads))), 0) << row.name;
    }
}

// Perspective-correct: a square far down a road shows the texels that a ray meets, not those half-way on the screen.
TEST(PreviewMesh, InterpolatesInSpaceNotOnTheScreen) {
    MipChain map = constant({256, 256}, 0.0f, 0.0f, 1.0f);
    for (int j = 0; j < 256; ++j) {
        for (int i = 0; i < 256; ++i)
            map.levels[0].y.at(i, j) = 1.0f - (static_cast<float>(j) + 0.5f) / 128.0f;  // 2 v - 1
    }
    MeshWithTangents mesh = quad(1.0f);
    PreviewOptions options;
    options.show = Show::normals;
    options.camera = Camera{0.0f, -75.0f, 90.0f};
    options.size = {200, 200};
    const Texture picture = mesh_picture(mesh, map, options);
    // The view of preview.h by hand: the sphere around the square has the radius 1 in the picture, sqrt(2) in the mesh.
    const double pitch = -75.0 * 3.14159265358979 / 180.0, distance = 1.06 * std::sqrt(2.0);
    int seen = 0;
    for (int j = 0; j < 200; ++j) {
        const double up = (1.0 - (j + 0.5) / 100.0);  // tan(45 degrees) is 1
        const double dy = up * std::cos(pitch) - std::sin(pitch), dz = -up * std::sin(pitch) - std::cos(pitch);
        const double t = -distance * std::cos(pitch) / dz, y = (distance * std::sin(pitch) + t * dy) * std::sqrt(2.0);
        if (!(t > 0.0) || std::abs(y) > 0.95) continue;
        ++seen;
        EXPECT_NEAR(pixel(picture, 100, j)[1], (y + 1.0) / 2.0 * 255.0, 2.0) << j;
    }
    EXPECT_GT(seen, 25);
}

Float3 sum(Float3 a, Float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Float3 product(Float3 a, Float3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

TEST(PreviewMesh, TheDecoderMakesTheNormals) {
    // Corners whose normals and tangents differ much, so that decoders differ in the middle.
    MeshWithTangents mesh = quad();
    const Float3 normals[4] = {{-0.8f, -0.3f, 0.5f}, {0.8f, -0.2f, 0.6f}, {-0.5f, 0.8f, 0.3f}, {0.7f, 0.6f, 0.4f}};
    const Float3 tangents[4] = {{1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0.6f, 0.8f}};
    for (std::size_t k = 0; k < 4; ++k) mesh.part.normals[k] = unit_vector(normals[k]);
    for (std::size_t k = 0; k < 6; ++k) {
        const Float3 t = tangents[mesh.part.indices[k]];
        mesh.tangents[k] = {t.x, t.y, t.z, -1.0f};
    }
    const MipChain map = constant({4, 4}, 0.5f, 0.6f, std::sqrt(0.39f));
    const auto middle = [&](Decoder decoder) {
        const TangentSpace space = mesh.space(decoder);
        return pixel(render_or_fail({.map = &map, .mesh = &space}, from_the_front(Show::world_normals, 65)), 32, 32);
    };
    const Pixel fragment = middle(Decoder::gltf), vertex = middle(Decoder::unity_builtin);
    EXPECT_EQ(fragment, middle(Decoder::unreal));
    EXPECT_EQ(vertex, middle(Decoder::godot));
    EXPECT_NE(fragment, vertex);
    EXPECT_NE(middle(Decoder::three), vertex);
    EXPECT_NE(middle(Decoder::three), fragment);

    // By hand, twice the vectors in the middle of the diagonal from corner 0 to corner 3; w is -1.
    const Float3 n = sum(mesh.part.normals[0], mesh.part.normals[3]), t = sum(tangents[0], tangents[3]);
    const Float3 halved = product(n, t), b_fragment = {halved.x / -2, halved.y / -2, halved.z / -2};
    const Float3 b = sum(product(mesh.part.normals[0], tangents[0]), product(mesh.part.normals[3], tangents[3]));
    const auto expect_decoded = [&](const Pixel& found, Float3 binormal) {
        const float z = std::sqrt(0.39f);
        const Float3 v =
            unit_vector({0.5f * t.x + 0.6f * binormal.x + z * n.x, 0.5f * t.y + 0.6f * binormal.y + z * n.y,
                         0.5f * t.z + 0.6f * binormal.z + z * n.z});
        EXPECT_NEAR(found[0], (v.x + 1.0f) * 127.5f, 1.5f);
        EXPECT_NEAR(found[1], (v.y + 1.0f) * 127.5f, 1.5f);
        EXPECT_NEAR(found[2], (v.z + 1.0f) * 127.5f, 1.5f);
    };
    expect_decoded(fragment, b_fragment);
    expect_decoded(vertex, {-b.x, -b.y, -b.z});
}

TEST(PreviewMesh, HidesWhatIsBehindAndWhatFacesAway) {
    // A square in front of a larger one, listed in both orders; their normals tell them apart.
    MeshWithTangents mesh = quad(1.0f);
    const MeshWithTangents small = quad(0.5f);
    for (const std::uint32_t v : small.part.indices) mesh.part.indices.push_back(v + 4);
    for (std::size_t k = 0; k < 4; ++k) {
        const Float3 p = small.part.positions[k];
        mesh.part.positions.push_back({p.x, p.y, 0.25f});
        mesh.part.normals.push_back({0, 1, 0});
        mesh.part.uvs[0].push_back(small.part.uvs[0][k]);
    }
    for (std::size_t k = 0; k < 6; ++k) mesh.tangents.push_back({1, 0, 0, 1});
    const MipChain map = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    const auto middle_and_side = [&] {
        const Texture picture = mesh_picture(mesh, map, from_the_front(Show::world_normals));
        return std::pair{pixel(picture, 32, 32), pixel(picture, 16, 32)};
    };
    const auto expected = std::pair{Pixel{128, 255, 128}, Pixel{128, 128, 255}};
    EXPECT_EQ(middle_and_side(), expected);
    std::rotate(mesh.part.indices.begin(), mesh.part.indices.begin() + 6, mesh.part.indices.end());
    EXPECT_EQ(middle_and_side(), expected);
    // Turned around, the small square is not drawn.
    std::swap(mesh.part.indices[1], mesh.part.indices[2]);
    std::swap(mesh.part.indices[4], mesh.part.indices[5]);
    EXPECT_EQ(middle_and_side(), (std::pair{Pixel{128, 128, 255}, Pixel{128, 128, 255}}));
}

TEST(PreviewMesh, ThePictureDoesNotDependOnTheMeshsPlaceAndSize) {
    const MipChain map = random_map({16, 16}, 9);
    const MeshWithTangents mesh = quad();
    const PreviewOptions options = from_the_front(Show::lit);
    const Texture expected = mesh_picture(mesh, map, options);
    const auto moved = [&](float scale, float x, float z) {
        MeshWithTangents other = mesh;
        for (Float3& p : other.part.positions) p = {p.x * scale + x, p.y * scale, p.z * scale + z};
        return mesh_picture(other, map, options);
    };
    EXPECT_EQ(difference(moved(0x1p120f, 0.0f, 0.0f), expected), 0);
    EXPECT_EQ(difference(moved(0x1p-120f, 0.0f, 0.0f), expected), 0);
    EXPECT_EQ(difference(moved(1.0f, 1024.0f, 4096.0f), expected), 0);  // also behind where the viewer was
}

TEST(PreviewMesh, DrawsNothingOfTrianglesWithoutArea) {
    MeshWithTangents mesh = quad();
    const MipChain map = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    for (Float3& p : mesh.part.positions) p = {3, 4, 5};
    for (const auto& row : kShowNames) {
        const PreviewOptions options = from_the_front(row.value);
        if (row.value == Show::height || row.value == Show::uv || row.value == Show::channels ||
            row.value == Show::mips) {
            continue;
        }
        EXPECT_EQ(pixel(mesh_picture(mesh, map, options), 32, 32), kGroundPixel) << row.name;
    }
    mesh = quad();
    for (Float2& uv : mesh.part.uvs[0]) uv = {0.5f, 0.5f};  // a footprint of no size
    EXPECT_EQ(pixel(mesh_picture(mesh, map, from_the_front(Show::normals)), 32, 32), (Pixel{128, 128, 255}));
}

TEST(PreviewMesh, TurnsWithTheSpin) {
    const MeshWithTangents mesh = fine_sphere(12);
    const MipChain map = random_map({32, 16}, 5);
    PreviewOptions options = from_the_front(Show::normals);
    options.spin = 40.0f;
    const Texture spun = mesh_picture(mesh, map, options);
    options.spin = 0.0f;
    options.camera = Camera{-40.0f, 0.0f, 0.0f};
    EXPECT_LE(difference(spun, mesh_picture(mesh, map, options)), 1);
}

TEST(PreviewMesh, NamesWhatIsMissing) {
    const MipChain map = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    const auto refusal = [&](const MeshWithTangents* mesh, Show show, int uv_set = 0) {
        std::optional<TangentSpace> space;
        if (mesh != nullptr) space.emplace(mesh->space());
        if (space) space->uv_set = uv_set;
        PreviewScene scene;
        scene.map = &map;
        if (space) scene.mesh = &*space;
        const auto picture = preview(scene, from_the_front(show));
        return picture ? std::string("a picture") : picture.error().message();
    };
    for (const Show show : {Show::tangents, Show::uv, Show::seams})
        EXPECT_NE(refusal(nullptr, show).find("there is no mesh"), std::string::npos);
    MeshWithTangents mesh = quad();
    EXPECT_NE(refusal(&mesh, Show::lit, 1).find("no UV set 1"), std::string::npos);
    mesh.tangents.pop_back();
    EXPECT_NE(refusal(&mesh, Show::lit).find("not one tangent for each corner"), std::string::npos);
    mesh = quad();
    mesh.part.normals.clear();
    EXPECT_NE(refusal(&mesh, Show::lit).find("no normals"), std::string::npos);
    mesh = quad();
    mesh.part.uvs[0][3] = {20.0f, 0.0f};
    EXPECT_NE(refusal(&mesh, Show::uv).find("more than 16 repeats"), std::string::npos);
    mesh.part.uvs[0].assign(4, {3e6f, 0.0f});
    EXPECT_NE(refusal(&mesh, Show::uv).find("beyond a million"), std::string::npos);
}

TEST(PreviewMesh, StopsIfItIsCancelled) {
    const MeshWithTangents mesh = fine_sphere(12);
    const TangentSpace space = mesh.space();
    const MipChain map = constant({4, 4}, 0.0f, 0.0f, 1.0f);
    Execution execution;
    execution.progress = [](double done) { return done < 0.5; };
    const auto picture = preview({.map = &map, .mesh = &space}, from_the_front(Show::lit), execution);
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace tex
