// SPDX-License-Identifier: Apache-2.0
// Intact maps of kinds that mislead statistics: structures along the axes, structures that repeat, levels of which
// little is left. The rules say nothing about them.

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tex/bake.h>
#include <tex/check.h>
#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pack.h>

#include "reference/damage.h"

namespace tex {
namespace {

constexpr Extent kAlarmExtent{256, 256};
constexpr double kFullTurn = 2.0 * 3.14159265358979;

template <class Height>
NormalMap baked(Height&& height, float bumpiness) {
    HeightField field{Plane<float>(kAlarmExtent), bumpiness, bumpiness, Wrap::repeat, Wrap::repeat};
    for (int j = 0; j < kAlarmExtent.height; ++j) {
        for (int i = 0; i < kAlarmExtent.width; ++i)
            field.height.at(i, j) =
                static_cast<float>(height(i * kFullTurn / kAlarmExtent.width, j * kFullTurn / kAlarmExtent.height));
    }
    return std::move(*bake(field));
}

std::set<std::string> ids(const Texture& texture, const CheckOptions& options = {}) {
    const auto report = check("map", texture, options);
    EXPECT_TRUE(report);
    std::set<std::string> found;
    for (const Finding& finding : report->findings) found.emplace(finding.rule->id);
    return found;
}

using Ids = std::set<std::string>;

Texture packed(NormalMap map, Encoding encoding) {
    auto chain = build_mip_chain(std::move(map));
    EXPECT_TRUE(chain);
    auto texture = pack(*chain, {encoding, YAxis::up, Effort::fast});
    EXPECT_TRUE(texture);
    texture->y_known = true;
    return std::move(*texture);
}

// The slopes of h = f(x) + g(y) do not change across: what rounding and block codecs leave there has a sign by chance.
TEST(FalseAlarms, WavesAlongTheAxesShowNoDirection) {
    CheckOptions options;
    for (const char* id : {"N305", "N306", "N503"}) options.disable.emplace_back(id);
    for (const int waves : {1, 8, 16}) {
        for (const float steep : {0.4f, 2.0f, 20.0f}) {
            for (const double sharp : {0.0, 8.0}) {
                const auto wave = [&](double x) {
                    return sharp > 0.0 ? std::tanh(sharp * std::sin(waves * x)) : std::sin(waves * x);
                };
                for (const Encoding encoding : {Encoding::rgb8, Encoding::bc5, Encoding::dxt5nm}) {
                    NormalMap map = baked([&](double x, double y) { return wave(x) + wave(y); }, steep);
                    EXPECT_EQ(ids(packed(std::move(map), encoding), options), Ids{})
                        << waves << " " << steep << " " << sharp << " " << static_cast<int>(encoding);
                }
            }
        }
    }
}

// A texel of yarns that pass over each other: the normal of the cylinder on top.
NormalMap woven(double period) {
    NormalMap map(kAlarmExtent);
    for (int j = 0; j < kAlarmExtent.height; ++j) {
        for (int i = 0; i < kAlarmExtent.width; ++i) {
            const double x = i / period - std::floor(i / period) - 0.5, y = j / period - std::floor(j / period) - 0.5;
            const bool upright = (static_cast<int>(i / period) + static_cast<int>(j / period)) % 2 == 0;
            const double p = upright ? 1.8 * x : 0.3 * x, q = upright ? 0.3 * y : 1.8 * y;
            const double length = std::sqrt(p * p + q * q + 1.0);
            map.x.at(i, j) = static_cast<float>(p / length);
            map.y.at(i, j) = static_cast<float>(-q / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
    }
    return map;
}

TEST(FalseAlarms, WovenYarnsHaveNoBandsAndNoTracesOfJpeg) {
    for (const double period : {10.0, 12.0, 16.0, 24.0, 32.0, 64.0}) {
        const Ids found = ids(reference::texture_of(reference::codes_of(woven(period))));
        for (const char* id : {"N304", "N305", "N306"}) EXPECT_EQ(found.count(id), 0u) << period << " " << id;
    }
}

TEST(FalseAlarms, AWaveAlongOneAxisIsNoPaletteAndNotTurned) {
    for (const int waves : {1, 2, 4, 5, 8}) {
        for (const float steep : {4.0f, 10.0f, 30.0f}) {
            const auto codes = reference::codes_of(baked([&](double x, double) { return std::sin(waves * x); }, steep));
            EXPECT_EQ(ids(reference::texture_of(codes)), Ids{}) << waves << " " << steep;
            EXPECT_EQ(ids(reference::texture_of(reference::jpeg(codes, 85))).count("N309"), 0u)
                << waves << " " << steep;
        }
    }
}

NormalMap rough() {
    return baked(
        [](double x, double y) {
            return std::sin(3 * x + std::cos(2 * y)) * std::cos(4 * y) + 0.5 * std::sin(7 * x + 5 * y) +
                   0.2 * std::sin(13 * x - 9 * y) + 0.05 * std::sin(31 * x + 37 * y);
        },
        14.0f);
}

bool is_chart(int i, int j) {
    const int x = i - 90, y = j - 100;
    return x * x + y * y < 70 * 70 || std::abs(i + j / 3 - 260) < 30;
}

// Grey, as block codecs leave it: vectors of nearly no length, whose direction means nothing.
TEST(FalseAlarms, LevelsOverAGreyBackgroundAreRelated) {
    std::vector<reference::Codes> levels = {reference::codes_of(rough())};
    unsigned state = 1;
    for (int j = 0; j < kAlarmExtent.height; ++j) {
        for (int i = 0; i < kAlarmExtent.width; ++i) {
            if (is_chart(i, j)) continue;
            for (int c = 0; c < 3; ++c) {
                state = state * 1664525u + 1013904223u;
                levels[0].at(i, j, c) = static_cast<unsigned char>(126 + (state >> 24) % 5);
            }
        }
    }
    while (levels.back().extent.width > 1) {
        reference::Codes& larger = levels.back();
        reference::Codes level = larger;
        level.extent = {larger.extent.width / 2, larger.extent.height / 2};
        level.values.resize(static_cast<std::size_t>(level.extent.texels() * level.channels));
        for (int j = 0; j < level.extent.height; ++j) {
            for (int i = 0; i < level.extent.width; ++i) {
                for (int c = 0; c < 3; ++c) {
                    const int sum = larger.at(2 * i, 2 * j, c) + larger.at(2 * i + 1, 2 * j, c) +
                                    larger.at(2 * i, 2 * j + 1, c) + larger.at(2 * i + 1, 2 * j + 1, c);
                    level.at(i, j, c) = static_cast<unsigned char>((sum + 2) / 4);
                }
            }
        }
        levels.push_back(level);
    }
    const Ids found = ids(reference::texture_of(levels));
    EXPECT_EQ(found.count("N215"), 1u);
    for (const char* id : {"N502", "N503"}) EXPECT_EQ(found.count(id), 0u) << id;
    // Levels of another map still are an error.
    std::vector<reference::Codes> others = levels;
    for (std::size_t k = 1; k < others.size(); ++k) others[k] = reference::exchange(levels[k], 0, 1);
    EXPECT_EQ(ids(reference::texture_of(others)).count("N502"), 1u);
}

TEST(FalseAlarms, JpegAroundGreyLeavesNoVectorsWithoutADirection) {
    for (const int quality : {60, 75, 90}) {
        reference::Codes codes = reference::codes_of(rough());
        for (int j = 0; j < kAlarmExtent.height; ++j) {
            for (int i = 0; i < kAlarmExtent.width; ++i) {
                for (int c = 0; c < 3 && !is_chart(i, j); ++c) codes.at(i, j, c) = 128;
            }
        }
        const Ids found = ids(reference::texture_of(reference::jpeg(codes, quality)));
        EXPECT_EQ(found.count("N215"), 1u) << quality << ": " << testing::PrintToString(found);
        EXPECT_EQ(found.count("N205"), 0u) << quality;
    }
}

// 64 blocks of a bake agree by chance on the steps of a JPEG of quality 12.
TEST(FalseAlarms, FewBlocksAreNoTraceOfJpeg) {
    const std::string file = TEX_SOURCE_DIR "/../shared/data/wild/normal_rgb_height_in_alpha.png";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no ../shared/data/wild";
    const auto texture = read_texture(file);
    ASSERT_TRUE(texture);
    EXPECT_EQ(ids(*texture).count("N304"), 0u);
}

// Corrugated sheet, as a JPEG: what the codec leaves across the edges has an axis, and blue is that of other texels.
TEST(FalseAlarms, SawToothsAsJpegAreNeitherTurnedNorOtherData) {
    for (const int period : {8, 16, 32, 64}) {
        for (const float steep : {2.0f, 4.0f, 8.0f}) {
            for (const bool across : {false, true}) {
                const auto saw = [&](double x, double y) {
                    const double at = (across ? y : x) / kFullTurn * kAlarmExtent.width / period;
                    return at + 1e-9 - std::floor(at + 1e-9);
                };
                for (const int quality : {60, 75, 85, 92}) {
                    const Ids found =
                        ids(reference::texture_of(reference::jpeg(reference::codes_of(baked(saw, steep)), quality)));
                    EXPECT_EQ(found.count("N309") + found.count("N219"), 0u)
                        << period << " " << steep << " " << across << " quality " << quality;
                }
            }
        }
    }
}

}  // namespace
}  // namespace tex
