// SPDX-License-Identifier: Apache-2.0
// Parts that stand in several places: rays hit what they would hit on copies.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "rays/ray_groups.h"
#include "unit/solids.h"
#include "unit/targets.h"
#include "unit/transfers.h"

namespace tex {
namespace {

using Rows = std::array<double, 12>;

class PlaceRandoms {
public:
    explicit PlaceRandoms(unsigned seed) : random_(seed * 7919 + 1) {}
    double around(double size) { return size * (2.0 * static_cast<double>(random_()) / 2147483646.0 - 1.0); }
    unsigned below(unsigned n) { return static_cast<unsigned>(random_() >> 8) % n; }

private:
    std::minstd_rand random_;
};

// One of the kinds of matrices that nodes have, about a place.
Rows matrix(PlaceRandoms& random, unsigned kind) {
    Rows rows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const auto fill = [&](double diagonal, double size) {
        for (std::size_t k = 0; k < 12; ++k) {
            if (k % 4 != 3) rows[k] = (k % 5 == 0 ? diagonal : 0.0) + random.around(size);
        }
    };
    if (kind == 1) fill(1.0, 0.0);
    if (kind == 2) {  // a turn, and a size
        const double c = random.around(1.0), s = std::sqrt(1.0 - c * c), size = 1.2 + random.around(0.8);
        rows = {size * c, 0, size * s, 0, 0, size, 0, 0, -size * s, 0, size * c, 0};
    }
    if (kind == 3) fill(1.0, 0.7);  // sheared
    if (kind == 4) {                // mirrored, and not uniform
        fill(1.0, 0.1);
        for (std::size_t k = 0; k < 3; ++k) rows[k] *= -0.4;
    }
    if (kind == 5) {  // nearly flat
        fill(1.0, 0.3);
        for (std::size_t k = 0; k < 3; ++k) rows[k + 8] = rows[k] * 0.5 + rows[k + 8] * 1e-7;
    }
    if (kind == 6) fill(0.0, 1e-3);
    if (kind == 7) fill(0.0, 300.0);
    if (kind == 0) return rows;
    const double far = kind == 1 ? 3000.0 : 4.0;
    for (std::size_t k = 3; k < 12; k += 4) rows[k] = random.around(far);
    return rows;
}

// Parts, their places, and copies of them.
struct Scene {
    std::vector<MeshPart> parts;
    std::vector<PartPlace> places;
    std::vector<MeshPart> copies;

    void place(std::size_t part, const Rows& to_scene) {
        places.push_back({part, "place " + std::to_string(places.size()), to_scene});
        auto copy = in_scene(parts[part], {{}, 0, to_scene});
        ASSERT_TRUE(copy) << copy.error().message();
        copies.push_back(std::move(*copy));
    }
};

MeshPart with_colors(MeshPart part) {
    for (const Float3& p : part.positions) part.colors.push_back({0.5f + 0.1f * p.x, 0.5f + 0.1f * p.y, 0.25f});
    return part;
}

Scene random_scene(unsigned seed) {
    PlaceRandoms random(seed);
    Scene scene;
    scene.parts = {sphere().part, with_colors(torus().part), square(-0.5f, 1.0f), smooth_cube().part};
    scene.parts[2].normals.clear();
    for (unsigned k = 0; k < 40; ++k) scene.place(random.below(3), matrix(random, k < 16 ? k / 2 : random.below(5)));
    scene.place(3, matrix(random, 0));  // stands alone
    scene.place(1, scene.places[random.below(20)].to_scene);
    return scene;
}

RayGroups groups_of(const std::vector<MeshPart>& high, const std::vector<PartPlace>& places) {
    TransferInputs inputs;
    inputs.high_places = places;
    static const MeshPart low = square(0.0f, 1.0f);
    auto groups = RayGroups::make(low, high, inputs, false, {}, {});
    EXPECT_TRUE(groups) << groups.error().message();
    return std::move(*groups);
}

bool same_hit(const RayHit& a, const RayHit& b) {
    return a.triangle == b.triangle && a.t == b.t && std::memcmp(a.weights, b.weights, sizeof a.weights) == 0;
}

// Near each other, or not: those that are go through the trees together.
std::vector<Ray> rays_at(const Scene& scene, PlaceRandoms& random) {
    const MeshPart& part = scene.copies[random.below(static_cast<unsigned>(scene.copies.size()))];
    const Float3 to = part.positions[random.below(static_cast<unsigned>(part.positions.size()))];
    const double size = random.below(2) == 0 ? 20.0 : 2.0, spread = random.below(3) == 0 ? 1.0 : 0.01;
    const double from[3] = {static_cast<double>(to.x) + random.around(size),
                            static_cast<double>(to.y) + random.around(size),
                            static_cast<double>(to.z) + random.around(size)};
    std::vector<Ray> rays;
    for (int k = 0; k < 19; ++k) {
        Ray ray{};
        double squared = 0.0;
        const double aim[3] = {static_cast<double>(to.x), static_cast<double>(to.y), static_cast<double>(to.z)};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = from[axis] + (k == 0 ? 0.0 : random.around(0.01));
            ray.direction[axis] = aim[axis] + (k == 0 ? 0.0 : random.around(spread)) - ray.origin[axis];
            squared += ray.direction[axis] * ray.direction[axis];
        }
        for (double& d : ray.direction) d /= std::sqrt(squared);
        ray.length = random.below(4) == 0 ? size : 1e5;
        constexpr Facing kFacings[] = {Facing::front, Facing::back, Facing::both};
        ray.facing = kFacings[random.below(3)];
        rays.push_back(ray);
    }
    return rays;
}

TEST(TransferPlaces, RaysHitExactlyWhatTheyHitOnCopies) {
    on_every_target([] {
        for (unsigned seed = 0; seed < 6; ++seed) {
            const Scene scene = random_scene(seed);
            const RayGroups placed = groups_of(scene.parts, scene.places), copied = groups_of(scene.copies, {});
            const TreeView a = placed.whole().tree().view(), b = copied.whole().tree().view();
            ASSERT_NE(a.places, nullptr);
            ASSERT_EQ(b.places, nullptr);
            PlaceRandoms random(seed + 100);
            int hits = 0;
            for (int k = 0; k < 400; ++k) {
                const std::vector<Ray> rays = rays_at(scene, random);
                std::vector<RayHit> of_a(rays.size()), of_b(rays.size());
                trace_rays(a, rays.data(), rays.size(), of_a.data());
                trace_rays(b, rays.data(), rays.size(), of_b.data());
                std::vector<std::uint8_t> blocked(rays.size());
                find_blocked(a, rays.data(), rays.size(), blocked.data());
                for (std::size_t r = 0; r < rays.size(); ++r) {
                    ASSERT_TRUE(same_hit(of_a[r], of_b[r])) << seed << " " << k << " " << r;
                    ASSERT_EQ(blocked[r], of_b[r].triangle != kNoHit ? 1 : 0);
                    hits += blocked[r];
                }
            }
            EXPECT_GT(hits, 2000);
        }
    });
}

TEST(TransferPlaces, HaveTheBoxAndTheNearestPointsOfCopies) {
    for (unsigned seed = 0; seed < 3; ++seed) {
        const Scene scene = random_scene(seed);
        const RayGroups placed = groups_of(scene.parts, scene.places), copied = groups_of(scene.copies, {});
        const BoxTree &a = placed.whole().tree(), &b = copied.whole().tree();
        EXPECT_EQ(a.low().x, b.low().x);
        EXPECT_EQ(a.high().y, b.high().y);
        EXPECT_EQ(a.high().z, b.high().z);
        PlaceRandoms random(seed);
        for (int k = 0; k < 200; ++k) {
            const Vector3 p{random.around(9.0), random.around(9.0), random.around(9.0)};
            const NearestPoint of_a = a.nearest(p), of_b = b.nearest(p);
            ASSERT_EQ(of_a.squared, of_b.squared);
            ASSERT_EQ(of_a.triangle, of_b.triangle);
        }
    }
}

// What a low mesh sees of a few solids around it.
struct Baked {
    MeshPart low = sphere().part;
    Scene scene;
    std::vector<std::vector<Float4>> tangents, of_copies;
    std::vector<std::int32_t> ids;
    NormalMap map = bumpy_map({32, 16});
    Image picture;

    Baked() {
        scene.parts = {sphere().part, with_colors(torus().part)};
        for (MeshPart& part : scene.parts) {
            const std::vector<Float4> made = *make_tangents(part);
            part.tangents.resize(part.positions.size());
            for (std::size_t c = 0; c < made.size(); ++c) part.tangents[part.indices[c]] = made[c];
        }
        PlaceRandoms random(5);
        for (unsigned k = 0; k < 24; ++k) {
            Rows rows = matrix(random, k % 5);
            for (std::size_t i = 0; i < 12; ++i) rows[i] = i % 4 == 3 ? random.around(0.5) : 0.9 * rows[i];
            scene.place(k % 2, rows);
            ids.push_back(static_cast<std::int32_t>(k % 7));
        }
        for (const char* const name : {"R", "G", "B"}) {
            picture.planes.emplace_back(map.extent());
            picture.names.emplace_back(name);
            for (int j = 0; j < 16; ++j) {
                for (int i = 0; i < 32; ++i)
                    picture.planes.back().at(i, j) = static_cast<float>((i * 7 + j * 3) % 16) / 16.0f;
            }
        }
        for (const MeshPart& part : scene.parts) tangents.push_back(*stored_tangents(part));
        for (const MeshPart& copy : scene.copies) of_copies.push_back(*stored_tangents(copy));
    }

    [[nodiscard]] Result<TransferredMaps> baked(bool in_places, TransferOptions options, bool has_groups,
                                                const Execution& execution = {}) const {
        options.object = options.heights = options.positions = options.vertex_colors = true;
        options.occlusion = options.bent = options.thickness = true;
        options.rays_per_hit = 5;
        TransferInputs inputs;
        inputs.high_ids = ids;
        if (in_places) inputs.high_places = scene.places;
        for (std::size_t k = 0; k < scene.parts.size() && in_places; ++k)
            inputs.high_details.push_back({&map, &tangents[k], Decoder::gltf, &picture});
        for (std::size_t k = 0; k < scene.copies.size() && !in_places; ++k)
            inputs.high_details.push_back({&map, &of_copies[k], Decoder::gltf, &picture});
        if (has_groups) {
            for (std::size_t k = 0; k < scene.places.size(); ++k) inputs.high_groups.push_back(k % 3 == 0 ? 1 : 2);
            for (std::size_t k = 0; k < low.triangles(); ++k) inputs.low_groups.push_back(k % 2 == 0 ? 1 : 2);
        } else {
            for (HighDetail& detail : inputs.high_details) detail.normals = nullptr;
        }
        const auto own = make_tangents(low);
        return transfer({64, 32}, {low, *own}, in_places ? scene.parts : scene.copies, inputs, options, execution);
    }
};

void expect_same(const Plane<float>& a, const Plane<float>& b) { EXPECT_TRUE(same_plane(a, b)); }

void expect_same(const TransferredMaps& a, const TransferredMaps& b) {
    EXPECT_TRUE(same_maps(a, b));
    expect_same(a.object.x, b.object.x);
    expect_same(a.position[2], b.position[2]);
    expect_same(a.occlusion, b.occlusion);
    expect_same(a.bent.x, b.bent.x);
    expect_same(a.thickness, b.thickness);
    for (std::size_t k = 0; k < 3; ++k) expect_same(a.color.planes[k], b.color.planes[k]);
    for (std::size_t k = 0; k < 3; ++k) expect_same(a.vertex_color.planes[k], b.vertex_color.planes[k]);
    EXPECT_EQ(a.front, b.front);
    EXPECT_EQ(a.back, b.back);
    EXPECT_EQ(a.missed, b.missed);
    EXPECT_EQ(a.needed_front, b.needed_front);
    std::size_t others = 0;
    for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 64; ++i) others += a.ids.at(i, j) != b.ids.at(i, j) ? 1 : 0;
    }
    EXPECT_EQ(others, 0u);
}

TEST(TransferPlaces, MakeTheMapsOfCopiesByteForByte) {
    const Baked baked;
    for (const HitChoice hit : {HitChoice::outermost, HitChoice::nearest}) {
        for (const bool backfaces : {false, true}) {
            for (const bool has_groups : {false, true}) {
                TransferOptions options;
                options.hit = hit;
                options.backfaces = backfaces;
                options.front = backfaces ? length(1.0) : Reach{};
                const auto copies = baked.baked(false, options, has_groups);
                ASSERT_TRUE(copies) << copies.error().message();
                EXPECT_GT(copies->covered - copies->missed, 500);
                for (const int threads : {1, 3}) {
                    Execution execution;
                    execution.threads = threads;
                    const auto places = baked.baked(true, options, has_groups, execution);
                    ASSERT_TRUE(places) << places.error().message();
                    expect_same(*places, *copies);
                }
            }
        }
    }
}

TEST(TransferPlaces, RefusesWhatDoesNotFit) {
    const MeshPart low = square(0.0f, 1.0f);
    TransferInputs inputs;
    inputs.high_places = {{0, "a", Rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}, {1, "b"}};
    EXPECT_EQ(guided(low, only(low), {8, 8}, inputs).error().reason, "high_places: the high mesh has no such part");
    inputs.high_places[1] = {0, "b", Rows{}};
    EXPECT_EQ(guided(low, only(low), {8, 8}, inputs).error().reason, "node \"b\": its matrix is not invertible");
    inputs.high_places[1] = {0, "b", Rows{1e39, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    EXPECT_EQ(guided(low, only(low), {8, 8}, inputs).error().code, ErrorCode::bad_data);
    inputs.high_places[1] = {0, "b"};
    inputs.high_ids = {0};
    EXPECT_EQ(guided(low, only(low), {8, 8}, inputs).error().code, ErrorCode::bad_option);
    inputs.high_ids = {0, 1};
    EXPECT_TRUE(guided(low, only(low), {8, 8}, inputs));
}

// A mesh of 8,192 triangles and one of 2, shown `times` and once.
Mesh forest(std::size_t times) {
    Mesh mesh;
    const auto flat = [](float u, float v) { return Float3{u, v, 0.0f}; };
    const auto up = [](float, float) { return Float3{0.0f, 0.0f, 1.0f}; };
    mesh.parts = {grid_part(64, 64, flat, up), square(0.0f, 1.0f)};
    mesh.parts[1].mesh = 1;
    mesh.parts[1].name = "ground";
    mesh.nodes.push_back({"", 1, {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0}});
    for (std::size_t k = 0; k < times; ++k)
        mesh.nodes.push_back(
            {"tree " + std::to_string(k), 0, {1, 0, 0, static_cast<double>(k), 0, 1, 0, 0, 0, 0, 1, 0}});
    return mesh;
}

TEST(TransferPlaces, AreKeptWhereCopiesWouldBeMany) {
    const auto few = places_in_scene(forest(31));
    ASSERT_TRUE(few);
    EXPECT_TRUE(few->places.empty());
    EXPECT_EQ(few->parts.size(), 32u);
    const auto many = places_in_scene(forest(32));
    ASSERT_TRUE(many);
    EXPECT_EQ(many->parts.size(), 2u);
    ASSERT_EQ(many->places.size(), 33u);
    EXPECT_EQ(many->places[3].name, "tree 3");
    EXPECT_EQ(many->places[3].part, 0u);
    EXPECT_EQ(many->places[3].to_scene[3], 3.0);
    EXPECT_EQ(many->parts[0].positions[1].x, 1.0f / 64.0f);
    EXPECT_EQ(many->places[32].name, "ground");  // moved, because it stands once
    EXPECT_EQ(many->places[32].to_scene[0], 1.0);
    EXPECT_EQ(many->parts[1].positions[2].x, 2.0f * forest(1).parts[1].positions[2].x);
    EXPECT_TRUE(places_in_scene(forest(32), 16 * 32));
    EXPECT_EQ(places_in_scene(forest(32), 16 * 32 - 1).error().reason,
              "its 33 nodes make 262144 triangles of 8192: too many copies");
    Mesh broken = forest(32);
    broken.nodes[7].to_scene = {};
    EXPECT_EQ(places_in_scene(broken).error().reason, "node \"tree 6\": its matrix is not invertible");
}

}  // namespace
}  // namespace tex
