// SPDX-License-Identifier: Apache-2.0

#include <tex/bake.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reference/bake.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace {

using tex::BakeOptions;
using tex::Extent;
using tex::GradientKernel;
using tex::HeightField;
using tex::NormalMap;
using tex::Wrap;
using tex::fields::field_of;
using tex::fields::noise;
using tex::fields::same_bytes;

constexpr int kSizes[] = {1, 2, 15, 16, 17, 33, 257};
constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

std::vector<BakeOptions> all_kernels() {
    std::vector<BakeOptions> options;
    for (const auto& row : tex::kGradientKernelNames) options.push_back({row.value, 1.0f});
    options.push_back({GradientKernel::gaussian, 2.5f});
    return options;
}

NormalMap baked(const HeightField& field, const BakeOptions& options = {}, int threads = 1) {
    return std::move(tex::bake(field, options, {threads, {}}).value());
}

double slope_x(const NormalMap& map, int i, int j) {
    return static_cast<double>(-map.x.at(i, j)) / static_cast<double>(map.z.at(i, j));
}

double slope_y(const NormalMap& map, int i, int j) {
    return static_cast<double>(-map.y.at(i, j)) / static_cast<double>(map.z.at(i, j));
}

// -- direction ---------------------------------------------------------------------------------------------

TEST(Bake, HeightsThatRiseToTheRightTurnNormalsToTheLeft) {
    const NormalMap map = baked(field_of({8, 4}, 1.0f, Wrap::clamp, [](int i, int) { return 0.5 * i; }));
    EXPECT_FLOAT_EQ(map.x.at(3, 2), -0.5f / std::sqrt(1.25f));
    EXPECT_EQ(map.y.at(3, 2), 0.0f);
    EXPECT_FLOAT_EQ(map.z.at(3, 2), 1.0f / std::sqrt(1.25f));
}

TEST(Bake, HeightsThatRiseTowardsTheTopRowTurnNormalsDownwards) {
    const NormalMap map = baked(field_of({4, 8}, 1.0f, Wrap::clamp, [](int, int j) { return -0.5 * j; }));
    EXPECT_EQ(map.x.at(2, 3), 0.0f);
    EXPECT_FLOAT_EQ(map.y.at(2, 3), -0.5f / std::sqrt(1.25f));
}

TEST(Bake, ABumpsNormalsPointOutwardsOnAllSides) {
    for (const BakeOptions& options : all_kernels()) {
        const NormalMap map =
            baked(field_of({31, 31}, 1.0f, Wrap::clamp,
                           [](int i, int j) { return -0.05 * ((i - 15) * (i - 15) + (j - 15) * (j - 15)); }),
                  options);
        EXPECT_LT(map.x.at(5, 15), 0.0f);
        EXPECT_GT(map.x.at(25, 15), 0.0f);
        EXPECT_GT(map.y.at(15, 5), 0.0f);
        EXPECT_LT(map.y.at(15, 25), 0.0f);
    }
}

TEST(Bake, NegativeBumpinessTurnsBumpsIntoDents) {
    HeightField field = field_of({5, 5}, 3.0f, Wrap::repeat, [](int i, int j) { return noise(i, j); });
    const NormalMap bumps = baked(field);
    field.bumpiness_x = field.bumpiness_y = -3.0f;
    const NormalMap dents = baked(field);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(bumps.x.at(i, 2), -dents.x.at(i, 2));
        EXPECT_EQ(bumps.y.at(i, 2), -dents.y.at(i, 2));
        EXPECT_EQ(bumps.z.at(i, 2), dents.z.at(i, 2));
    }
}

// -- exactness ---------------------------------------------------------------------------------------------

TEST(Bake, PlanesKeepTheirSlopeUpToClampedBorders) {
    for (const BakeOptions& options : all_kernels()) {
        for (const int size : {2, 3, 17, 64}) {
            const auto plane = [](int i, int j) { return 0.375 * i - 0.25 * j + 3.0; };
            const NormalMap map = baked(field_of({size, size}, 2.0f, Wrap::clamp, plane), options);
            for (int j = 0; j < size; ++j) {
                for (int i = 0; i < size; ++i) {
                    ASSERT_NEAR(slope_x(map, i, j), 0.75, 1e-6) << size << " " << i << " " << j;
                    ASSERT_NEAR(slope_y(map, i, j), 0.5, 1e-6) << size << " " << i << " " << j;
                }
            }
        }
    }
}

TEST(Bake, ConstantHeightsAreExactlyFlat) {
    for (const BakeOptions& options : all_kernels()) {
        for (const Wrap wrap : kWraps) {
            for (const int size : kSizes) {
                const NormalMap map = baked(field_of({size, size}, 1e6f, wrap, [](int, int) { return 0.1; }), options);
                for (int i = 0; i < size; ++i) {
                    ASSERT_EQ(map.x.at(i, size / 2), 0.0f);
                    ASSERT_EQ(map.y.at(i, size / 2), 0.0f);
                    ASSERT_FALSE(std::signbit(map.x.at(i, 0)) || std::signbit(map.y.at(i, 0)));
                    ASSERT_EQ(map.z.at(i, size / 2), 1.0f);
                }
            }
        }
    }
}

TEST(Bake, AnAxisOfOneTexelHasSlopeZero) {
    for (const BakeOptions& options : all_kernels()) {
        for (const Wrap wrap : kWraps) {
            const auto ramp = [](int i, int j) { return 0.1 * (i + j); };
            EXPECT_EQ(baked(field_of({1, 9}, 1.0f, wrap, ramp), options).x.at(0, 4), 0.0f);
            EXPECT_EQ(baked(field_of({9, 1}, 1.0f, wrap, ramp), options).y.at(4, 0), 0.0f);
        }
    }
}

// The largest error of the slope of `height`, sampled at n texels on [0, 1), relative to the scale of the true slope.
double sine_error(int n) {
    const double turn = 2.0 * 3.14159265358979323846;
    const NormalMap map = baked(field_of({n, 1}, static_cast<float>(n), Wrap::repeat,
                                         [&](int i, int) { return 0.05 * std::sin(turn * i / n); }));
    double largest = 0.0;
    for (int i = 0; i < n; ++i) {
        largest = std::max(largest, std::abs(slope_x(map, i, 0) - 0.05 * turn * std::cos(turn * i / n)));
    }
    return largest;
}

TEST(Bake, CentralDifferencesConvergeWithSecondOrder) {
    // Halving the texel size divides the error by four. The log2 of the ratio is the order.
    for (const int n : {16, 32, 64, 128}) {
        EXPECT_NEAR(std::log2(sine_error(n) / sine_error(2 * n)), 2.0, 0.05) << n;
    }
}

TEST(Bake, ASphereHasTheNormalsOfASphere) {
    // A cap of a sphere with a radius of 1000 texels, 257 texels wide: n = (x, y, z) / radius.
    const double radius = 1000.0;
    const int size = 257;
    const auto height = [&](int i, int j) {
        return std::sqrt(radius * radius - (i - 128) * (i - 128) - (j - 128) * (j - 128));
    };
    for (const BakeOptions& options : all_kernels()) {
        if (options.kernel == GradientKernel::forward) continue;  // shifted by half a texel
        const NormalMap map = baked(field_of({size, size}, 1.0f, Wrap::clamp, height), options);
        const auto grid = tex::reference::grid_of(map);
        for (int j = 8; j < size - 8; ++j) {
            for (int i = 8; i < size - 8; ++i) {
                const tex::reference::Vector truth{i - 128.0, 128.0 - j, height(i, j)};
                ASSERT_LT(tex::reference::angle_between(grid.at(i, j), truth), 0.01) << i << " " << j;
            }
        }
    }
}

// -- against the reference ---------------------------------------------------------------------------------

TEST(Bake, AgreesWithTheReferenceForEveryKernelWrapAndSize) {
    for (const BakeOptions& options : all_kernels()) {
        for (const Wrap wrap : kWraps) {
            for (const int width : kSizes) {
                for (const int height : {1, 2, 17}) {
                    for (const float bumpiness : {0.1f, 1.0f, 40.0f}) {
                        HeightField field =
                            field_of({width, height}, bumpiness, wrap, [](int i, int j) { return noise(i, j); });
                        field.bumpiness_y *= 1.5f;
                        const double angle = largest_angle(baked(field, options), tex::reference::bake(field, options));
                        ASSERT_LT(angle, 0.01) << name_of(tex::kGradientKernelNames, options.kernel) << " "
                                               << name_of(tex::kWrapNames, wrap) << " " << width << "x" << height;
                    }
                }
            }
        }
    }
}

// texconv -nmap, as DirectXTexNormalMaps.cpp has it: of three rows or columns, the sum of the differences by 6, and y
// grows downwards.
TEST(Bake, PrewittIsWhatTexconvMeasures) {
    constexpr float kAmplitude = 4.0f;
    const HeightField field = field_of({32, 24}, kAmplitude, Wrap::repeat, [](int i, int j) { return noise(i, j); });
    const NormalMap map = baked(field, {GradientKernel::prewitt, 1.0f});
    const auto at = [&](int i, int j) { return static_cast<double>(field.height.at((i + 32) % 32, (j + 24) % 24)); };
    for (int j = 0; j < 24; ++j) {
        for (int i = 0; i < 32; ++i) {
            double x = 0.0, down = 0.0;
            for (int k = -1; k <= 1; ++k) {
                x += (at(i - 1, j + k) - at(i + 1, j + k)) * static_cast<double>(kAmplitude) / 6.0;
                down += (at(i + k, j - 1) - at(i + k, j + 1)) * static_cast<double>(kAmplitude) / 6.0;
            }
            const double length = std::sqrt(x * x + down * down + 1.0);
            ASSERT_NEAR(map.x.at(i, j), x / length, 1e-5);
            ASSERT_NEAR(-map.y.at(i, j), down / length, 1e-5);
        }
    }
}

TEST(Bake, HeightsNearTheGreatestFloatHaveTheirSlopes) {
    const float four[] = {0.0f, 3e38f, 0.0f, -3e38f};
    const NormalMap map =
        baked(field_of({4, 1}, 1e-38f, Wrap::repeat, [&](int i, int) { return static_cast<double>(four[i]); }), {});
    EXPECT_NEAR(map.x.at(0, 0), -3 / std::sqrt(10.0), 1e-6);
    EXPECT_NEAR(map.z.at(0, 0), 1 / std::sqrt(10.0), 1e-6);
    EXPECT_NEAR(map.x.at(2, 0), 3 / std::sqrt(10.0), 1e-6);
    for (const BakeOptions& options : all_kernels()) {
        for (const Wrap wrap : kWraps) {
            for (const double scale : {1e-30, 1e30, 3e38}) {
                const HeightField field = field_of({19, 13}, static_cast<float>(7 / scale), wrap,
                                                   [&](int i, int j) { return scale * noise(i, j); });
                ASSERT_LT(largest_angle(baked(field, options), tex::reference::bake(field, options)), 0.01)
                    << name_of(tex::kGradientKernelNames, options.kernel) << " " << name_of(tex::kWrapNames, wrap)
                    << " " << scale;
            }
        }
    }
}

TEST(Bake, AxesMayWrapDifferently) {
    for (const Wrap wrap_x : kWraps) {
        for (const Wrap wrap_y : kWraps) {
            HeightField field = field_of({19, 13}, 5.0f, wrap_x, [](int i, int j) { return noise(i, j); });
            field.wrap_y = wrap_y;
            const BakeOptions options{GradientKernel::sobel5, 1.0f};
            EXPECT_LT(largest_angle(baked(field, options), tex::reference::bake(field, options)), 0.01);
        }
    }
}

TEST(Bake, KernelsWiderThanTheMapWrapAgainAndAgain) {
    for (const Wrap wrap : kWraps) {
        for (const int size : {2, 3, 5}) {
            const HeightField field = field_of({size, size}, 4.0f, wrap, [](int i, int j) { return noise(i, j); });
            const BakeOptions options{GradientKernel::gaussian, 8.0f};
            EXPECT_LT(largest_angle(baked(field, options), tex::reference::bake(field, options)), 0.01);
        }
    }
}

// -- promises of the header --------------------------------------------------------------------------------

TEST(Bake, EveryFiniteHeightGivesAFiniteUnitNormal) {
    constexpr float kMax = std::numeric_limits<float>::max();
    const float extremes[] = {0.0f, kMax, -kMax, 1e-45f, 1e20f, -1.0f};
    for (const BakeOptions& options : all_kernels()) {
        for (const Wrap wrap : kWraps) {
            for (const float bumpiness : {0.0f, 1e-30f, 1.0f, kMax, -kMax}) {
                for (const int size : {2, 7, 20}) {
                    const NormalMap map = baked(
                        field_of({size, size}, bumpiness, wrap,
                                 [&](int i, int j) {
                                     return static_cast<double>(extremes[static_cast<std::size_t>(noise(i, j) * 6.0)]);
                                 }),
                        options);
                    for (int j = 0; j < size; ++j) {
                        for (int i = 0; i < size; ++i) {
                            const auto x = static_cast<double>(map.x.at(i, j)), y = static_cast<double>(map.y.at(i, j)),
                                       z = static_cast<double>(map.z.at(i, j));
                            ASSERT_NEAR(std::sqrt(x * x + y * y + z * z), 1.0, 2.4e-7);
                            ASSERT_GT(z, 0.0);
                        }
                    }
                }
            }
        }
    }
}

TEST(Bake, RefusesHeightsThatAreNotFinite) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
        for (const auto& [i, j] : {std::pair{0, 0}, {36, 0}, {18, 150}, {36, 299}}) {
            HeightField field = field_of({37, 300}, 1.0f, Wrap::clamp, [](int, int) { return 0.5; });
            field.height.at(i, j) = bad;
            const auto map = tex::bake(field, {}, {2, {}});
            ASSERT_FALSE(map) << i << ", " << j;
            EXPECT_EQ(map.error().code, tex::ErrorCode::bad_data);
        }
    }
}

TEST(Bake, LengthsAreExactToTwoUnitsInTheLastPlace) {
    const NormalMap map =
        baked(field_of({512, 64}, 50.0f, Wrap::repeat, [](int i, int j) { return noise(i, j) * noise(j, i); }));
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 512; ++i) {
            const auto x = static_cast<double>(map.x.at(i, j)), y = static_cast<double>(map.y.at(i, j)),
                       z = static_cast<double>(map.z.at(i, j));
            ASSERT_NEAR(std::sqrt(x * x + y * y + z * z), 1.0, 2.0 * 0x1p-24 * 2.0);
        }
    }
}

// The result of make() must be the same on every target and with each number of threads.
void expect_same_bytes(const std::vector<int>& threads, const std::function<NormalMap(int threads)>& make) {
    std::optional<NormalMap> first;
    tex::on_every_target([&] {
        for (const int count : threads) {
            NormalMap map = make(count);
            if (!first)
                first = std::move(map);
            else
                EXPECT_TRUE(same_bytes(*first, map)) << count << " threads";
        }
    });
}

TEST(Bake, GivesTheSameBytesOnEveryTarget) {
    for (const BakeOptions& options : all_kernels()) {
        for (const Wrap wrap : kWraps) {
            for (const int width : kSizes) {
                const HeightField field = field_of({width, 40}, 12.0f, wrap, [](int i, int j) { return noise(i, j); });
                expect_same_bytes({1}, [&](int threads) { return baked(field, options, threads); });
            }
        }
    }
}

TEST(Bake, GivesTheSameBytesForEveryNumberOfThreads) {
    // Several strips of rows. Other kernels would be divided into the same strips.
    const HeightField field = field_of({1031, 400}, 12.0f, Wrap::clamp, [](int i, int j) { return noise(i, j); });
    for (const GradientKernel kernel : {GradientKernel::central, GradientKernel::sobel5}) {
        expect_same_bytes({1, 2, 3, 8}, [&](int threads) { return baked(field, {kernel, 1.0f}, threads); });
    }
}

TEST(Bake, CanBeCancelled) {
    const HeightField field = field_of({4096, 256}, 1.0f, Wrap::repeat, [](int i, int) { return i; });
    const auto result = tex::bake(field, {}, {1, [](double) { return false; }});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, tex::ErrorCode::cancelled);
}

TEST(SlopeRange, FindsTheSteepestTexels) {
    HeightField field =
        field_of({100, 50}, 1.0f, Wrap::clamp, [](int i, int j) { return i == 60 && j == 20 ? 8.0 : 0.0; });
    const tex::SlopeRange range = tex::slope_range(baked(field));
    EXPECT_FLOAT_EQ(range.max_x, 4.0f);
    EXPECT_FLOAT_EQ(range.min_x, -4.0f);
    EXPECT_FLOAT_EQ(range.max_y, 4.0f);
    EXPECT_FLOAT_EQ(range.min_y, -4.0f);
}

TEST(SlopeRange, OfACliffIsItsSlopeToo) {
    for (const double height : {1e4, 1e12}) {
        const tex::SlopeRange range = tex::slope_range(baked(
            field_of({100, 50}, 1.0f, Wrap::clamp, [=](int i, int j) { return i == 60 && j == 20 ? height : 0.0; })));
        EXPECT_FLOAT_EQ(range.max_x, static_cast<float>(height / 2));
        EXPECT_FLOAT_EQ(range.min_y, static_cast<float>(-height / 2));
    }
}

TEST(SlopeRange, OfAPlaneIsItsSlopeWhateverTheThreadsAndTargets) {
    const NormalMap map = baked(field_of({33, 700}, 1.0f, Wrap::clamp, [](int i, int j) { return 2.0 * i + 0.5 * j; }));
    tex::on_every_target([&] {
        for (const int threads : {1, 2, 8}) {
            const tex::SlopeRange range = tex::slope_range(map, {threads, {}});
            EXPECT_FLOAT_EQ(range.min_x, 2.0f);
            EXPECT_FLOAT_EQ(range.max_x, 2.0f);
            EXPECT_FLOAT_EQ(range.min_y, -0.5f);
            EXPECT_FLOAT_EQ(range.max_y, -0.5f);
        }
    });
}

}  // namespace
