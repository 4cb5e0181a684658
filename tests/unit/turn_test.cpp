// SPDX-License-Identifier: Apache-2.0
// Pictures of a formula's normals, sampled at turned places, and noise.

#include "checks/turn.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "unit/stored_maps.h"

namespace tex {
namespace {

Texel texel_of(double p, double q) {
    const double length = std::sqrt(p * p + q * q + 1.0);
    return {static_cast<float>(-p / length), static_cast<float>(-q / length), static_cast<float>(1.0 / length)};
}

// The normals of the height sin(u) / 2 + sin(v) / 3 at the place (x, y), y up.
Texel normal_at(double x, double y) {
    const double u = 0.31 * x - 0.17 * y, v = 0.13 * x + 0.29 * y;
    return texel_of(0.31 * std::cos(u) / 2.0 + 0.13 * std::cos(v) / 3.0,
                    -0.17 * std::cos(u) / 2.0 + 0.29 * std::cos(v) / 3.0);
}

// What a picture turned counterclockwise shows at column i and row j: it was at a place further clockwise.
Texel turned(int i, int j, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
    const double x = i, y = -j;
    return normal_at(c * x + s * y, -s * x + c * y);
}

Turn turn_of(Extent extent, const std::function<Texel(int, int)>& make, int threads = 1) {
    const StoredMap map(extent, make);
    return measure_turn(map.stored(), {threads, {}}).value();
}

// Numbers from -0.5 to 0.5.
struct Noise {
    unsigned state = 1;
    double operator()() { return ((state = state * 1664525u + 1013904223u) >> 16) / 65536.0 - 0.5; }
};

TEST(TurnOfPictures, IsFoundInBothDirectionsOfGreen) {
    for (const double degrees : {-75.0, -60.0, -30.0, -5.0, 0.0, 15.0, 45.0, 70.0}) {
        for (const float y : {1.0f, -1.0f}) {
            const Turn turn = turn_of({128, 128}, [&](int i, int j) {
                const Texel t = turned(i, j, degrees);
                return Texel{t.r, y * t.g, t.b};
            });
            const TurnScale& scale = turn.scale[0];
            EXPECT_EQ(&scale.clearest(), y > 0.0f ? &scale.up : &scale.down) << degrees;
            EXPECT_NEAR(scale.clearest().angle(), degrees, 0.6);
            EXPECT_GT(scale.clearest().strength(), 0.99) << degrees;
            EXPECT_LT(scale.shared(), 0.5) << degrees;
            // sin^2 of the angle, if green points the way that has less curl
            const double sine = std::sin(degrees * std::numbers::pi / 180.0);
            EXPECT_LT(scale.curl_share(), sine * sine + 0.001) << degrees;
        }
    }
}

TEST(TurnOfPictures, ExchangedChannelsAreAQuarterTurn) {
    const Turn turn = turn_of({128, 128}, [](int i, int j) {
        const Texel t = turned(i, j, 0.0);
        return Texel{t.g, t.r, t.b};
    });
    EXPECT_NEAR(std::abs(turn.scale[0].clearest().angle()), 90.0, 0.5);
    EXPECT_GT(turn.scale[0].clearest().strength(), 0.99);
}

// Pairs (divergence, curl) on one line, whose angle is known: (cos, sin) of it.
TEST(TurnOfPictures, TheAxisOfPairsOnALineIsThatLine) {
    EXPECT_EQ((TurnSums{0.0, 2.0, 0.0}).angle(), 0.0);
    EXPECT_EQ((TurnSums{2.0, 0.0, 0.0}).angle(), 90.0);
    EXPECT_NEAR((TurnSums{1.0, 1.0, 1.0}).angle(), 45.0, 1e-9);
    EXPECT_NEAR((TurnSums{1.0, 1.0, -1.0}).angle(), -45.0, 1e-9);
    EXPECT_NEAR((TurnSums{3.0, 1.0, std::sqrt(3.0)}).angle(), 60.0, 1e-9);
}

TEST(TurnOfPictures, NoiseHasAsMuchCurlAsDivergenceAndNoAxis) {
    Noise noise;
    const Turn turn = turn_of({256, 256}, [&](int, int) {
        const double p = noise(), q = noise();
        return texel_of(p, q);
    });
    for (const TurnScale& scale : turn.scale) {
        EXPECT_NEAR(scale.curl_share(), 0.5, 0.02);
        EXPECT_LT(scale.clearest().strength(), 0.05);
        EXPECT_LT(scale.shared(), 0.01);
    }
    // Each of the two changes has twice the variance of numbers from -0.5 to 0.5, 2 / 12. Large ones weigh less.
    EXPECT_LT(turn.scale[0].rms(), std::sqrt(4.0 / 12.0));
    EXPECT_GT(turn.scale[0].rms(), 0.5);
}

TEST(TurnOfPictures, NoiseInOneDirectionIsShared) {
    Noise noise;
    const Turn turn = turn_of({128, 128}, [&](int, int) {
        const double p = noise();
        return texel_of(p, p);
    });
    EXPECT_GT(turn.scale[0].shared(), 0.99);
}

TEST(TurnOfPictures, FlatMapsAndTexelsWithoutNormalsGiveZero) {
    for (const Texel& texel : {Texel{0.0f, 0.0f, 1.0f}, Texel{0.0f, 0.0f, 0.0f}}) {
        const Turn turn = turn_of({64, 64}, [&](int, int) { return texel; });
        EXPECT_EQ(turn.scale[0].rms(), 0.0);
        EXPECT_EQ(turn.scale[0].clearest().angle(), 0.0);
        EXPECT_EQ(turn.scale[0].clearest().strength(), 0.0);
        EXPECT_EQ(turn.scale[0].shared(), 0.0);
    }
}

// 16 windows.
TEST(TurnOfPictures, IsTheSameForEveryNumberOfThreads) {
    const auto make = [](int i, int j) { return turned(i, j, 25.0); };
    const Turn expected = turn_of({1300, 900}, make);
    EXPECT_NEAR(expected.scale[0].clearest().angle(), 25.0, 0.6);
    for (const int threads : {2, 5}) {
        const Turn turn = turn_of({1300, 900}, make, threads);
        for (int k = 0; k < Turn::kScales; ++k) {
            EXPECT_EQ(turn.scale[k].up.product, expected.scale[k].up.product);
            EXPECT_EQ(turn.scale[k].down.curl, expected.scale[k].down.curl);
            EXPECT_EQ(turn.scale[k].weight, expected.scale[k].weight);
        }
    }
}

}  // namespace
}  // namespace tex
