// SPDX-License-Identifier: Apache-2.0

#include <tex/height.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reference/blur.h"
#include "unit/fields.h"
#include "unit/targets.h"

namespace {

using tex::ErrorCode;
using tex::Extent;
using tex::HeightChannel;
using tex::HeightField;
using tex::HeightOptions;
using tex::Image;
using tex::Plane;
using tex::Wrap;
using tex::fields::noise;
using tex::fields::plane_of;
using tex::fields::same_bytes;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A picture with the planes `names`; each plane has its own constant: 0.125, 0.25, ...
Image image_of(const std::vector<std::string>& names, Extent extent = {3, 2}) {
    Image image;
    for (const std::string& name : names) {
        image.planes.emplace_back(extent, 0.125f * static_cast<float>(image.planes.size() + 1));
        image.names.push_back(name);
    }
    return image;
}

Image grey_image(Plane<float> plane) {
    Image image;
    image.planes.push_back(std::move(plane));
    image.names = {"Y"};
    return image;
}

HeightOptions channel(HeightChannel value) {
    HeightOptions options;
    options.channel = value;
    return options;
}

float first_height(const Image& image, HeightChannel value) {
    return tex::height_field(image, channel(value)).value().height.at(0, 0);
}

ErrorCode failure(const Image& image, HeightChannel value) {
    return tex::height_field(image, channel(value)).error().code;
}

// -- strength ----------------------------------------------------------------------------------------------

// -- channels ----------------------------------------------------------------------------------------------

TEST(HeightField, TakesTheOnlyChannelWhateverItsName) {
    for (const char* name : {"Y", "R", "A", "height", "foo"}) {
        EXPECT_EQ(first_height(image_of({name}), HeightChannel::automatic), 0.125f) << name;
    }
}

TEST(HeightField, AlphaBesideGreyIsNotAHeight) {
    EXPECT_EQ(first_height(image_of({"A", "Y"}), HeightChannel::automatic), 0.25f);
    EXPECT_EQ(first_height(image_of({"A", "foo"}), HeightChannel::automatic), 0.25f);
}

TEST(HeightField, OfManyChannelsTakesTheOneCalledLikeAHeight) {
    for (const char* name : {"Y", "height", "Height", "DISPLACEMENT", "z", "Depth"}) {
        EXPECT_EQ(first_height(image_of({"N.x", "A", name}), HeightChannel::automatic), 0.375f) << name;
    }
    EXPECT_EQ(failure(image_of({"N.x", "N.y"}), HeightChannel::automatic), ErrorCode::bad_option);
    EXPECT_EQ(failure(image_of({"R", "G"}), HeightChannel::automatic), ErrorCode::bad_option);
}

TEST(HeightField, TakesTheChannelAskedFor) {
    const Image image = image_of({"B", "G", "R", "A"});
    EXPECT_EQ(first_height(image, HeightChannel::b), 0.125f);
    EXPECT_EQ(first_height(image, HeightChannel::g), 0.25f);
    EXPECT_EQ(first_height(image, HeightChannel::r), 0.375f);
    EXPECT_EQ(first_height(image, HeightChannel::a), 0.5f);
    EXPECT_FLOAT_EQ(first_height(image, HeightChannel::luma), 0.2126f * 0.375f + 0.7152f * 0.25f + 0.0722f * 0.125f);
    EXPECT_FLOAT_EQ(first_height(image, HeightChannel::average), 0.25f);
    EXPECT_EQ(first_height(image, HeightChannel::max), 0.375f);
}

TEST(HeightField, OfAGreyPictureEveryColourIsGrey) {
    const Image image = image_of({"Y", "A"});
    for (const HeightChannel value : {HeightChannel::r, HeightChannel::g, HeightChannel::b, HeightChannel::y,
                                      HeightChannel::luma, HeightChannel::average, HeightChannel::max}) {
        EXPECT_EQ(first_height(image, value), 0.125f);
    }
}

TEST(HeightField, AMissingChannelIsAnErrorThatListsThoseThereAre) {
    const auto result = tex::height_field(image_of({"R", "G", "B"}), channel(HeightChannel::a));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::bad_option);
    EXPECT_EQ(result.error().reason, "the picture has no channel for \"a\"; its channels are R, G, B");
    EXPECT_EQ(failure(image_of({"Y"}), HeightChannel::a), ErrorCode::bad_option);
    EXPECT_EQ(failure(image_of({"R", "G", "B"}), HeightChannel::y), ErrorCode::bad_option);
}

TEST(HeightField, AutomaticTakesLumaOnlyWhereColoursDifferAndCounts) {
    Image image;
    for (int k = 0; k < 3; ++k) image.planes.push_back(plane_of({37, 5}, [](int i, int j) { return noise(i, j); }));
    image.names = {"R", "G", "B"};
    image.planes[1].at(36, 0) = 0.0f;
    image.planes[2].at(20, 4) = 1.0f;
    tex::on_every_target([&] {
        const tex::PictureHeights field = tex::height_field(image).value();
        EXPECT_EQ(field.report.luma_texels, 2);
        EXPECT_EQ(field.report.invalid_texels, 0);
        for (int j = 0; j < 5; ++j) {
            for (int i = 0; i < 37; ++i) {
                if ((i == 36 && j == 0) || (i == 20 && j == 4)) continue;
                EXPECT_EQ(field.height.at(i, j), image.planes[0].at(i, j));  // exactly, so luma's weights are not used
            }
        }
        EXPECT_FLOAT_EQ(field.height.at(36, 0), (0.2126f + 0.0722f) * image.planes[0].at(36, 0));
    });
}

TEST(HeightField, HasStrengthOneAndTheWrapAskedFor) {
    HeightOptions options;
    options.wrap_x = Wrap::mirror;
    options.wrap_y = Wrap::clamp;
    const HeightField field = tex::height_field(image_of({"Y"}), options).value();
    EXPECT_EQ(field.bumpiness_x, 1.0f);
    EXPECT_EQ(field.bumpiness_y, 1.0f);
    EXPECT_EQ(field.wrap_x, Wrap::mirror);
    EXPECT_EQ(field.wrap_y, Wrap::clamp);
}

TEST(HeightField, InvertMakesWhiteLow) {
    HeightOptions options;
    options.invert = true;
    EXPECT_EQ(tex::height_field(image_of({"Y"}), options).value().height.at(2, 1), 0.875f);
}

// -- invalid heights ---------------------------------------------------------------------------------------

TEST(HeightField, InvalidHeightsAreAnErrorThatNamesTheFirstAndTheCount) {
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        Image image = image_of({"Y"}, {40, 30});
        image.planes[0].at(33, 7) = bad;
        image.planes[0].at(2, 8) = bad;
        const auto result = tex::height_field(image, {});
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::bad_data);
        EXPECT_EQ(result.error().reason, "2 heights are NaN or infinite, the first at column 33, row 7");
        EXPECT_EQ(result.error().detail, tex::ErrorDetail::missing_heights);
    }
}

TEST(HeightField, ANoDataValueIsInvalidOnlyWhereItIsNamed) {
    Image image = image_of({"Y"}, {4, 4});
    image.planes[0].at(1, 2) = -9999.0f;
    EXPECT_TRUE(tex::height_field(image, {}));
    HeightOptions options;
    options.no_data = -9999.0f;
    const auto result = tex::height_field(image, options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().reason, "1 height is NaN, infinite or no-data, the first at column 1, row 2");
}

TEST(HeightField, APictureWithoutAnyHeightCannotBeFilled) {
    HeightOptions options;
    options.fill_invalid = true;
    const auto result = tex::height_field(grey_image(Plane<float>({5, 5}, kNan)), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().detail, tex::ErrorDetail::none);
    EXPECT_EQ(result.error().code, ErrorCode::bad_data);
}

TEST(HeightField, InvalidColoursAreInvalidHeightsInEveryMixture) {
    for (const HeightChannel value :
         {HeightChannel::automatic, HeightChannel::luma, HeightChannel::average, HeightChannel::max}) {
        for (std::size_t plane = 0; plane < 3; ++plane) {
            Image image = image_of({"R", "G", "B"});
            image.planes[plane].at(1, 1) = kNan;
            tex::on_every_target([&] { EXPECT_EQ(failure(image, value), ErrorCode::bad_data); });
        }
    }
}

TEST(HeightField, FillsAcrossTheBorderOfItsWrapAndCounts) {
    Image image = grey_image(Plane<float>({8, 1}, kNan));
    image.planes[0].at(0, 0) = 1.0f;
    image.planes[0].at(4, 0) = 2.0f;
    HeightOptions options;
    options.fill_invalid = true;
    const tex::PictureHeights filled = tex::height_field(image, options).value();
    EXPECT_EQ(filled.height.at(7, 0), 1.0f);
    EXPECT_EQ(filled.report.invalid_texels, 6);
    options.wrap_x = Wrap::clamp;
    EXPECT_EQ(tex::height_field(image, options).value().height.at(7, 0), 2.0f);
}

TEST(HeightField, FillsBeforeItInverts) {
    Image image = image_of({"Y"}, {4, 4});
    image.planes[0].at(1, 2) = kNan;
    HeightOptions options;
    options.fill_invalid = options.invert = true;
    EXPECT_EQ(tex::height_field(image, options).value().height.at(1, 2), 0.875f);
}

// -- blur --------------------------------------------------------------------------------------------------

TEST(HeightField, BlursAfterItInverts) {
    HeightOptions options;
    options.invert = true;
    options.blur_sigma = 2.0f;
    options.wrap_x = Wrap::mirror;
    const Plane<float> heights = plane_of({20, 12}, [](int i, int j) { return noise(i, j); });
    const auto inverted = plane_of({20, 12}, [](int i, int j) { return 1.0 - noise(i, j); });
    const auto truth = tex::reference::blur(tex::reference::grid_of(inverted), 2.0, Wrap::mirror, Wrap::repeat);
    const HeightField field = tex::height_field(grey_image(heights.clone()), options).value();
    for (int i = 0; i < 20; ++i) EXPECT_NEAR(static_cast<double>(field.height.at(i, 11)), truth.at(i, 11), 1e-6);
}

TEST(HeightField, BlurBeyondItsRangeIsABadOption) {
    for (const float sigma : {-1.0f, 256.5f, kNan, kInfinity}) {
        HeightOptions options;
        options.blur_sigma = sigma;
        const auto result = tex::height_field(image_of({"Y"}), options);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::bad_option);
    }
}

// -- the same bytes ----------------------------------------------------------------------------------------

TEST(HeightField, GivesTheSameBytesOnEveryTargetAndForEveryNumberOfThreads) {
    Image image;
    for (unsigned k = 0; k < 3; ++k) {
        image.planes.push_back(plane_of({263, 701}, [&](int i, int j) {
            return noise(i, j, 20) < 0.3 ? static_cast<double>(kNan) : noise(i, j, k);
        }));
    }
    image.names = {"R", "G", "B"};
    HeightOptions options;
    options.fill_invalid = options.invert = true;
    options.blur_sigma = 2.0f;
    std::optional<HeightField> first;
    tex::on_every_target([&] {
        for (const int threads : {1, 2, 3, 8}) {
            HeightField field = tex::height_field(image, options, {threads, {}}).value();
            if (!first)
                first = std::move(field);
            else
                EXPECT_TRUE(same_bytes(first->height, field.height)) << threads << " threads";
        }
    });
}

TEST(HeightField, ReportsProgressUpwardsThroughAllSteps) {
    Image image = image_of({"Y"}, {300, 300});
    image.planes[0].at(5, 5) = kNan;
    HeightOptions options;
    options.fill_invalid = true;
    options.blur_sigma = 1.0f;
    std::vector<double> seen = {0.0};
    ASSERT_TRUE(tex::height_field(image, options, {1, [&](double fraction) {
                                                       seen.push_back(fraction);
                                                       return true;
                                                   }}));
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_GT(seen.size(), 4u);
    EXPECT_EQ(seen.back(), 1.0);
}

TEST(HeightField, CanBeCancelledInEveryStep) {
    Image image = image_of({"Y"}, {300, 300});
    image.planes[0].at(5, 5) = kNan;
    HeightOptions options;
    options.fill_invalid = true;
    options.blur_sigma = 1.0f;
    for (const double limit : {0.0, 0.1, 0.3, 0.45, 0.7, 0.9}) {
        const auto result = tex::height_field(image, options, {1, [&](double fraction) { return fraction < limit; }});
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::cancelled);
    }
}

}  // namespace
