// SPDX-License-Identifier: Apache-2.0

#include "rows/blur.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "reference/bake.h"
#include "reference/blur.h"
#include "unit/fields.h"

namespace {

using tex::Extent;
using tex::Plane;
using tex::Wrap;
using tex::fields::noise;
using tex::fields::plane_of;

constexpr Wrap kBlurWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

Plane<float> blurred(const Plane<float>& heights, double sigma, Wrap wrap_x, Wrap wrap_y) {
    const auto weights = tex::gaussian_weights(sigma);
    const int height = heights.extent().height;
    Plane<float> across(heights.extent()), result(heights.extent());
    tex::blur_across(heights.view(), weights, wrap_x, 0, height, across);
    tex::blur_down(across.view(), weights, wrap_y, 0, height, result);
    return result;
}

TEST(Blur, WeightsAreOfAGaussianAndSumToOne) {
    for (const double sigma : {0.01, 0.3, 1.0, 7.7, 256.0}) {
        const auto weights = tex::gaussian_weights(sigma);
        ASSERT_EQ(weights.size(), static_cast<std::size_t>(std::ceil(3.0 * sigma)) + 1);
        double sum = static_cast<double>(weights[0]);
        for (std::size_t k = 1; k < weights.size(); ++k) {
            sum += 2.0 * static_cast<double>(weights[k]);
            const auto x = static_cast<double>(k);
            EXPECT_NEAR(static_cast<double>(weights[k] / weights[0]), std::exp(-x * x / (2.0 * sigma * sigma)), 2e-7);
        }
        EXPECT_NEAR(sum, 1.0, 1e-6);
    }
}

TEST(Blur, AgreesWithTheReference) {
    for (const double sigma : {0.01, 0.5, 1.0, 3.3, 12.0}) {
        for (const Wrap wrap_x : kBlurWraps) {
            for (const Wrap wrap_y : kBlurWraps) {
                for (const Extent extent : {Extent{1, 1}, Extent{2, 1}, Extent{3, 40}, Extent{33, 17}}) {
                    const Plane<float> heights = plane_of(extent, [](int i, int j) { return noise(i, j); });
                    const Plane<float> result = blurred(heights, sigma, wrap_x, wrap_y);
                    const auto truth = tex::reference::blur(tex::reference::grid_of(heights), sigma, wrap_x, wrap_y);
                    for (int j = 0; j < extent.height; ++j) {
                        for (int i = 0; i < extent.width; ++i) {
                            // Outside clamped borders, heights grow with the distance, and so do errors.
                            ASSERT_NEAR(static_cast<double>(result.at(i, j)), truth.at(i, j), 2e-6 * (1.0 + sigma))
                                << sigma << " " << extent.width << "x" << extent.height;
                        }
                    }
                }
            }
        }
    }
}

TEST(Blur, KeepsClampedRampsUpToTheBorder) {
    const Plane<float> ramp = plane_of({40, 9}, [](int i, int j) { return i - 2.0 * j; });
    const Plane<float> result = blurred(ramp, 4.0, Wrap::clamp, Wrap::clamp);
    for (int i = 0; i < 40; ++i) EXPECT_NEAR(result.at(i, 5), i - 10.0, 2e-5);
}

TEST(Blur, MakesOneValueOfConstantHeights) {
    for (const Wrap wrap : kBlurWraps) {
        const Plane<float> result = blurred(Plane<float>({50, 50}, 0.1f), 4.0, wrap, wrap);
        for (int j = 0; j < 50; ++j) {
            for (int i = 0; i < 50; ++i) ASSERT_EQ(result.at(i, j), result.at(0, 0));
        }
    }
}

TEST(Blur, LeavesSlopesExactEnoughToBake) {
    // Rounding errors of a blur are noise, and a bake amplifies them. With bumpiness 100 the result must stay
    // invisible.
    const Plane<float> heights = plane_of({150, 40}, [](int i, int j) { return noise(i, j); });
    tex::HeightField field{blurred(heights, 20.0, Wrap::repeat, Wrap::repeat), 100.0f, 100.0f, Wrap::repeat,
                           Wrap::repeat};
    const auto normals = tex::bake(field).value();
    const auto truth = tex::reference::blur(tex::reference::grid_of(heights), 20.0, Wrap::repeat, Wrap::repeat);
    for (int j = 1; j < 39; ++j) {
        for (int i = 1; i < 149; ++i) {
            const double du = (truth.at(i + 1, j) - truth.at(i - 1, j)) / 2,
                         dv = (truth.at(i, j - 1) - truth.at(i, j + 1)) / 2;
            const tex::reference::Vector n{-100.0 * du, -100.0 * dv, 1.0};
            ASSERT_LT(tex::reference::angle_between(tex::reference::grid_of(normals).at(i, j), n), 0.01);
            if (i > 20) break;
        }
    }
}

}  // namespace
