// SPDX-License-Identifier: Apache-2.0
// Counts what the rules of check.h find and miss on real maps, and on the same maps with planted damages.

#include <tex/check.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tex/blend.h>
#include <tex/pack.h>

#include "checks/turn.h"
#include "reference/damage.h"
#include "reference/detection.h"
#include "reference/real_maps.h"

namespace tex {
namespace {

const std::string kData = TEX_SOURCE_DIR "/../shared/data/";

CheckReport checked(const Texture& texture, const CheckOptions& options) {
    const auto report = check("", texture, options);
    if (report) return *report;
    ADD_FAILURE() << report.error().message();
    return {};
}

bool found(const CheckReport& report, const std::string& ids) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [&](const Finding& finding) { return ids.find(finding.rule->id) != std::string::npos; });
}

#define SKIP_WITHOUT_DATA() \
    if (!std::filesystem::exists(kData)) GTEST_SKIP() << "no " << kData

// A row is a label if the author's file name says GL or DX, or if the sign of the correlation with its height map shows
// the direction. SOURCES.md measured the other rows by a curl test, too, so agreement with them proves little. The
// table separates the two.
TEST(CheckData, TellsEveryKnownDirectionOfGreen) {
    SKIP_WITHOUT_DATA();
    std::map<std::string, int> confusion[2];
    std::printf("%-52s %-9s %-22s %-9s %s\n", "map", "expected", "known by", "told", "correlation, confidence");
    for (const auto& map : reference::real_maps()) {
        const auto texture = read_texture(kData + map.path);
        ASSERT_TRUE(texture) << texture.error().message();
        const CheckReport report = checked(*texture, {});
        const auto name = [](std::optional<YAxis> y) {
            return y ? std::string(name_of(kYAxisNames, *y)) : std::string("unknown");
        };
        const bool is_label = reference::is_label(map.source);
        const std::string known_by = (is_label ? "label: " : "no label: ") + std::string(to_string(map.source));
        std::printf("%-52s %-9s %-22s %-9s %+.2f %.3f\n", map.path.c_str(), name(map.y).c_str(), known_by.c_str(),
                    name(report.y.y).c_str(), report.y.correlation, report.y.confidence);
        ++confusion[is_label ? 0 : 1][name(map.y) + " told " + name(report.y.y)];
        EXPECT_EQ(report.y.y, map.y) << map.path;
        EXPECT_FALSE(found(report, "N402")) << map.path;
        for (const YAxis y : {YAxis::up, YAxis::down}) {
            CheckOptions options;
            options.require.y = y;
            const CheckReport required = checked(*texture, options);
            EXPECT_EQ(found(required, "N401"), map.y && *map.y != y) << map.path;
        }
    }
    std::printf("%-24s %8s %28s\n", "confusion", "labels", "measured by a curl test");
    for (const char* expected : {"up", "down", "unknown"}) {
        for (const char* told : {"up", "down", "unknown"}) {
            const std::string what = std::string(expected) + " told " + told;
            std::printf("%-24s %8d %28d\n", what.c_str(), confusion[0][what], confusion[1][what]);
        }
    }
}

// The findings on the unchanged files. SOURCES.md does not name these damages, but they are real: see the next test.
TEST(CheckData, FindsNoDamageThatIsNotThere) {
    SKIP_WITHOUT_DATA();
    const std::set<std::string> expected = {
        "normal/water1_256.tga N305", "dds/d3d_RifleStock_DXT1_747x600_mips10_nvtt.dds N306",
        "dds/d3d_dwarf_armor_RGBA8_512_mips10.dds N501",
        // Its last column is a wall of 70 degrees, the steepest one inside 33.
        "dds/fieldstone_ATI2_512_mips10.dds N307", "dds/gz_waves_RGB24_256_mips9_gimp.dds N501",
        // 226 colours, each 4 degrees from the nearest one.
        "normal/nm_balls_256.png N317"};
    std::set<std::string> met;
    for (const auto& map : reference::real_maps()) {
        if (!map.intact) continue;
        CheckOptions options;
        options.require.y = map.y;
        options.require.tiles = map.tiles;
        const auto report = check_file(kData + map.path, options);
        ASSERT_TRUE(report);
        for (const Finding& finding : report->findings) {
            const RuleFamily family = finding.rule->family;
            if (family == RuleFamily::damage || family == RuleFamily::convention || family == RuleFamily::mips) {
                met.insert(map.path + " " + std::string(finding.rule->id));
            }
        }
    }
    EXPECT_EQ(met, expected);
    std::printf("%zu findings of damage on %zu untouched maps, all of them true\n", met.size(),
                reference::real_maps().size());
}

// Maps that were baked from a high-poly model are no height fields: they make up for the normals of the low-poly mesh.
TEST(CheckData, IntactMapsOfModelsHaveCurlButNoFindingOfIt) {
    SKIP_WITHOUT_DATA();
    std::vector<std::string> paths = {"mesh/Suzanne/02_suzanne_Normal.png", "trial/materialx_chess_bishop_black.jpg",
                                      "trial/WoodFloor043_normal_GL.jpg", "trial/Grass001_normal_DX.jpg"};
    for (const char* part : {"GlassPlasticMat", "LeatherPartsMat", "LensesMat", "MetalPartsMat", "RubberWoodMat"})
        paths.push_back("mesh/FlightHelmet/FlightHelmet_Materials_" + std::string(part) + "_Normal.png");
    double most = 0.0;
    for (const std::string& path : paths) {
        const auto texture = read_texture(kData + path);
        ASSERT_TRUE(texture) << texture.error().message();
        const CheckReport report = checked(*texture, {});
        EXPECT_FALSE(found(report, "N309 N310")) << path;
        const Image image = decode(*texture, 0).value();
        const auto turn = measure_turn({&image, kSwizzleXyz, false, false}, {});
        ASSERT_TRUE(turn);
        std::printf("%-66s correlation %+.2f", path.c_str(), report.y.correlation);
        for (const TurnScale& scale : turn->scale)
            std::printf("   curl %.2f, axis %+.0f (%.2f)", scale.curl_share(), scale.clearest().angle(),
                        scale.clearest().strength());
        std::printf("\n");
        most = std::max(most, turn->scale[0].curl_share());
    }
    EXPECT_GT(most, 0.35);
}

// Faint and coarse copies of every intact map, in the formats of games.
TEST(CheckData, CompressionOfFaintMapsIsNoTurn) {
    SKIP_WITHOUT_DATA();
    int copies = 0;
    for (const auto& map : reference::real_maps()) {
        if (!map.intact) continue;
        auto texture = read_texture(kData + map.path);
        ASSERT_TRUE(texture) << texture.error().message();
        texture->levels.resize(1);
        const auto chain = unpack(*texture);
        ASSERT_TRUE(chain);
        const Extent extent = chain->levels[0].extent();
        const NormalMap part =
            reference::crop(chain->levels[0], 0, 0, {std::min(extent.width, 256), std::min(extent.height, 256)});
        for (const float strength : {1.0f, 0.3f, 0.1f}) {
            auto scaled = scale(reference::crop(part, 0, 0, part.extent()), strength);
            ASSERT_TRUE(scaled);
            MipChain faint;
            faint.levels.push_back(std::move(*scaled));
            for (const Encoding encoding : {Encoding::rgb8, Encoding::bc5, Encoding::dxt5nm}) {
                const auto packed = pack(faint, {encoding, YAxis::up, Effort::fast});
                ASSERT_TRUE(packed);
                EXPECT_FALSE(found(checked(*packed, {}), "N309 N310"))
                    << map.path << " " << strength << " " << name_of(kEncodingNames, encoding);
                ++copies;
            }
        }
    }
    std::printf("%d copies\n", copies);
}

// The mean length of the stored vectors of a level.
double mean_length(const Texture& texture, int level) {
    const auto image = decode(texture, level);
    EXPECT_TRUE(image);
    double sum = 0.0;
    for (int j = 0; j < image->extent().height; ++j) {
        for (int i = 0; i < image->extent().width; ++i) {
            double square = 0.0;
            for (std::size_t c = 0; c < 3; ++c) square += std::pow(2.0 * image->planes[c].at(i, j) - 1.0, 2.0);
            sum += std::sqrt(square);
        }
    }
    return sum / static_cast<double>(image->extent().texels());
}

// The levels are averages without renormalisation: their vectors get shorter from level to level.
TEST(CheckData, TwoFilesWereNotRenormalised) {
    SKIP_WITHOUT_DATA();
    for (const auto& [path, last] : {std::pair<const char*, double>{"dds/d3d_dwarf_armor_RGBA8_512_mips10.dds", 0.94},
                                     {"dds/gz_waves_RGB24_256_mips9_gimp.dds", 0.985}}) {
        const auto texture = read_texture(kData + path);
        ASSERT_TRUE(texture);
        EXPECT_NEAR(mean_length(*texture, 0), 1.0, 0.005) << path;
        for (int level = 1; level <= 4; ++level)
            EXPECT_LT(mean_length(*texture, level), mean_length(*texture, level - 1) - 0.002) << path << level;
        EXPECT_LT(mean_length(*texture, 4), last) << path;
    }
}

// A DXT1 with normals in R, G and B: from texel to texel the normals turn by far more at the border of a block.
TEST(CheckData, RifleStockShowsItsBlocks) {
    SKIP_WITHOUT_DATA();
    const auto texture = read_texture(kData + "dds/d3d_RifleStock_DXT1_747x600_mips10_nvtt.dds");
    ASSERT_TRUE(texture);
    const auto image = decode(*texture, 0);
    ASSERT_TRUE(image);
    std::vector<double> across, inside;  // mean steps for each column
    for (int i = 0; i + 1 < image->extent().width; ++i) {
        double sum = 0.0;
        for (int j = 0; j < image->extent().height; ++j) {
            for (std::size_t c = 0; c < 2; ++c)
                sum += std::abs(image->planes[c].at(i + 1, j) - image->planes[c].at(i, j));
        }
        (i % 4 == 3 ? across : inside).push_back(sum);
    }
    const auto median = [](std::vector<double>& values) {
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
        return values[values.size() / 2];
    };
    EXPECT_GT(median(across), 1.5 * median(inside));
}

// The names of encodings: which files are DXT5nm and which are not.
TEST(CheckData, NamesTheVariantsOfTwoChannelFiles) {
    SKIP_WITHOUT_DATA();
    const auto swizzle = [](const char* file) { return to_string(check_file(kData + file, {})->swizzle); };
    EXPECT_EQ(swizzle("dds/fieldstone_ATI2_512_mips10.dds").substr(0, 2), "yx");
    EXPECT_EQ(swizzle("dds/amd_wood_ATI2_A2XY_512_mips10.dds").substr(0, 2), "xy");
    EXPECT_EQ(swizzle("dds/oiio_dds_bc3rxgb.dds").substr(1), "yzx");
    EXPECT_EQ(swizzle("dds/reference/run_RXGB_noalpha.dds").substr(1), "yzx");
    EXPECT_EQ(swizzle("dds/urho_Stone_DXT5_xGxR_1024_mips11.dds"), "_y_x");
    for (const char* grey :
         {"dds/torque_Grenade2_DXT5nm_GGGR_512_mips10.dds", "dds/torque_rock_DXT5nm_GGGR_256_mips9.dds"}) {
        const auto report = check_file(kData + grey, {});
        ASSERT_TRUE(report);
        EXPECT_TRUE(found(*report, "N211")) << grey;
    }
}

// A check of a hostile file always ends with a report.
TEST(CheckData, HostileFilesGiveReports) {
    SKIP_WITHOUT_DATA();
    ReadOptions read;
    read.max_texels = std::int64_t{1} << 24;
    read.reader_memory = std::int64_t{1} << 30;
    read.reader_timeout = 20;
    int files = 0, unreadable = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kData + "bad")) {
        const auto report = check_file(entry.path().string(), {}, read);
        ASSERT_TRUE(report) << entry.path();
        EXPECT_EQ(found(*report, "N101"), report->error && report->error->code != ErrorCode::out_of_memory &&
                                              report->error->code != ErrorCode::io)
            << entry.path();
        ++files;
        unreadable += report->error ? 1 : 0;
    }
    std::printf("%d hostile files, %d of them unreadable\n", files, unreadable);
}

// The thresholds were set on the first half of the maps (checks/thresholds.h). The other half did not influence them.
TEST(CheckData, FindsPlantedDamage) {
    SKIP_WITHOUT_DATA();
    const auto detection = reference::detect_planted(kData);
    ASSERT_TRUE(detection) << detection.error().message();
    std::printf("%s", detection->text().c_str());
    for (const auto& [damage, halves] : detection->by_damage) {
        // N402 leaves maps undecided that were baked from meshes and have few clear regions.
        const int least = damage == "green swapped in one half" ? 90 : 95;
        EXPECT_GE(halves[1].detected * 100, halves[1].planted * least) << damage;
    }
    EXPECT_GE(detection->total[0].detected * 100, detection->total[0].planted * 95);
    // A true one: see FindsNoDamageThatIsNotThere.
    EXPECT_EQ(detection->alarmed, std::vector<std::string>{"seam: dds/fieldstone_ATI2_512_mips10.dds"});
}

}  // namespace
}  // namespace tex
