// SPDX-License-Identifier: Apache-2.0

#include <tex/surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/file.h>

#include "kernels/slopes.h"
#include "reference/bake.h"
#include "reference/integrate.h"
#include "unit/fields.h"
#include "unit/targets.h"
#include "unit/textures.h"

namespace {

using namespace tex;
using fields::field_of;
using fields::noise;

constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

IntegrateOptions options_for(const HeightField& field, const BakeOptions& bake) {
    IntegrateOptions options;
    options.bake = bake;
    options.bumpiness_x = field.bumpiness_x;
    options.bumpiness_y = field.bumpiness_y;
    options.wrap_x = field.wrap_x;
    options.wrap_y = field.wrap_y;
    return options;
}

Integration integrated(const NormalMap& map, const IntegrateOptions& options, int threads = 1) {
    return std::move(integrate(map, options, {threads, {}}).value());
}

// The largest difference between two fields after their means have been made equal, relative to the range of `truth`.
double error_of(const Plane<float>& is, const Plane<float>& truth) {
    const Extent extent = truth.extent();
    double mean = 0.0;
    float low = truth.at(0, 0), high = low;
    const auto difference = [&](int i, int j) {
        return static_cast<double>(is.at(i, j)) - static_cast<double>(truth.at(i, j));
    };
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            mean += difference(i, j) / static_cast<double>(extent.texels());
            low = std::min(low, truth.at(i, j));
            high = std::max(high, truth.at(i, j));
        }
    }
    double largest = 0.0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) largest = std::max(largest, std::abs(difference(i, j) - mean));
    }
    return largest / static_cast<double>(high - low);
}

double round_trip_error(const HeightField& field, const BakeOptions& with) {
    const auto map = bake(field, with);
    return error_of(integrated(*map, options_for(field, with)).field.height, field.height);
}

// A smooth surface that continues beyond each border as its wraps say; (i + 0.5) is the centre of a texel.
HeightField smooth_field(Extent extent, Wrap wrap_x, Wrap wrap_y) {
    constexpr double kTurn = 6.283185307179586477;
    const auto along = [](Wrap wrap, double t, double phase) {
        if (wrap == Wrap::repeat) return std::sin(kTurn * t + phase) + 0.4 * std::cos(2.0 * kTurn * t);
        if (wrap == Wrap::mirror) return std::cos(0.5 * kTurn * t) + 0.3 * std::cos(1.5 * kTurn * t);
        return 1.5 * t + 0.7 * std::sin(4.0 * t + phase);
    };
    HeightField field = field_of(extent, 3.0f, wrap_x, [&](int i, int j) {
        const double x = along(wrap_x, (i + 0.5) / extent.width, 0.5);
        const double y = along(wrap_y, (j + 0.5) / extent.height, 1.0);
        return x + y + 0.5 * x * y;
    });
    field.wrap_y = wrap_y;
    field.bumpiness_y = -2.0f;
    return field;
}

TEST(Integrate, EveryKernelGivesSmoothHeightsBackInEveryWrap) {
    for (const auto& kernel : kGradientKernelNames) {
        for (const Wrap wrap_x : kWraps) {
            for (const Wrap wrap_y : kWraps) {
                for (const Extent extent : {Extent{64, 48}, Extent{61, 75}, Extent{30, 101}}) {
                    const HeightField field = smooth_field(extent, wrap_x, wrap_y);
                    EXPECT_LT(round_trip_error(field, {kernel.value, 1.0f}), 1e-3)
                        << kernel.name << " " << name_of(kWrapNames, wrap_x) << " " << name_of(kWrapNames, wrap_y)
                        << " " << extent.width;
                }
            }
        }
    }
}

// Heights that tile. At borders of other kinds they bend sharply, which sobel5 alone is too wide to see.
TEST(Integrate, EveryKernelKeepsThePromiseForHeightsOfAFile) {
    TEX_NEEDS_SHARED_DATA();
    const auto image = read_image((shared_data() / "trial3/h50.dds").string());
    ASSERT_TRUE(image);
    for (const auto& kernel : kGradientKernelNames) {
        for (const Wrap wrap_x : kWraps) {
            for (const Wrap wrap_y : kWraps) {
                const bool tiles = wrap_x == Wrap::repeat && wrap_y == Wrap::repeat;
                if (kernel.value == GradientKernel::sobel5 && !tiles) continue;
                HeightField field = field_of(image->extent(), 1.0f, wrap_x, [&](int i, int j) {
                    return static_cast<double>(image->planes.front().at(i, j));
                });
                field.wrap_y = wrap_y;
                EXPECT_LT(round_trip_error(field, {kernel.value, 1.0f}), 1e-4)
                    << kernel.name << " " << name_of(kWrapNames, wrap_x) << " " << name_of(kWrapNames, wrap_y);
            }
        }
    }
}

TEST(Integrate, ForwardCentralAndScharrGiveNoiseBackOnOddExtents) {
    for (const GradientKernel kernel : {GradientKernel::forward, GradientKernel::central, GradientKernel::scharr}) {
        for (const Wrap wrap_x : kWraps) {
            for (const Wrap wrap_y : kWraps) {
                for (const Extent extent : {Extent{33, 45}, Extent{17, 3}, Extent{1, 9}, Extent{29, 1}}) {
                    HeightField field = field_of(extent, 4.0f, wrap_x, [](int i, int j) { return noise(i, j); });
                    field.wrap_y = wrap_y;
                    EXPECT_LT(round_trip_error(field, {kernel, 1.0f}), 1e-4)
                        << name_of(kGradientKernelNames, kernel) << " " << name_of(kWrapNames, wrap_x) << " "
                        << name_of(kWrapNames, wrap_y) << " " << extent.width << "x" << extent.height;
                }
            }
        }
    }
}

TEST(Integrate, ARampKeepsItsSlopeUpToClampedBorders) {
    const HeightField ramp = field_of({40, 24}, 2.0f, Wrap::clamp, [](int i, int j) { return 0.5 * i - 0.25 * j; });
    for (const auto& kernel : kGradientKernelNames) EXPECT_LT(round_trip_error(ramp, {kernel.value, 1.0f}), 1e-3);
    for (const Extent extent : {Extent{3, 24}, Extent{24, 3}, Extent{5, 5}}) {  // hardly wider than a kernel
        const HeightField small = field_of(extent, 2.0f, Wrap::clamp, [](int i, int j) { return 0.5 * i - 0.25 * j; });
        for (const auto& kernel : kGradientKernelNames)
            EXPECT_LT(round_trip_error(small, {kernel.value, 1.0f}), 1e-3) << kernel.name << " " << extent.width;
    }
}

// A map of one row or column, whose slopes are rises of 1 texel. bake() gives the last two texels of a clamped axis the
// same slope, so of two slopes that differ, the mean is the best.
TEST(Integrate, ForwardDifferencesTakeTheMeanOfTheLastTwoSlopes) {
    const double slopes[] = {0.3, -0.2, 0.5, 0.1, -0.7, 0.9};
    const double heights[] = {0.0, 0.3, 0.1, 0.6, 0.7, 0.7 + (-0.7 + 0.9) / 2.0};
    IntegrateOptions options;
    options.bake.kernel = GradientKernel::forward;
    options.bumpiness_x = options.bumpiness_y = 1.0f;
    options.wrap_x = options.wrap_y = Wrap::clamp;
    for (const bool across : {true, false}) {  // upwards, else
        const Extent extent = across ? Extent{6, 1} : Extent{1, 6};
        const auto place = [&](int i, int j) { return across ? i : 5 - j; };
        NormalMap map(extent);
        for (int k = 0; k < 6; ++k) {
            const int i = across ? k : 0, j = across ? 0 : k;
            const double slope = slopes[place(i, j)], length = std::sqrt(1.0 + slope * slope);
            map.x.at(i, j) = static_cast<float>(across ? -slope / length : 0.0);
            map.y.at(i, j) = static_cast<float>(across ? 0.0 : -slope / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
        const Plane<float> expected = fields::plane_of(extent, [&](int i, int j) { return heights[place(i, j)]; });
        EXPECT_LT(error_of(integrated(map, options).field.height, expected), 1e-5) << across;
    }
}

TEST(Integrate, CentralDifferencesDoNotSeeAlternatingHeights) {
    const auto wave = [](int i) { return std::sin(0.785398163397448 * i); };
    const HeightField smooth = field_of({16, 8}, 1.0f, Wrap::repeat, [&](int i, int) { return wave(i); });
    const HeightField alternating =
        field_of({16, 8}, 1.0f, Wrap::repeat, [&](int i, int j) { return wave(i) + ((i + j) % 2 == 0 ? 0.3 : -0.3); });
    const Integration result = integrated(*bake(alternating), options_for(alternating, {}));
    EXPECT_LT(error_of(result.field.height, smooth.height), 1e-6);
    // Forward differences see them.
    EXPECT_LT(round_trip_error(alternating, {GradientKernel::forward, 1.0f}), 1e-6);
}

TEST(Integrate, AgreesWithTheReferenceOnMapsThatAreNoBake) {
    const NormalMap map = fields::noise_normals({15, 11}, 3);
    for (const GradientKernel kernel : {GradientKernel::forward, GradientKernel::central, GradientKernel::scharr}) {
        for (const Wrap wrap_x : {Wrap::repeat, Wrap::mirror}) {
            for (const Wrap wrap_y : {Wrap::repeat, Wrap::mirror}) {
                IntegrateOptions options;
                options.bake.kernel = kernel;
                options.bumpiness_x = 2.0f;
                options.bumpiness_y = 0.75f;
                options.wrap_x = wrap_x;
                options.wrap_y = wrap_y;
                const reference::Grid<double> truth = reference::integrate(reference::grid_of(map), options);
                const Plane<float> plane = fields::plane_of(map.extent(), [&](int i, int j) { return truth.at(i, j); });
                EXPECT_LT(error_of(integrated(map, options).field.height, plane), 2e-6)
                    << name_of(kGradientKernelNames, kernel);
            }
        }
    }
}

TEST(Integrate, TheLowestHeightIsZeroAndTheHighestIsReported) {
    const HeightField field = smooth_field({32, 32}, Wrap::clamp, Wrap::repeat);
    const Integration result = integrated(*bake(field), options_for(field, {}));
    float low = 1e9f, high = -1e9f;
    for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 32; ++i) {
            low = std::min(low, result.field.height.at(i, j));
            high = std::max(high, result.field.height.at(i, j));
        }
    }
    EXPECT_EQ(low, 0.0f);
    EXPECT_FLOAT_EQ(high, result.highest);
    EXPECT_EQ(result.steps, 1);
}

TEST(Integrate, CurlIsTheAngleToTheBakeOfTheResult) {
    const NormalMap map = fields::noise_normals({24, 20}, 1);
    const Integration result = integrated(map, {});
    const reference::Grid<reference::Vector> made = reference::bake(result.field, {});
    double mean = 0.0;
    for (int j = 0; j < 20; ++j) {
        for (int i = 0; i < 24; ++i) {
            const auto x = static_cast<double>(map.x.at(i, j)), y = static_cast<double>(map.y.at(i, j));
            const double angle = reference::angle_between({x, y, static_cast<double>(map.z.at(i, j))}, made.at(i, j));
            EXPECT_NEAR(static_cast<double>(result.degrees.at(i, j)), angle, 1e-3);
            mean += angle / 480.0;
        }
    }
    EXPECT_NEAR(result.curl.mean, mean, 1e-3);
    EXPECT_GT(result.curl.mean, 5.0);  // noise is no surface
    EXPECT_EQ(result.curl.texels, 480);
}

// -- unknown texels ------------------------------------------------------------------------------------------

TEST(Integrate, UnknownTexelsFollowFromTheOthers) {
    for (const Wrap wrap : kWraps) {
        const HeightField field = smooth_field({48, 40}, wrap, wrap);
        NormalMap map = std::move(bake(field).value());
        for (const auto& [i, j] : {std::pair{5, 5}, {6, 5}, {20, 30}, {47, 39}, {0, 12}}) {
            map.x.at(i, j) = 1.0f;
            map.y.at(i, j) = 0.0f;
            map.z.at(i, j) = 0.0f;
        }
        const Integration result = integrated(map, options_for(field, {}));
        EXPECT_EQ(result.unused_texels, 5);
        EXPECT_GT(result.steps, 1);
        EXPECT_LT(error_of(result.field.height, field.height), 1e-3);
    }
}

TEST(Integrate, NormalsThatAreNotFiniteAreUnknown) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : kWraps) {
        const HeightField field = smooth_field({48, 40}, wrap, wrap);
        NormalMap map = std::move(bake(field).value());
        map.x.at(5, 5) = kNan;  // z is sound
        map.y.at(6, 5) = kInfinity;
        map.z.at(20, 30) = kNan;
        for (Plane<float>* plane : {&map.x, &map.y, &map.z}) plane->at(0, 39) = kNan;
        const Integration result = integrated(map, options_for(field, {}));
        EXPECT_EQ(result.unused_texels, 4);
        EXPECT_LT(error_of(result.field.height, field.height), 1e-3);
        EXPECT_EQ(result.degrees.at(5, 5), 0.0f);
        EXPECT_LT(result.curl.max, 1.0) << "no angle is NaN";
        EXPECT_TRUE(std::isfinite(result.curl.mean));
    }
    NormalMap nothing(Extent{4, 4});
    for (int j = 0; j < 4; ++j) std::fill_n(nothing.x.row(j), 4, kNan);
    EXPECT_EQ(integrate(nothing).error().code, ErrorCode::bad_data);
}

TEST(Integrate, RefusesObjectSpaceAndMapsWithoutSlopes) {
    NormalMap map(Extent{8, 8});
    for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 8; ++i) {
            map.x.at(i, j) = 0.6f;
            map.y.at(i, j) = 0.0f;
            map.z.at(i, j) = j < 2 ? -0.8f : 0.8f;
        }
    }
    const auto object = integrate(map);
    ASSERT_FALSE(object);
    EXPECT_EQ(object.error().code, ErrorCode::bad_data);
    EXPECT_NE(object.error().reason.find("negative in 16 of 64 texels, as in object-space"), std::string::npos);
    for (int j = 0; j < 8; ++j) std::fill_n(map.z.row(j), 8, 0.0f);
    const auto vertical = integrate(map);
    ASSERT_FALSE(vertical);
    EXPECT_NE(vertical.error().reason.find("z is 0 or not finite everywhere"), std::string::npos);
}

TEST(Integrate, RefusesHeightsThatFloatsCannotHold) {
    NormalMap map({64, 64});
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const float x = i % 2 == 0 ? -1.0f : 1.0f, y = static_cast<float>((i * 37 + j * 91) % 101) / 101.0f - 0.5f;
            const float z = 2e-6f, length = std::sqrt(x * x + y * y + z * z);
            map.x.at(i, j) = x / length;
            map.y.at(i, j) = y / length;
            map.z.at(i, j) = z / length;
        }
    }
    IntegrateOptions options;
    options.bumpiness_x = 1e-20f;
    const auto heights = integrate(map, options);
    ASSERT_FALSE(heights);
    EXPECT_EQ(heights.error().code, ErrorCode::bad_data);
    EXPECT_EQ(heights.error().reason, "the heights do not fit floats: slopes are too steep");
}

// With the least response that is allowed, rounding is amplified, but not beyond what the header says of it.
TEST(Integrate, TheLeastResponseKeepsHeightsInBounds) {
    HeightField field;
    field.height = Plane<float>({48, 40});
    field.bumpiness_x = field.bumpiness_y = 8.0f;
    for (int j = 0; j < 40; ++j) {
        for (int i = 0; i < 48; ++i)
            field.height.at(i, j) =
                0.5f + 0.3f * std::sin(0.3f * static_cast<float>(i)) * std::cos(0.3f * static_cast<float>(j));
    }
    for (const Named<GradientKernel>& kernel : kGradientKernelNames) {
        BakeOptions bake_options{kernel.value};
        const NormalMap map = *bake(field, bake_options);
        for (const auto& [x, y] :
             {std::pair{Wrap::repeat, Wrap::repeat}, {Wrap::clamp, Wrap::repeat}, {Wrap::mirror, Wrap::clamp}}) {
            IntegrateOptions options;
            options.bake = bake_options;
            options.wrap_x = x;
            options.wrap_y = y;
            options.least_response = 1e-6f;
            const auto heights = integrate(map, options);
            ASSERT_TRUE(heights) << kernel.name << ": " << heights.error().message();
            EXPECT_LT(heights->highest, 1e4f) << kernel.name;
        }
    }
}

TEST(Integrate, FlatMapsAndSingleTexelsAreFlat) {
    for (const Extent extent : {Extent{1, 1}, Extent{1, 7}, Extent{9, 1}, Extent{2, 2}, Extent{13, 8}}) {
        for (const Wrap wrap : kWraps) {
            const HeightField field = field_of(extent, 5.0f, wrap, [](int, int) { return 0.25; });
            const Integration result = integrated(*bake(field), options_for(field, {}));
            EXPECT_EQ(result.highest, 0.0f);
            EXPECT_EQ(result.field.height.at(0, 0), 0.0f);
            EXPECT_EQ(result.curl.max, 0.0);
        }
    }
}

// -- bytes ---------------------------------------------------------------------------------------------------

TEST(Integrate, SameBytesForEveryNumberOfThreadsAndEveryTarget) {
    NormalMap map = fields::noise_normals({530, 391}, 7);
    map.z.at(3, 3) = 0.0f;  // several solutions
    IntegrateOptions options;
    options.wrap_y = Wrap::clamp;
    options.most_steps = 3;
    const std::uint64_t hash = fields::hash_of(integrated(map, options).field.height);
    for (const int threads : {2, 3, 8})
        EXPECT_EQ(fields::hash_of(integrated(map, options, threads).field.height), hash);
    on_every_target([&] { EXPECT_EQ(fields::hash_of(integrated(map, options).field.height), hash); });
}

TEST(Integrate, GoldenBytes) {
    HeightField field = field_of({60, 37}, 6.0f, Wrap::mirror, [](int i, int j) { return noise(i, j); });
    field.wrap_x = Wrap::repeat;
    const Integration result = integrated(*bake(field), options_for(field, {}));
    EXPECT_EQ(fields::hash_of(result.field.height), 18437198940337331163u);
}

TEST(Integrate, CancelStopsIt) {
    const NormalMap map = fields::noise_normals({300, 300});
    int calls = 0;
    const auto stopped = integrate(map, {}, {2, [&](double) { return ++calls < 2; }});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

TEST(Integrate, StretchedHeightsRunFromZeroToOne) {
    Plane<float> heights = fields::plane_of({3, 1}, [](int i, int) { return 2.0 + i; });
    stretch_heights(heights, 2.0f, 4.0f);
    EXPECT_EQ(heights.at(0, 0), 0.0f);
    EXPECT_EQ(heights.at(1, 0), 0.5f);
    EXPECT_EQ(heights.at(2, 0), 1.0f);
    stretch_heights(heights, 0.5f, 0.5f);
    EXPECT_EQ(heights.at(2, 0), 0.0f);
}

}  // namespace
