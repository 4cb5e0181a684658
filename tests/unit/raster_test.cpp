// SPDX-License-Identifier: Apache-2.0
// Triangles on a grid of samples, against a test of every sample.

#include "preview/raster.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tex::render {
namespace {

constexpr Extent kPicture{23, 37};  // several bands, the last one cut

struct Scene {
    std::vector<RasterVertex> vertices;
    std::vector<RasterTriangle> triangles;

    void add(std::array<RasterVertex, 3> corners, std::uint32_t tag, bool one_sided = false) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        vertices.insert(vertices.end(), corners.begin(), corners.end());
        triangles.push_back({{first, first + 1, first + 2}, tag, one_sided});
    }
};

// The tags of all samples, row by row.
std::vector<std::uint32_t> drawn(const Scene& scene, Extent picture = kPicture) {
    const auto raster = Raster::make(picture, scene.vertices, scene.triangles);
    EXPECT_TRUE(raster);
    std::vector<std::uint32_t> tags;
    Raster::Band band;
    for (int b = 0; raster && b < raster->bands(); ++b) {
        raster->draw(b, band);
        tags.insert(tags.end(), band.tags.begin(), band.tags.end());
    }
    return tags;
}

// One triangle at one sample, in units of 1/256 pixel: inside, or on an edge that is above or to the left.
bool covers(const RasterVertex& a, RasterVertex b, RasterVertex c, int x, int y) {
    const auto side = [](const RasterVertex& from, const RasterVertex& to, std::int64_t px, std::int64_t py) {
        return (to.x - from.x) * (py - from.y) - (to.y - from.y) * (px - from.x);
    };
    const std::int64_t area = side(a, b, c.x, c.y);
    if (area == 0) return false;
    if (area < 0) std::swap(b, c);
    const RasterVertex corner[3] = {a, b, c};
    for (int k = 0; k < 3; ++k) {
        const RasterVertex &from = corner[k], &to = corner[(k + 1) % 3];
        const std::int64_t value = side(from, to, x, y);
        const bool keeps_edge = to.y < from.y || (to.y == from.y && to.x > from.x);
        if (value < 0 || (value == 0 && !keeps_edge)) return false;
    }
    return true;
}

std::vector<std::uint32_t> tested(const Scene& scene, Extent picture = kPicture) {
    std::vector<std::uint32_t> tags;
    for (int j = 0; j < picture.height * Raster::kSide; ++j) {
        for (int i = 0; i < picture.width * Raster::kSide; ++i) {
            const int x = 64 * i + 32, y = 64 * j + 32;
            std::uint32_t nearest = kNoTag;
            double depth = 0.0;
            for (const RasterTriangle& t : scene.triangles) {
                const RasterVertex &a = scene.vertices[t.vertex[0]], &b = scene.vertices[t.vertex[1]],
                                   &c = scene.vertices[t.vertex[2]];
                const double area = double(b.x - a.x) * (c.y - a.y) - double(c.x - a.x) * (b.y - a.y);
                if (!covers(a, b, c, x, y) || (t.one_sided && area > 0.0)) continue;
                const double wb = (double(x - a.x) * (c.y - a.y) - double(c.x - a.x) * (y - a.y)) / area;
                const double wc = (double(b.x - a.x) * (y - a.y) - double(x - a.x) * (b.y - a.y)) / area;
                const double here = a.nearness * (1.0 - wb - wc) + b.nearness * wb + c.nearness * wc;
                if (nearest != kNoTag && !(here > depth)) continue;
                nearest = t.tag;
                depth = here;
            }
            tags.push_back(nearest);
        }
    }
    return tags;
}

TEST(Raster, EqualsATestOfEverySample) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        std::mt19937 engine(seed);
        // Some corners are on samples, some triangles are tiny, some reach far beyond the picture.
        const auto place = [&](int pixels, int size) {
            const int range = (pixels + 2 * size) * 256;
            const int at = static_cast<int>(engine() % static_cast<unsigned>(range)) - size * 256;
            return seed % 3 == 0 ? at / 32 * 32 : at;
        };
        Scene scene;
        for (std::uint32_t k = 0; k < 60; ++k) {
            std::array<RasterVertex, 3> corners;
            const int size = seed % 4 == 0 ? 2000 : 10;
            for (RasterVertex& v : corners) {
                v = {place(kPicture.width, size), place(kPicture.height, size), 1.0 + double(engine() % 1000)};
            }
            if (seed % 4 == 1) {
                for (std::size_t c = 1; c < 3; ++c) {
                    corners[c].x = corners[0].x + static_cast<int>(engine() % 200) - 100;
                    corners[c].y = corners[0].y + static_cast<int>(engine() % 200) - 100;
                }
            }
            scene.add(corners, k, k % 2 == 0);
        }
        EXPECT_EQ(drawn(scene), tested(scene)) << seed;
    }
}

TEST(Raster, TrianglesThatShareEdgesCoverEverySampleOnce) {
    // A fan around a point that is itself a sample; then each triangle is drawn alone.
    std::mt19937 engine(5);
    std::vector<RasterVertex> ring;
    for (int k = 0; k <= 40; ++k) ring.push_back({k * 144, 0, 1.0});
    for (int k = 0; k <= 40; ++k) ring.push_back({23 * 256, k * 237, 1.0});
    for (int k = 40; k >= 0; --k) ring.push_back({k * 147, 37 * 256 + 8, 1.0});
    for (int k = 40; k >= 0; --k) ring.push_back({0, k * 237, 1.0});
    const RasterVertex middle{64 * 40 + 32, 64 * 70 + 32, 1.0};
    std::vector<int> count(static_cast<std::size_t>(kPicture.texels()) * Raster::kSamples);
    for (std::size_t k = 0; k < ring.size(); ++k) {
        Scene scene;
        scene.add({ring[k], ring[(k + 1) % ring.size()], middle}, 0);
        const auto tags = drawn(scene);
        for (std::size_t s = 0; s < tags.size(); ++s) count[s] += tags[s] == 0 ? 1 : 0;
    }
    EXPECT_EQ(std::count(count.begin(), count.end(), 1), static_cast<std::ptrdiff_t>(count.size()));
}

TEST(Raster, OfEqualTrianglesTheFirstIsSeenInAnyOrder) {
    Scene scene;
    const std::array<RasterVertex, 3> corners = {{{0, 0, 1.0}, {256 * 20, 0, 2.0}, {0, 256 * 30, 3.0}}};
    for (const std::uint32_t tag : {7u, 3u, 5u}) scene.add(corners, tag);
    const auto tags = drawn(scene);
    EXPECT_EQ(std::count(tags.begin(), tags.end(), 7u) + std::count(tags.begin(), tags.end(), 5u), 0);
    EXPECT_GT(std::count(tags.begin(), tags.end(), 3u), 1000);
}

TEST(Raster, PlacesBecomeUnits) {
    const RasterVertex v = raster_vertex({1.5, -2.25, 4.0});
    EXPECT_EQ(v.x, 384);
    EXPECT_EQ(v.y, -576);
    EXPECT_EQ(v.nearness, 4.0);
    EXPECT_EQ(raster_vertex({-1.0 / 1024, 0.0, 0.0}).x, 0);
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    EXPECT_EQ(raster_vertex({nan, 0.0, 0.0}).x, -(1 << 28));
    EXPECT_EQ(raster_vertex({infinite, 0.0, 0.0}).x, 1 << 28);
    EXPECT_EQ(raster_vertex({-infinite, 1e300, 0.0}).y, 1 << 28);
}

TEST(Raster, CornersFarAwayCoverThePictureAndCauseNoOverflow) {
    Scene scene;
    const auto corner = [](double x, double y) { return raster_vertex({x, y, 1.0}); };
    scene.add({corner(-1e30, -1e30), corner(1e30, -1e30), corner(0.0, 1e30)}, 0);
    const auto tags = drawn(scene);
    EXPECT_EQ(std::count(tags.begin(), tags.end(), 0u), static_cast<std::ptrdiff_t>(tags.size()));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Scene lost;
    lost.add({corner(nan, nan), corner(nan, nan), corner(nan, nan)}, 0);
    EXPECT_EQ(drawn(lost), std::vector<std::uint32_t>(tags.size(), kNoTag));
}

TEST(Raster, RefusesTooManyLayers) {
    Scene scene;
    const Extent picture{512, 512};
    const std::array<RasterVertex, 3> whole = {{{0, 0, 1.0}, {256 * 1024, 0, 1.0}, {0, 256 * 1024, 1.0}}};
    for (std::uint32_t k = 0; k < 1000; ++k) scene.add(whole, k);
    EXPECT_TRUE(Raster::make(picture, scene.vertices, scene.triangles));
    for (std::uint32_t k = 0; k < 2000; ++k) scene.add(whole, k);
    const auto refused = Raster::make(picture, scene.vertices, scene.triangles);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace tex::render
