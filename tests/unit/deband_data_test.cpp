// SPDX-License-Identifier: Apache-2.0
// deband() on real height maps that are rounded to 8 bits: the bake is never farther from that of the original.

#include <tex/bake.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/height.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "unit/fields.h"
#include "unit/textures.h"

namespace {

namespace fs = std::filesystem;
using tex::HeightField;
using tex::Plane;

// Rounding of floats moves the heights of 8 bits themselves this far, in degrees.
constexpr double kRounding = 1e-6;

// Heights from 0 to 1.
Plane<float> stretched(const Plane<float>& heights) {
    float low = heights.at(0, 0), high = low;
    for (int j = 0; j < heights.extent().height; ++j) {
        const auto [least, most] = std::minmax_element(heights.row(j), heights.row(j) + heights.extent().width);
        low = std::min(low, *least);
        high = std::max(high, *most);
    }
    return tex::fields::plane_of(heights.extent(), [&](int i, int j) {
        return high > low ? static_cast<double>((heights.at(i, j) - low) / (high - low)) : 0.0;
    });
}

Plane<float> in_8_bits(const Plane<float>& heights) {
    return tex::fields::plane_of(heights.extent(), [&](int i, int j) {
        return static_cast<double>(std::round(heights.at(i, j) * 255.0f) / 255.0f);
    });
}

HeightField field_of(const Plane<float>& heights) {
    return {heights.clone(), 20.0f, 20.0f, tex::Wrap::clamp, tex::Wrap::clamp};
}

// The mean angle, in degrees.
double mean_error(const HeightField& truth, const HeightField& field) {
    return tex::compare(tex::bake(field).value(), tex::bake(truth).value())->error.mean;
}

TEST(DebandData, NeverMakesAMapWorse) {
    TEX_NEEDS_SHARED_DATA();
    int maps = 0;
    for (const auto& entry : fs::directory_iterator(tex::shared_data() / "height")) {
        const std::string name = entry.path().filename().string();
        tex::HeightOptions options;
        options.fill_invalid = true;
        if (name.find("unfinished") != std::string::npos) options.no_data = -32768.0f;
        if (name.find("nodata") != std::string::npos) options.no_data = -9999.0f;
        const auto image = tex::read_image(entry.path().string());
        ASSERT_TRUE(image) << name << ": " << image.error().message();
        if (image->bits <= 8 && image->sample != tex::SampleKind::floating) continue;
        const auto read = tex::height_field(*image, options);
        ASSERT_TRUE(read) << name << ": " << read.error().message();
        const Plane<float> heights = stretched(read->height);
        const HeightField truth = field_of(heights), rounded = field_of(in_8_bits(heights));
        const HeightField debanded = tex::deband(field_of(rounded.height)).value();
        EXPECT_LE(mean_error(truth, debanded), mean_error(truth, rounded) + kRounding) << name;
        ++maps;
    }
    EXPECT_GE(maps, 10);
}

}  // namespace
