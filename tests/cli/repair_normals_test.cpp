// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class RepairNormals : public testing::Test {
protected:
    RepairNormals() {
        scratch_.add_sample("waves.png", "waves.png");
        EXPECT_EQ(run(scratch_, "bake-normals", {"waves.png", "-o", "marked.png", "--bumpiness", "6"}).code, 0);
        // ImageMagick does the damage, and leaves out the mark that says what the channels hold.
        damage("", "clean.png");
        damage("-set colorspace RGB -colorspace sRGB", "light.png");
        damage("-separate -swap 0,2 -combine", "bgr.png");
        clean_ = bytes_of("clean.png");
    }
    void damage(const std::string& how, const std::string& name) {
        const Ran ran = shell(scratch_, "convert marked.png " + how + " -strip -define png:color-type=2 " + name);
        EXPECT_EQ(ran.code, 0) << ran.err;
    }
    Ran go(std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, "repair-normals", arguments);
    }
    std::string bytes_of(const std::string& name) {
        const auto texture = read_texture(scratch_.path(name));
        if (!texture) return {};
        const auto& bytes = texture->levels.front().bytes;
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }

    Scratch scratch_;
    std::string clean_;
};

TEST_F(RepairNormals, MendsSeveralFilesAndLeavesCleanOnesAsTheyAre) {
    const Ran ran = go({"clean.png", "light.png", "bgr.png", "--out-dir", "mended"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(scratch_.read("mended/clean.png"), scratch_.read("clean.png"));
    EXPECT_EQ(bytes_of("mended/bgr.png"), clean_);
    const std::string mended = bytes_of("mended/light.png");
    ASSERT_EQ(mended.size(), clean_.size());
    int worst = 0;
    for (std::size_t k = 0; k < mended.size(); ++k)
        worst =
            std::max(worst, std::abs(static_cast<unsigned char>(mended[k]) - static_cast<unsigned char>(clean_[k])));
    EXPECT_LE(worst, 2);  // the curve is steep where it is light
    EXPECT_NE(ran.out.find("light.png: N302 srgb-encoded: decode with the sRGB curve (safe), "), std::string::npos)
        << ran.out;
    EXPECT_NE(ran.out.find("bgr.png: N308 channels-exchanged: exchange R and B (safe), "), std::string::npos);
    EXPECT_NE(ran.out.find("3 maps: 2 repaired, 1 without a fault to repair\n"), std::string::npos) << ran.out;
}

// Small changes of contrast on real maps, whose histograms show what their makers did.
TEST_F(RepairNormals, RealMapsDoNotGetWorse) {
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/wild4/normal/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/wild4";
    constexpr const char* kAutoLevels = "-channel R -auto-level -channel G -auto-level -channel B -auto-level +channel";
    const struct {
        const char *file, *change, *limit;  // degrees that may be left
    } cases[] = {{"bevy_water_normals.png", "-brightness-contrast 0x5", "0.2"},
                 {"bevy_water_normals.png", "-brightness-contrast 0x20", "1.5"},
                 {"castle_Brick_02_Nrm.png", "-level 10%,90%", "1.2"},
                 {"castle_Brick_02_Nrm.png", "-gamma 2.2", "0.8"},  // which was BC1 once
                 {"castle_baked_normals_0004.png", kAutoLevels, "2"},
                 {"castle_baked_normals_0022.png", kAutoLevels, "2"},
                 {"castle_grassfull_normalmap.png", "-posterize 16", "3"}};
    for (const auto& [file, change, limit] : cases) {
        const Ran ran =
            shell(scratch_, "convert " + folder + file + " -alpha off PNG24:o.png && convert o.png " + change +
                                " PNG24:d.png && repair-normals d.png -o r.png --likely --no-sync && "
                                "compare-normals o.png r.png --max-mean " +
                                limit);
        EXPECT_EQ(ran.code, 0) << file << " " << change << "\n" << ran.out << ran.err;
    }
}

// A lightness of 80 % moves the middle as far as decoding sRGB does; nothing is proved, and nothing is done unasked.
TEST_F(RepairNormals, ADarkerPictureIsNoProofOfACurve) {
    const std::string map = TEX_SOURCE_DIR "/../shared/data/wild4/normal/godotdemos_checker_normal.png";
    if (!std::filesystem::exists(map)) GTEST_SKIP() << "no ../shared/data/wild4";
    ASSERT_EQ(shell(scratch_, "convert " + map + " -alpha off -modulate 80 PNG24:dark.png").code, 0);
    const Ran ran = go({"dark.png", "--dry-run"});
    EXPECT_EQ(ran.out.find("(safe)"), std::string::npos) << ran.out;
    ASSERT_EQ(
        shell(scratch_, "convert " + map + " -alpha off -set colorspace RGB -colorspace sRGB PNG24:pale.png").code, 0);
    EXPECT_NE(go({"pale.png", "--dry-run"}).out.find("N302 srgb-encoded: decode with the sRGB curve (safe)"),
              std::string::npos);
}

// What the file holds beside the texels stays, and a direction that is asked for and is there changes nothing.
TEST_F(RepairNormals, AMapWithoutAFaultKeepsItsBytes) {
    ASSERT_EQ(shell(scratch_, "convert clean.png -set comment 'by hand' kept.png && cp kept.png before.png").code, 0);
    EXPECT_EQ(go({"kept.png", "-o", "out.png", "--y", "up"}).code, 0);
    EXPECT_EQ(scratch_.read("out.png"), scratch_.read("before.png"));
    EXPECT_EQ(go({"kept.png", "-o", "./kept.png", "--y", "up"}).code, 0) << "in place, by another name";
    EXPECT_EQ(scratch_.read("kept.png"), scratch_.read("before.png"));
    const std::string ati = TEX_SOURCE_DIR "/../shared/data/dds/fieldstone_ATI2_512_mips10.dds";
    if (!std::filesystem::exists(ati)) GTEST_SKIP() << "no ../shared/data/dds";
    EXPECT_EQ(go({ati, "-o", "ati2.dds", "--y", "down"}).code, 0);
    EXPECT_EQ(shell(scratch_, "cmp " + ati + " ati2.dds").code, 0) << "y stays before x";
}

// With --likely, parts of both directions are repaired only if a straight line divides them.
TEST_F(RepairNormals, PromisesNoMoreThanItMayDo) {
    scratch_.add_sample("broken/N402-mixed-y.png", "mixed.png");
    const Ran ran = go({"mixed.png", "-o", "out.png"});
    EXPECT_EQ(ran.code, 1);
    EXPECT_NE(ran.out.find("; --likely repairs it if a straight line divides the two parts\n"), std::string::npos)
        << ran.out;
}

TEST_F(RepairNormals, WhatCouldNotBeWrittenCountsNowhere) {
    std::filesystem::create_directories(scratch_.path("mended/light.png/in-the-way"));
    const Ran ran = go({"light.png", "clean.png", "--out-dir", "mended"});
    EXPECT_EQ(ran.code, 3) << ran.err;
    EXPECT_NE(ran.out.find("1 map: 0 repaired, 1 without a fault to repair\n"), std::string::npos) << ran.out;
}

TEST_F(RepairNormals, APlanIsPrintedAndNothingWritten) {
    const auto before = scratch_.list();
    const Ran text = go({"light.png", "clean.png", "--dry-run"});
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_NE(text.out.find("1 would be repaired"), std::string::npos) << text.out;
    const Ran ran = go({"light.png", "--out-dir", "mended", "--dry-run", "--json"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(scratch_.list(), before);
    const auto json = nlohmann::json::parse(ran.out);
    EXPECT_EQ(json["state"], "repaired");
    ASSERT_EQ(json["repairs"].size(), 1u);
    EXPECT_EQ(json["repairs"][0]["id"], "N302");
    EXPECT_EQ(json["repairs"][0]["repair"], "decode-srgb");
    EXPECT_EQ(json["repairs"][0]["class"], "safe");
    EXPECT_GT(json["repairs"][0]["degrees"], 5.0);
    EXPECT_FALSE(json.contains("output"));
}

TEST_F(RepairNormals, AMapWithAnErrorThatIsLeftIsNotWritten) {
    damage("-channel G -negate +channel", "turned.png");
    const Ran ran = go({"turned.png", "-o", "out.png", "--y", "up"});
    EXPECT_EQ(ran.code, 1) << ran.err;
    EXPECT_FALSE(scratch_.has("out.png"));
    EXPECT_NE(ran.out.find("left: error N401"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("--mirrored green repairs it"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("--mirrored red"), std::string::npos) << ran.out;
    EXPECT_EQ(go({"turned.png", "-o", "out.png", "--y", "up", "--likely"}).code, 1);
    EXPECT_FALSE(scratch_.has("out.png"));
    EXPECT_EQ(go({"turned.png", "-o", "out.png", "--y", "up", "--mirrored", "green"}).code, 0);
    EXPECT_EQ(bytes_of("out.png"), clean_);
    scratch_.add_sample("waves.png", "grey.png");
    EXPECT_EQ(go({"grey.png", "-o", "grey_out.png"}).code, 1);
    EXPECT_FALSE(scratch_.has("grey_out.png"));
    // Rules that are skipped do not count.
    EXPECT_EQ(go({"turned.png", "-o", "as_it_is.png", "--y", "up", "--skip", "N401"}).code, 0);
    EXPECT_TRUE(scratch_.has("as_it_is.png"));
}

TEST_F(RepairNormals, AnInputIsItsOwnOutputOnlyIfItIsNamed) {
    const std::string clean = scratch_.read("clean.png");
    EXPECT_EQ(go({"light.png", "--out-dir", "."}).code, 2);
    EXPECT_EQ(go({"bgr.png", "-o", "bgr.png"}).code, 0);
    EXPECT_EQ(bytes_of("bgr.png"), clean_);
    EXPECT_EQ(go({"clean.png", "-o", "clean.png"}).code, 0);
    EXPECT_EQ(scratch_.read("clean.png"), clean);
    std::filesystem::create_symlink(scratch_.path("light.png"), scratch_.path("link.png"));
    EXPECT_EQ(go({"light.png", "-o", "link.png"}).code, 2);
}

// A folder is repaired with its tree, or where it lies; what an earlier run wrote into it is no input.
TEST_F(RepairNormals, FoldersKeepTheirTreeOrAreRepairedInPlace) {
    const Ran made = shell(scratch_,
                           "mkdir -p art/deep art/.git && cp light.png bgr.png art && cp bgr.png art/deep && "
                           "cp bgr.png art/.git && cp clean.png waves.png art && echo text > art/notes.txt");
    ASSERT_EQ(made.code, 0) << made.err;
    for (const char* out_dir : {"mended", "art/mended", "art/mended"}) {
        const Ran ran = go({"art", "--out-dir", out_dir});
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_NE(ran.out.find("4 maps: 3 repaired, 1 without a fault to repair; 1 picture left out, which holds "
                               "no normals; 1 file left out, which is no picture\n"),
                  std::string::npos)
            << ran.out;
        EXPECT_EQ(bytes_of(std::string(out_dir) + "/deep/bgr.png"), clean_);
        EXPECT_FALSE(scratch_.has(std::string(out_dir) + "/waves.png"));
    }
    std::filesystem::remove_all(scratch_.path("art/mended"));
    const auto written = std::filesystem::last_write_time(scratch_.path("art/clean.png"));
    EXPECT_EQ(go({"art", "--in-place", "--dry-run"}).code, 0);
    EXPECT_NE(bytes_of("art/bgr.png"), clean_);
    std::filesystem::create_directory(scratch_.path("elsewhere"));
    scratch_.write("elsewhere/bgr.png", scratch_.read("bgr.png"));
    std::filesystem::create_symlink("../elsewhere/bgr.png", scratch_.path("art/link.png"));
    std::filesystem::create_directory_symlink("../elsewhere", scratch_.path("art/folder"));
    const Ran in_place = go({"art/", "--in-place"});
    EXPECT_EQ(in_place.code, 0);
    EXPECT_NE(in_place.out.find("; 2 files left out, which a link leads to"), std::string::npos) << in_place.out;
    EXPECT_EQ(scratch_.read("elsewhere/bgr.png"), scratch_.read("bgr.png"));
    EXPECT_EQ(bytes_of("art/bgr.png"), clean_);
    EXPECT_EQ(bytes_of("art/deep/bgr.png"), clean_);
    EXPECT_NE(bytes_of("art/.git/bgr.png"), clean_);
    EXPECT_EQ(std::filesystem::last_write_time(scratch_.path("art/clean.png")), written);
    const Ran packed = run(scratch_, "pack-normals", {"bgr.png", "--in-place"});
    EXPECT_NE(packed.err.find("--in-place; repair-normals --in-place writes over its inputs"), std::string::npos)
        << packed.err;
    const std::vector<std::vector<std::string>> refused = {{"bgr.png", "--in-place", "-o", "a.png"},
                                                           {"bgr.png", "--in-place", "--out-dir", "."},
                                                           {"-", "--in-place"},
                                                           {"bgr.png", "--in-place", "--no-clobber"}};
    for (const auto& line : refused) EXPECT_EQ(go(line).code, 2) << line.back();
    const Ran pack = run(scratch_, "pack-normals", {"art", "--out-dir", "x"});
    EXPECT_EQ(pack.code, 3);
    EXPECT_NE(pack.err.find("art: is a directory; name its files, such as 'art/*.png'"), std::string::npos) << pack.err;
}

TEST_F(RepairNormals, AnotherEncodingIsThatOfPackNormals) {
    ASSERT_EQ(run(scratch_, "pack-normals", {"clean.png", "-o", "packed.dds", "--format", "bc5"}).code, 0);
    ASSERT_EQ(go({"clean.png", "-o", "mended.dds", "--format", "bc5"}).code, 0);
    EXPECT_EQ(scratch_.read("mended.dds"), scratch_.read("packed.dds"));
    ASSERT_EQ(go({"light.png", "-o", "light.dds", "--format", "bc5"}).code, 0);
    const auto made = read_texture(scratch_.path("light.dds"));
    ASSERT_TRUE(made);
    EXPECT_EQ(made->format, Format::bc5_unorm);
}

// A clean map comes out as pack-normals writes it, byte for byte.
TEST_F(RepairNormals, ACleanMapIsWhatPackNormalsWrites) {
    for (const std::string format : {"rgb8", "rgb16", "bc5", "dxt5nm", "bc7", "rg8-snorm", "rgba32f"}) {
        for (const std::string file : {"a.dds", "a.ktx2", "a.png"}) {
            const std::vector<std::string> options = {"clean.png", "-o", file, "--format", format};
            scratch_.write(file, "");
            const Ran packed = run(scratch_, "pack-normals", options);
            if (packed.code != 0) continue;  // a file type that cannot hold it
            const std::string bytes = scratch_.read(file);
            scratch_.write(file, "");
            EXPECT_EQ(go(options).code, 0) << format << " " << file;
            EXPECT_TRUE(scratch_.read(file) == bytes) << format << " " << file;
        }
    }
}

TEST_F(RepairNormals, TheReportShowsBothMapsAndTheSteps) {
    damage("-separate -swap 0,2 -combine -set colorspace RGB -colorspace sRGB", "both.png");
    damage("-channel G -negate +channel", "turned.png");
    const std::vector<std::string> inputs = {"clean.png", "both.png", "turned.png", "absent.png"};
    const auto with = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = inputs;
        arguments.insert(arguments.end(), more.begin(), more.end());
        return go(arguments).code;
    };
    EXPECT_EQ(with({"--dry-run", "--likely", "--y", "up", "--report", "page.html", "--threads", "1"}), 3);
    const std::string page = scratch_.read("page.html");
    const auto has = [&](const std::string& text) { EXPECT_NE(page.find(text), std::string::npos) << text; };
    for (const char* text :
         {"data-other=", "before on the left, after on the right", "angle between before and after, degrees",
          ">exchange R and B</td><td>likely</td>", ">decode with the sRGB curve</td>", "Nothing was repaired.",
          ">refused</span>", ">repaired</span>", ">whole</span>", "href=\"#N401\"", "id=\"N302\"", "absent.png"})
        has(text);
    EXPECT_EQ(page.find("http://"), std::string::npos);
    EXPECT_EQ(with({"--dry-run", "--likely", "--y", "up", "--report", "again.html", "--threads", "3"}), 3);
    EXPECT_TRUE(scratch_.read("again.html") == page);
    // Its angle is that of compare-normals.
    damage("-gamma 2.2", "gamma.png");
    const Ran mended = shell(scratch_,
                             "set -e; repair-normals gamma.png -o mended.png --report gamma.html --no-sync;"
                             "compare-normals gamma.png mended.png --json");
    EXPECT_EQ(mended.code, 0) << mended.err;
    const std::string line = lines_of(mended.out).back();
    const double mean = nlohmann::json::parse(line)["degrees"]["mean"];
    EXPECT_NE(scratch_.read("gamma.html").find(fmt::format("<td>{:.2f}</td>", mean)), std::string::npos) << line;
    // It is no file that is read or written.
    const std::string clean = scratch_.read("clean.png");
    EXPECT_EQ(go({"clean.png", "--dry-run", "--report", "clean.png"}).code, 2);
    EXPECT_EQ(go({"clean.png", "-o", "out.png", "--report", "out.png"}).code, 2);
    EXPECT_EQ(go({"clean.png", "-o", "out.png", "--height", "waves.png", "--report", "waves.png"}).code, 2);
    std::filesystem::create_symlink("clean.png", scratch_.path("link.html"));
    EXPECT_EQ(go({"clean.png", "--dry-run", "--report", "link.html"}).code, 2);
    EXPECT_EQ(go({"clean.png", "-o", "out.png", "--update", "--report", "x.html"}).code, 2);
    EXPECT_EQ(scratch_.read("clean.png"), clean);
}

TEST_F(RepairNormals, ReadsAndWritesStreams) {
    const Ran ran = run(scratch_, "repair-normals", {"-", "-o", "-", "--container", "png"},
                        Setting{scratch_.read("bgr.png"), {}, {}});
    EXPECT_EQ(ran.code, 0) << ran.err;
    scratch_.write("out.png", ran.out);
    EXPECT_EQ(bytes_of("out.png"), clean_);
}

TEST_F(RepairNormals, SaysWhatItDoesNotTake) {
    EXPECT_EQ(go({"clean.png"}).code, 2);
    EXPECT_EQ(go({"clean.png", "-o", "a.png", "--only", "N999"}).code, 2);
    EXPECT_EQ(go({"clean.png", "--dry-run", "--depfile", "d"}).code, 2);
    EXPECT_EQ(go({"clean.png", "-o", "a.png", "--material", "m0"}).code, 2);
    EXPECT_EQ(go({"clean.png", "bgr.png", "--dry-run", "--height", "waves.png"}).code, 2);
    EXPECT_EQ(go({"clean.png", "-o", "waves.png", "--height", "waves.png"}).code, 2);
    scratch_.write("model.gltf", R"({"asset": {"version": "2.0"}})");
    for (const char* output : {"out.png", "out.gltf"}) {
        const Ran model = go({"model.gltf", "-o", output});
        EXPECT_EQ(model.code, 4);
        EXPECT_NE(model.err.find("no material uses a normal map"), std::string::npos) << model.err;
    }
}

// Slopes show that one of red and green is mirrored, and heights show which.
TEST_F(RepairNormals, HeightsDecideWhichChannelIsMirrored) {
    for (const std::string channel : {"R", "G"}) {
        damage("-channel " + channel + " -negate +channel", "mirrored.png");
        EXPECT_EQ(go({"mirrored.png", "-o", "out.png", "--y", "up"}).code, 1) << channel;
        EXPECT_FALSE(scratch_.has("out.png"));
        const Ran ran = go({"mirrored.png", "-o", "out.png", "--y", "up", "--height", "waves.png"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_NE(ran.out.find("invert " + channel + " (safe)"), std::string::npos) << ran.out;
        EXPECT_TRUE(bytes_of("out.png") == clean_) << channel;
        EXPECT_EQ(shell(scratch_, "rm out.png").code, 0);
    }
}

TEST_F(RepairNormals, IsAStepOfManifests) {
    const auto write = [&](const std::string& options) {
        scratch_.write("normals.toml",
                       "version = 1\n[[rule]]\nmatch = \"in/*.png\"\nout-dir = \"out\"\n"
                       "name = \"{stem}.png\"\nsteps = [ { repair = { " +
                           options + " } } ]\n");
    };
    const auto build = [&] { return run(scratch_, "build-normals", {"--no-sync"}); };
    ASSERT_EQ(shell(scratch_, "mkdir in; cp clean.png bgr.png in").code, 0);
    write("");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(scratch_.read("out/clean.png"), scratch_.read("clean.png"));
    EXPECT_EQ(bytes_of("out/bgr.png"), clean_);
    EXPECT_NE(build().out.find("0 made, 2 up to date"), std::string::npos);
    // Green that is mirrored, if it is one: likely, and so an error unless the manifest takes that.
    damage("-channel G -negate +channel", "in/down.png");
    write("y = \"up\", likely = true");
    const Ran refused = build();
    EXPECT_EQ(refused.code, 4);
    EXPECT_NE(refused.err.find("in/down.png: cannot be repaired: N401"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("mirrored = \"green\""), std::string::npos) << refused.err;
    EXPECT_FALSE(scratch_.has("out/down.png"));
    write("y = \"up\", mirrored = \"green\"");
    EXPECT_EQ(build().code, 0);
    EXPECT_EQ(bytes_of("out/down.png"), clean_);
    write("dry-run = true");
    EXPECT_EQ(build().code, 2);
    // No picture that holds no normals becomes a texture.
    write("likely = true");
    scratch_.add_sample("waves.png", "in/waves.png");
    EXPECT_EQ(build().code, 4);
    EXPECT_FALSE(scratch_.has("out/waves.png"));
}

TEST_F(RepairNormals, TheManualHasTheClassOfEveryRule) {
    std::ifstream page(TEX_BINARY_DIR "/man/check-normals.1");
    const std::string manual{std::istreambuf_iterator<char>(page), {}};
    for (const Rule& rule : rules()) {
        std::string classes;
        for (const RuleRepair& row : rule_repairs()) {
            const std::string name(name_of(kRepairClassNames, row.certainty));
            if (row.rule == rule.id && classes.find(name) == std::string::npos)
                classes += (classes.empty() ? "" : " or ") + name;
        }
        if (rule.id == "N112") classes += " or choice";
        for (const char* unsure : {"N221", "N301", "N302", "N314"}) classes += rule.id == unsure ? " or likely" : "";
        const std::size_t at = manual.find(fmt::format(".It Sy {} Li {} Pq ", rule.id, rule.name));
        ASSERT_NE(at, std::string::npos) << rule.id;
        const std::string line = manual.substr(at, manual.find('\n', at) - at);
        EXPECT_EQ(line.find(", repair ") == std::string::npos, classes.empty()) << line;
        if (!classes.empty()) {
            EXPECT_TRUE(line.ends_with(", repair " + classes)) << line;
        }
    }
}

}  // namespace tex::cli
