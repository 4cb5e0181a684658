// SPDX-License-Identifier: Apache-2.0

#include <tex/check.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <tex/bake.h>
#include <tex/mip.h>
#include <tex/pack.h>

#include "reference/damage.h"
#include "scratch.h"

namespace tex {
namespace {

// Bumps of several sizes that tile: the normals of a height field, y up.
NormalMap bumps(Extent extent, float strength = 12.0f) {
    HeightField field{Plane<float>(extent), strength, strength, Wrap::repeat, Wrap::repeat};
    const double tau = 2.0 * 3.14159265358979;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double u = tau * i / extent.width, v = tau * j / extent.height;
            field.height.at(i, j) =
                static_cast<float>(std::sin(3 * u + std::cos(2 * v)) * std::cos(4 * v) + 0.5 * std::sin(7 * u + 5 * v) +
                                   0.3 * std::cos(11 * v - 4 * u) + 0.2 * std::sin(13 * u - 9 * v));
        }
    }
    return std::move(*bake(field));
}

Texture map_texture() { return reference::texture_of(reference::codes_of(bumps({128, 128}))); }

std::set<std::string> ids(const Texture& texture, const CheckOptions& options = {}) {
    const auto report = check("map", texture, options);
    EXPECT_TRUE(report);
    std::set<std::string> found;
    for (const Finding& finding : report->findings) found.emplace(finding.rule->id);
    return found;
}

using Ids = std::set<std::string>;

void set_code(Texture& texture, std::size_t texel, int channel, int code) {
    texture.levels[0].bytes[texel * static_cast<std::size_t>(format_info(texture.format).channels) +
                            static_cast<std::size_t>(channel)] = static_cast<std::byte>(code);
}

CheckOptions requiring(std::initializer_list<const char*> requirements) {
    CheckOptions options;
    for (const char* text : requirements) EXPECT_TRUE(add_requirement(options.require, text)) << text;
    return options;
}

TEST(Rules, AreOrderedNamedAndExplained) {
    std::set<std::string_view> names;
    std::string_view last;
    for (const Rule& rule : rules()) {
        EXPECT_LT(last, rule.id);
        last = rule.id;
        EXPECT_EQ(rule.id.size(), 4u);
        EXPECT_TRUE(names.insert(rule.name).second) << rule.name;
        EXPECT_EQ(rule.sentence.back(), '.') << rule.id;
        EXPECT_GT(rule.explanation.size(), 30u) << rule.id;
        EXPECT_EQ(find_rule(rule.id), &rule);
        EXPECT_EQ(find_rule(rule.name), &rule);
    }
    EXPECT_EQ(find_rule("N999"), nullptr);
    EXPECT_EQ(find_rule(""), nullptr);
}

// Otherwise two findings could hide each other.
TEST(Rules, NoRuleExplainsItselfThroughOthers) {
    const auto explains = [](const Rule& a, const Rule& b) { return a.explains.find(b.id) != std::string_view::npos; };
    for (const Rule& rule : rules()) {
        std::set<std::string_view> reached{};
        std::vector<const Rule*> open{&rule};
        while (!open.empty()) {
            const Rule* next = open.back();
            open.pop_back();
            for (const Rule& other : rules()) {
                if (explains(*next, other) && reached.insert(other.id).second) open.push_back(&other);
            }
        }
        EXPECT_EQ(reached.count(rule.id), 0u) << rule.id;
    }
}

TEST(Check, SoundMapsHaveNoFindings) {
    EXPECT_EQ(ids(map_texture()), Ids{});
    EXPECT_EQ(ids(map_texture(),
                  requiring({"y=up", "tiles", "pow2", "mips=none", "format=rgb8", "extent=128x128", "max-extent=128"})),
              Ids{});
    EXPECT_EQ(ids(reference::texture_of(reference::chain_of(bumps({128, 128}), reference::ChainFault::none)),
                  requiring({"mips=full"})),
              Ids{});
}

// Heights for which it is difficult to judge a bake: few values, flat parts, slopes that hardly change or that 8 bits
// cannot hold.
float awkward_height(int shape, int i, int j) {
    constexpr int kSide = 128;
    const double x = i - kSide / 2, y = j - kSide / 2, edge = std::max(std::abs(x), std::abs(y));
    const double tau = 2.0 * 3.14159265358979 / kSide;
    const double heights[] = {
        (x * x + y * y) / 8192.0 * 251.0,                                         // a bowl
        std::max(0.0, 200.0 - 3.0 * edge),                                        // a pyramid
        60.0 * std::clamp((56.0 - edge) / 12.0, 0.0, 1.0),                        // a stamp
        250.0 * std::sqrt(std::max(0.0, 1.0 - (x * x + y * y) / (55.0 * 55.0))),  // half a ball
        127.0 + 60.0 * std::sin(tau * i + std::cos(2.0 * tau * j)) * std::cos(tau * j) +
            30.0 * std::sin(tau * (3 * i + 2 * j)),
    };
    return static_cast<float>(std::floor(heights[shape]) / 255.0);
}

// N305 would be correct for these, because the heights have few values.
TEST(Check, OwnBakesOfAwkwardHeightsAreIntact) {
    for (int shape = 0; shape < 5; ++shape) {
        for (const float bumpiness : {0.5f, 2.0f, 8.0f, 10.0f, 1000.0f}) {
            HeightField field{Plane<float>(Extent{128, 128}), bumpiness, bumpiness, Wrap::clamp, Wrap::clamp};
            for (int k = 0; k < 128 * 128; ++k)
                field.height.at(k % 128, k / 128) = awkward_height(shape, k % 128, k / 128);
            for (const Encoding encoding :
                 {Encoding::dxt5nm, Encoding::bc5, Encoding::bc5_snorm, Encoding::rgb8, Encoding::rgb16}) {
                SCOPED_TRACE(testing::Message() << "shape " << shape << ", bumpiness " << bumpiness << ", "
                                                << name_of(kEncodingNames, encoding));
                PackOptions options;
                options.encoding = encoding;
                const auto chain = build_mip_chain(std::move(*bake(field)), {});
                const Ids found = ids(*pack(*chain, options));
                for (const char* id : {"N201", "N202", "N203", "N205", "N301", "N302", "N304", "N306", "N308", "N309",
                                       "N310", "N402", "N404", "N501", "N502", "N503"})
                    EXPECT_FALSE(found.contains(id)) << id;
            }
        }
    }
}

TEST(Check, OneChannelIsNoNormalMap) {
    Texture texture;
    texture.format = Format::r8_unorm;
    texture.swizzle = {Component::other, Component::zero, Component::zero, Component::one};
    texture.levels.push_back({{32, 32}, std::vector<std::byte>(32 * 32, std::byte{128})});
    EXPECT_TRUE(ids(texture).contains("N210"));
}

// The result of mip --fade: the last levels are flat, which is not a different image.
TEST(Check, LevelsThatFadedToFlatAreRelated) {
    for (const Encoding encoding : {Encoding::rgb8, Encoding::dxt5nm}) {
        MipOptions mips;
        mips.fade = Fade{0, 3};
        auto chain = build_mip_chain(bumps({256, 256}), mips);
        ASSERT_TRUE(chain);
        const auto texture = pack(*chain, {encoding, YAxis::up, Effort::fast});
        ASSERT_TRUE(texture);
        const auto met = ids(*texture);
        for (const char* id : {"N501", "N502", "N503", "N504"}) EXPECT_EQ(met.count(id), 0u) << id;
    }
}

TEST(Check, AnEngineNeedsItsFileTypeFormatAndLevels) {
    Texture texture = map_texture();
    const auto message = [&](const std::string& file, const EngineNeeds& needs) {
        CheckOptions options;
        options.require.engines = {needs};
        const auto report = check(file, texture, options);
        EXPECT_TRUE(report);
        if (report->findings.empty()) return std::string();
        EXPECT_EQ(report->findings.size(), 1u);
        EXPECT_EQ(report->findings.front().rule->id, "N113");
        return report->findings.front().message;
    };
    const std::vector<Encoding> rgb = {Encoding::rgb16, Encoding::rgb8};
    EXPECT_EQ(message("a.png", {"e", {Container::png}, rgb, false}), "");
    EXPECT_EQ(message("-", {"e", {Container::png}, rgb, false}), "");
    EXPECT_EQ(message("a.tga", {"e", {Container::png, Container::exr}, rgb, false}),
              "e does not read tga but png, exr");
    EXPECT_EQ(message("a.png", {"e", {Container::png}, {Encoding::bc5, Encoding::ag8}, false}),
              "e does not read normals from rgb8-unorm, rgb but from bc5, ag8");
    EXPECT_EQ(message("a.png", {"e", {Container::png}, rgb, true}), "e needs all 8 levels, and the file has 1");
    EngineNeeds needs{"e", {Container::ktx2}, rgb};
    texture.zlib = true;
    EXPECT_EQ(message("a.ktx2", needs), "");
    needs.inflates_zlib = false;
    EXPECT_EQ(message("a.ktx2", needs),
              "e does not read KTX2 that zlib compressed, but Zstandard (--supercompress zstd)");
}

TEST(Check, RequirementsAreWhatTheySay) {
    const Texture texture = map_texture();
    EXPECT_EQ(ids(texture, requiring({"y=down"})), Ids{"N401"});
    EXPECT_EQ(ids(texture, requiring({"mips=full"})), Ids{"N109"});
    EXPECT_EQ(ids(texture, requiring({"mips=3"})), Ids{"N109"});
    EXPECT_EQ(ids(texture, requiring({"format=dxt5nm"})), Ids{"N108"});
    EXPECT_EQ(ids(texture, requiring({"format=bc3-unorm"})), Ids{"N108"});
    EXPECT_EQ(ids(texture, requiring({"extent=128x64"})), Ids{"N110"});
    EXPECT_EQ(ids(texture, requiring({"max-extent=127"})), Ids{"N107"});
    const Texture odd = reference::texture_of(reference::codes_of(bumps({96, 64})));
    EXPECT_EQ(ids(odd), Ids{});
    EXPECT_EQ(ids(odd, requiring({"pow2"})), Ids{"N105"});
    const Texture cut =
        reference::texture_of(reference::codes_of(reference::crop(bumps({160, 160}), 0, 0, {128, 128})));
    EXPECT_EQ(ids(cut), Ids{});
    EXPECT_EQ(ids(cut, requiring({"tiles"})), Ids{"N307"});
}

// Boards whose joints run down the map. Where the border lies in a joint, it is as steep as the joints inside.
TEST(Check, ABorderInAJointIsNoSeam) {
    constexpr int kSide = 512;
    const auto boards = [&](int shift) {
        HeightField field;
        field.height = Plane<float>({kSide, kSide});
        field.bumpiness_x = field.bumpiness_y = 1.0f;
        for (int j = 0; j < kSide; ++j) {
            for (int i = 0; i < kSide; ++i) {
                const int across = (i + shift) % 256;
                const float grain = 0.6f * std::sin(0.012271846f * static_cast<float>(j * 32 + i * 16));
                field.height.at(i, j) = grain - (across < 2 ? 3.0f : 0.0f);
            }
        }
        auto map = bake(field);
        EXPECT_TRUE(map);
        return reference::texture_of(reference::codes_of(*map));
    };
    for (const int shift : {0, 1, 2, 20}) EXPECT_EQ(ids(boards(shift), requiring({"tiles"})), Ids{}) << shift;
}

TEST(Check, RefusesRequirementsThatMeanNothing) {
    Requirements requirements;
    for (const char* text :
         {"", "=", "y", "y=", "y=left", "mips", "mips=0", "mips=-1", "mips=two", "mips=4x", "extent=12", "extent=x12",
          "extent=0x4", "extent=4x4x4", "max-extent=99999999999", "format=dxt9", "pow2=yes", "tiles=", "colour=blue"}) {
        const auto result = add_requirement(requirements, text);
        ASSERT_FALSE(result) << text;
        EXPECT_EQ(result.error().code, ErrorCode::bad_option);
    }
}

TEST(Check, UnknownRulesAreAnError) {
    CheckOptions options;
    options.disable = {"N999"};
    const auto report = check("map", map_texture(), options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::bad_option);
}

TEST(Check, SeverityAndChoiceOfRulesFollowTheOptions) {
    CheckOptions options = requiring({"y=down"});
    options.severity = {{"wrong-y", Severity::note}};
    const auto report = check("map", map_texture(), options);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->findings.size(), 1u);
    EXPECT_EQ(report->findings[0].severity, Severity::note);
    options.disable = {"N401"};
    EXPECT_EQ(ids(map_texture(), options), Ids{});
}

TEST(Check, CountsTexelsAndNamesTheFirst) {
    Texture texture = map_texture();
    for (const std::size_t texel : {300u, 301u, 9000u}) {
        for (int c = 0; c < 3; ++c) set_code(texture, texel, c, 128);
    }
    const auto report = check("map", texture);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->findings.size(), 1u) << "off-length texels are explained";
    const Finding& finding = report->findings[0];
    EXPECT_EQ(finding.rule->id, "N205");
    EXPECT_DOUBLE_EQ(finding.figure, 3.0 / (128 * 128));
    EXPECT_EQ(finding.column, 300 % 128);
    EXPECT_EQ(finding.row, 300 / 128);
}

TEST(Check, FindsOneTexelThatIsNotANumber) {
    Texture texture;
    texture.format = Format::rgb32_float;
    Level level{{64, 64}, {}};
    const NormalMap map = bumps({64, 64});
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const float texel[3] = {i == 5 && j == 6 ? std::nanf("") : map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)};
            const auto* bytes = reinterpret_cast<const std::byte*>(texel);
            level.bytes.insert(level.bytes.end(), bytes, bytes + sizeof texel);
        }
    }
    texture.levels.push_back(level);
    const auto report = check("map", texture);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->findings.size(), 1u);
    EXPECT_EQ(report->findings[0].rule->id, "N204");
    EXPECT_EQ(report->findings[0].column, 5);
    EXPECT_EQ(report->findings[0].row, 6);
}

TEST(Check, ChangesNothingAndGivesTheSameReportForEveryNumberOfThreads) {
    const Texture texture =
        reference::texture_of(reference::chain_of(bumps({256, 256}), reference::ChainFault::shifted));
    Execution one;
    one.threads = 1;
    const auto expected = check("map", texture, requiring({"y=down"}), one);
    Execution four;
    four.threads = 4;
    const auto report = check("map", texture, requiring({"y=down"}), four);
    ASSERT_TRUE(expected && report);
    ASSERT_EQ(report->findings.size(), expected->findings.size());
    EXPECT_GE(report->findings.size(), 2u);
    for (std::size_t k = 0; k < report->findings.size(); ++k) {
        EXPECT_EQ(report->findings[k].message, expected->findings[k].message);
        EXPECT_EQ(report->findings[k].figure, expected->findings[k].figure);
    }
    EXPECT_EQ(report->y.correlation, expected->y.correlation);
}

TEST(Check, StopsWhenAsked) {
    Execution execution;
    execution.progress = [](double) { return false; };
    const auto report = check("map", map_texture(), {}, execution);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::cancelled);
}

TEST(Check, ProgressNeverDecreases) {
    std::vector<double> fractions;
    Execution execution;
    execution.progress = [&](double done) {
        fractions.push_back(done);
        return true;
    };
    ASSERT_TRUE(check("map", map_texture(), {}, execution));
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GT(fractions.size(), 5u);
    EXPECT_EQ(fractions.back(), 1.0);
    EXPECT_LT(fractions.front(), 1.0);
}

TEST(Check, TexturesOfOneTexelAreChecked) {
    EXPECT_EQ(ids(reference::texture_of(reference::codes_of(bumps({1, 1})))), Ids{});
    EXPECT_EQ(ids(reference::texture_of(reference::codes_of(bumps({3, 2})))), Ids{});
}

// What unpack() does: a map that leans to one side has no negative component, but it is signed.
TEST(Check, FloatsWithoutANegativeValueAreReadByTheirLength) {
    for (const Extent extent : {Extent{1, 1}, Extent{64, 64}}) {
        NormalMap map = bumps(extent);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                map.x.at(i, j) = std::abs(map.x.at(i, j));
                map.y.at(i, j) = std::abs(map.y.at(i, j));
            }
        }
        MipChain chain;
        chain.levels.push_back(std::move(map));
        for (const Encoding encoding : {Encoding::half, Encoding::float_}) {
            auto texture = pack(chain, {encoding, YAxis::up, Effort::fast});
            ASSERT_TRUE(texture);
            texture->normal_encoding.clear();
            EXPECT_FALSE(ids(*texture).contains("N201")) << extent.width;
        }
    }
}

TEST(CheckFile, UnreadableFilesAreFindings) {
    const Scratch scratch;
    const std::string path = scratch.write("not_a_picture.dds", "DDS nothing");
    const auto report = check_file(path);
    ASSERT_TRUE(report);
    ASSERT_TRUE(report->error);
    EXPECT_EQ(report->error->code, ErrorCode::bad_data);
    ASSERT_EQ(report->findings.size(), 1u);
    EXPECT_EQ(report->findings[0].rule->id, "N101");
    std::filesystem::remove(path);
    const auto missing = check_file(path);
    ASSERT_TRUE(missing);
    EXPECT_EQ(missing->error->code, ErrorCode::io);
    EXPECT_TRUE(missing->findings.empty()) << "a missing file is no finding";
}

TEST(CheckPair, ReportsStrengthSignAndOffset) {
    const Extent extent{128, 128};
    HeightField field{Plane<float>(extent), 6.0f, 6.0f, Wrap::clamp, Wrap::clamp};
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            field.height.at(i, j) =
                static_cast<float>(std::sin(0.2 * i) * std::cos(0.17 * j) + 0.3 * std::sin(0.31 * i + 0.4 * j));
        }
    }
    const auto normals = bake(field);
    ASSERT_TRUE(normals);
    CheckOptions options;
    options.height = &field;
    const auto report = check("map", reference::texture_of(reference::codes_of(*normals)), options);
    ASSERT_TRUE(report && report->pair);
    EXPECT_TRUE(report->findings.empty());
    EXPECT_GT(report->pair->correlation, 0.99);
    EXPECT_NEAR(report->pair->strength, 6.0, 0.3);
    EXPECT_EQ(report->pair->y, YAxis::up);

    const NormalMap shifted = reference::crop(*normals, 2, 0, {120, 128});
    HeightField narrow{Plane<float>(Extent{120, 128}), 1.0f, 1.0f, Wrap::clamp, Wrap::clamp};
    for (int j = 0; j < 128; ++j) std::memcpy(narrow.height.row(j), field.height.row(j), 120 * sizeof(float));
    options.height = &narrow;
    const auto moved = check("map", reference::texture_of(reference::codes_of(shifted)), options);
    ASSERT_TRUE(moved && moved->pair);
    EXPECT_EQ(moved->pair->offset_x, -2);
    ASSERT_EQ(moved->findings.size(), 1u);
    EXPECT_EQ(moved->findings[0].rule->id, "N601");
}

}  // namespace
}  // namespace tex
