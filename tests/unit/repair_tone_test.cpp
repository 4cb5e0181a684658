// SPDX-License-Identifier: Apache-2.0
// What else image editors do to colours: brightness that is added, and the lightness of HSL.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "bench/wild_maps.h"
#include "reference/damage.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {
namespace {

unsigned char code_of(double c) {
    return static_cast<unsigned char>(std::floor(std::clamp(c, 0.0, 1.0) * 255.0 + 0.5));
}

// Through hue and saturation, as textbooks have it: Foley and others, Computer Graphics, 1990, section 13.3.5.
Codes with_lightness_of(double by) {
    Codes codes = clean();
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            const double r = codes.at(i, j, 0) / 255.0, g = codes.at(i, j, 1) / 255.0, b = codes.at(i, j, 2) / 255.0;
            const double most = std::max({r, g, b}), least = std::min({r, g, b}), l = 0.5 * (most + least);
            if (most == least) {
                for (int c = 0; c < 3; ++c) codes.at(i, j, c) = code_of(by * l);
                continue;
            }
            const double d = most - least, s = l <= 0.5 ? d / (most + least) : d / (2.0 - most - least);
            double h = 60.0 * (r == most ? (g - b) / d : g == most ? 2.0 + (b - r) / d : 4.0 + (r - g) / d);
            if (h < 0.0) h += 360.0;
            const double l2 = by * l, m2 = l2 <= 0.5 ? l2 * (1.0 + s) : l2 + s - l2 * s, m1 = 2.0 * l2 - m2;
            const auto value = [&](double hue) {
                hue = hue > 360.0 ? hue - 360.0 : hue < 0.0 ? hue + 360.0 : hue;
                if (hue < 60.0) return m1 + (m2 - m1) * hue / 60.0;
                if (hue < 180.0) return m2;
                return hue < 240.0 ? m1 + (m2 - m1) * (240.0 - hue) / 60.0 : m1;
            };
            codes.at(i, j, 0) = code_of(value(h + 120.0));
            codes.at(i, j, 1) = code_of(value(h));
            codes.at(i, j, 2) = code_of(value(h - 120.0));
        }
    }
    return codes;
}

// A surface that does not repeat, so that its histogram is smooth.
Codes ground() {
    constexpr int side = 512;
    HeightField field{Plane<float>(Extent{side, side}), 4.0f, 4.0f, Wrap::clamp, Wrap::clamp};
    for (int k = 0; k < side * side; ++k) {
        const double x = 0.0123 * (k % side), y = 0.0123 * (k / side);
        field.height.at(k % side, k / side) = static_cast<float>(
            0.5 + 0.15 * std::sin(9.13 * x + 6.27 * y) + 0.12 * std::sin(15.37 * x - 12.91 * y + 1.0) +
            0.1 * std::sin(6.71 * x + 21.43 * y + 2.0) * std::cos(18.19 * x));
    }
    return reference::codes_of(*bake(field));
}

}  // namespace

TEST(Repair, TakesLightnessBack) {
    const Texture plain = reference::texture_of(clean());
    for (const auto& [by, plan] : {std::pair{1.2, "N314 take lightness 120 % (HSL) back"},
                                   std::pair{0.85, "N314 take lightness 85 % (HSL) back"}}) {
        const Repaired done = repaired(reference::texture_of(with_lightness_of(by)));
        EXPECT_EQ(plan_of(done), plan);
        ASSERT_TRUE(done.texture);
        EXPECT_LT(angle(*done.texture, plain), 0.7) << "what rounding costs: three channels of 8 bits";
    }
}

// A shift leaves no gaps in the histogram, cuts z off nearly everywhere, and moves the middle almost as far as the
// curve of sRGB does.
TEST(Repair, SubtractsABrightnessThatWasAdded) {
    const Codes plain = ground();
    Codes light = plain;
    for (unsigned char& code : light.values) code = static_cast<unsigned char>(std::min(255, code + 51));
    const Texture texture = reference::texture_of(light);
    EXPECT_FALSE(repaired(texture).texture) << "z proves nothing";
    RepairOptions options;
    options.likely = true;
    const Repaired done = repaired(texture, options);
    EXPECT_EQ(plan_of(done).substr(0, 23), "N314 subtract 51 of 255") << "and not the curve of sRGB";
    Codes dark = plain;
    for (unsigned char& code : dark.values) code = static_cast<unsigned char>(std::max(0, code - 51));
    EXPECT_EQ(plan_of(repaired(reference::texture_of(dark), options)).substr(0, 18), "N314 add 51 of 255");
}

// Automatic levels stretch each channel from its darkest to its lightest value.
TEST(Repair, TakesAutomaticLevelsBack) {
    const Codes plain = clean();
    for (const int lowest_z : {0, 1}) {
        Codes codes = plain;
        for (int c = 0; c < 3; ++c) {
            int low = 255, high = 0;
            for (int k = 0; k < codes.extent.width * codes.extent.height; ++k) {
                const int code = plain.values[static_cast<std::size_t>(3 * k + c)];
                low = std::min(low, code);
                high = std::max(high, code);
            }
            // Levels of z alone are those of a map with z from 0 to 1, if it has no slope of 90 degrees.
            if (c == 2 && lowest_z == 1) low = 1;
            for (int k = 0; k < codes.extent.width * codes.extent.height; ++k) {
                unsigned char& code = codes.values[static_cast<std::size_t>(3 * k + c)];
                code = code_of((code - low) / static_cast<double>(high - low));
            }
        }
        const Texture texture = reference::texture_of(codes);
        RepairOptions options;
        options.likely = true;
        const Repaired done = repaired(texture, options);
        const bool is_auto = lowest_z == 0;
        EXPECT_EQ(plan_of(done) == "N314 take the levels of each channel back", is_auto) << plan_of(done);
        if (!is_auto) continue;
        EXPECT_FALSE(repaired(texture).texture) << "likely";
        ASSERT_FALSE(done.before.findings.empty());
        const std::string& message = done.before.findings.front().message;
        EXPECT_NE(message.find(": R "), std::string::npos) << message;
        EXPECT_NE(message.find(" % (z then"), std::string::npos) << message;
        ASSERT_TRUE(done.texture);
        EXPECT_GT(angle(texture, reference::texture_of(plain)), 3.0);
        EXPECT_LT(angle(*done.texture, reference::texture_of(plain)),
                  0.2 * angle(texture, reference::texture_of(plain)));
    }
}

// Sixteen values have none in the middle, so that all that is level leans to one side.
TEST(Repair, LevelGroundIsLevelAgainAfterFewValues) {
    Codes codes = clean();
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            const bool is_level = (i / 96 + j / 96) % 2 == 0;
            for (int c = 0; is_level && c < 3; ++c) codes.at(i, j, c) = c == 2 ? 255 : 128;
        }
    }
    const Texture plain = reference::texture_of(codes);
    for (unsigned char& code : codes.values)
        code = static_cast<unsigned char>(17.0 * std::floor(std::min(15.0, code / 16.0)));
    RepairOptions options;
    options.likely = true;
    const Repaired done = repaired(reference::texture_of(codes), options);
    EXPECT_EQ(plan_of(done).substr(0, 4), "N315");
    ASSERT_TRUE(done.texture);
    const auto map = unpack(*done.texture);
    double lean = 0.0;
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i)
            lean += static_cast<double>(map->levels.front().x.at(i, j)) / static_cast<double>(codes.extent.texels());
    }
    EXPECT_LT(std::abs(lean), 0.01) << "a step is 0.13";
    EXPECT_LT(angle(*done.texture, plain), 0.6 * angle(reference::texture_of(codes), plain));
}

// The curve makes one colour of a flat map, too, whose length as a vector is not far from 1.
TEST(RepairTone, AFlatMapThatWentThroughTheCurveIsFlatAgain) {
    Codes codes{{64, 64}, 3, std::vector<unsigned char>(std::size_t{3} * 64 * 64, 255)};
    for (std::size_t k = 0; k < codes.values.size(); ++k) codes.values[k] = k % 3 == 2 ? 255 : 188;
    RepairOptions options;
    options.likely = true;
    const Repaired done = repaired(reference::texture_of(codes), options);
    EXPECT_EQ(plan_of(done), "N302 decode with the sRGB curve");
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(codes_in(*done.texture).front(), 128);
}

// A plain power of 2.2, or its inverse, explains inverted blue nearly as well, and leaves a degree.
TEST(RepairTone, TheCurveIsFoundBesideAnotherZ) {
    const Texture plain = reference::texture_of(clean());
    RepairOptions options;
    options.likely = true;
    for (const bool is_inverted : {true, false}) {
        Codes codes = clean();
        for (std::size_t k = 2; k < codes.values.size(); k += 3) {
            const int z = codes.values[k];
            codes.values[k] = static_cast<unsigned char>(is_inverted ? 255 - z : std::max(0, 2 * z - 255));
        }
        for (const bool is_encoded : {true, false}) {
            const Codes stored = is_encoded ? reference::srgb_encode(codes) : reference::srgb_decode(codes);
            const Repaired done = repaired(reference::texture_of(stored), options);
            EXPECT_EQ(plan_of(done).substr(0, 4), is_encoded ? "N302" : "N301") << plan_of(done);
            ASSERT_TRUE(done.texture);
            EXPECT_LT(angle(*done.texture, plain), is_encoded ? 0.3 : 0.5) << plan_of(done);
        }
    }
}

// The middle of a map that leans by a degree lies where a plain power would have it, and its vectors are unit vectors
// either way; but only one curve makes codes of 8 bits of all values.
TEST(RepairTone, SixteenBitsThatWereEightProveTheCurve) {
    Codes codes = clean();
    for (std::size_t k = 0; k < codes.values.size(); ++k) {
        if (k % 3 != 2) codes.values[k] = static_cast<unsigned char>(std::max(0, codes.values[k] - 2));
    }
    Texture texture = reference::texture_of(codes);
    texture.format = Format::rgb16_unorm;
    std::vector<std::byte>& bytes = texture.levels.front().bytes;
    bytes.clear();
    for (const unsigned char code : codes.values) {
        const double c = code / 255.0, encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
        const auto value = static_cast<unsigned>(65535.0 * encoded + 0.5);
        bytes.push_back(static_cast<std::byte>(value & 255u));
        bytes.push_back(static_cast<std::byte>(value >> 8u));
    }
    const Repaired done = repaired(texture);
    EXPECT_EQ(plan_of(done).substr(0, 4), "N302") << "safe";
    ASSERT_TRUE(done.texture);
    EXPECT_LT(angle(*done.texture, reference::texture_of(codes)), 0.05);
}

// Contrast pushes many vectors of a rough map beyond the unit circle, which is no reason to call it a picture.
TEST(RepairTone, AContrastMakesNoPictureOfAMap) {
    Codes codes = reference::codes_of(bumps(24.0f));
    for (unsigned char& code : codes.values) code = code_of(0.5 + 2.0 * (code / 255.0 - 0.5));
    const auto report = check("map.png", reference::texture_of(codes));
    ASSERT_TRUE(report);
    bool is_long = false;
    for (const Finding& finding : report->findings) {
        EXPECT_NE(finding.rule->id, "N214") << finding.message;
        is_long = is_long || (finding.rule->id == "N201" && finding.severity == Severity::warning);
    }
    EXPECT_TRUE(is_long);
}

// A strong JPEG leaves one value in each block of a nearly flat map. In other files, such squares are enlarged texels.
TEST(RepairTone, BlocksOfJpegAreNoEnlargement) {
    Codes codes = clean();
    codes.extent = {codes.extent.width / 8 * 8, codes.extent.height / 8 * 8};
    codes.values.resize(static_cast<std::size_t>(3 * codes.extent.texels()));
    for (int j = 0; j < codes.extent.height; ++j) {
        for (int i = 0; i < codes.extent.width; ++i) {
            for (int c = 0; c < 3; ++c) codes.at(i, j, c) = clean().at(i / 8 * 8, j / 8 * 8, c);
        }
    }
    for (const std::string name : {"map.jpg", "map.png"}) {
        const auto report = check(name, reference::texture_of(codes));
        ASSERT_TRUE(report);
        const bool is_enlarged =
            std::ranges::any_of(report->findings, [](const Finding& f) { return f.rule->id == "N312"; });
        EXPECT_EQ(is_enlarged, name == "map.png");
    }
}

// Brightness of 15 %, which leaves z in few texels: they deny all contrasts, whatever the histogram suggests.
TEST(RepairTone, ReadsWhatIsLeftOfZAfterBrightness) {
    const std::string file = reference::kWildMaps + "normal/castle_cool_water_texture_seamless_normalmap.png";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no ../shared/data/wild4";
    const auto intact = read_texture(file);
    ASSERT_TRUE(intact);
    Texture bright = *intact;
    for (std::byte& byte : bright.levels.front().bytes)
        byte = static_cast<std::byte>(std::min(255, static_cast<int>(byte) + 38));
    RepairOptions options;
    options.likely = true;
    const Repaired done = repaired(bright, options);
    ASSERT_TRUE(done.texture) << plan_of(done);
    EXPECT_LT(angle(*done.texture, *intact), 1.0) << plan_of(done);
}

}  // namespace tex::repaired_maps
