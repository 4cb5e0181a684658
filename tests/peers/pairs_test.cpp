// SPDX-License-Identifier: Apache-2.0
// Height and normal maps that other people's tools made from one another: does a bake, at a fitted strength, give
// their normals, with their sign and their y?

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>

#include "peer_texture.h"

namespace {

const std::string kPairs = TEX_SOURCE_DIR "/../shared/data/pairs/";

struct Pair {
    const char* name;
    const char* height;
    tex::HeightChannel channel;
    bool invert;
    const char* normal;
    tex::YAxis y_axis;
    tex::GradientKernel kernel;
    double limit;  // mean angle in degrees at the best strength
};

constexpr Pair kPairTable[] = {
    {"oiio_bump", "height_half.exr", tex::HeightChannel::automatic, false, "normal_YDOWN_half.exr", tex::YAxis::down,
     tex::GradientKernel::central, 0.3},
    {"d3d_pom_rocks", "normal_rgb_height_a.tga", tex::HeightChannel::a, false, "normal_rgb_height_a.tga",
     tex::YAxis::up, tex::GradientKernel::sobel, 2.6},
    {"d3d_pom_bump", "normal_rgb_height_a.tga", tex::HeightChannel::a, false, "normal_rgb_height_a.tga",
     tex::YAxis::down, tex::GradientKernel::sobel, 2.6},
    {"godot_cheese", "height_INVERTED.png", tex::HeightChannel::automatic, true, "normal_GL.png", tex::YAxis::up,
     tex::GradientKernel::sobel, 2.6},
};

double mean_angle(const tex::NormalMap& a, const tex::NormalMap& b) {
    double sum = 0.0;
    const tex::Extent extent = a.extent();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double dot = static_cast<double>(a.x.at(i, j)) * b.x.at(i, j) +
                               static_cast<double>(a.y.at(i, j)) * b.y.at(i, j) +
                               static_cast<double>(a.z.at(i, j)) * b.z.at(i, j);
            sum += std::acos(std::clamp(dot, -1.0, 1.0));
        }
    }
    return sum / static_cast<double>(extent.texels()) * 180.0 / 3.14159265358979323846;
}

struct Fit {
    double bumpiness = 0.0;
    double degrees = 0.0;
};

// The positive strength with the least mean angle (golden-section search over its logarithm).
Fit fit_strength(tex::HeightField& field, const tex::NormalMap& target, tex::GradientKernel kernel) {
    const auto angle_at = [&](double logarithm) {
        field.bumpiness_x = field.bumpiness_y = static_cast<float>(std::exp(logarithm));
        tex::BakeOptions options;
        options.kernel = kernel;
        return mean_angle(tex::bake(field, options).value(), target);
    };
    constexpr double kRatio = 0.6180339887498949;
    double low = std::log(0.05);
    double high = std::log(500.0);
    for (int step = 0; step < 40; ++step) {
        const double a = high - kRatio * (high - low);
        const double b = low + kRatio * (high - low);
        (angle_at(a) < angle_at(b) ? high : low) = angle_at(a) < angle_at(b) ? b : a;
    }
    const double best = (low + high) / 2.0;
    return {std::exp(best), angle_at(best)};
}

TEST(Pairs, BakesGiveTheNormalsThatOthersMadeFromTheirHeights) {
    if (!std::filesystem::exists(kPairs)) GTEST_SKIP() << kPairs << " is not here";
    std::printf("| pair | kernel | y | fitted bumpiness | mean angle | with y flipped |\n|---|---|---|---|---|---|\n");
    for (const Pair& pair : kPairTable) {
        const auto heights = tex::read_image(kPairs + pair.name + "/" + pair.height);
        const auto picture = tex::read_image(kPairs + pair.name + "/" + pair.normal);
        ASSERT_TRUE(heights && picture) << pair.name;
        tex::HeightOptions height_options;
        height_options.channel = pair.channel;
        height_options.invert = pair.invert;
        auto field = tex::height_field(*heights, height_options);
        ASSERT_TRUE(field) << field.error().message();
        tex::UnpackOptions unpack_options;
        unpack_options.y_axis = pair.y_axis;
        const auto normals = tex::unpack(*picture, unpack_options);
        ASSERT_TRUE(normals) << normals.error().message();
        const Fit fit = fit_strength(*field, *normals, pair.kernel);
        unpack_options.y_axis = pair.y_axis == tex::YAxis::up ? tex::YAxis::down : tex::YAxis::up;
        const Fit flipped = fit_strength(*field, *tex::unpack(*picture, unpack_options), pair.kernel);
        std::printf("| %s | %s | %s | %.3g | %.2f | %.2f |\n", pair.name,
                    tex::name_of(tex::kGradientKernelNames, pair.kernel).data(),
                    tex::name_of(tex::kYAxisNames, pair.y_axis).data(), fit.bumpiness, fit.degrees, flipped.degrees);
        EXPECT_LE(fit.degrees, pair.limit) << pair.name;
        EXPECT_GT(flipped.degrees, fit.degrees * 1.5) << pair.name << ": the other y fits as well";
    }
}

// maketx computes Sobel slopes, per texel, s to the right and t downwards. What lies beyond the border differs, so the
// border is left out.
TEST(Pairs, SobelSlopesAreThoseOfMaketx) {
    const std::string source = kPairs + "oiio_bump/height_half.exr";
    if (!std::filesystem::exists(source)) GTEST_SKIP() << source << " is not here";
    const std::string slopes = peers::scratch_path("slopes.tx");
    ASSERT_EQ(std::system(("maketx --bumpslopes '" + source + "' -o '" + slopes + "'").c_str()), 0);
    const auto input = OIIO::ImageInput::open(slopes);
    ASSERT_TRUE(input) << OIIO::geterror();
    const OIIO::ImageSpec spec = input->spec();
    ASSERT_EQ(spec.nchannels, 6);
    std::vector<float> theirs(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) * 6);
    ASSERT_TRUE(input->read_image(0, 0, 0, 6, OIIO::TypeDesc::FLOAT, theirs.data()));

    auto field = tex::height_field(tex::read_image(source).value(), {});
    ASSERT_TRUE(field);
    ASSERT_EQ(field->height.extent(), (tex::Extent{spec.width, spec.height}));
    tex::BakeOptions options;
    options.kernel = tex::GradientKernel::sobel;
    const tex::NormalMap normals = tex::bake(*field, options).value();
    float steepest = 0.0f;
    for (int j = 1; j < spec.height - 1; ++j) {
        for (int i = 1; i < spec.width - 1; ++i) {
            const float* texel = theirs.data() + static_cast<std::ptrdiff_t>(j * spec.width + i) * 6;
            const float slope_right = -normals.x.at(i, j) / normals.z.at(i, j);
            const float slope_up = -normals.y.at(i, j) / normals.z.at(i, j);
            ASSERT_NEAR(slope_right, texel[1], 2e-6f) << "texel " << i << ", " << j;
            ASSERT_NEAR(slope_up, -texel[2], 2e-6f) << "texel " << i << ", " << j;
            steepest = std::max(steepest, std::abs(texel[1]));
        }
    }
    EXPECT_GT(steepest, 0.01f) << "a flat map would prove nothing";
}

}  // namespace
