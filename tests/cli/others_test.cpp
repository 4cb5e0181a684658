// SPDX-License-Identifier: Apache-2.0
// --blue, --alpha, --kind, --layout, --blue-out, --alpha-out: data beside the normals, from file to file.

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

class Others : public testing::Test {
protected:
    Others() {
        std::filesystem::copy_file(TEX_SOURCE_DIR "/samples/bricks.png", scratch_.path("h.png"));
        run("bake-normals h.png -o n.png --bumpiness 6");
        run("preview-normals n.png -o ao.png --show lit --size 512 --no-legend");
    }
    void run(const std::string& line) const {
        const Ran ran = shell(scratch_, line + " --no-sync --quiet");
        ASSERT_EQ(ran.code, 0) << line << '\n' << ran.err;
    }
    void refuses(const std::string& line, int code, const std::string& words) {
        const auto before = scratch_.list();
        const Ran ran = shell(scratch_, line);
        EXPECT_EQ(ran.code, code) << line << '\n' << ran.err;
        EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before) << line;
    }
    [[nodiscard]] Image image(const std::string& name) const { return read_image(scratch_.path(name)).value(); }
    // Whether a channel of a file equals one of another file, to the last code of 8 bits.
    [[nodiscard]] bool equal(const std::string& a, std::size_t channel, const std::string& b, std::size_t other) const {
        const Image left = image(a), right = image(b);
        if (left.extent() != right.extent() || left.planes.size() <= channel || right.planes.size() <= other)
            return false;
        for (int j = 0; j < left.extent().height; ++j) {
            for (int i = 0; i < left.extent().width; ++i) {
                if (std::abs(left.planes[channel].at(i, j) - right.planes[other].at(i, j)) > 0.51f / 255.0f)
                    return false;
            }
        }
        return true;
    }

    Scratch scratch_;
};

TEST_F(Others, HeightsGoIntoAlpha) {
    run("bake-normals h.png -o nh.png --format rgba8 --alpha height --bumpiness 6");
    EXPECT_TRUE(equal("nh.png", 3, "h.png", 0));
    EXPECT_TRUE(equal("nh.png", 0, "n.png", 0));
    run("bake-normals h.png -o nh.dds --format rgba8 --alpha height --kind height --bumpiness 6");
    EXPECT_TRUE(equal("nh.dds", 3, "h.png", 0));
}

TEST_F(Others, ALayoutRoundTrips) {
    run("pack-normals n.png -o pbr.png --layout labpbr --blue ao.png:g --alpha h.png");
    EXPECT_TRUE(equal("pbr.png", 2, "ao.png", 1));
    EXPECT_TRUE(equal("pbr.png", 3, "h.png", 0));
    run("unpack-normals pbr.png -o back.png --swizzle rg --y-in down --y up --blue-out ao2.png --alpha-out h2.png");
    EXPECT_TRUE(equal("ao2.png", 0, "ao.png", 1));
    EXPECT_TRUE(equal("h2.png", 0, "h.png", 0));
    EXPECT_EQ(shell(scratch_, "compare-normals n.png back.png --max 1.5").code, 0);
    // What is kept stays, through another container and a smaller level.
    run("mip-normals pbr.png -o pbr.dds --swizzle rg --blue keep --format rgba8 --kind occlusion,height");
    EXPECT_TRUE(equal("pbr.dds", 2, "ao.png", 1));
    EXPECT_TRUE(equal("pbr.dds", 3, "h.png", 0));
    run("scale-normals pbr.dds -o flat.dds --scale 0.5 --blue keep");
    EXPECT_TRUE(equal("flat.dds", 2, "ao.png", 1));
    run("blend-normals pbr.dds n.png -o blend.ktx2 --format rgba8");
    EXPECT_TRUE(equal("blend.ktx2", 3, "h.png", 0));
}

// ImageMagick takes apart what we have put together, and we what it has: alpha is unassociated.
TEST_F(Others, OtherProgramsSeeTheSameAlpha) {
    for (const std::string type : {"png", "tga", "dds"}) {
        run("pack-normals n.png -o both." + type + " --format rgba8 --alpha h.png");
        ASSERT_EQ(shell(scratch_, "convert both." + type + " -auto-orient -alpha extract -depth 8 a.png").code, 0);
        EXPECT_TRUE(equal("a.png", 0, "h.png", 0)) << type;
        ASSERT_EQ(shell(scratch_, "convert both." + type + " -auto-orient -alpha off -depth 8 rgb.png").code, 0);
        EXPECT_TRUE(equal("rgb.png", 0, "n.png", 0)) << type << ": colours are not multiplied by alpha";
    }
    const std::string theirs =
        "convert n.png h.png -alpha off -compose CopyOpacity -composite -depth 8 PNG32:theirs.png;"
        "convert theirs.png -alpha extract -depth 8 a.png";
    ASSERT_EQ(shell(scratch_, theirs).code, 0);
    run("pack-normals theirs.png -o ours.dds --format rgba8");
    EXPECT_TRUE(equal("ours.dds", 3, "a.png", 0));
    EXPECT_TRUE(equal("ours.dds", 0, "n.png", 0));
}

TEST_F(Others, PatternsNameAFileForEachInput) {
    std::filesystem::create_directory(scratch_.path("in"));
    for (const std::string name : {"a", "b"}) {
        std::filesystem::copy_file(scratch_.path("n.png"), scratch_.path("in/" + name + "_n.png"));
        std::filesystem::copy_file(scratch_.path("h.png"), scratch_.path("in/" + name + "_h.png"));
    }
    run("pack-normals in/a_n.png in/b_n.png --out-dir out --name '{stem}.tga' --format rgba8 --alpha "
        "'{dir}/{stem:-_n}_h.png'");
    EXPECT_TRUE(equal("out/b_n.tga", 3, "h.png", 0));
}

TEST_F(Others, WhatCannotBeIsOneError) {
    refuses("mip-normals n.png -o x.dds --format bc5 --blue ao.png:g --kind roughness", 2,
            "bc5 has no room for --blue; these formats have: rgb8");
    refuses("pack-normals n.png -o x.png --layout labpbr", 2, "give --blue FILE, or --blue 1 for none");
    refuses("pack-normals n.png -o x.png --layout skyrim --blue ao.png", 2, "--layout skyrim has z in blue");
    refuses("pack-normals n.png -o x.png --format rgba8 --alpha 2", 2, "--alpha");
    refuses("pack-normals n.png -o x.png --format rgba8 --alpha none.png", 3, "none.png");
    refuses("pack-normals n.png -o h.png --format rgba8 --alpha h.png", 2, "h.png");
    refuses("unpack-normals n.png -o x.png --alpha-out y.png", 4, "has no alpha beside the normals");
    refuses("unpack-normals n.png -o x.png --alpha-out n.png", 2, "n.png");
}

}  // namespace
}  // namespace tex::cli
