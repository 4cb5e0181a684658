// SPDX-License-Identifier: Apache-2.0
// What check() says about pictures that are no normal maps, and about maps of kinds that look like damage.

#include <tex/check.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <tex/file.h>
#include <tex/format.h>

#include "reference/damage.h"

namespace tex {
namespace {

using reference::Codes;
using Ids = std::set<std::string>;

const std::string kWild = TEX_SOURCE_DIR "/../shared/data/wild4/";

Ids ids_of(const CheckReport& report, Severity least) {
    Ids ids;
    for (const Finding& finding : report.findings) {
        if (finding.severity >= least) ids.emplace(finding.rule->id);
    }
    return ids;
}

Ids ids(const Codes& codes, Severity least = Severity::warning) {
    const auto report = check("picture", reference::texture_of(codes));
    EXPECT_TRUE(report);
    return report ? ids_of(*report, least) : Ids();
}

using Color = std::function<std::array<int, 4>(int, int)>;

Codes picture(int side, int channels, const Color& color) {
    Codes codes{{side, side}, channels, {}};
    codes.values.resize(static_cast<std::size_t>(side * side * channels));
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const auto c = color(i, j);
            for (int k = 0; k < channels; ++k)
                codes.at(i, j, k) = static_cast<unsigned char>(std::clamp(c[static_cast<std::size_t>(k)], 0, 255));
        }
    }
    return codes;
}

// Brightness of a picture: smooth spots and fine grain, 0 to 255.
int shade(int i, int j) {
    const double spots = std::sin(0.21 * i + std::cos(0.17 * j)) * std::cos(0.13 * j - 0.05 * i);
    return static_cast<int>(128.0 + 80.0 * spots) + (i * 7919 + j * 104729) % 23 - 11;
}

// A unit vector of waves, as x, y and z in codes.
std::array<int, 4> wave(int i, int j, double strength = 1.0) {
    const double p = strength * (0.5 * std::cos(0.2 * i) + 0.2 * std::sin(0.13 * j + 0.07 * i));
    const double q = strength * (0.4 * std::sin(0.17 * j) + 0.37 * std::sin(0.13 * j + 0.07 * i));
    const double length = std::sqrt(p * p + q * q + 1.0);
    const auto code = [](double c) { return static_cast<int>(std::lround(127.5 + 127.5 * c)); };
    return {code(-p / length), code(-q / length), code(1.0 / length), 255};
}

TEST(Verdicts, PicturesOfAnyHueAreNoNormalMaps) {
    const std::array<std::array<double, 3>, 8> hues{{{0.8, 0.55, 0.35},
                                                     {0.95, 0.88, 0.75},
                                                     {0.3, 0.25, 0.2},
                                                     {0.7, 0.6, 0.95},
                                                     {0.5, 0.7, 0.9},
                                                     {0.4, 0.65, 0.3},
                                                     {0.9, 0.5, 0.6},
                                                     {0.6, 0.62, 0.6}}};
    for (const auto& hue : hues) {
        for (const int base : {0, 90, 150}) {  // dark, middle and light, and with less contrast
            const Codes codes = picture(64, 3, [&](int i, int j) {
                const double s = base + shade(i, j) * (255 - base) / 255.0;
                return std::array<int, 4>{static_cast<int>(s * hue[0]), static_cast<int>(s * hue[1]),
                                          static_cast<int>(s * hue[2]), 255};
            });
            const Ids found = ids(codes);
            EXPECT_TRUE(found == Ids{"N214"} || found == Ids{"N210"}) << hue[0] << " " << base;
        }
    }
}

TEST(Verdicts, AShareOfNothingIsPrintedAsZero) {
    const auto brown = [](int i, int j) {
        const int s = shade(i, j) / 3;
        return std::array<int, 4>{70 + s, 45 + s / 2, 30 + s / 3, 255};
    };
    const auto report = check("picture", reference::texture_of(picture(128, 3, brown)));
    ASSERT_TRUE(report && report->findings.size() == 1u);
    EXPECT_EQ(report->findings[0].message.find("0.000000"), std::string::npos) << report->findings[0].message;
}

TEST(Verdicts, VectorsThatAreAllTooShortHoldNoZFromZero) {
    const auto shortened = [](int i, int j) {
        std::array<int, 4> c = wave(i, j);
        for (std::size_t k = 0; k < 3; ++k) c[k] = 128 + (c[k] - 128) * 85 / 100;
        return c;
    };
    const Ids found = ids(picture(128, 3, shortened), Severity::note);
    EXPECT_TRUE(found.contains("N201")) << testing::PrintToString(found);
    EXPECT_FALSE(found.contains("N221"));
}

// An opacity that was flattened on black: the curve of sRGB would be undone by 8 degrees too much.
TEST(Verdicts, ADarkenedMapDidNotGoThroughTheCurve) {
    for (const int percent : {46, 50, 60, 80, 90}) {
        const auto darkened = [percent](int i, int j) {
            std::array<int, 4> c = wave(i, j);
            for (std::size_t k = 0; k < 3; ++k) c[k] = c[k] * percent / 100;
            return c;
        };
        const Ids found = ids(picture(128, 3, darkened), Severity::error);
        EXPECT_TRUE(found == Ids{"N313"} || found == Ids{"N214"}) << percent << testing::PrintToString(found);
    }
}

// A number that suits few colours is no evidence: the smallest level of a picture of the sky.
TEST(Verdicts, AFewColoursAreNoDarkenedMap) {
    const auto sky = [](int i, int j) {
        constexpr int kLight[] = {67, 55, 76, 58};
        const int c = kLight[2 * j + i];
        return std::array<int, 4>{c, c - 5, c - 24, 255};
    };
    EXPECT_FALSE(ids(picture(2, 3, sky), Severity::error).contains("N313"));
}

// What contrast and sharpening do: averages never make vectors longer.
TEST(Verdicts, VectorsThatAreTooLongNameTheirCause) {
    const auto says = [](int percent) {
        const auto scaled = [percent](int i, int j) {
            std::array<int, 4> c = wave(i, j);
            for (std::size_t k = 0; k < 3; ++k) c[k] = std::clamp(128 + (c[k] - 128) * percent / 100, 0, 255);
            return c;
        };
        const auto report = check("map", reference::texture_of(picture(128, 3, scaled)));
        std::string text;
        for (const Finding& finding : report->findings) text += finding.message;
        return text;
    };
    EXPECT_NE(says(125).find("contrast, levels and sharpening"), std::string::npos) << says(125);
    EXPECT_EQ(says(85).find("contrast"), std::string::npos) << says(85);
    EXPECT_EQ(says(100), "");
}

TEST(Verdicts, GreyWithAlphaIsNoLayoutOfNormals) {
    EXPECT_EQ(ids(picture(64, 4,
                          [](int i, int j) {
                              const int s = shade(i, j);
                              return std::array<int, 4>{s, s, s, 255 - shade(j, i + 40)};
                          })),
              Ids{"N210"});
}

// JPEG leaves so much: heights to be baked, not colours.
TEST(Verdicts, GreyWithALittleColourIsGrey) {
    const Codes codes = picture(64, 3, [](int i, int j) {
        const int s = shade(i, j);
        return std::array<int, 4>{std::min(s + i % 3, 255), s, std::max(s - j % 4, 0), 255};
    });
    EXPECT_EQ(ids(codes), Ids{"N210"});
}

TEST(Verdicts, OcclusionInBlueLeavesXAndYToBeJudged) {
    const Codes codes = picture(64, 4, [](int i, int j) {
        auto c = wave(i, j, 0.4);
        c[2] = 255 - std::abs(i % 16 - 8) * 28;
        c[3] = 255 - std::abs(j % 16 - 8) * 3;
        return c;
    });
    EXPECT_EQ(ids(codes), Ids());
    EXPECT_TRUE(ids(codes, Severity::note).contains("N219"));
    EXPECT_EQ(ids(picture(16, 4,
                          [](int i, int j) {
                              auto c = wave(8 * i, 8 * j, 0.4);
                              c[2] = 255 - std::abs(i - 8) * 28;
                              c[3] = 255 - std::abs(i - 8) * 8;
                              return c;
                          })),
              Ids());
}

TEST(Verdicts, TexelsUnderAlpha0CountForNoRule) {
    const auto leaf = [](int i, int j) { return (i - 32) * (i - 32) + (j - 32) * (j - 32) < 700; };
    for (const int under : {0, 60, 200}) {
        const Codes codes = picture(64, 4, [&](int i, int j) {
            if (!leaf(i, j)) return std::array<int, 4>{under, under / 2, 20, 0};
            return wave(i, j);
        });
        EXPECT_EQ(ids(codes), Ids()) << under;
    }
}

TEST(Verdicts, ZBelowZeroIsNamedAsWhatItIs) {
    const Codes inverted = picture(64, 3, [](int i, int j) {
        auto c = wave(i, j);
        c[2] = 255 - c[2];
        return c;
    });
    EXPECT_EQ(ids(inverted), Ids{"N220"});
    const Codes from_zero = picture(64, 3, [](int i, int j) {
        auto c = wave(i, j, 3.0);
        c[2] = 2 * c[2] - 255;
        return c;
    });
    EXPECT_EQ(ids(from_zero), Ids{"N221"});
    const Codes background = picture(64, 3, [](int i, int j) {
        if (i < 20) return std::array<int, 4>{128, 128, 0, 255};
        return wave(i, j);
    });
    EXPECT_EQ(ids(background), Ids{"N215"});
    const Codes undercut = picture(64, 3, [](int i, int j) {  // bevels that lean beyond the vertical
        const int k = i % 16;
        if (j % 32 < 2 || k >= 4) return std::array<int, 4>{128, 128, 255, 255};
        return k < 2 ? std::array<int, 4>{7, 128, 80, 255} : std::array<int, 4>{248, 128, 80, 255};
    });
    EXPECT_EQ(ids(undercut), Ids{"N202"});
}

// Steep sides that lie flat on the surface, as JPEG and rounding leave them, are no vectors into the surface.
TEST(Verdicts, ZThatIsBelowZeroByRoundingIsNotSaid) {
    const auto sides = [](int z) {
        return picture(64, 3, [z](int i, int j) {
            const int k = i % 16;
            if (j % 32 < 2 || k >= 4) return std::array<int, 4>{128, 128, 255, 255};
            return std::array<int, 4>{k < 2 ? 1 : 254, 128, z, 255};
        });
    };
    EXPECT_EQ(ids(sides(124)), Ids{});
    EXPECT_EQ(ids(sides(110)), Ids{"N202"});
}

// In a map that is nearly flat, z is 1 to a code or two. A filler there bends nothing.
TEST(Verdicts, AFillerInBlueIsSaidWhereItBendsNormals) {
    const auto filled = [](double strength) {
        return picture(64, 3, [strength](int i, int j) {
            auto c = wave(i, j, strength);
            c[2] = 255;
            return c;
        });
    };
    EXPECT_EQ(ids(filled(0.16)), Ids{});
    EXPECT_EQ(ids(filled(1.0)), Ids{"N209"});
}

// A converter that normalised black around a chart, and rebuilt z.
TEST(Verdicts, BlackThatWasNormalisedIsABackground) {
    for (const int z : {54, 201}) {
        const Codes codes = picture(64, 3, [z](int i, int j) {
            const bool is_chart = i > 12 && j > 9 && i < 52;
            return is_chart ? wave(i, j) : std::array<int, 4>{54, 54, z, 255};
        });
        EXPECT_EQ(ids(codes), Ids{"N215"}) << z;
    }
}

// Colours that are nearly grey, with heights in alpha: the layout of x in alpha has R, G and B alike, or R and B
// constant.
TEST(Verdicts, FaintColorsWithHeightsInAlphaAreNoNormalMap) {
    const Codes codes = picture(128, 4, [](int i, int j) {
        const int c = shade(i, j), hue = (i / 8 + j / 8) % 4;
        return std::array<int, 4>{c + 2 * hue, c, c - hue, 128 + (shade(j + 40, i) - 128) / 2};
    });
    EXPECT_EQ(ids(codes), Ids{"N214"});
}

// Colours of two hues that are centred and do not follow each other, with a blue that is at times small. No texel is
// level, as some are in every map.
TEST(Verdicts, ColorsWithoutALevelTexelAreNoNormalMap) {
    const Codes codes = picture(256, 3, [](int i, int j) {
        const int c = (shade(i, j) - 128) / 5;
        if (j < 32) return std::array<int, 4>{200 + c, 128 + c, 10 + c / 4, 255};
        return std::array<int, 4>{104 + c / 3, 148 + c, 168 + c, 255};
    });
    EXPECT_EQ(ids(codes), Ids{"N214"});
}

// An environment map: floats without a value below 0.
TEST(Verdicts, ColorsOfHighRangeAreNoNormalMap) {
    Texture texture;
    texture.format = Format::rgb32_float;
    std::vector<float> values;
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const auto bright = static_cast<float>(shade(i, j)) / 96.0f;
            values.insert(values.end(), {1.2f * bright, bright, 0.7f * bright});
        }
    }
    Level level{{64, 64}, {}};
    level.bytes.resize(values.size() * sizeof(float));
    std::memcpy(level.bytes.data(), values.data(), level.bytes.size());
    texture.levels.push_back(std::move(level));
    const auto report = check("picture", texture);
    ASSERT_TRUE(report);
    EXPECT_EQ(ids_of(*report, Severity::warning), Ids{"N214"});
}

// Roughness between occlusion and metalness of 1 is no y beside a lost x; a flat map with stretched levels is no ORM.
TEST(Verdicts, RoughnessBetweenOnesIsNoNormalMap) {
    const auto ids_with = [](int red, int green, int parts) {
        const auto color = [=](int i, int j) { return std::array{red, green + (shade(i, j) - 128) / parts, 255, 255}; };
        return ids(picture(128, 3, color));
    };
    EXPECT_EQ(ids_with(255, 152, 3), Ids{"N216"});
    EXPECT_EQ(ids_with(16, 16, 64), Ids{"N214"});
}

// One colour beside white, as of a logo. The edges between them look like slopes.
TEST(Verdicts, ALogoInTwoColorsIsNoNormalMap) {
    const Codes codes = picture(256, 3, [](int i, int j) {
        const double x = i - 128.0, y = j - 128.0, radius = std::sqrt(x * x + 0.5 * y * y + 0.3 * x * y);
        const double white = std::clamp(60.0 - radius, 0.0, 1.0);
        const auto mix = [white](double c) { return static_cast<int>(c + white * (255.0 - c) + 0.5); };
        return std::array<int, 4>{mix(101), mix(79), mix(240), 255};
    });
    EXPECT_EQ(ids(codes), Ids{"N214"});
}

TEST(Verdicts, XThatIsLostIsAnError) {
    for (const int red : {0, 255}) {
        const Codes codes = picture(64, 3, [&](int i, int j) {
            return std::array<int, 4>{red, wave(i, j)[1], red, 255};
        });
        EXPECT_EQ(ids(codes), Ids{"N222"}) << red;
    }
}

TEST(Verdicts, EnlargedMapsHaveNoBlocksOfCodecs) {
    for (const int factor : {2, 8}) {
        const Codes repeated = picture(128, 3, [&](int i, int j) { return wave(5 * (i / factor), 5 * (j / factor)); });
        EXPECT_EQ(ids(repeated), Ids()) << factor;
        EXPECT_TRUE(ids(repeated, Severity::note).contains("N312")) << factor;
    }
}

// -- the files of ../shared/data/wild4 --------------------------------------------------------------------------------

TEST(Verdicts, OfWildMapsAndPictures) {
    if (!std::filesystem::exists(kWild)) GTEST_SKIP() << "no ../shared/data/wild4";
    constexpr std::uintmax_t kMostBytes = 150000;  // larger files take time; tests/wild4.py has all of them
    std::ifstream in(kWild + "labels.tsv");
    int pictures = 0, maps = 0;
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        std::string file, kind, before, verdict;
        std::getline(fields, file, '\t');
        std::getline(fields, kind, '\t');
        std::getline(fields, before, '\t');
        std::getline(fields, verdict, '\t');
        if (kind == "kind" || kind == "data" || std::filesystem::file_size(kWild + file) > kMostBytes) continue;
        const auto report = check_file(kWild + file, {}, {}, {});
        ASSERT_TRUE(report) << file;
        const Ids errors = ids_of(*report, Severity::error);
        if (verdict.starts_with("must be an error")) {
            EXPECT_FALSE(errors.empty() && !report->error) << file;
            ++pictures;
        } else if (verdict.find("true") == std::string::npos) {
            EXPECT_TRUE(errors.empty()) << file << ": " << *errors.begin();
            ++maps;
        }
    }
    EXPECT_GT(pictures, 80);
    EXPECT_GT(maps, 200);
}

TEST(Verdicts, OfFilesMadeByFormula) {
    if (!std::filesystem::exists(kWild)) GTEST_SKIP() << "no ../shared/data/wild4";
    const std::pair<const char*, const char*> files[] = {
        {"colour_brown.png", "N214"},        {"grey_alpha.png", "N210"},
        {"leaf128_colour_under.png", ""},    {"leaf_30.png", ""},
        {"n214_labpbr_ao_blue_16.png", ""},  {"n303_labpbr_16.png", ""},
        {"n304_nearest_x2_96.png", ""},      {"trgb_void.png", "N214"},
        {"unity_pink_no_alpha.png", "N222"}, {"stalker1.png", ""},
    };
    for (const auto& [file, id] : files) {
        const auto report = check_file(kWild + file, {}, {}, {});
        ASSERT_TRUE(report) << file;
        EXPECT_EQ(ids_of(*report, Severity::error), *id == '\0' ? Ids() : Ids{id}) << file;
    }
}

}  // namespace
}  // namespace tex
