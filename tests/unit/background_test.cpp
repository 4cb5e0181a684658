// SPDX-License-Identifier: Apache-2.0
// Maps with areas that no chart covers: the background is one finding, and the other rules judge the charts alone.

#include "checks/background.h"

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <tex/bake.h>
#include <tex/check.h>
#include <tex/mip.h>
#include <tex/pack.h>

#include "reference/damage.h"

namespace tex {
namespace {

constexpr Extent kExtent{192, 192};
using Color = std::array<int, 3>;

NormalMap waves() {
    HeightField field{Plane<float>(kExtent), 14.0f, 14.0f, Wrap::repeat, Wrap::repeat};
    const double tau = 2.0 * 3.14159265358979;
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) {
            const double u = tau * i / kExtent.width, v = tau * j / kExtent.height;
            field.height.at(i, j) = static_cast<float>(std::sin(3 * u + std::cos(2 * v)) * std::cos(4 * v) +
                                                       0.5 * std::sin(7 * u + 5 * v) + 0.2 * std::sin(13 * u - 9 * v));
        }
    }
    return std::move(*bake(field));
}

// Two charts: a disc, and a slanted strip.
bool is_chart(int i, int j) {
    const int x = i - 70, y = j - 80;
    return x * x + y * y < 60 * 60 || std::abs(i + j / 3 - 210) < 24;
}

reference::Codes with_background(const NormalMap& map, const Color& color) {
    reference::Codes codes = reference::codes_of(map);
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) {
            if (is_chart(i, j)) continue;
            for (int c = 0; c < 3; ++c)
                codes.at(i, j, c) = static_cast<unsigned char>(color[static_cast<std::size_t>(c)]);
        }
    }
    return codes;
}

double background_share() {
    double outside = 0.0;
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) outside += is_chart(i, j) ? 0.0 : 1.0;
    }
    return outside / static_cast<double>(kExtent.texels());
}

CheckReport checked(const Texture& texture, const CheckOptions& options = {}) {
    auto report = check("map", texture, options);
    EXPECT_TRUE(report);
    return std::move(*report);
}

std::set<std::string> ids(const CheckReport& report) {
    std::set<std::string> found;
    for (const Finding& finding : report.findings) found.emplace(finding.rule->id);
    return found;
}

using Ids = std::set<std::string>;

TEST(Background, IsTheOnlyFindingWhateverItsColor) {
    const double share = background_share();
    for (const auto& [color, name] : {std::pair{Color{0, 0, 0}, "black"}, std::pair{Color{128, 128, 128}, "grey"},
                                      std::pair{Color{255, 255, 255}, "white"}, std::pair{Color{30, 200, 10}, "("}}) {
        const CheckReport report = checked(reference::texture_of(with_background(waves(), color)));
        ASSERT_EQ(ids(report), Ids{"N215"}) << name;
        EXPECT_NEAR(report.findings[0].figure, share, 0.001);
        EXPECT_NE(report.findings[0].message.find(std::string("background: ") + name), std::string::npos)
            << report.findings[0].message;
        EXPECT_EQ(report.y.y, YAxis::up) << "judged by the charts";
    }
}

// Programs that normalise what they read turn black into (-0.58, -0.58), which encodings without z store as a normal.
TEST(Background, IsFoundAfterItWasNormalisedAndCompressed) {
    const Texture picture = reference::texture_of(with_background(waves(), {0, 0, 0}));
    for (const Encoding encoding : {Encoding::bc5, Encoding::dxt5nm, Encoding::rgb8}) {
        auto chain = unpack(picture);
        ASSERT_TRUE(chain);
        const auto mips = build_mip_chain(std::move(chain->levels[0]));
        ASSERT_TRUE(mips);
        const auto texture = pack(*mips, {encoding, YAxis::up, Effort::fast});
        ASSERT_TRUE(texture);
        EXPECT_EQ(ids(checked(*texture)), Ids{"N215"}) << name_of(kEncodingNames, encoding);
    }
}

TEST(Background, FiltersMixItIntoItsNeighbours) {
    const reference::Codes sharp = with_background(waves(), {0, 0, 0});
    reference::Codes soft = sharp;
    for (int j = 1; j < kExtent.height; ++j) {
        for (int i = 1; i < kExtent.width; ++i) {
            if (is_chart(i, j) == is_chart(i - 1, j - 1)) continue;
            for (int c = 0; c < 3; ++c) {
                soft.at(i, j, c) = static_cast<unsigned char>((sharp.at(i, j, c) + sharp.at(i - 1, j, c) +
                                                               sharp.at(i, j - 1, c) + sharp.at(i - 1, j - 1, c) + 2) /
                                                              4);
            }
        }
    }
    EXPECT_EQ(ids(checked(reference::texture_of(soft))), Ids{"N215"});
}

// Blue 0 beside middle red and green points into the surface, and so does what a filter makes of it at edges.
TEST(Background, OfBlueZeroMayHaveSoftEdges) {
    const reference::Codes sharp = with_background(waves(), {128, 128, 0});
    reference::Codes soft = sharp;
    for (int j = 1; j < kExtent.height; ++j) {
        for (int i = 1; i < kExtent.width; ++i) {
            for (int c = 0; c < 3 && is_chart(i, j) != is_chart(i - 1, j - 1); ++c)
                soft.at(i, j, c) = static_cast<unsigned char>((3 * sharp.at(i, j, c) + sharp.at(i - 1, j - 1, c)) / 4);
        }
    }
    EXPECT_EQ(ids(checked(reference::texture_of(soft))), Ids{"N215"});
}

// A contrast makes all vectors short, and those of a slope without bumps alike.
TEST(Background, IsNoSlopeOfAMapWhoseVectorsAreShort) {
    double by = 0.5;  // as a layer of grey over it
    const auto faded = [&by](int c) { return reference::rounded_code(127.5 + by * (c - 127.5)); };
    for (const Color& flat : {Color{120, 128, 254}, Color{128, 102, 252}}) {
        const reference::Codes codes = with_background(waves(), flat);
        const std::set<std::string> found = ids(checked(reference::texture_of(reference::with_curve(codes, faded))));
        EXPECT_EQ(found.count("N215"), 0u) << by;
        by = 0.48;
    }
    const reference::Codes grey = with_background(waves(), {128, 128, 128});
    const std::set<std::string> kept = ids(checked(reference::texture_of(reference::with_curve(grey, faded))));
    EXPECT_EQ(kept.count("N215"), 1u);
}

TEST(Background, ScatteredTexelsAreDamage) {
    reference::Codes codes = reference::codes_of(waves());
    for (int k = 0; k < kExtent.texels(); k += 37) {
        for (int c = 0; c < 3; ++c) codes.at(k % kExtent.width, k / kExtent.width, c) = 128;
    }
    EXPECT_EQ(ids(checked(reference::texture_of(codes))), Ids{"N205"});
}

// What is wrong with the charts is still found.
TEST(Background, HidesNoFaultOfTheCharts) {
    CheckOptions up;
    up.require.y = YAxis::up;
    NormalMap map = waves();
    for (int k = 0; k < kExtent.texels(); ++k) {
        float& y = map.y.at(k % kExtent.width, k / kExtent.width);
        y = -y;
    }
    EXPECT_EQ(ids(checked(reference::texture_of(with_background(map, {0, 0, 0})), up)), (Ids{"N215", "N401"}));
    map = waves();
    for (int k = 0; k < kExtent.texels(); ++k) std::swap(map.x.at(k % 192, k / 192), map.y.at(k % 192, k / 192));
    EXPECT_EQ(ids(checked(reference::texture_of(with_background(map, {0, 0, 0})))), Ids{"N308"});
    map = waves();  // in object space, half of the surface faces away
    for (int j = 0; j < kExtent.height; j += 2) {
        for (int i = 0; i < kExtent.width; ++i) map.z.at(i, j) = -map.z.at(i, j);
    }
    EXPECT_EQ(ids(checked(reference::texture_of(with_background(map, {0, 0, 0})))), Ids{"N213"});
}

TEST(Background, LeavesTheTextOfWhatIsUndecidedTrue) {
    CheckOptions up;
    up.require.y = YAxis::up;
    NormalMap flat;
    flat.x = Plane<float>(kExtent, 0.0f);
    flat.y = Plane<float>(kExtent, 0.0f);
    flat.z = Plane<float>(kExtent, 1.0f);
    const CheckReport report = checked(reference::texture_of(with_background(flat, {0, 0, 0})), up);
    ASSERT_EQ(ids(report), (Ids{"N215", "N403"}));
    EXPECT_NE(report.findings[1].message.find("the correlation is nearer to 0 than 0.2 (correlation 0.00"),
              std::string::npos)
        << report.findings[1].message;
}

// The harm that the fix of N215 would do.
std::string harm_of(const Texture& texture) {
    const CheckReport report = checked(texture);
    for (const Finding& finding : report.findings) {
        if (finding.rule->id == "N215") return finding.fix_harms;
    }
    ADD_FAILURE() << "no background was found";
    return {};
}

TEST(BackgroundFill, IsHarmlessWhereOneColorLiesAroundCharts) {
    for (const Color& color : {Color{0, 0, 0}, Color{128, 128, 128}, Color{255, 255, 255}, Color{30, 200, 10}}) {
        const reference::Codes codes = with_background(waves(), color);
        EXPECT_EQ(harm_of(reference::texture_of(codes)), "") << color[0];
    }
    const reference::Codes grey = with_background(waves(), {128, 128, 128});
    EXPECT_EQ(harm_of(reference::texture_of(reference::jpeg(grey, 75))), "");
}

// An edge of two texels that leans outwards, longer than unit vectors: the fix would give it the normals inside.
TEST(BackgroundFill, WouldDeleteBevels) {
    const double radius = 60.0;
    reference::Codes codes = with_background(waves(), {0, 0, 0});
    int bevels = 0;
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) {
            const double x = i - 70.0, y = j - 80.0, r = std::sqrt(x * x + y * y);
            if (r >= radius || r < radius - 2.0) continue;
            ++bevels;
            const double lean = 1.2 * std::sqrt(0.75);
            const double components[] = {lean * x / r, -lean * y / r, 0.6};
            for (int c = 0; c < 3; ++c)
                codes.at(i, j, c) = static_cast<unsigned char>(std::lround(127.5 * (1.0 + components[c])));
        }
    }
    const std::string harm = harm_of(reference::texture_of(codes));
    ASSERT_EQ(harm.rfind("filling would turn ", 0), 0u) << harm;
    const int turned = std::stoi(harm.substr(19));
    EXPECT_GT(turned, bevels / 3);
    EXPECT_LE(turned, bevels);
}

// A colour of bevels that are too long is no background: there is one that leans as far the other way.
TEST(BackgroundFill, KnowsBevelsByTheirTwins) {
    reference::Codes codes = reference::codes_of(waves());
    for (int j = 40; j < 140; ++j) {
        for (int i = 0; i < 5; ++i) {
            const Color left{0, 20, 150}, right{255, 235, 150};
            for (std::size_t c = 0; c < 3; ++c) {
                codes.at(40 + i, j, static_cast<int>(c)) = static_cast<unsigned char>(left[c]);
                codes.at(140 + i, j, static_cast<int>(c)) = static_cast<unsigned char>(right[c]);
            }
        }
    }
    const std::string harm = harm_of(reference::texture_of(codes));
    EXPECT_NE(harm.find("bevels"), std::string::npos) << harm;
}

}  // namespace
}  // namespace tex
