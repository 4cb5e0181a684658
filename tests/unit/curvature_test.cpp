// SPDX-License-Identifier: Apache-2.0

#include <tex/surface.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>

#include "unit/fields.h"
#include "unit/targets.h"

namespace {

using namespace tex;

// A surface with its slopes, to the right and upwards, and its curvature of both kinds, at a point in texels; y points
// up.
struct Surface {
    std::function<double(double x, double y)> p, q, mean, divergence;
};

NormalMap map_of(Extent extent, const Surface& surface) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double x = i - 0.5 * (extent.width - 1), y = 0.5 * (extent.height - 1) - j;
            const double p = surface.p(x, y), q = surface.q(x, y);
            const double length = std::sqrt(p * p + q * q + 1.0);
            map.x.at(i, j) = static_cast<float>(-p / length);
            map.y.at(i, j) = static_cast<float>(-q / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
    }
    return map;
}

// The largest error inside the border, relative to the largest curvature.
double error_of(Extent extent, const Surface& surface, CurvatureKind kind) {
    const auto result = curvature(map_of(extent, surface), {kind, Wrap::clamp, Wrap::clamp});
    const auto& truth = kind == CurvatureKind::mean ? surface.mean : surface.divergence;
    double error = 0.0, largest = 0.0;
    for (int j = 1; j < extent.height - 1; ++j) {
        for (int i = 1; i < extent.width - 1; ++i) {
            const double is = truth(i - 0.5 * (extent.width - 1), 0.5 * (extent.height - 1) - j);
            largest = std::max(largest, std::abs(is));
            error = std::max(error, std::abs(static_cast<double>(result->values.at(i, j)) - is));
        }
    }
    return error / largest;
}

// Mean curvature of z = h(x, y): -((1 + q^2) hxx - 2 p q hxy + (1 + p^2) hyy) / (2 (1 + p^2 + q^2)^(3/2)).
double mean_curvature(double p, double q, double hxx, double hxy, double hyy) {
    const double square = 1.0 + p * p + q * q;
    return -((1.0 + q * q) * hxx - 2.0 * p * q * hxy + (1.0 + p * p) * hyy) / (2.0 * square * std::sqrt(square));
}

Surface sphere(double r) {
    const auto z = [r](double x, double y) { return std::sqrt(r * r - x * x - y * y); };
    return {[z](double x, double y) { return -x / z(x, y); }, [z](double x, double y) { return -y / z(x, y); },
            [r](double, double) { return 1.0 / r; },
            [z, r](double x, double y) {
                const double d = z(x, y);
                return 0.5 * ((r * r - y * y) + (r * r - x * x)) / (d * d * d);
            }};
}

Surface saddle(double s) {
    return {[s](double x, double) { return s * x; }, [s](double, double y) { return -0.5 * s * y; },
            [s](double x, double y) { return mean_curvature(s * x, -0.5 * s * y, s, 0.0, -0.5 * s); },
            [s](double, double) { return -0.25 * s; }};
}

// h = a sin(w x) cos(w y)
Surface waves(double a, double w) {
    const auto p = [=](double x, double y) { return a * w * std::cos(w * x) * std::cos(w * y); };
    const auto q = [=](double x, double y) { return -a * w * std::sin(w * x) * std::sin(w * y); };
    const auto h = [=](double x, double y) { return a * std::sin(w * x) * std::cos(w * y); };
    return {p, q,
            [=](double x, double y) {
                const double hxy = -a * w * w * std::cos(w * x) * std::sin(w * y);
                return mean_curvature(p(x, y), q(x, y), -w * w * h(x, y), hxy, -w * w * h(x, y));
            },
            [=](double x, double y) { return w * w * h(x, y); }};
}

TEST(Curvature, SphereSaddleAndWavesAreWithinOnePercent) {
    for (const CurvatureKind kind : {CurvatureKind::mean, CurvatureKind::divergence}) {
        EXPECT_LT(error_of({65, 49}, sphere(80.0), kind), 0.01);
        EXPECT_LT(error_of({65, 49}, saddle(0.01), kind), 0.01);
        EXPECT_LT(error_of({65, 49}, waves(4.0, 0.1), kind), 0.01);
    }
}

TEST(Curvature, ConvergesWithSecondOrder) {
    // One surface on half the texels: the error is divided by four; log2 of the ratio is the order.
    for (const CurvatureKind kind : {CurvatureKind::mean, CurvatureKind::divergence}) {
        const double coarse = error_of({33, 33}, waves(4.0, 0.2), kind);
        const double fine = error_of({65, 65}, waves(8.0, 0.1), kind);
        EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15);
    }
}

TEST(Curvature, BumpsArePositiveAndDentsNegative) {
    const auto bump = curvature(map_of({9, 9}, sphere(12.0)));
    EXPECT_GT(bump->values.at(4, 4), 0.0f);
    const HeightField dent = fields::field_of(
        {9, 9}, 1.0f, Wrap::clamp, [](int i, int j) { return 0.02 * ((i - 4) * (i - 4) + (j - 4) * (j - 4)); });
    const auto map = bake(dent);
    EXPECT_LT(curvature(*map)->values.at(4, 4), 0.0f);
}

TEST(Curvature, BordersFollowTheWrap) {
    // h = cos(w (i + 1/2)) is even about its border: mirrored, its curvature is exact there, too.
    constexpr int kWidth = 32;
    const double w = 3.14159265358979323846 / kWidth;
    const HeightField field =
        fields::field_of({kWidth, 4}, 1.0f, Wrap::mirror, [&](int i, int) { return std::cos(w * (i + 0.5)); });
    const auto map = bake(field);
    const CurvatureOptions mirror{CurvatureKind::divergence, Wrap::mirror, Wrap::mirror};
    const auto mirrored = curvature(*map, mirror);
    for (const int i : {0, 1, kWidth - 1})
        EXPECT_NEAR(static_cast<double>(mirrored->values.at(i, 0)), 0.5 * w * w * std::cos(w * (i + 0.5)), 2e-5);
    // A clamped border keeps a constant change of slope.
    const Surface bowl = saddle(0.01);
    const auto clamped = curvature(map_of({17, 13}, bowl), {CurvatureKind::divergence, Wrap::clamp, Wrap::clamp});
    for (const auto& [i, j] : {std::pair{0, 0}, {16, 12}, {8, 0}, {0, 6}})
        EXPECT_NEAR(clamped->values.at(i, j), -0.0025f, 1e-6f);
}

TEST(Curvature, FlatMapsAndSingleTexelsDoNotBend) {
    for (const Extent extent : {Extent{1, 1}, Extent{1, 5}, Extent{6, 1}, Extent{7, 7}}) {
        const auto flat =
            curvature(map_of(extent, {[](double, double) { return 0.0; }, [](double, double) { return 0.0; }, {}, {}}));
        EXPECT_EQ(flat->least, 0.0f);
        EXPECT_EQ(flat->greatest, 0.0f);
        EXPECT_EQ(flat->rms, 0.0);
    }
    // An axis of one texel does not bend, however steep it is.
    const auto thin = curvature(map_of({1, 1}, saddle(3.0)), {CurvatureKind::mean, Wrap::clamp, Wrap::clamp});
    EXPECT_EQ(thin->values.at(0, 0), 0.0f);
}

TEST(Curvature, SameBytesForEveryNumberOfThreadsAndEveryTarget) {
    const NormalMap map = fields::noise_normals({331, 257});
    for (const CurvatureKind kind : {CurvatureKind::mean, CurvatureKind::divergence}) {
        const std::uint64_t hash = fields::hash_of(curvature(map, {kind})->values);
        for (const int threads : {2, 5})
            EXPECT_EQ(fields::hash_of(curvature(map, {kind}, {threads, {}})->values), hash);
        on_every_target([&] { EXPECT_EQ(fields::hash_of(curvature(map, {kind})->values), hash); });
    }
}

}  // namespace
