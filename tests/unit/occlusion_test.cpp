// SPDX-License-Identifier: Apache-2.0

#include <tex/surface.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/file.h>

#include "reference/occlusion.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace {

using namespace tex;

constexpr OcclusionOptions kAllMaps{64, 0.0f, true, true, true};
constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

// The mean of a value over all directions.
double mean_of_turn(const std::function<double(double angle)>& value) {
    constexpr int kParts = 100000;
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) sum += value(2.0 * 3.14159265358979323846 * (k + 0.5) / kParts);
    return sum / kParts;
}

// Where the normal is upright, and horizons have these tangents.
void expect_sky(const HeightField& field, int i, int j, const std::function<double(double angle)>& tangent) {
    const auto maps = occlusion(field, kAllMaps);
    ASSERT_TRUE(maps);
    const double sky = mean_of_turn([&](double a) { return 1.0 - std::sin(std::atan(tangent(a))); });
    const double light = mean_of_turn([&](double a) { return std::pow(std::cos(std::atan(tangent(a))), 2); });
    EXPECT_NEAR(static_cast<double>(maps->sky_view.at(i, j)), sky, 0.005);
    EXPECT_NEAR(static_cast<double>(maps->occlusion.at(i, j)), light, 0.005);
}

HeightField rough_field(Extent extent, float bumpiness, Wrap wrap) {
    return fields::field_of(extent, bumpiness, wrap, [&](int i, int j) {
        const double x = 6.2831853 * i / extent.width, y = 6.2831853 * j / extent.height;
        return std::sin(x + 2.0 * y) + std::cos(2.0 * x) + 0.5 * std::sin(5.0 * y) + 0.1 * fields::noise(i, j);
    });
}

struct SkyErrors {
    double occlusion = 0.0, sky_view = 0.0, degrees = 0.0;  // means
};

// Beside the reference, at a texel of every so many.
SkyErrors errors_of(const HeightField& field, const OcclusionOptions& options, int every) {
    const auto maps = occlusion(field, options);
    const auto normals = bake(field);
    EXPECT_TRUE(maps && normals);
    SkyErrors sum;
    int count = 0;
    const Extent extent = field.height.extent();
    for (int k = every / 2; k < extent.texels(); k += every, ++count) {
        const int i = k % extent.width, j = k / extent.width;
        const auto z = static_cast<double>(normals->z.at(i, j));
        const double p = -static_cast<double>(normals->x.at(i, j)) / z;
        const double q = -static_cast<double>(normals->y.at(i, j)) / z;
        const auto is = reference::sky_of(field, i, j, p, q, 128, static_cast<double>(options.distance));
        sum.occlusion += std::abs(static_cast<double>(maps->occlusion.at(i, j)) - is.occlusion);
        sum.sky_view += std::abs(static_cast<double>(maps->sky_view.at(i, j)) - is.sky_view);
        const double cosine = is.bent[0] * static_cast<double>(maps->bent.x.at(i, j)) +
                              is.bent[1] * static_cast<double>(maps->bent.y.at(i, j)) +
                              is.bent[2] * static_cast<double>(maps->bent.z.at(i, j));
        sum.degrees += std::acos(std::min(1.0, cosine)) * 57.29577951;
    }
    return {sum.occlusion / count, sum.sky_view / count, sum.degrees / count};
}

TEST(Occlusion, PlanesAreOpen) {
    for (const Extent extent : {Extent{1, 1}, Extent{1, 5}, Extent{67, 1}, Extent{70, 9}}) {
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
            const auto maps = occlusion(fields::field_of(extent, 9.0f, wrap, [](int, int) { return 0.3; }), kAllMaps);
            for (int j = 0; j < extent.height; ++j) {
                EXPECT_NEAR(maps->occlusion.at(0, j), 1.0f, 1e-5f);
                EXPECT_NEAR(maps->sky_view.at(0, j), 1.0f, 1e-5f);
                EXPECT_NEAR(maps->bent.z.at(extent.width - 1, j), 1.0f, 1e-5f);
            }
        }
    }
}

TEST(Occlusion, FollowsItsFormulas) {
    constexpr int kMiddle = 64;
    const Extent extent{2 * kMiddle + 1, 2 * kMiddle + 1};
    const auto field = [&](const std::function<double(int x, int y)>& height) {
        return fields::field_of(extent, 1.0f, Wrap::clamp,
                                [&](int i, int j) { return height(i - kMiddle, j - kMiddle); });
    };
    // A valley; sky view at its bottom is the mean of 1 - sin(atan(s |cos a|)), and occlusion 1 / sqrt(1 + s^2).
    for (const double slope : {0.25, 1.0, 3.0}) {
        expect_sky(field([&](int x, int) { return slope * std::abs(x); }), kMiddle, kMiddle,
                   [&](double a) { return slope * std::abs(std::cos(a)); });
        expect_sky(field([&](int, int y) { return slope * std::abs(y); }), kMiddle, kMiddle,
                   [&](double a) { return slope * std::abs(std::sin(a)); });
    }
    // The middle of a crater whose wall is a cone: from 20 to 60 texels away, up to 28.
    expect_sky(field([](int x, int y) { return 0.7 * std::clamp(std::hypot(x, y) - 20.0, 0.0, 40.0); }), kMiddle,
               kMiddle, [](double) { return 28.0 / 60.0; });
    // 12 texels before a step that is 9 high.
    expect_sky(field([](int x, int) { return x >= 12 ? 9.0 : 0.0; }), kMiddle, kMiddle,
               [](double a) { return std::max(0.0, 9.0 / 12.0 * std::cos(a)); });
}

TEST(Occlusion, TheBottomOfABowlSeesAllAboveItsEdge) {
    constexpr int kRadius = 100;
    const HeightField bowl = fields::field_of({225, 225}, 1.0f, Wrap::clamp, [](int i, int j) {
        const double square = std::pow(i - 112.0, 2) + std::pow(j - 112.0, 2);
        return -std::sqrt(std::max(0.0, kRadius * kRadius - square));
    });
    expect_sky(bowl, 112, 112, [](double) { return 1.0; });
}

TEST(Occlusion, OfASlopeIsThatOfTheSkyAboveIt) {
    // A wide ridge: halfway down, the light of half the sky comes over the ground, (1 + cos a) / 2.
    const HeightField ridge =
        fields::field_of({129, 9}, 1.0f, Wrap::clamp, [](int i, int) { return 0.75 * std::min(i, 128 - i); });
    const auto maps = occlusion(ridge, kAllMaps);
    EXPECT_NEAR(static_cast<double>(maps->occlusion.at(32, 4)), 0.5 * (1.0 + 0.8), 0.005);
    // What is near alone: nothing but the slope itself.
    OcclusionOptions near = kAllMaps;
    near.distance = 4.0f;
    EXPECT_NEAR(static_cast<double>(occlusion(ridge, near)->occlusion.at(32, 4)), 1.0, 0.005);
}

TEST(Occlusion, IsThatOfTheReference) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
        HeightField field = rough_field({61, 47}, 4.0f, wrap);
        const SkyErrors square = errors_of(field, {32, 0.0f, true, true, true}, 97);
        EXPECT_LT(square.occlusion, 0.004) << static_cast<int>(wrap);
        EXPECT_LT(square.sky_view, 0.006);
        EXPECT_LT(square.degrees, 0.5);
        field.bumpiness_y = 7.0f;  // texels that are wider than high
        EXPECT_LT(errors_of(field, {32, 0.0f, true, true, true}, 149).occlusion, 0.004);
        EXPECT_LT(errors_of(field, {32, 12.0f, true, true, true}, 149).occlusion, 0.004);
    }
}

TEST(Occlusion, OfRealMapsIsThatOfTheReference) {
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/height/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data";
    for (const char* const name : {"metal_plate_disp_1k_1024x1024_u16.png", "dem_puget_sound_1025x1025_u16.png",
                                   "materialx_plain_sphere_pyramid_512x512_u8.png"}) {
        const auto heights = height_field(read_image(folder + name).value());
        ASSERT_TRUE(heights);
        const HeightField crop = fields::field_of({96, 96}, 20.0f, Wrap::repeat, [&](int i, int j) {
            return static_cast<double>(heights->height.at(200 + i, 300 + j));
        });
        const SkyErrors errors = errors_of(crop, {32, 0.0f, true, true, true}, 307);
        EXPECT_LT(errors.occlusion, 0.0015) << name;
        EXPECT_LT(errors.sky_view, 0.003) << name;
        EXPECT_LT(errors.degrees, 0.3) << name;
    }
}

// The mean and the largest difference between the sines of horizons and those of the reference, at a texel of every so
// many.
std::pair<double, double> horizon_errors(const HeightField& field, const OcclusionOptions& options, int every) {
    const auto maps = occlusion(field, options);
    EXPECT_TRUE(maps);
    double sum = 0.0, largest = 0.0;
    int count = 0;
    const Extent extent = field.height.extent();
    for (int n = 0; n < options.horizons; ++n) {
        const double turn = 2.0 * 3.14159265358979323846 * n / options.horizons;
        for (int k = every / 2; k < extent.texels(); k += every, ++count) {
            const int i = k % extent.width, j = k / extent.width;
            const double is =
                std::sin(std::atan(std::max(0.0, reference::horizon_of(field, i, j, std::cos(turn), std::sin(turn),
                                                                       static_cast<double>(options.distance)))));
            const double off = std::abs(static_cast<double>(maps->horizons[static_cast<std::size_t>(n)].at(i, j)) - is);
            sum += off;
            largest = std::max(largest, off);
        }
    }
    return {sum / count, largest};
}

TEST(Occlusion, HorizonsAreThoseOfTheReference) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
        HeightField field = rough_field({61, 47}, 4.0f, wrap);
        const auto [mean, largest] = horizon_errors(field, {4, 0.0f, false, false, false, 8}, 41);
        EXPECT_LT(mean, 0.004) << static_cast<int>(wrap);
        EXPECT_LT(largest, 0.08);
        field.bumpiness_y = 7.0f;
        EXPECT_LT(horizon_errors(field, {4, 0.0f, false, false, false, 5}, 97).first, 0.01);
        EXPECT_LT(horizon_errors(field, {4, 12.0f, false, false, false, 16}, 197).first, 0.01);
    }
}

TEST(Occlusion, HorizonsLieOneBelowTheOtherAndHolesHaveNone) {
    HeightField field = rough_field({50, 33}, 5.0f, Wrap::repeat);
    field.height.at(20, 10) = kNoHeight;
    const auto alone = occlusion(field, {16, 0.0f, false, false, false, 4});
    ASSERT_TRUE(alone);
    ASSERT_EQ(alone->horizons.size(), 4u);
    EXPECT_TRUE(alone->occlusion.empty() && alone->sky_view.empty() && alone->bent.x.empty());
    for (std::size_t k = 0; k < 4; ++k) {
        const Plane<float>& plane = alone->horizons[k];
        EXPECT_EQ(plane.at(20, 10), 0.0f);
        const float* const below = plane.row(0) + 33 * plane.stride();
        EXPECT_TRUE(k == 3 || below == alone->horizons[k + 1].row(0));
    }
    const auto all = occlusion(field, {16, 0.0f, true, true, true, 4}), without = occlusion(field, kAllMaps);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(fields::same_bytes(all->horizons[k], alone->horizons[k]));
    EXPECT_TRUE(without->horizons.empty());
}

TEST(Occlusion, RepeatsAsTheInsideOfATiledCopy) {
    const HeightField one = rough_field({45, 37}, 3.0f, Wrap::repeat);
    const HeightField nine = fields::field_of({135, 111}, 3.0f, Wrap::repeat, [&](int i, int j) {
        return static_cast<double>(one.height.at(i % 45, j % 37));
    });
    const auto alone = occlusion(one, kAllMaps), inside = occlusion(nine, kAllMaps);
    // Lines lie differently between the texels of both.
    double sum = 0.0;
    for (int j = 0; j < 37; ++j) {
        for (int i = 0; i < 45; ++i) {
            EXPECT_NEAR(alone->sky_view.at(i, j), inside->sky_view.at(45 + i, 37 + j), 0.025f) << i << ' ' << j;
            const float difference = std::abs(alone->occlusion.at(i, j) - inside->occlusion.at(45 + i, 37 + j));
            EXPECT_LT(difference, 0.02f) << i << ' ' << j;
            sum += static_cast<double>(difference);
        }
    }
    EXPECT_LT(sum / (45 * 37), 0.003);
}

TEST(Occlusion, HolesHideNothing) {
    const auto field = [](double wall) {
        return fields::field_of({41, 41}, 1.0f, Wrap::clamp,
                                [=](int i, int) { return i >= 25 && i < 28 ? wall : 0.0; });
    };
    EXPECT_LT(occlusion(field(20.0), kAllMaps)->sky_view.at(20, 20), 0.8f);
    const auto open = occlusion(field(static_cast<double>(kNoHeight)), kAllMaps);
    EXPECT_NEAR(open->sky_view.at(20, 20), 1.0f, 1e-5f);
    EXPECT_NEAR(open->occlusion.at(24, 20), 1.0f, 1e-5f);
    EXPECT_EQ(open->occlusion.at(26, 20), 1.0f);
    EXPECT_EQ(open->sky_view.at(26, 20), 1.0f);
    EXPECT_EQ(open->bent.z.at(26, 20), 1.0f);
}

TEST(Occlusion, WithinADistanceIsLighter) {
    const HeightField field = rough_field({64, 64}, 5.0f, Wrap::repeat);
    const auto far = occlusion(field, kAllMaps);
    double before = 1.0;
    for (const float distance : {2.0f, 8.0f, 64.0f}) {
        OcclusionOptions near = kAllMaps;
        near.distance = distance;
        const auto maps = occlusion(field, near);
        double mean = 0.0;
        for (int j = 0; j < 64; ++j) {
            for (int i = 0; i < 64; ++i) {
                mean += static_cast<double>(maps->occlusion.at(i, j)) / 4096.0;
                EXPECT_GE(maps->sky_view.at(i, j), far->sky_view.at(i, j) - 0.02f);
            }
        }
        EXPECT_LT(mean, before);
        before = mean;
    }
}

TEST(Occlusion, OnlyWhatIsWantedIsMade) {
    const auto maps = occlusion(rough_field({16, 16}, 2.0f, Wrap::repeat), {16, 0.0f, false, true, false});
    EXPECT_TRUE(maps->occlusion.empty());
    EXPECT_TRUE(maps->bent.x.empty());
    const auto all = occlusion(rough_field({16, 16}, 2.0f, Wrap::repeat), {16, 0.0f, true, true, true});
    EXPECT_TRUE(fields::same_bytes(maps->sky_view, all->sky_view));
}

TEST(Occlusion, RefusesWhatIsNoSurface) {
    const auto refusal = [](HeightField field, OcclusionOptions options = {}) {
        const auto maps = occlusion(field, options);
        return maps ? std::string() : maps.error().message();
    };
    HeightField field = rough_field({8, 8}, 2.0f, Wrap::repeat);
    EXPECT_NE(refusal(rough_field({8, 8}, 2.0f, Wrap::repeat), {3}).find("directions: must be from 4 to 1024"),
              std::string::npos);
    EXPECT_NE(refusal(rough_field({8, 8}, 2.0f, Wrap::repeat), {32, -1.0f}).find("distance"), std::string::npos);
    EXPECT_NE(refusal(rough_field({8, 8}, 2.0f, Wrap::repeat), {32, 0.0f, true, false, false, 65}).find("horizons"),
              std::string::npos);
    EXPECT_NE(
        refusal(fields::field_of({3, 3}, 1.0f, Wrap::clamp, [](int, int) { return kNoHeight; })).find("all heights"),
        std::string::npos);
    field.height.at(3, 3) = std::numeric_limits<float>::infinity();
    EXPECT_NE(refusal(std::move(field)).find("infinite"), std::string::npos);
    HeightField mixed = rough_field({8, 8}, 2.0f, Wrap::repeat);
    mixed.bumpiness_y = -2.0f;
    EXPECT_NE(refusal(std::move(mixed)).find("bumpiness"), std::string::npos);
}

TEST(Occlusion, SameBytesForEveryNumberOfThreadsAndEveryTarget) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror}) {
        HeightField field = rough_field({211, 90}, 6.0f, wrap);
        for (int i = 0; i < 9; ++i) field.height.at(50 + i, 40) = kNoHeight;
        const OcclusionOptions options{20, 0.0f, true, true, true, 8};
        const auto hash = [&](const Execution& execution) {
            const auto maps = occlusion(field, options, {}, execution);
            return fields::hash_of(maps->occlusion) ^ (fields::hash_of(maps->sky_view) * 3) ^
                   (fields::hash_of(maps->bent.x) * 5) ^ (fields::hash_of(maps->bent.z) * 7) ^
                   (fields::hash_of(maps->horizons[0]) * 11) ^ (fields::hash_of(maps->horizons[5]) * 13);
        };
        const std::uint64_t one = hash({});
        EXPECT_EQ(hash({2, {}}), one);
        EXPECT_EQ(hash({5, {}}), one);
        on_every_target([&] { EXPECT_EQ(hash({}), one); });
    }
}

}  // namespace
