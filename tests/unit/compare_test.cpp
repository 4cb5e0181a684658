// SPDX-License-Identifier: Apache-2.0

#include <tex/check.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace tex {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

// Tilts a normal by `degrees` to the right.
void set_tilt(NormalMap& map, int i, int j, double degrees) {
    map.x.at(i, j) = static_cast<float>(std::sin(degrees * kDegree));
    map.y.at(i, j) = 0.0f;
    map.z.at(i, j) = static_cast<float>(std::cos(degrees * kDegree));
}

NormalMap flat(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) set_tilt(map, i, j, 0.0);
    }
    return map;
}

// Unit vectors over the whole upper hemisphere, the same on every run.
NormalMap scattered(Extent extent, unsigned seed) {
    NormalMap map(extent);
    unsigned state = seed;
    const auto next = [&] {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) / 16777216.0 * 2.0 - 1.0;
    };
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double x = next(), y = next(), z = std::abs(next()) + 1e-3;
            const double length = std::sqrt(x * x + y * y + z * z);
            map.x.at(i, j) = static_cast<float>(x / length);
            map.y.at(i, j) = static_cast<float>(y / length);
            map.z.at(i, j) = static_cast<float>(z / length);
        }
    }
    return map;
}

TEST(Compare, EqualMapsAreExactlyZeroDegreesApart) {
    const NormalMap map = scattered({37, 5}, 1);
    const auto comparison = compare(map, map);
    ASSERT_TRUE(comparison);
    EXPECT_EQ(comparison->error.texels, 37 * 5);
    EXPECT_EQ(comparison->error.mean, 0.0);
    EXPECT_EQ(comparison->error.max, 0.0);
    EXPECT_EQ(comparison->error.p999, 0.0);
}

TEST(Compare, MeasuresTheAngleThatWasSet) {
    for (const double degrees : {1e-4, 0.01, 0.22, 1.0, 30.0, 59.0, 61.0, 90.0, 120.0, 170.0}) {
        NormalMap tilted(Extent{1, 1});
        set_tilt(tilted, 0, 0, degrees);
        const auto comparison = compare(flat({1, 1}), tilted);
        ASSERT_TRUE(comparison);
        EXPECT_NEAR(comparison->error.max, degrees, 1e-4) << degrees;
    }
}

TEST(Compare, SmallAnglesKeepTheirDigits) {
    NormalMap tilted(Extent{1, 1});
    set_tilt(tilted, 0, 0, 1e-3);
    const auto comparison = compare(flat({1, 1}), tilted);
    ASSERT_TRUE(comparison);
    EXPECT_NEAR(comparison->error.max, 1e-3, 1e-9);
}

TEST(Compare, OppositeVectorsAre180DegreesApart) {
    NormalMap down(Extent{1, 1});
    set_tilt(down, 0, 0, 180.0);
    const auto comparison = compare(flat({1, 1}), down);
    ASSERT_TRUE(comparison);
    EXPECT_NEAR(comparison->error.max, 180.0, 0.03);
}

// Computes the same figures with doubles, atan2 and a sort.
TEST(Compare, AgreesWithTheDefinitionsInDouble) {
    for (const Extent extent :
         {Extent{1, 1}, Extent{2, 3}, Extent{15, 7}, Extent{16, 16}, Extent{17, 9}, Extent{257, 33}}) {
        const NormalMap a = scattered(extent, 1), b = scattered(extent, 2);
        std::vector<double> angles;
        double sum = 0.0, squares = 0.0;
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const double ax = a.x.at(i, j), ay = a.y.at(i, j), az = a.z.at(i, j);
                const double bx = b.x.at(i, j), by = b.y.at(i, j), bz = b.z.at(i, j);
                const double less = std::hypot(ax - bx, ay - by, az - bz), more = std::hypot(ax + bx, ay + by, az + bz);
                angles.push_back(2.0 * std::atan2(less, more) / kDegree);
                sum += angles.back();
                squares += angles.back() * angles.back();
            }
        }
        const auto count = static_cast<double>(angles.size());
        const std::vector<double> unsorted = angles;
        std::sort(angles.begin(), angles.end());
        const auto percentile = [&](double share) {
            return angles[static_cast<std::size_t>(std::ceil(share * count - 1e-9)) - 1];
        };
        const auto comparison = compare(a, b);
        ASSERT_TRUE(comparison);
        const AngularError& error = comparison->error;
        constexpr double kTolerance = 1e-3;  // angles close to 180 degrees are the least accurate
        EXPECT_NEAR(error.mean, sum / count, kTolerance);
        EXPECT_NEAR(error.rms, std::sqrt(squares / count), kTolerance);
        EXPECT_NEAR(error.p50, percentile(0.5), kTolerance);
        EXPECT_NEAR(error.p99, percentile(0.99), kTolerance);
        EXPECT_NEAR(error.p999, percentile(0.999), kTolerance);
        EXPECT_NEAR(error.max, angles.back(), kTolerance);
        const auto place = static_cast<std::size_t>(error.max_row * extent.width + error.max_column);
        EXPECT_NEAR(unsorted[place], angles.back(), kTolerance);
    }
}

TEST(Compare, NamesTheFirstOfSeveralWorstTexels) {
    const Extent extent{40, 50};
    NormalMap map = flat(extent);
    set_tilt(map, 31, 17, 25.0);
    set_tilt(map, 30, 18, 25.0);
    const auto comparison = compare(flat(extent), map);
    ASSERT_TRUE(comparison);
    EXPECT_EQ(comparison->error.max_column, 31);
    EXPECT_EQ(comparison->error.max_row, 17);
}

TEST(Compare, PercentilesAreNearestRank) {
    const Extent extent{1000, 1};
    NormalMap map = flat(extent);
    for (int i = 0; i < 10; ++i) set_tilt(map, i, 0, 10.0);  // 1 % of the texels
    auto comparison = compare(flat(extent), map);
    ASSERT_TRUE(comparison);
    EXPECT_EQ(comparison->error.p99, 0.0);
    EXPECT_NEAR(comparison->error.p999, 10.0, 1e-4);
    set_tilt(map, 10, 0, 10.0);
    comparison = compare(flat(extent), map);
    ASSERT_TRUE(comparison);
    EXPECT_NEAR(comparison->error.p99, 10.0, 1e-4);
}

TEST(Compare, GivesTheSameBytesForEveryNumberOfThreads) {
    const Extent extent{129, 300};
    const NormalMap a = scattered(extent, 3), b = scattered(extent, 4);
    Execution one;
    one.threads = 1;
    const auto expected = compare(a, b, one);
    ASSERT_TRUE(expected);
    for (const int threads : {2, 3, 8}) {
        Execution execution;
        execution.threads = threads;
        const auto comparison = compare(a, b, execution);
        ASSERT_TRUE(comparison);
        EXPECT_EQ(comparison->error.mean, expected->error.mean);
        EXPECT_EQ(comparison->error.rms, expected->error.rms);
        EXPECT_EQ(comparison->error.p50, expected->error.p50);
        EXPECT_EQ(comparison->error.p99, expected->error.p99);
        EXPECT_EQ(comparison->error.p999, expected->error.p999);
        for (int j = 0; j < extent.height; ++j) {
            ASSERT_EQ(std::memcmp(comparison->degrees.row(j), expected->degrees.row(j),
                                  static_cast<std::size_t>(extent.width) * sizeof(float)),
                      0);
        }
    }
}

TEST(Compare, StopsWhenAsked) {
    Execution execution;
    execution.progress = [](double) { return false; };
    const auto comparison = compare(flat({64, 640}), flat({64, 640}), execution);
    ASSERT_FALSE(comparison);
    EXPECT_EQ(comparison.error().code, ErrorCode::cancelled);
}

// A square of two triangles over [low, high] in u and v.
MeshPart covering_chart(float low, float high) {
    MeshPart part;
    part.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    part.uvs = {{{low, low}, {high, low}, {high, high}, {low, high}}};
    part.indices = {0, 1, 2, 0, 2, 3};
    return part;
}

TEST(Compare, OnAMeshOnlyCoveredTexelsCount) {
    const Extent extent{64, 64};
    const NormalMap a = scattered(extent, 3), b = scattered(extent, 4);
    const auto all = compare(a, b);
    const auto on_mesh = compare(a, b, covering_chart(0.25f, 0.75f));
    ASSERT_TRUE(all && on_mesh);
    std::vector<float> covered;  // the centres in the square are those of columns and rows 16 to 47
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const bool inside = i >= 16 && i < 48 && j >= 16 && j < 48;
            EXPECT_EQ(on_mesh->degrees.at(i, j), inside ? all->degrees.at(i, j) : 0.0f) << i << " " << j;
            if (inside) covered.push_back(all->degrees.at(i, j));
        }
    }
    std::sort(covered.begin(), covered.end());
    double sum = 0.0, squares = 0.0;
    for (const float angle : covered) {
        sum += static_cast<double>(angle);
        squares += static_cast<double>(angle) * static_cast<double>(angle);
    }
    const AngularError& error = on_mesh->error;
    EXPECT_EQ(error.texels, 1024);
    EXPECT_NEAR(error.mean, sum / 1024.0, 1e-9);
    EXPECT_NEAR(error.rms, std::sqrt(squares / 1024.0), 1e-9);
    EXPECT_EQ(error.p50, static_cast<double>(covered[511]));
    EXPECT_EQ(error.p99, static_cast<double>(covered[1013]));
    EXPECT_EQ(error.p999, static_cast<double>(covered[1022]));
    EXPECT_EQ(error.max, static_cast<double>(covered.back()));
    EXPECT_EQ(static_cast<double>(on_mesh->degrees.at(error.max_column, error.max_row)), error.max);
}

TEST(Compare, OnAMeshThreadsChangeNothing) {
    const NormalMap a = scattered({301, 203}, 5), b = scattered({301, 203}, 6);
    const MeshPart part = covering_chart(0.1f, 0.83f);
    const auto one = compare(a, b, part, 0, {1, {}}), many = compare(a, b, part, 0, {5, {}});
    ASSERT_TRUE(one && many);
    EXPECT_EQ(one->error.texels, many->error.texels);
    EXPECT_EQ(one->error.mean, many->error.mean);
    EXPECT_EQ(one->error.rms, many->error.rms);
    EXPECT_EQ(one->error.p999, many->error.p999);
}

TEST(Compare, AMeshThatCoversNothingIsAnError) {
    const NormalMap map = flat({8, 8});
    const auto nothing = compare(map, map, covering_chart(0.5f, 0.5f));
    ASSERT_FALSE(nothing);
    EXPECT_EQ(nothing.error().code, ErrorCode::bad_option);
    const auto no_set = compare(map, map, covering_chart(0.0f, 1.0f), 1);
    ASSERT_FALSE(no_set);
    EXPECT_EQ(no_set.error().code, ErrorCode::bad_option);
    MeshPart damaged = covering_chart(0.0f, 1.0f);
    damaged.indices[2] = 9;
    const auto refused = compare(map, map, damaged);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_data);
}

}  // namespace
}  // namespace tex
