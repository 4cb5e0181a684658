// SPDX-License-Identifier: Apache-2.0

#include <cstring>
#include <string>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class BlendNormals : public testing::Test {
protected:
    BlendNormals() {
        scratch_.add_sample("bricks.png", "bricks.png");
        scratch_.add_sample("waves.png", "waves.png");
        does("bake-normals", {"bricks.png", "-o", "base.exr", "--bumpiness", "8", "--format", "float"});
        does("bake-normals", {"waves.png", "-o", "detail.exr", "--bumpiness", "4", "--format", "float"});
        does("scale-normals", {"detail.exr", "-o", "flat.exr", "--scale", "0"});
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    void does(const std::string& command, const std::vector<std::string>& arguments) {
        const Ran ran = go(command, arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err, "");
    }
    void refuses(const std::vector<std::string>& arguments, const std::string& part) {
        const Ran ran = go("blend-normals", arguments);
        EXPECT_EQ(ran.code, 2) << part;
        EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
    }
    double angle(const std::string& a, const std::string& b) {
        const auto map = [&](const std::string& name) {
            auto chain = unpack(*read_texture(scratch_.path(name)));
            EXPECT_TRUE(chain);
            return std::move(chain->levels.front());
        };
        const auto compared = compare(map(a), map(b));
        EXPECT_TRUE(compared);
        return compared->error.max;
    }
    Scratch scratch_;
};

TEST_F(BlendNormals, AFlatDetailLeavesTheBase) {
    for (const std::string mode : {"whiteout", "partial-derivative", "rnm", "udn"}) {
        does("blend-normals", {"base.exr", "flat.exr", "-o", "x.exr", "--mode", mode});
        EXPECT_LT(angle("x.exr", "base.exr"), 1e-4) << mode;
    }
    does("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr", "--strength", "0"});
    EXPECT_LT(angle("x.exr", "base.exr"), 1e-4);
    does("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr"});
    EXPECT_GT(angle("x.exr", "base.exr"), 5.0);
}

TEST_F(BlendNormals, LayersTakeTheirOwnOptionsOrShareOne) {
    does("blend-normals", {"base.exr", "detail.exr", "flat.exr", "-o", "one.exr", "--tiling", "4"});
    does("blend-normals", {"base.exr", "detail.exr", "flat.exr", "-o", "each.exr", "--tiling", "4", "--tiling", "2,3"});
    EXPECT_LT(angle("one.exr", "each.exr"), 1e-4);
    does("blend-normals",
         {"base.exr", "detail.exr", "detail.exr", "-o", "none.exr", "--strength", "0", "--strength", "0"});
    EXPECT_LT(angle("none.exr", "base.exr"), 1e-4);
    refuses({"base.exr", "detail.exr", "flat.exr", "flat.exr", "-o", "x.exr", "--tiling", "4", "--tiling", "2"},
            "--tiling is given 2 times for 3 details");
    for (const std::string option :
         {"--tiling", "--detail-scale", "--rotate", "--strength", "--detail-wrap", "--offset"}) {
        const std::string value = option == "--detail-wrap" ? "clamp" : option == "--offset" ? "0.25,0.5" : "0.5";
        does("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr", "--tiling", "2"});
        std::vector<std::string> arguments = {"base.exr", "detail.exr", "-o", "changed.exr", option, value};
        arguments.insert(arguments.end(), {"--wrap", "clamp"});
        if (option != "--tiling") arguments.insert(arguments.end(), {"--tiling", "2"});
        does("blend-normals", arguments);
        EXPECT_GT(angle("x.exr", "changed.exr"), 0.1) << option;
    }
}

TEST_F(BlendNormals, MasksChooseWhereDetailShows) {
    does("blend-normals", {"base.exr", "detail.exr", "-o", "masked.exr", "--mask", "bricks.png:r"});
    EXPECT_GT(angle("masked.exr", "base.exr"), 1.0);
    scratch_.write("not:a:picture", "");
    EXPECT_EQ(go("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr", "--mask", "not:a:picture"}).code, 4);
    EXPECT_EQ(go("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr", "--mask", "missing.png:a"}).code, 3);
}

TEST_F(BlendNormals, OneDetailGoesOnManyBases) {
    does("blend-normals", {"base.exr", "detail.exr", "-o", "single.dds", "--tiling", "4", "--effort", "fast"});
    does("bake-normals", {"bricks.png", "-o", "other.exr", "--bumpiness", "2", "--format", "float"});
    const Ran ran =
        go("blend-normals", {"base.exr", "other.exr", "--detail", "detail.exr", "--tiling", "4", "--out-dir", "out",
                             "--name", "{stem}.dds", "--effort", "fast", "--json", "--depfile", "d"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(lines_of(ran.out).size(), 2u);
    EXPECT_TRUE(scratch_.read("out/base.dds") == scratch_.read("single.dds"));
    EXPECT_EQ(scratch_.read("d"),
              "out/base.dds: \\\n  base.exr \\\n  detail.exr\nout/other.dds: \\\n  other.exr \\\n  detail.exr\n");
}

TEST_F(BlendNormals, WhatADetailHasBesideItsNormalsIsMissedAloud) {
    does("pack-normals", {"detail.exr", "-o", "d.png", "--format", "rgba8", "--alpha", "detail.exr:r"});
    const Ran ran = go("blend-normals", {"base.exr", "d.png", "-o", "x.exr"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(
        ran.err,
        "blend-normals: warning: d.png: data beside the normals, in A, are not blended: the output has there what "
        "the base has (--drop silences this warning)\n");
    does("blend-normals", {"base.exr", "d.png", "-o", "x.exr", "--drop"});
    does("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr"});
}

// Where a mask shows the detail, alpha is that of the detail, too: the judge is ImageMagick's own mixture.
TEST_F(BlendNormals, DataBesideTheNormalsFollowTheMask) {
    const Ran ready =
        shell(scratch_,
              "set -e; bake-normals bricks.png -o base.png --bumpiness 8; convert waves.png -resize '512x512!' w.png\n"
              "bake-normals w.png -o detail.png --bumpiness 4\n"
              "size=$(identify -format '%wx%h!' base.png)\n"
              "convert waves.png -resize \"$size\" -depth 8 a.png; convert a.png -negate -level 20%,90% b.png\n"
              "convert bricks.png -resize \"$size\" -depth 8 m.png\n"
              "pack-normals base.png -o ba.png --format rgba8 --alpha a.png\n"
              "pack-normals detail.png -o da.png --format rgba8 --alpha b.png\n"
              "convert a.png b.png m.png -compose over -composite wanted.png\n");
    ASSERT_EQ(ready.code, 0) << ready.err;
    const auto differs_by = [&](const std::string& options) {
        does("blend-normals", {"ba.png", "da.png", "-o", "x.png", "--mask", "m.png", "--format", "rgba8", options});
        const Ran ran = shell(scratch_,
                              "convert x.png -alpha extract x_a.png; "
                              "compare -metric PAE x_a.png wanted.png null: 2>&1 | sed 's/.*(//; s/).*//'");
        return std::stod(ran.out) * 255.0;
    };
    EXPECT_LT(differs_by("--quiet"), 1.5) << "nothing was said, and alpha is mixed";
    const Ran plain = go("blend-normals", {"ba.png", "da.png", "-o", "x.png", "--format", "rgba8"});
    EXPECT_NE(plain.err.find("data beside the normals, in A, are not blended"), std::string::npos) << plain.err;
    const Ran given = go("blend-normals", {"ba.png", "da.png", "-o", "x.png", "--mask", "m.png", "--alpha", "a.png"});
    EXPECT_NE(given.err.find("in A, are not blended"), std::string::npos) << given.err;
    // A detail that repeats is sampled as its normals are, and one without alpha leaves that of the base.
    does("blend-normals", {"ba.png", "da.png", "-o", "y.png", "--mask", "m.png", "--tiling", "2", "--format", "rgba8"});
    does("blend-normals", {"ba.png", "detail.png", "-o", "z.png", "--mask", "m.png", "--format", "rgba8"});
    EXPECT_EQ(shell(scratch_, "convert z.png -alpha extract z_a.png; compare -metric AE z_a.png a.png null:").err, "0");
}

// A detail is read and filtered once. One as large as the base, whose rows could be read in step, is no exception.
TEST_F(BlendNormals, ManyBasesShareWhatIsReadOfTheirDetails) {
    const Ran ready =
        shell(scratch_,
              "set -e; mkdir in; bake-normals bricks.png -o in/large.exr --bumpiness 2 --format half\n"
              "mip-normals in/large.exr -o in/1.exr --max-size 64 --mips none --format half\n"
              "for k in $(seq 2 12); do cp in/1.exr in/$k.exr; done\n"
              "convert waves.png -resize '512x512!' big.png; convert waves.png -resize '16x16!' tiny.png\n"
              "for k in big tiny; do bake-normals $k.png -o ${k}_n.png --bumpiness 4; done\n");
    ASSERT_EQ(ready.code, 0) << ready.err;
    // Calls of the system for each base after the first two.
    const auto calls_each = [&](const std::string& detail) {
        int counts[2] = {};
        for (int k = 0; k < 2; ++k) {
            scratch_.write("calls", std::string(sizeof(int), '\0'));
            const Ran ran = shell(scratch_, std::string("rm -rf out; LD_PRELOAD=" TEX_BINARY_DIR "/faults.so ") +
                                                "TEX_FAULT_COUNT=calls blend-normals " +
                                                (k == 0 ? "in/[12].exr" : "in/[1-9].exr in/1?.exr") + " --detail " +
                                                detail + " --out-dir out --threads 1 --no-sync --quiet");
            EXPECT_EQ(ran.code, 0) << ran.err;
            std::memcpy(&counts[k], scratch_.read("calls").data(), sizeof(int));
        }
        return (counts[1] - counts[0]) / 10.0;
    };
    EXPECT_EQ(calls_each("big_n.png"), calls_each("tiny_n.png"));
    for (const std::string options : {"--tiling 2", "--tiling 1", "--tiling 0.5 --detail-wrap mirror", "--tiling 9"}) {
        const std::string details = " --detail big_n.png --detail detail.exr --no-sync --quiet " + options;
        const Ran ran = shell(scratch_, "set -e; rm -rf out; blend-normals in/*.exr --out-dir out" + details +
                                            "\nfor k in 7 large; do blend-normals in/$k.exr -o one.exr" + details +
                                            "; cmp one.exr out/$k.exr; done");
        EXPECT_EQ(ran.code, 0) << options << ran.out << ran.err;
    }
}

TEST_F(BlendNormals, WhatADetailSaysOfItsYCountsBeforeThatOfTheBase) {
    does("pack-normals", {"detail.exr", "-o", "down.exr", "--y", "down", "--format", "float"});
    does("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr", "--format", "float"});
    does("blend-normals", {"base.exr", "down.exr", "-o", "y.exr", "--format", "float", "--y-in", "up"});
    EXPECT_LT(angle("x.exr", "y.exr"), 1e-3);
    const Ran wrong =
        go("blend-normals", {"base.exr", "down.exr", "-o", "y.exr", "--format", "float", "--detail-y-in", "up"});
    EXPECT_NE(wrong.err.find("down.exr: green is stated to point up, but the texels show the other"), std::string::npos)
        << wrong.err;
    EXPECT_GT(angle("x.exr", "y.exr"), 1.0);
}

TEST_F(BlendNormals, ResultsHaveTheBaseSizeAndTheirOwnLevels) {
    const auto report = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--json", "--effort", "fast"});
        const Ran ran = go("blend-normals", arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return nlohmann::json::parse(ran.out);
    };
    const auto whole = report({"base.exr", "detail.exr", "-o", "x.dds"});
    EXPECT_EQ(whole["extent"], (std::vector<int>{512, 512}));
    EXPECT_EQ(whole["levels"], 10);
    EXPECT_EQ(whole["format"], "dxt5nm");
    const auto small = report({"base.exr", "detail.exr", "-o", "x.exr", "--extent", "100x60"});
    EXPECT_EQ(small["extent"], (std::vector<int>{100, 60}));
    EXPECT_EQ(small["format"], "float");
}

TEST_F(BlendNormals, ADetailThatIsStretchedIsSaidAndTheAdviceKeepsItsShape) {
    does("blend-normals", {"base.exr", "-o", "wide.exr", "--extent", "512x256"});
    const Ran ran = go("blend-normals", {"wide.exr", "detail.exr", "-o", "x.exr", "--tiling", "8"});
    EXPECT_EQ(ran.code, 0);
    const std::string advice = "is stretched 2 to 1 on the base of 512x256; a tiling of 8,4 keeps its shape";
    EXPECT_NE(ran.err.find("detail.exr: " + advice), std::string::npos) << ran.err;
    does("blend-normals", {"wide.exr", "detail.exr", "-o", "x.exr", "--tiling", "8,4"});
    // What counts is the shape of the result.
    does("blend-normals", {"wide.exr", "detail.exr", "-o", "x.exr", "--extent", "64x64", "--offset", "0.5,0"});
    const Ran result = go("blend-normals", {"base.exr", "detail.exr", "-o", "x.exr", "--extent", "512x256"});
    EXPECT_NE(result.err.find("detail.exr: is stretched 2 to 1 in the result of 512x256"), std::string::npos)
        << result.err;
}

TEST_F(BlendNormals, ABaseAloneGetsAnotherSize) {
    does("blend-normals", {"base.exr", "-o", "alone.exr", "--extent", "40x40"});
    does("blend-normals", {"base.exr", "flat.exr", "-o", "flat_on_it.exr", "--extent", "40x40"});
    EXPECT_LT(angle("alone.exr", "flat_on_it.exr"), 0.01);
    for (const char* option : {"--tiling", "--strength", "--rotate"})
        refuses({"base.exr", "-o", "x.exr", "--extent", "40x40", option, "1"}, " is for a detail, and there is none");
}

TEST_F(BlendNormals, MisuseIsRefused) {
    refuses({"base.exr", "-o", "x.dds"}, "no detail: give BASE DETAIL... -o FILE");
    refuses({"base.exr", "detail.exr", "--out-dir", "out"}, "no detail");
    refuses({"base.exr", "detail.exr", "-o", "detail.exr"}, "the output detail.exr is the input detail.exr");
    scratch_.write("list", "base.exr detail.exr\n");
    refuses({"@list", "-o", "list", "--container", "exr"}, "the output list is the file of @list");
    refuses({"base.exr", "--detail", "detail.exr", "-o", "detail.exr"},
            "the output detail.exr is the input detail.exr");
    refuses({"base.exr", "detail.exr", "-o", "x.dds", "--mask", "bricks.png", "--depfile", "bricks.png"},
            "is the input bricks.png");
    refuses({"base.exr", "detail.exr", "-o", "x.dds", "--tiling", "0"}, "--tiling: 0 is not greater than 0");
    refuses({"base.exr", "detail.exr", "-o", "x.dds", "--offset", "1"}, "--offset: '' is not a number");
    refuses({"base.exr", "detail.exr", "-o", "x.dds", "--strength", "1.5"},
            "--strength: 1.5 is not at least 0 and at most 1");
    refuses({"base.exr", "detail.exr", "-o", "x.dds", "--mode", "whitout"}, "did you mean whiteout?");
    refuses({"base.exr", "detail.exr", "-o", "x.dds", "--extent", "0x5"}, "--extent: 0 is not at least 1");
    refuses({"base.exr", "detail.exr", "-o", "x.dds", "--extent", "65536"},
            "--extent: 65536x65536 texels are more than the limit of 1073741824; --max-texels raises it");
}

// Wrong in the picture, and nothing of it shows in an exit code: each was silent once.
TEST_F(BlendNormals, SaysWhatThePlaceOfADetailCosts) {
    const auto warnings = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"base.exr", "detail.exr", "-o", "o.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ran ran = go("blend-normals", arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return ran.err;
    };
    const auto has = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    ASSERT_EQ(probe(scratch_.path("base.exr"))->width, 512);
    ASSERT_EQ(probe(scratch_.path("detail.exr"))->width, 128);
    EXPECT_EQ(warnings({"--tiling", "8"}), "");
    has(warnings({"--tiling", "16"}),
        "detail.exr: repeats so often that its 128x128 texels shrink to 32x32; an extent of 2048x2048 keeps its finest "
        "bumps, and one that is given, such as 512x512, is taken without this warning");
    const Ran larger = go("blend-normals", {"detail.exr", "base.exr", "-o", "larger.exr"});
    has(larger.err, "base.exr: is larger than the result: its 512x512 texels shrink to 128x128; an extent of 512x512 ");
    for (const char* extent : {"512x512", "2048x2048"}) EXPECT_EQ(warnings({"--tiling", "16", "--extent", extent}), "");
    has(warnings({"--tiling", "2.5"}),
        "detail.exr: repeats 2.5 times, so that the result has seams where it repeats; a wrap of clamp says that it "
        "does not repeat");
    has(warnings({"--rotate", "30"}), "detail.exr: is rotated by 30 degrees, so that");
    for (const char* option : {"--tiling", "--rotate"}) EXPECT_EQ(warnings({option, "2.5", "--wrap", "clamp"}), "");
    EXPECT_EQ(warnings({"--tiling", "2", "--rotate", "90"}), "");
}

// The luma of a normal map, or of colours, is no mask.
TEST_F(BlendNormals, AMaskOfColoursNeedsAChannel) {
    does("pack-normals", {"detail.exr", "-o", "n.png", "--mips", "none"});
    const Ran ran = go("blend-normals", {"base.exr", "detail.exr", "-o", "o.exr", "--mask", "n.png"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.err.find("n.png: its channels differ (R is "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("name the one that is the mask, such as --mask n.png:r"), std::string::npos) << ran.err;
    EXPECT_EQ(go("blend-normals", {"base.exr", "detail.exr", "-o", "o.exr", "--mask", "n.png:r"}).code, 0);
    // Lossy and block-compressed grey is grey.
    EXPECT_EQ(shell(scratch_, "convert waves.png -colorspace gray waves.jpg").code, 0);
    EXPECT_EQ(go("blend-normals", {"base.exr", "detail.exr", "-o", "o.exr", "--mask", "waves.jpg"}).code, 0);
}

}  // namespace tex::cli
