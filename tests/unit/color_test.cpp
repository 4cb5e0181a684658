// SPDX-License-Identifier: Apache-2.0

#include <tex/height.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "scratch.h"

namespace tex {
namespace {

constexpr const char* kConfig = R"(ocio_profile_version: 1
search_path: luts
strictparsing: true
roles:
  default: raw
  scene_linear: lin
  painted: gamma2
displays:
  d:
    - !<View> {name: v, colorspace: raw}
colorspaces:
  - !<ColorSpace>
    name: raw
    isdata: true
  - !<ColorSpace>
    name: lin
    bitdepth: 32f
  - !<ColorSpace>
    name: gamma2
    to_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}
  - !<ColorSpace>
    name: swapped
    to_reference: !<MatrixTransform> {matrix: [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: broken
    to_reference: !<FileTransform> {src: missing.spi1d}
)";

Image grey(std::initializer_list<float> values, SampleKind sample = SampleKind::floating, int bits = 32) {
    Image image;
    image.names = {"Y"};
    image.planes.emplace_back(Extent{static_cast<int>(values.size()), 1});
    int i = 0;
    for (const float v : values) image.planes[0].at(i++, 0) = v;
    image.sample = sample;
    image.bits = bits;
    return image;
}

Image rgba(float r, float g, float b, float a) {
    Image image;
    image.names = {"A", "R", "G", "B"};
    for (const float v : {a, r, g, b}) image.planes.emplace_back(Extent{3, 2}, v);
    image.sample = SampleKind::floating;
    image.bits = 32;
    return image;
}

double srgb(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

class Color : public testing::Test, protected Scratch {
protected:
    void SetUp() override { config_ = write("config.ocio", kConfig); }
    std::string config_;
};

TEST_F(Color, BuiltInCurveIsThatOfTheStandard) {
    for (const int bits : {8, 16}) {
        const int top = (1 << bits) - 1;
        Image image = grey({0.0f, 0.5f, 1.0f}, SampleKind::unorm, bits);
        image.planes[0] = Plane<float>(Extent{top + 1, 1});
        for (int k = 0; k <= top; ++k) image.planes[0].at(k, 0) = static_cast<float>(k) / static_cast<float>(top);
        image = to_linear(std::move(image), {"sRGB", ""}).value();
        for (int k = 0; k <= top; ++k)
            ASSERT_NEAR(image.planes[0].at(k, 0), srgb(k / static_cast<double>(top)), 1e-7) << k;
        EXPECT_EQ(image.planes[0].at(0, 0), 0.0f);
        EXPECT_EQ(image.planes[0].at(top, 0), 1.0f);
    }
    Image image = grey({-0.5f, 0.02f, 0.5f, 4.0f, std::numeric_limits<float>::quiet_NaN()});
    image = to_linear(std::move(image), {"srgb", ""}).value();
    EXPECT_NEAR(image.planes[0].at(0, 0), -srgb(0.5), 1e-7);
    EXPECT_NEAR(image.planes[0].at(1, 0), srgb(0.02), 1e-9);
    EXPECT_NEAR(image.planes[0].at(3, 0), srgb(4.0), 1e-4);
    EXPECT_TRUE(std::isnan(image.planes[0].at(4, 0)));
}

TEST_F(Color, TableAndFormulaAgreeToTheLastBit) {
    Image few = grey({0.0f, 13 / 255.0f, 128 / 255.0f, 200 / 255.0f, 1.0f}, SampleKind::unorm, 8);
    Image many = grey({0.0f, 13 / 255.0f, 128 / 255.0f, 200 / 255.0f, 1.0f});
    few = to_linear(std::move(few), {"sRGB", ""}).value();
    many = to_linear(std::move(many), {"sRGB", ""}).value();
    for (int i = 0; i < 5; ++i) EXPECT_EQ(few.planes[0].at(i, 0), many.planes[0].at(i, 0));
}

TEST_F(Color, FilesAreTheConfigurationAndItsTables) {
    std::filesystem::create_directory(folder_ + "/luts");
    const std::string table =
        write("luts/missing.spi1d", "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n0.0\n0.5\n}\n");
    const auto files = color_files({"broken", config_});
    ASSERT_TRUE(files) << files.error().message();
    EXPECT_EQ(*files, (std::vector<std::string>{config_, table}));
    EXPECT_EQ(*color_files({"gamma2", config_}), std::vector<std::string>{config_});
    EXPECT_TRUE(color_files({"sRGB", ""})->empty());
    EXPECT_EQ(color_files({"none", config_}).error().code, ErrorCode::bad_option);
}

TEST_F(Color, LinearAndAlphaStayAsTheyAre) {
    Image image = rgba(0.5f, 0.25f, 0.75f, 0.5f);
    image = to_linear(std::move(image), {"LINEAR", ""}).value();
    EXPECT_EQ(image.planes[1].at(2, 1), 0.5f);
    image = to_linear(std::move(image), {"sRGB", ""}).value();
    EXPECT_EQ(image.planes[0].at(2, 1), 0.5f);
    EXPECT_NEAR(image.planes[2].at(2, 1), srgb(0.25), 1e-7);
}

TEST_F(Color, AConfigurationConvertsByNameAndByRole) {
    for (const char* space : {"gamma2", "painted"}) {
        Image image = rgba(0.5f, 0.25f, 1.0f, 0.5f);
        Result<Image> done = to_linear(std::move(image), {space, config_});
        ASSERT_TRUE(done) << done.error().message();
        image = std::move(*done);
        EXPECT_NEAR(image.planes[1].at(2, 1), 0.25f, 1e-5);
        EXPECT_NEAR(image.planes[2].at(0, 0), 0.0625f, 1e-5);
        EXPECT_EQ(image.planes[0].at(2, 1), 0.5f);
    }
    Image image = rgba(0.5f, 0.25f, 1.0f, 0.5f);
    image = to_linear(std::move(image), {"swapped", config_}).value();
    EXPECT_NEAR(image.planes[1].at(0, 0), 0.25f, 1e-6);
    EXPECT_NEAR(image.planes[2].at(0, 0), 0.5f, 1e-6);
    Image one = grey({0.5f, 1.0f});
    one = to_linear(std::move(one), {"gamma2", config_}).value();
    EXPECT_NEAR(one.planes[0].at(0, 0), 0.25f, 1e-5);
}

TEST_F(Color, ErrorsNameTheConfigurationAndTheSpaces) {
    const Result<Image> unknown = to_linear(grey({0.5f}), {"nonsense", ""});
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::bad_option);
    EXPECT_NE(unknown.error().reason.find("sRGB"), std::string::npos);

    const Result<Image> other = to_linear(grey({0.5f}), {"nonsense", config_});
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().code, ErrorCode::bad_option);
    EXPECT_EQ(other.error().file, config_);
    EXPECT_NE(other.error().reason.find("gamma2"), std::string::npos) << other.error().reason;

    EXPECT_EQ(to_linear(grey({0.5f}), {"raw", folder_ + "/missing.ocio"}).error().code, ErrorCode::io);
    EXPECT_EQ(to_linear(grey({0.5f}), {"raw", folder_}).error().code, ErrorCode::io);
    EXPECT_EQ(to_linear(grey({0.5f}), {"raw", write("bad.ocio", "ocio_profile_version: [")}).error().code,
              ErrorCode::bad_data);
    EXPECT_EQ(to_linear(grey({0.5f}), {"raw", write("bad2.ocio", "hello")}).error().code, ErrorCode::bad_data);
    EXPECT_EQ(to_linear(grey({0.5f}), {"broken", config_}).error().code, ErrorCode::bad_data);
    std::string roleless = kConfig;
    roleless.erase(roleless.find("  scene_linear: lin\n"), 20);
    const Result<Image> no_role = to_linear(grey({0.5f}), {"gamma2", write("roleless.ocio", roleless)});
    ASSERT_FALSE(no_role);
    EXPECT_EQ(no_role.error().code, ErrorCode::bad_option);
    EXPECT_EQ(no_role.error().reason, "the configuration has no role scene_linear");
}

}  // namespace
}  // namespace tex
