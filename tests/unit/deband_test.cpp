// SPDX-License-Identifier: Apache-2.0

#include <tex/height.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <tex/bake.h>

#include "unit/fields.h"

namespace {

using tex::Deband;
using tex::DebandReport;
using tex::Extent;
using tex::HeightField;
using tex::Plane;
using tex::Wrap;
using tex::fields::noise;
using tex::fields::plane_of;
using tex::fields::same_bytes;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kPi = 3.14159265358979323846;
using Formula = std::function<double(int i, int j)>;

HeightField field_of(Extent extent, const Formula& height, Wrap wrap = Wrap::clamp) {
    return tex::fields::field_of(extent, 20.0f, wrap, height);
}

// Heights from 0 to 1 as a file of 8 bits holds them.
Formula in_8_bits(const Formula& height) {
    return [height](int i, int j) { return std::round(255.0 * height(i, j)) / 255.0; };
}

Formula in_16_bits(const Formula& height) {
    return [height](int i, int j) { return std::round(65535.0 * height(i, j)) / 65535.0; };
}

double hills(int i, int j) { return 0.5 + 0.3 * std::sin(0.02 * i + 0.01 * j) * std::cos(0.017 * j); }

// The mean angle between the normals of two fields, in degrees.
double angle(const HeightField& a, const HeightField& b) {
    const tex::NormalMap first = tex::bake(a).value(), second = tex::bake(b).value();
    double sum = 0.0;
    for (int j = 0; j < first.extent().height; ++j) {
        for (int i = 0; i < first.extent().width; ++i) {
            const double x = first.x.at(i, j) - second.x.at(i, j), y = first.y.at(i, j) - second.y.at(i, j);
            const double z = first.z.at(i, j) - second.z.at(i, j);
            sum += 2.0 * std::asin(std::min(1.0, std::sqrt(x * x + y * y + z * z) / 2.0));
        }
    }
    return sum / static_cast<double>(first.extent().texels()) * 180.0 / kPi;
}

// The number of texels that do not round to the step of the input.
int texels_off(const HeightField& in, const HeightField& out, double step, double lowest = 0.0) {
    int off = 0;
    for (int j = 0; j < in.height.extent().height; ++j) {
        for (int i = 0; i < in.height.extent().width; ++i) {
            const auto code = [&](float height) { return std::round((static_cast<double>(height) - lowest) / step); };
            off += code(in.height.at(i, j)) != code(out.height.at(i, j)) ? 1 : 0;
        }
    }
    return off;
}

HeightField debanded(const HeightField& field, DebandReport* report = nullptr, tex::Execution execution = {}) {
    HeightField copy{field.height.clone(), field.bumpiness_x, field.bumpiness_y, field.wrap_x, field.wrap_y};
    tex::DebandedField found = tex::deband(std::move(copy), Deband::on, execution).value();
    if (report != nullptr) *report = found.report;
    return found;
}

TEST(Deband, RoundsToTheInputOnEveryTexel) {
    const Formula kFields[] = {hills, [](int i, int j) { return noise(i, j); },
                               [](int i, int j) { return (i + 3 * j) / 700.0; },
                               [](int i, int j) { return i < 40 ? hills(i, j) : 0.9 * noise(i, j, 2); },
                               [](int i, int j) { return (i / 20 + j / 15) % 2 == 0 ? 0.2 : 0.8; }};
    for (const Formula& height : kFields) {
        for (const Extent extent : {Extent{91, 87}, Extent{32, 64}, Extent{1, 90}, Extent{90, 1}, Extent{3, 2}}) {
            for (const auto& wrap : tex::kWrapNames) {
                const HeightField in = field_of(extent, in_8_bits(height), wrap.value);
                EXPECT_EQ(texels_off(in, debanded(in), 1.0 / 255.0), 0) << extent.width << "x" << extent.height;
            }
        }
    }
}

// The formula is the truth that 8 bits have lost.
TEST(Deband, GivesSmoothGroundItsSlopesBack) {
    const Formula kFields[] = {hills, [](int i, int j) { return 0.2 + 0.0006 * i + 0.0003 * j; },
                               [](int i, int j) { return 0.1 + 1e-5 * ((i - 200.0) * (i - 200.0) + j * j); }};
    for (const Formula& height : kFields) {
        const HeightField truth = field_of({160, 160}, height);
        const HeightField in = field_of({160, 160}, in_8_bits(height));
        EXPECT_LT(angle(truth, debanded(in)), 0.2 * angle(truth, in));
    }
}

TEST(Deband, NeverMakesRoughGroundWorse) {
    for (const double roughness : {0.004, 0.01, 0.03, 0.1}) {
        const Formula height = [roughness](int i, int j) {
            return 0.3 + 0.5 * hills(i, j) + roughness * (noise(i, j) - 0.5);
        };
        const HeightField truth = field_of({160, 160}, height);
        const HeightField in = field_of({160, 160}, in_8_bits(height));
        EXPECT_LE(angle(truth, debanded(in)), angle(truth, in)) << roughness;
    }
}

// Plateaus whose heights differ by at least 20 steps: there is nothing to smooth.
TEST(Deband, LeavesPlateausBetweenCliffsAlone) {
    const Formula height = [](int i, int j) {
        const int x = i / 10, y = j / 10;
        return 0.1 + 0.2 * ((x + 2 * y) % 4) + 0.1 * noise(x, y);
    };
    const HeightField truth = field_of({160, 160}, height);
    const HeightField in = field_of({160, 160}, in_8_bits(height));
    EXPECT_LE(angle(truth, debanded(in)), angle(truth, in) + 1e-6);
}

// The sum of squared Laplacians inside the border, in double precision.
double bending_energy(const Plane<float>& heights) {
    double energy = 0.0;
    for (int j = 1; j + 1 < heights.extent().height; ++j) {
        for (int i = 1; i + 1 < heights.extent().width; ++i) {
            const auto at = [&](int x, int y) { return static_cast<double>(heights.at(x, y)); };
            const double bend = at(i - 1, j) + at(i + 1, j) + at(i, j - 1) + at(i, j + 1) - 4.0 * at(i, j);
            energy += bend * bend;
        }
    }
    return energy;
}

// The true surface is in the bounds, too. So the smoothest field bends no more, apart from what steps are left out.
TEST(Deband, BendsLittleMoreThanTheTruth) {
    const HeightField truth = field_of({160, 160}, hills);
    const HeightField in = field_of({160, 160}, in_8_bits(hills));
    const HeightField out = debanded(in);
    EXPECT_LT(bending_energy(out.height), 2.0 * bending_energy(truth.height));
    EXPECT_GT(bending_energy(in.height), 100.0 * bending_energy(out.height));
}

TEST(Deband, ChangesNothingThatIsFlat) {
    const HeightField in = field_of({50, 40}, [](int, int) { return 0.25; });
    DebandReport report;
    EXPECT_TRUE(same_bytes(in.height, debanded(in, &report).height));
    EXPECT_FALSE(report.applied);
    EXPECT_EQ(report.codes, 0);
}

// -- steps ---------------------------------------------------------------------------------------------------

TEST(Deband, FindsTheStepsOf8BitsInEveryDisguise) {
    struct Case {
        const char* what;
        Formula height;
        double step;
    };
    const auto code = [](int i, int j) { return std::round(255.0 * hills(i, j)); };
    const Case kCases[] = {
        {"8 bits", [&](int i, int j) { return code(i, j) / 255.0; }, 1.0 / 255.0},
        {"padded with zeros", [&](int i, int j) { return 256.0 * code(i, j) / 65535.0; }, 256.0 / 65535.0},
        {"padded with themselves", [&](int i, int j) { return 257.0 * code(i, j) / 65535.0; }, 1.0 / 255.0},
        {"stretched", in_16_bits([&](int i, int j) { return (code(i, j) - 50.0) / 155.0; }), 1.0 / 155.0},
        {"in metres", [&](int i, int j) { return 812.5 + 2.5 * code(i, j); }, 2.5},
        {"12 bits", [](int i, int j) { return std::round(4095.0 * hills(i, j)) / 4095.0; }, 1.0 / 4095.0},
    };
    for (const Case& one : kCases) {
        DebandReport report;
        const HeightField in = field_of({120, 110}, one.height);
        const HeightField out = debanded(in, &report);
        EXPECT_TRUE(report.applied) << one.what;
        EXPECT_NEAR(report.step, one.step, 0.001 * one.step) << one.what;
        float lowest = in.height.at(0, 0);
        for (int j = 0; j < 110; ++j)
            lowest = std::min(lowest, *std::min_element(in.height.row(j), in.height.row(j) + 120));
        EXPECT_EQ(texels_off(in, out, static_cast<double>(report.step), static_cast<double>(lowest)), 0) << one.what;
    }
}

TEST(Deband, LeavesHeightsWithoutStepsAlone) {
    const Formula kFields[] = {hills, in_16_bits(hills),
                               [](int i, int j) { return std::pow(in_8_bits(hills)(i, j), 2.2); },
                               [](int i, int) { return i % 3 == 0 ? 0.1 : 0.7; }};
    for (const Formula& height : kFields) {
        const HeightField in = field_of({220, 200}, height);
        DebandReport report;
        EXPECT_TRUE(same_bytes(in.height, debanded(in, &report).height));
        EXPECT_FALSE(report.applied);
        EXPECT_EQ(report.step, 0.0f);
    }
}

TEST(Deband, AutoAsksForTerraces) {
    HeightField terraces = field_of({128, 128}, in_8_bits(hills));
    const DebandReport found = tex::deband(std::move(terraces), Deband::automatic)->report;
    EXPECT_TRUE(found.applied);
    EXPECT_GT(found.terrace_texels, 128 * 128 / 10);
    HeightField rough = field_of({128, 128}, in_8_bits([](int i, int j) { return noise(i, j); }));
    const Plane<float> before = rough.height.clone();
    tex::DebandedField same = tex::deband(std::move(rough), Deband::automatic).value();
    const DebandReport& none = same.report;
    EXPECT_FALSE(none.applied);
    EXPECT_NEAR(none.step, 1.0 / 255.0, 1e-6);
    EXPECT_TRUE(same_bytes(same.height, before));
    EXPECT_EQ(tex::deband(std::move(same), Deband::off)->report.codes, 0);
}

// -- borders and holes ---------------------------------------------------------------------------------------

TEST(Deband, SmoothsAcrossBordersThatRepeat) {
    const Formula height = [](int i, int j) {
        return 0.5 + 0.02 * std::sin(2.0 * kPi * (i + 40) / 128) + 0.02 * std::cos(2.0 * kPi * (j + 17) / 128);
    };
    const HeightField truth = field_of({128, 128}, height, Wrap::repeat);
    const HeightField in = field_of({128, 128}, in_8_bits(height), Wrap::repeat);
    EXPECT_LT(angle(truth, debanded(in)), 0.2 * angle(truth, in));
}

TEST(Deband, KeepsHolesAndBendsThroughThem) {
    const auto hole = [](int i, int j) { return (i - 60) * (i - 60) + (j - 70) * (j - 70) < 400; };
    const HeightField in = field_of(
        {160, 150}, [&](int i, int j) { return hole(i, j) ? static_cast<double>(kNan) : in_8_bits(hills)(i, j); });
    const HeightField out = debanded(in);
    for (int j = 0; j < 150; ++j) {
        for (int i = 0; i < 160; ++i) {
            EXPECT_EQ(std::isnan(out.height.at(i, j)), hole(i, j));
            if (hole(i, j)) continue;
            EXPECT_LE(std::abs(out.height.at(i, j) - in.height.at(i, j)), 0.5f / 255.0f);
        }
    }
}

// -- progress ------------------------------------------------------------------------------------------------

TEST(Deband, ReportsProgressUpwardsAndCanBeCancelled) {
    const HeightField in = field_of({200, 200}, in_8_bits(hills));
    std::vector<double> seen = {0.0};
    debanded(in, nullptr, {1, [&](double fraction) {
                               seen.push_back(fraction);
                               return true;
                           }});
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.back(), 1.0);
    for (const double limit : {0.0, 0.1, 0.5, 0.9}) {
        HeightField field{in.height.clone(), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp};
        const auto result =
            tex::deband(std::move(field), Deband::on, {1, [&](double fraction) { return fraction < limit; }});
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, tex::ErrorCode::cancelled);
    }
}

}  // namespace
