// SPDX-License-Identifier: Apache-2.0
// The fixes that check-normals prints: each is run, on every file type that has the finding. The finding is gone
// afterwards, there is no new one, and nothing else is lost.

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

std::string with(std::string text, const std::string& word, const std::string& by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
    return text;
}

}  // namespace

class Fixes : public testing::Test {
protected:
    Fixes() {
        scratch_.add_sample("waves.png", "waves.png");
        go("cp -r " TEX_SOURCE_DIR "/samples/broken/N* " TEX_SOURCE_DIR
           "/samples/broken/meshes .; bake-normals waves.png -o n.exr --format float --bumpiness 8 "
           "--mips all --no-sync");
    }
    void go(const std::string& script) {
        const Ran ran = shell(scratch_, "set -e; " + script);
        EXPECT_EQ(ran.code, 0) << script << ran.err;
    }
    nlohmann::json check(const std::string& name, const std::string& options) {
        return nlohmann::json::parse(shell(scratch_, "check-normals --json " + options + " " + name).out);
    }
    static std::set<std::string> ids(const nlohmann::json& report) {
        std::set<std::string> all;
        for (const auto& finding : report["findings"]) all.insert(finding["id"].get<std::string>());
        return all;
    }
    static nlohmann::json finding(const nlohmann::json& report, const std::string& id) {
        for (const auto& one : report["findings"]) {
            if (one["id"] == id) return one;
        }
        ADD_FAILURE() << id << " is not in " << report;
        return {};
    }
    Texture read(const std::string& name) {
        auto texture = read_texture(scratch_.path(name));
        EXPECT_TRUE(texture) << name;
        return texture ? std::move(*texture) : Texture{};
    }
    MipChain vectors(const Texture& texture, YAxis y) {
        UnpackOptions options;
        options.keep_length = true;
        options.y_axis = y;
        if (const auto swizzle = guess_swizzle(texture)) options.swizzle = *swizzle;
        auto chain = unpack(texture, options);
        EXPECT_TRUE(chain);
        return chain ? std::move(*chain) : MipChain{};
    }

    // Runs the fix of `id` as printed, with its placeholders filled in. Returns the name of the new file.
    std::string repair(const std::string& name, const std::string& id, const std::string& options) {
        const auto before = check(name, options);
        std::string fix = finding(before, id).value("fix", "");
        const auto output = fix.rfind("FIXED.");
        if (output == std::string::npos) {
            ADD_FAILURE() << id << " of " << name << " has no fix: " << before;
            return {};
        }
        const std::string fixed = fix.substr(output);
        fix = with(with(fix, "FIRST,LAST", "0,3"), "TEXELS", "8");
        const Ran ran = shell(scratch_, fix + " --no-sync --quiet");
        EXPECT_EQ(ran.code, 0) << fix << ran.err;
        const auto after = check(fixed, options);
        EXPECT_EQ(ids(after).count(id), 0u) << fix << after;
        // What the fault hid may show now.
        for (const std::string& left : ids(after)) {
            const bool was_hidden = find_rule(id)->explains.find(left) != std::string_view::npos;
            EXPECT_TRUE(was_hidden || ids(before).count(left) == 1u) << fix << after;
        }
        expect_nothing_lost(before, after, fix);
        return fixed;
    }
    static void expect_nothing_lost(const nlohmann::json& before, const nlohmann::json& after, const std::string& fix) {
        const auto info = [](const nlohmann::json& report) {
            return format_info(*find_by_name(kFormatNames, report["format"].get<std::string>()));
        };
        EXPECT_EQ(before["extent"], after["extent"]) << fix;
        EXPECT_GE(after["levels"], before["levels"]) << fix;
        EXPECT_GE(info(after).bits, info(before).bits) << fix;
        const bool compresses = info(after).has_blocks() && !info(before).has_blocks();
        EXPECT_TRUE(!compresses || fix.find("--format dxt5nm") != std::string::npos) << fix;  // as required
    }

    // The two files hold the same vectors, with y as given for each.
    void expect_same_vectors(const std::string& a, YAxis y_a, const std::string& b, YAxis y_b) {
        const MipChain p = vectors(read(a), y_a), q = vectors(read(b), y_b);
        ASSERT_EQ(p.levels.size(), q.levels.size()) << a;
        for (std::size_t k = 0; k < p.levels.size(); ++k) {
            const Extent extent = p.levels[k].extent();
            ASSERT_EQ(extent, q.levels[k].extent());
            float most = 0.0f;
            for (int j = 0; j < extent.height; ++j) {
                for (int i = 0; i < extent.width; ++i) {
                    most = std::max({most, std::abs(p.levels[k].x.at(i, j) - q.levels[k].x.at(i, j)),
                                     std::abs(p.levels[k].y.at(i, j) - q.levels[k].y.at(i, j)),
                                     std::abs(p.levels[k].z.at(i, j) - q.levels[k].z.at(i, j))});
                }
            }
            EXPECT_LE(most, 1e-6f) << a << " and " << b << ", level " << k;
        }
    }
    // The base levels hold the same vectors, with y up, to what rounding does to them.
    void expect_nearly_same(const std::string& a, const std::string& b) {
        const auto p = read_normals(scratch_.path(a)), q = read_normals(scratch_.path(b));
        ASSERT_TRUE(p && q) << a << b;
        const auto compared = compare(p->chain.levels[0], q->chain.levels[0]);
        ASSERT_TRUE(compared) << a << b;
        EXPECT_LT(compared->error.max, 0.02) << a << " and " << b;
    }
    Scratch scratch_;
};

TEST_F(Fixes, RepairEveryBrokenSample) {
    std::map<std::string, std::string> options;
    const Ran list = shell(scratch_, "cat " TEX_SOURCE_DIR "/samples/broken/options.txt");
    for (const std::string& line : lines_of(list.out))
        options[line.substr(0, 4)] = with(line.substr(5), "../waves.png", "waves.png");
    std::set<std::string> repaired;
    for (const std::string& name : scratch_.list()) {
        if (!name.starts_with("N")) continue;
        const std::string id = name.substr(0, 4);
        const auto found = finding(check(name, options[id]), id);
        if (id == "N808") continue;  // ConvertedModels runs its fix
        // Exchanged channels have a command if it is z that changed places.
        if (find_rule(id)->fix.find("-normals FILE") == std::string_view::npos && id != "N308") {
            EXPECT_FALSE(found.contains("fix")) << found;
            EXPECT_EQ(found.value("advice", ""), find_rule(id)->fix);
            continue;
        }
        if (id == "N112") continue;            // too small to show which way green points; see below
        if (name.ends_with(".glb")) continue;  // ModelOutputs runs the fixes of models
        repair(name, id, options[id]);
        repaired.insert(id);
    }
    EXPECT_EQ(repaired.size(), 33u);
}

struct Kind {
    const char* name;
    const char* format;
    bool states_y;
};
constexpr Kind kKinds[] = {
    {"m.png", "rgb8", false},      {"m.png", "rgb16", false}, {"m.tif", "rgb16", false}, {"m.tga", "rgb8", false},
    {"m.dds", "rgba8", false},     {"m.dds", "ag8", false},   {"m.dds", "bc5", false},   {"m.dds", "dxt5nm", false},
    {"m.dds", "half", false},      {"m.ktx2", "rg16", true},  {"m.ktx2", "bc5", true},   {"m.ktx2", "rgba8", true},
    {"m.ktx2", "bc5-snorm", true}, {"m.exr", "half", true},   {"m.exr", "float", true},
};

// Green is turned over, and nothing else changes, in any file.
TEST_F(Fixes, TurnGreenOverWithoutLoss) {
    for (const Kind& kind : kKinds) {
        const std::string name = kind.name;
        go("pack-normals n.exr -o " + name + " --format " + kind.format + " --no-sync");
        const std::string fixed = repair(name, "N401", "--require y=down");
        EXPECT_EQ(read(fixed).format, read(name).format) << kind.format;
        EXPECT_EQ(read(fixed).levels.size(), read(name).levels.size()) << kind.format;
        expect_same_vectors(name, YAxis::up, fixed, YAxis::down);
    }
}

// Red that is turned over looks like green that is: two commands are printed, and heights say which one is right.
TEST_F(Fixes, TurnRedOverIfThatIsWhatIsMirrored) {
    go("pack-normals n.exr -o plain.png --format rgb16 --no-sync; pack-normals plain.png -o dx.png --y-in up --y down "
       "--format rgb16 --no-sync; convert plain.png -depth 16 -channel R -negate -define png:bit-depth=16 red.png");
    const auto red = finding(check("red.png", "--require y=up"), "N401");
    EXPECT_NE(red.value("message", "").find("from the slopes alone, the two look the same"), std::string::npos) << red;
    EXPECT_EQ(red.value("message", "").find("confidence"), std::string::npos) << red;
    const std::string advice = red.value("advice", "");
    EXPECT_NE(advice.find("check-normals --height FILE"), std::string::npos) << red;
    const auto begin = advice.find("scale-normals "), end = advice.find("; check-normals");
    ASSERT_TRUE(begin != std::string::npos && end != std::string::npos && begin < end) << advice;
    go(advice.substr(begin, end - begin) + " --no-sync");
    EXPECT_EQ(ids(check("FIXED.png", "--require y=up")).count("N401"), 0u);
    expect_nearly_same("FIXED.png", "plain.png");
    // Without heights, the first command is the usual one, and makes dents here, which the check cannot see.
    go(red.value("fix", "") + " --no-sync");
    EXPECT_EQ(ids(check("FIXED.png", "--require y=up")).count("N401"), 0u);

    const std::string heights = "--require y=up --height waves.png";
    for (const auto& [name, program] : {std::pair("red.png", "scale-normals "), std::pair("dx.png", "pack-normals ")}) {
        const auto report = check(name, heights);
        EXPECT_EQ(ids(report).count("N602"), 0u) << report;
        const auto found = finding(report, "N401");
        EXPECT_NE(found.value("message", "").find("as the heights show"), std::string::npos) << found;
        EXPECT_FALSE(found.contains("advice")) << found;
        EXPECT_TRUE(found.value("fix", "").starts_with(program)) << found;
        go(found.value("fix", "") + " --no-sync");
        EXPECT_EQ(ids(check("FIXED.png", heights)).count("N401"), 0u) << name;
        EXPECT_EQ(ids(check("FIXED.png", heights)).count("N602"), 0u) << name;
        expect_nearly_same("FIXED.png", "plain.png");
    }
    EXPECT_EQ(ids(check("plain.png", heights)).count("N401"), 0u);
    const Ran text = shell(scratch_, "check-normals red.png --require y=up");
    EXPECT_NE(text.out.find("\n    fix: pack-normals red.png"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("\n    advice: If bumps look like dents after that, red was mirrored instead"),
              std::string::npos)
        << text.out;
}

// A file that states a direction, and whose red is mirrored.
TEST_F(Fixes, TurnRedOverInFilesThatStateTheirDirection) {
    go("pack-normals n.exr -o plain.png --format rgb16 --no-sync; convert plain.png -depth 16 -channel R -negate "
       "-define png:bit-depth=16 red.png; pack-normals red.png -o red.ktx2 --y-in up --y up --format rg16 --no-sync");
    const auto found = finding(check("red.ktx2", "--height waves.png"), "N404");
    EXPECT_NE(found.value("message", "").find("red points left"), std::string::npos) << found;
    go(found.value("fix", "") + " --no-sync");
    EXPECT_EQ(ids(check("FIXED.ktx2", "--height waves.png")).count("N404"), 0u);
    expect_nearly_same("FIXED.ktx2", "plain.png");
    const auto unsure = finding(check("red.ktx2", ""), "N404");
    EXPECT_TRUE(unsure.contains("fix") && unsure.contains("advice")) << unsure;
}

// A file that is right, but states the other direction, is not turned over.
TEST_F(Fixes, CorrectOnlyTheStatementOfMislabelledFiles) {
    for (const Kind& kind : kKinds) {
        if (!kind.states_y) continue;
        const std::string name = kind.name;
        go("pack-normals n.exr --y-in down --y down -o " + name + " --format " + kind.format + " --no-sync");
        for (const char* id : {"N112", "N404"}) {
            const std::string fixed = repair(name, id, "--require y=up");
            EXPECT_EQ(read(fixed).y_axis, YAxis::up);
            EXPECT_EQ(read(fixed).format, read(name).format) << kind.format;
            expect_same_vectors(name, YAxis::up, fixed, YAxis::up);
        }
    }
    // Whether this one is right cannot be seen.
    const auto small = finding(check("N112-wrong-declared-y.ktx2", "--require y=up"), "N112");
    EXPECT_FALSE(small.contains("fix")) << small;
    EXPECT_NE(small.value("advice", "").find("do not show which way green points"), std::string::npos) << small;
}

TEST_F(Fixes, KeepTheBitsOfDeepFiles) {
    go("convert N201-not-unit-length.png -depth 16 -evaluate multiply 1.0001 -define png:bit-depth=16 d.png;"
       "cp d.png d201.png; convert N209-blue-not-z.png -evaluate add 3 -channel B -evaluate set 100% -depth 16 "
       "-define png:bit-depth=16 d209.png;"
       "unpack-normals N501-level-not-unit.dds -o d501.exr --keep-length --level all --no-sync");
    for (const auto& [name, id] : {std::pair("d201.png", "N201"), std::pair("d209.png", "N209")}) {
        ASSERT_EQ(format_info(read(name).format).bits, 16);
        EXPECT_EQ(repair(name, id, ""), "FIXED.png");
    }
    EXPECT_EQ(repair("d501.exr", "N501", ""), "FIXED.exr");
    const MipChain before = vectors(read("d209.png"), YAxis::up);
    repair("d209.png", "N209", "");
    const MipChain after = vectors(read("FIXED.png"), YAxis::up);
    for (int k = 0; k < 128; ++k) {
        EXPECT_NEAR(before.levels[0].x.at(k, k), after.levels[0].x.at(k, k), 1e-6f);
        EXPECT_NEAR(before.levels[0].y.at(k, k), after.levels[0].y.at(k, k), 1e-6f);
    }
}

// What a command would lose, no command is offered for.
TEST_F(Fixes, ThatWouldLoseDataAreSentences) {
    go("pack-normals n.exr -o plain.png --format rgb8 --no-sync;"
       "convert plain.png waves.png -alpha off -compose CopyOpacity -composite PNG32:gloss.png;"
       "convert plain.png -quality 95 photo.jpg; convert plain.png -define dds:compression=dxt1 -define "
       "dds:mipmaps=0 dxt1.dds; cp plain.png -- -odd.png");
    const auto gloss = check("gloss.png", "--require y=down");
    for (const auto& found : gloss["findings"]) EXPECT_EQ(found.contains("fix"), found["id"] == "N401") << found;
    EXPECT_NE(finding(gloss, "N212").value("advice", "").find("which unpack-normals --alpha-out saves."),
              std::string::npos)
        << gloss;
    // Whoever says what the channels hold is told no more.
    EXPECT_NE(finding(gloss, "N212").value("advice", "").find("--swizzle rgb says so"), std::string::npos) << gloss;
    for (const char* layout : {"--swizzle rgb", "--swizzle labpbr"}) {
        const auto stated = check("gloss.png", layout);
        for (const auto& found : stated["findings"]) EXPECT_NE(found["id"], "N212") << layout;
    }
    // Alpha goes along.
    const std::string kept = finding(gloss, "N401").value("fix", "");
    EXPECT_NE(kept.find("--format rgba8"), std::string::npos) << kept;
    go(kept +
       " --no-sync; convert gloss.png -alpha extract a.gray; convert FIXED.png -alpha extract b.gray; "
       "cmp a.gray b.gray");
    EXPECT_NE(finding(check("dxt1.dds", "--require y=down"), "N401").value("advice", "").find("bc1-unorm"),
              std::string::npos);
    EXPECT_EQ(repair("photo.jpg", "N401", "--require y=down"), "FIXED.png") << "JPEG would lose more";
    EXPECT_EQ(repair("./-odd.png", "N401", "--require y=down"), "FIXED.png");
    const Ran text = shell(scratch_, "check-normals gloss.png");
    EXPECT_NE(text.out.find("No command: it would lose the data"), std::string::npos) << text.out;
    EXPECT_EQ(text.out.find("    fix: "), std::string::npos) << text.out;
    // What the sentence names.
    go("unpack-normals gloss.png -o apart.png --alpha-out alpha.png --no-sync;"
       "pack-normals gloss.png -o kept.png --format rgba8 --no-sync");
    const auto apart = check("apart.png", "--require y=down");
    for (const auto& found : apart["findings"]) EXPECT_NE(found["id"], "N212");
    EXPECT_EQ(finding(check("kept.png", "--require y=down"), "N212")["id"], "N212");
}

// DXT5 with normals in its colours and data in its alpha: no encoding of blocks holds that, and 8 bits do.
TEST_F(Fixes, OfBlocksWithAlphaKeepItIn8Bits) {
    go("pack-normals n.exr -o plain.png --format rgb8 --no-sync;"
       "convert plain.png waves.png -alpha off -compose CopyOpacity -composite -define dds:compression=dxt5 dxt5.dds");
    const auto found = finding(check("dxt5.dds", "--require y=down"), "N401");
    const std::string fix = found.value("fix", "");
    EXPECT_NE(fix.find("--format rgba8 -o FIXED.dds"), std::string::npos) << found;
    go(fix +
       " --no-sync; unpack-normals dxt5.dds -o x.png --alpha-out a.png --no-sync --quiet;"
       "unpack-normals FIXED.dds -o x.png --alpha-out b.png --no-sync --quiet; cmp a.png b.png");
}

// The advice of N309, which no command follows: turn the picture back, and let blend-normals turn the vectors, too.
TEST_F(Fixes, NameFilesThatBeginAsListsDo) {
    go("bake-normals waves.png -o ./@n.png --bumpiness 8 --y down --no-sync");
    go("check-normals --json --require y=up -- @n.png > found || true");
    const std::string fix = finding(nlohmann::json::parse(scratch_.read("found")), "N401")["fix"];
    EXPECT_EQ(fix.find("pack-normals ./@n.png "), 0u) << fix;
    go(fix + " --no-sync");
}

TEST_F(Fixes, FillHeightsThatAreNotValid) {
    std::vector<float> heights(64 * 64);
    for (std::size_t k = 0; k < heights.size(); ++k)
        heights[k] = 0.0001f * static_cast<float>(k % 64 * (63 - k % 64) * (k / 64) * (63 - k / 64));
    heights[100] = std::numeric_limits<float>::quiet_NaN();
    Texture texture;
    texture.format = Format::r32_float;
    texture.levels.push_back({{64, 64}, std::vector<std::byte>(heights.size() * sizeof(float))});
    std::memcpy(texture.levels[0].bytes.data(), heights.data(), texture.levels[0].bytes.size());
    ASSERT_TRUE(write_texture(scratch_.path("voids.exr"), texture));
    repair("voids.exr", "N210", "");
}

// In blocks, R, G and B that hold the same differ by what 5 and 6 bits differ.
TEST_F(Fixes, KnowThatColoursRepeatEachOther) {
    const std::string rock = TEX_SOURCE_DIR "/../shared/data/dds/torque_rock_DXT5nm_GGGR_256_mips9.dds";
    if (!std::filesystem::exists(rock)) GTEST_SKIP() << "../shared/data is not there";
    go("cp " + rock + " rock.dds");
    const std::string fix = finding(check("rock.dds", ""), "N215")["fix"];
    go(fix + " --no-sync --quiet");
    EXPECT_EQ(ids(check("FIXED.dds", "")).count("N215"), 0u);
}

TEST_F(Fixes, TurnedPicturesAreTurnedBackAndTurnedRight) {
    go("cp " TEX_SOURCE_DIR
       "/samples/bricks.png . && bake-normals bricks.png -o b.png --bumpiness 12 --no-sync;"
       "convert b.png -virtual-pixel tile -distort SRT 40 turned.png;"
       "convert turned.png -distort SRT -40 -gravity center -crop 300x300+0+0 +repage back.png;"
       "convert -size 512x512 'xc:#8080ff' flat.png; blend-normals flat.png b.png -o right.png --rotate -40 --no-sync");
    const auto turned = finding(check("turned.png", ""), "N309");
    EXPECT_NEAR(turned.value("figure", 0.0), -40.0, 2.0) << "ImageMagick turns clockwise";
    EXPECT_NE(turned.value("message", "").find("degrees clockwise"), std::string::npos) << turned;
    EXPECT_NE(turned.value("advice", "").find("blend-normals --rotate"), std::string::npos) << turned;
    for (const char* name : {"b.png", "back.png", "right.png"})
        EXPECT_EQ(ids(check(name, "")).count("N309"), 0u) << name;
}

// SARIF and the page print the same words as the text.
TEST_F(Fixes, AreTheSameInEveryReport) {
    go("pack-normals n.exr -o m.dds --format rgba8 --no-sync");
    const Ran ran = shell(scratch_, "check-normals m.dds --require y=down --sarif s.json --report r.html");
    const std::string fix = "pack-normals m.dds --keep-length --y-in up --y down --format rgba8 -o FIXED.dds";
    EXPECT_NE(ran.out.find("    fix: " + fix + "\n"), std::string::npos) << ran.out;
    EXPECT_NE(scratch_.read("s.json").find("Fix: " + fix), std::string::npos);
    EXPECT_NE(scratch_.read("r.html").find("<code>" + fix + "</code>"), std::string::npos);
    EXPECT_EQ(finding(check("m.dds", "--require y=down"), "N401")["fix"], fix);
}

}  // namespace tex::cli
