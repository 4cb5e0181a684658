// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/pack.h>

#include "unit/convert_maps.h"
#include "unit/fields.h"

namespace tex {
namespace {

TEST(Convert, ReturnsToTheMapForEveryDecoder) {
    std::vector<MeshPart> parts = {wavy_part(20, true), wavy_part(3)};
    for (const Solid& solid : {sphere(), torus(), smooth_cube()}) parts.push_back(solid.part);
    const NormalMap map = bumpy_map({192, 128});
    for (const MeshPart& part : parts) {
        const auto tangents = make_tangents(part);
        ASSERT_TRUE(tangents);
        for (const auto& decoder : kDecoderNames) {
            const TangentSpace space{part, *tangents, 0, decoder.value};
            const auto object = to_object_space(map, space);
            ASSERT_TRUE(object);
            const auto back = to_tangent_space(object->map, space);
            ASSERT_TRUE(back);
            EXPECT_EQ(back->backward, 0);
            EXPECT_EQ(back->singular, 0);
            const Angles angles = angles_between(map, back->map, object->coverage);
            EXPECT_LT(angles.max, 1e-4) << decoder.name;
            EXPECT_GT(angles.texels, 5000);
            EXPECT_EQ(angles.texels, object->covered);
        }
    }
}

// What a map shows that was made for one decoder and is read by another: mean and largest angle in degrees, on surfaces
// that are flat. The table of convert-normals(1).
struct Mismatch {
    const char* solid;
    Decoder made_for, read_by;
    double mean, max;
};
constexpr Decoder kPerVertex = Decoder::unity_builtin, kPerFragment = Decoder::unreal, kThree = Decoder::three;
constexpr Mismatch kMismatches[] = {
    {"cube", kPerVertex, kPerFragment, 5.48, 11.28},    {"cube", kPerVertex, kThree, 4.22, 6.87},
    {"cube", kPerFragment, kPerVertex, 6.18, 11.85},    {"cube", kPerFragment, kThree, 5.88, 12.90},
    {"cube", kThree, kPerVertex, 4.77, 8.53},           {"cube", kThree, kPerFragment, 6.49, 16.01},
    {"torus", kPerVertex, kPerFragment, 0.010, 0.060},  {"torus", kPerVertex, kThree, 0.051, 0.304},
    {"torus", kPerFragment, kPerVertex, 0.010, 0.062},  {"torus", kPerFragment, kThree, 0.048, 0.304},
    {"torus", kThree, kPerVertex, 0.054, 0.328},        {"torus", kThree, kPerFragment, 0.051, 0.328},
    {"sphere", kPerVertex, kPerFragment, 0.005, 0.023}, {"sphere", kPerVertex, kThree, 0.003, 0.022},
    {"sphere", kPerFragment, kPerVertex, 0.005, 0.023}, {"sphere", kPerFragment, kThree, 0.005, 0.020},
    {"sphere", kThree, kPerVertex, 0.003, 0.023},       {"sphere", kThree, kPerFragment, 0.005, 0.020},
};

TEST(Convert, ShowsFlatSurfacesFlatUnderTheMatchingDecoderAlone) {
    for (const Solid& solid : {sphere(), torus(), smooth_cube()}) {
        const NormalMap truth = surface_map(solid, {384, 256});
        const auto tangents = make_tangents(solid.part);
        ASSERT_TRUE(tangents);
        const auto angles = [&](Decoder made_for, Decoder read_by) {
            const auto tangent = to_tangent_space(truth, {solid.part, *tangents, 0, made_for});
            EXPECT_TRUE(tangent);
            EXPECT_EQ(tangent->backward, 0);
            const auto seen = to_object_space(tangent->map, {solid.part, *tangents, 0, read_by});
            EXPECT_TRUE(seen);
            return angles_between(truth, seen->map, seen->coverage);
        };
        for (const auto& decoder : kDecoderNames) EXPECT_LT(angles(decoder.value, decoder.value).max, 1e-4);
        for (const Mismatch& row : kMismatches) {
            if (row.solid != solid.name) continue;
            const Angles seen = angles(row.made_for, row.read_by);
            EXPECT_NEAR(seen.mean, row.mean, 0.001 + 0.002 * row.mean) << row.solid;
            EXPECT_NEAR(seen.max, row.max, 0.001 + 0.002 * row.max) << row.solid;
        }
    }
}

TEST(Convert, KeepsFlatSurfacesFlatAtEightBits) {
    for (const Solid& solid : {sphere(), torus(), smooth_cube()}) {
        const NormalMap truth = surface_map(solid, {192, 128});
        const auto tangents = make_tangents(solid.part);
        ASSERT_TRUE(tangents);
        for (const auto& decoder : kDecoderNames) {
            const TangentSpace space{solid.part, *tangents, 0, decoder.value};
            auto tangent = to_tangent_space(truth, space);
            ASSERT_TRUE(tangent);
            MipChain chain;
            chain.levels.push_back(std::move(tangent->map));
            PackOptions rgb8;
            rgb8.encoding = Encoding::rgb8;
            const auto packed = pack(chain, rgb8);
            ASSERT_TRUE(packed);
            const auto unpacked = unpack(*packed);
            ASSERT_TRUE(unpacked);
            const auto seen = to_object_space(unpacked->levels.front(), space);
            ASSERT_TRUE(seen);
            const Angles angles = angles_between(truth, seen->map, seen->coverage);
            EXPECT_LT(angles.mean, 0.25) << solid.name << " " << decoder.name;
            EXPECT_LT(angles.max, 0.6) << solid.name << " " << decoder.name;
        }
    }
}

// The right half of the map shows the sheet again, mirrored.
TEST(Convert, TurnsMirroredChartsTheRightWay) {
    MeshPart part = wavy_part(8);
    const std::size_t vertices = part.positions.size(), corners = part.indices.size();
    for (std::size_t v = 0; v < vertices; ++v) {
        part.uvs[0][v] = {0.45f * part.uvs[0][v].x, 0.9f * part.uvs[0][v].y - 0.1f};
        part.positions.push_back(part.positions[v]);
        part.normals.push_back(part.normals[v]);
        part.uvs[0].push_back({1.0f - part.uvs[0][v].x, part.uvs[0][v].y});
    }
    for (std::size_t k = 0; k < corners; ++k)
        part.indices.push_back(part.indices[k] + static_cast<std::uint32_t>(vertices));
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const Extent extent{100, 50};
    const auto right = to_object_space(constant_map(extent, {0.6f, 0.0f, 0.8f}), {part, *tangents});
    const auto up = to_object_space(constant_map(extent, {0.0f, 0.6f, 0.8f}), {part, *tangents});
    ASSERT_TRUE(right && up);
    EXPECT_EQ(right->overlaps, 0);
    EXPECT_GT(right->covered, 2000);
    for (int j = 0; j < 50; ++j) {
        for (int i = 0; i < 45; ++i) {
            const int mirror = 99 - i;
            if (right->coverage.at(i, j) != Coverage::triangle) continue;
            if (right->coverage.at(mirror, j) != Coverage::triangle) continue;
            EXPECT_LT(right->map.x.at(mirror, j), right->map.x.at(i, j) - 0.5f);
            EXPECT_LT(degrees_between(vector_at(up->map, i, j), vector_at(up->map, mirror, j)), 0.5);
        }
    }
}

TEST(Convert, MakesTexelsWithoutTangentSpaceFlat) {
    MeshPart part = square(0.25f, 0.75f);
    for (Float3& n : part.normals) n = {0.6f, 0.0f, 0.8f};
    for (const Float4& tangent : {Float4{0.6f, 0.0f, 0.8f, 1.0f}, Float4{0.0f, 0.0f, 0.0f, 1.0f}}) {
        const std::vector<Float4> tangents(6, tangent);
        for (const auto& decoder : kDecoderNames) {
            const TangentSpace space{part, tangents, 0, decoder.value};
            const auto flat = to_tangent_space(constant_map({16, 16}, {0.6f, 0.0f, 0.8f}), space);
            ASSERT_TRUE(flat);
            EXPECT_EQ(flat->singular, 64);
            EXPECT_EQ(flat->map.z.at(8, 8), 1.0f);
            const auto object = to_object_space(constant_map({16, 16}, {0.0f, 1.0f, 0.0f}), space);
            ASSERT_TRUE(object);
            EXPECT_NEAR(object->map.x.at(8, 8), 0.6f, 1e-6f);  // the normal of the mesh
            EXPECT_NEAR(object->map.z.at(8, 8), 0.8f, 1e-6f);
        }
    }
}

TEST(Convert, CountsNormalsThatPointIntoTheSurface) {
    const MeshPart part = square(0.25f, 0.75f);
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const auto converted = to_tangent_space(constant_map({16, 16}, {0.6f, 0.0f, -0.8f}), {part, *tangents});
    ASSERT_TRUE(converted);
    EXPECT_EQ(converted->backward, 64);
    EXPECT_FLOAT_EQ(converted->map.z.at(8, 8), -0.8f);
}

TEST(Convert, MakesUnitVectorsOfTrianglesThatNobodyWouldModel) {
    for (unsigned seed = 1; seed <= 60; ++seed) {
        MeshPart part = random_part(seed);
        for (Float2& uv : part.uvs[0]) uv = {0.1f * uv.x, 0.1f * uv.y};  // at most 16 repeats
        const auto tangents = make_tangents(part);
        ASSERT_TRUE(tangents);
        for (const auto& decoder : kDecoderNames) {
            for (const auto verb : {to_object_space, to_tangent_space}) {
                const auto converted = verb(bumpy_map({40, 30}), {part, *tangents, 0, decoder.value}, {}, {2, {}});
                if (!converted) {
                    EXPECT_EQ(converted.error().reason, "its triangles cover no texel of the map");
                    continue;
                }
                for (int j = 0; j < 30; ++j) {
                    for (int i = 0; i < 40; ++i) {
                        const Float3 n = vector_at(converted->map, i, j);
                        EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1.0f, 1e-5f) << seed;
                    }
                }
            }
        }
    }
}

// The mesh stays, the tangents change: what the engine shows does not.
TEST(Convert, RefitsMapsToOtherTangentsAndDecoders) {
    const Solid solid = torus();
    const auto before = make_tangents(solid.part, TangentMethod::mikktspace);
    const auto after = make_tangents(solid.part, TangentMethod::meshopt);
    ASSERT_TRUE(before && after);
    const NormalMap map = bumpy_map({192, 128});
    const TangentSpace from{solid.part, *before, 0, Decoder::unreal}, to{solid.part, *after, 0, Decoder::godot};
    const auto fitted = refit(map, from, to);
    ASSERT_TRUE(fitted);
    EXPECT_EQ(fitted->unmatched, 0);
    const auto wanted = to_object_space(map, from), got = to_object_space(fitted->map, to);
    const auto unfit = to_object_space(map, to);
    ASSERT_TRUE(wanted && got && unfit);
    EXPECT_LT(angles_between(wanted->map, got->map, got->coverage).max, 1e-4);
    EXPECT_GT(angles_between(wanted->map, unfit->map, got->coverage).max, 0.5);

    // It is one step after the other, with the same options.
    const auto first = to_object_space(map, from, {kPadAll, 2});
    ASSERT_TRUE(first);
    const auto second = to_tangent_space(first->map, to, {5, 2}), both = refit(map, from, to, {5, 2});
    ASSERT_TRUE(second && both);
    EXPECT_TRUE(fields::same_bytes(both->map, second->map));

    MeshPart moved = solid.part;  // to a smaller chart, and a larger one
    for (Float2& uv : moved.uvs[0]) uv = {0.5f * uv.x, 0.5f * uv.y};
    const TangentSpace small{moved, *before};
    const auto smaller = refit(map, from, small), larger = refit(map, small, from);
    ASSERT_TRUE(smaller && larger);
    EXPECT_EQ(smaller->unmatched, 0);
    EXPECT_EQ(larger->unmatched, larger->covered - smaller->covered);
}

// Godot rebuilds z, so that a stored z of another length changes nothing there, and much elsewhere.
TEST(Convert, GodotIgnoresTheZOfTheMap) {
    const Solid solid = torus();
    const auto tangents = make_tangents(solid.part);
    ASSERT_TRUE(tangents);
    const NormalMap map = bumpy_map({96, 64});
    NormalMap other = bumpy_map({96, 64});
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 96; ++i) other.z.at(i, j) *= 0.3f;
    }
    for (const auto& decoder : kDecoderNames) {
        const TangentSpace space{solid.part, *tangents, 0, decoder.value};
        const auto wanted = to_object_space(map, space), got = to_object_space(other, space);
        ASSERT_TRUE(wanted && got);
        const double most = angles_between(wanted->map, got->map, got->coverage).max;
        if (decoder.value == Decoder::godot)
            EXPECT_LT(most, 1e-4);
        else
            EXPECT_GT(most, 5.0) << decoder.name;
    }
}

TEST(Convert, GivesTheSameBytesForEveryNumberOfThreads) {
    const Solid solid = smooth_cube();
    const auto tangents = make_tangents(solid.part);
    ASSERT_TRUE(tangents);
    const NormalMap map = bumpy_map({300, 200});
    const auto one = to_object_space(map, {solid.part, *tangents}, {}, {1, {}});
    const auto two = to_object_space(map, {solid.part, *tangents}, {}, {2, {}});
    ASSERT_TRUE(one && two);
    for (int j = 0; j < 200; ++j) {
        EXPECT_TRUE(std::equal(one->map.x.row(j), one->map.x.row(j) + 300, two->map.x.row(j)));
        EXPECT_TRUE(std::equal(one->map.z.row(j), one->map.z.row(j) + 300, two->map.z.row(j)));
    }
}

TEST(Convert, RefusesWhatDoesNotFit) {
    MeshPart part = wavy_part(2);
    const std::vector<Float4> none;
    const auto tangents = make_tangents(part);
    const NormalMap map = bumpy_map({8, 8});
    EXPECT_EQ(to_object_space(map, {part, *tangents, 1}).error().code, ErrorCode::bad_option);
    EXPECT_EQ(to_object_space(map, {part, none, 0}).error().code, ErrorCode::bad_option);
    EXPECT_EQ(to_object_space(map, {part, none, 0, Decoder::gltf, "m.obj"}).error().file, "m.obj");
    MeshPart bare = part;
    bare.normals.clear();
    EXPECT_EQ(to_object_space(map, {bare, *tangents}).error().reason, "the mesh has no normals");
    MeshPart point = part;
    for (Float2& uv : point.uvs[0]) uv = {0.5f, 0.5f};
    EXPECT_EQ(to_object_space(map, {point, *tangents}).error().reason, "its triangles cover no texel of the map");
    MeshPart tall = part;
    for (Float2& uv : tall.uvs[0]) uv.y *= 100.0f;
    EXPECT_EQ(to_object_space(map, {tall, *tangents}).error().code, ErrorCode::unsupported);
    for (Float2& uv : part.uvs[0]) uv.x *= 100.0f;
    EXPECT_EQ(to_object_space(map, {part, *tangents}).error().code, ErrorCode::unsupported);
    for (Float2& uv : part.uvs[0]) uv = {1e30f, 1e30f};
    EXPECT_EQ(to_object_space(map, {part, *tangents}).error().code, ErrorCode::unsupported);
    const MeshPart heap = square(0.0f, 1.0f, 2000);
    const std::vector<Float4> many(heap.indices.size(), {1.0f, 0.0f, 0.0f, 1.0f});
    EXPECT_EQ(to_object_space(bumpy_map({1024, 1024}), {heap, many}).error().reason,
              "its triangles cover the map more than a thousand times");
}

}  // namespace
}  // namespace tex
