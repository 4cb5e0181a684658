// SPDX-License-Identifier: Apache-2.0
// bake-normals --occlusion-out, --sky-view-out, --bent-out, --horizon-out, --blue occlusion: what heights hide, beside
// their normals; the same of integrate-normals.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

class BakeOcclusion : public testing::Test {
protected:
    BakeOcclusion() { std::filesystem::copy_file(TEX_SOURCE_DIR "/samples/bricks.png", scratch_.path("h.png")); }
    Ran run(const std::string& line) const {
        Ran ran = shell(scratch_, line + " --no-sync");
        EXPECT_EQ(ran.code, 0) << line << '\n' << ran.err;
        return ran;
    }
    void refuses(const std::string& line, const std::string& words) {
        const auto before = scratch_.list();
        const Ran ran = shell(scratch_, line);
        EXPECT_EQ(ran.code, 2) << line << '\n' << ran.err;
        EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before) << line;
    }
    [[nodiscard]] Image image(const std::string& name) const { return read_image(scratch_.path(name)).value(); }
    // The largest difference between a channel of a file and a plane.
    [[nodiscard]] float difference(const std::string& name, std::size_t channel, const Plane<float>& plane) const {
        const Image picture = image(name);
        EXPECT_EQ(picture.extent(), plane.extent());
        float largest = 0.0f;
        for (int j = 0; j < plane.extent().height; ++j) {
            for (int i = 0; i < plane.extent().width; ++i)
                largest = std::max(largest, std::abs(picture.planes[channel].at(i, j) - plane.at(i, j)));
        }
        return largest;
    }
    // What the library makes of the sample.
    [[nodiscard]] OcclusionMaps maps(const OcclusionOptions& options, float blur = 0.0f) const {
        HeightOptions heights;
        heights.blur_sigma = blur;
        auto field = height_field(image("h.png"), heights);
        field->bumpiness_x = field->bumpiness_y = 6.0f;
        return std::move(*occlusion(*field, options));
    }

    Scratch scratch_;
};

// ImageMagick makes and reads the texture of three maps.
TEST_F(BakeOcclusion, GoesIntoAChannelOfAnotherTexture) {
    const std::string size = "$(identify -format %wx%h h.png)";
    ASSERT_EQ(shell(scratch_, "convert -size " + size + " xc:'rgb(1,100,200)' -define png:color-type=2 orm.png").code,
              0);
    const std::string bake = "bake-normals h.png -o n.png --bumpiness 6 --occlusion-out ";
    run(bake + "ao.exr");
    run(bake + "ao_orm.png --occlusion-into orm.png");
    EXPECT_LE(difference("ao_orm.png", 0, image("ao.exr").planes[0]), 0.501f / 255.0f);
    const Ran rest =
        shell(scratch_, "convert ao_orm.png -channel GB -separate -format '%k %[fx:round(255*mean)],' info:");
    EXPECT_EQ(rest.out, "1 100,1 200,") << "the other channels are as before";
    EXPECT_EQ(image("ao_orm.png").normal_mark, "") << "it holds no normals";
    run(bake + "blue.png --occlusion-into orm.png:b");
    EXPECT_LE(difference("blue.png", 2, image("ao.exr").planes[0]), 0.501f / 255.0f);
    refuses("bake-normals h.png -o n.png --occlusion-into orm.png", "--occlusion-into needs --occlusion-out");
    refuses(bake + "orm.png --occlusion-into orm.png", "orm.png");
    refuses(bake + "x.png --occlusion-into orm.png:luma", "is not one of r, g, b, a");
    ASSERT_EQ(shell(scratch_, "convert -size 7x7 xc:white -define png:color-type=2 small.png").code, 0);
    const Ran small = shell(scratch_, "rm n.png; " + bake + "x.png --occlusion-into small.png");
    EXPECT_EQ(small.code, 4);
    EXPECT_FALSE(scratch_.has("x.png") || scratch_.has("n.png")) << "nothing is written";
    EXPECT_NE(small.err.find("small.png: is 7x7 texels, and the occlusion is "), std::string::npos) << small.err;
    EXPECT_NE(shell(scratch_, bake + "x.png --occlusion-into orm.png:a").err.find("has no channel A"),
              std::string::npos);
}

TEST_F(BakeOcclusion, FilesHoldWhatTheLibraryMakes) {
    const Ran ran = run(
        "bake-normals h.png -o n.png --bumpiness 6 --occlusion-out ao.png --sky-view-out sky.exr --bent-out bent.png "
        "--occlusion-directions 12 --json");
    const auto report = nlohmann::json::parse(ran.out);
    EXPECT_EQ(report["occlusion"]["output"], "ao.png");
    EXPECT_EQ(report["sky_view"]["output"], "sky.exr");
    EXPECT_EQ(report["bent"]["output"], "bent.png");
    const OcclusionMaps is = maps({12, 0.0f, true, true, true});
    EXPECT_LT(difference("ao.png", 0, is.occlusion), 1.0f / 65535.0f);
    EXPECT_EQ(difference("sky.exr", 0, is.sky_view), 0.0f);
    const auto bent = read_normals(scratch_.path("bent.png"));
    ASSERT_TRUE(bent);
    EXPECT_LT(std::abs(bent->chain.levels[0].x.at(100, 50) - is.bent.x.at(100, 50)), 0.01f);
    // The normals are those of a bake without maps beside them.
    run("bake-normals h.png -o alone.png --bumpiness 6");
    EXPECT_EQ(scratch_.read("n.png"), scratch_.read("alone.png"));
}

TEST_F(BakeOcclusion, OcclusionGoesBesideTheNormals) {
    run("bake-normals h.png -o nb.png --format rgba8 --bumpiness 6 --blue occlusion --alpha height --blur 1.5");
    const OcclusionMaps is = maps({}, 1.5f);
    EXPECT_LE(difference("nb.png", 2, is.occlusion), 0.51f / 255.0f);
    EXPECT_LE(difference("nb.png", 3, image("h.png").planes[0]), 1.0f);
    run("bake-normals h.png -o nl.png --format rgb16 --bumpiness 6 --length occlusion --occlusion-distance 20");
    // LabPBR of heights alone: green down, occlusion in blue, heights in alpha.
    run("bake-normals h.png -o pbr.png --layout labpbr --bumpiness 6");
    run("bake-normals h.png -o down.png --format rgba8 --bumpiness 6 --y down");
    EXPECT_LE(difference("pbr.png", 2, maps({}).occlusion), 0.51f / 255.0f);
    EXPECT_EQ(difference("pbr.png", 1, image("down.png").planes[1]), 0.0f);
    EXPECT_LE(difference("pbr.png", 3, image("h.png").planes[0]), 0.51f / 255.0f);
}

TEST_F(BakeOcclusion, HorizonsAreSlicesOneBelowTheOther) {
    const Ran ran =
        run("bake-normals h.png -o n.png --bumpiness 6 --horizon-out hor.png --horizon-directions 5 --json");
    const auto report = nlohmann::json::parse(ran.out);
    EXPECT_EQ(report["horizons"]["output"], "hor.png");
    EXPECT_EQ(report["horizons"]["directions"], 5);
    const OcclusionMaps is = maps({4, 0.0f, false, false, false, 5});
    const Extent extent = is.horizons.front().extent();
    const Image picture = image("hor.png");
    ASSERT_EQ(picture.extent(), (Extent{extent.width, 5 * extent.height}));
    for (int j = 0; j < 5 * extent.height; j += 3) {
        const Plane<float>& slice = is.horizons[static_cast<std::size_t>(j / extent.height)];
        for (int i = 0; i < extent.width; i += 5)
            ASSERT_NEAR(picture.planes[0].at(i, j), slice.at(i, j % extent.height), 1.0f / 65535.0f) << i << ' ' << j;
    }
    EXPECT_FALSE(report.contains("occlusion"));
}

TEST_F(BakeOcclusion, NormalsComeBackAsTheOcclusionOfTheirHeights) {
    run("bake-normals h.png -o n.exr --format float --bumpiness 6 --occlusion-out ao.exr --bent-out bent.png --y down "
        "--horizon-out hor.exr");
    run("integrate-normals n.exr -o back.png --bumpiness 6 --y-in down --occlusion-out ao2.exr --sky-view-out sky2.png "
        "--bent-out bent2.png --horizon-out hor2.exr");
    // Whatever the strength of the stored heights is.
    run("integrate-normals n.exr -o back2.png --bumpiness 60 --y-in down --occlusion-out ao3.exr");
    const Image own = image("ao.exr"), bent = image("bent.png"), horizons = image("hor.exr");
    double sum = 0.0;
    EXPECT_LT(difference("ao2.exr", 0, own.planes[0]), 0.12f);
    EXPECT_LT(difference("ao3.exr", 0, image("ao2.exr").planes[0]), 0.01f);
    const Image back = image("ao2.exr");
    for (int j = 0; j < own.extent().height; ++j) {
        for (int i = 0; i < own.extent().width; ++i)
            sum += static_cast<double>(std::abs(back.planes[0].at(i, j) - own.planes[0].at(i, j)));
    }
    EXPECT_LT(sum / static_cast<double>(own.extent().texels()), 0.002);
    EXPECT_LT(difference("bent2.png", 1, bent.planes[1]), 0.2f);  // green points down in both
    EXPECT_LT(difference("hor2.exr", 0, horizons.planes[0]), 0.3f);
}

TEST_F(BakeOcclusion, FilesThatHoldLevelsHaveAverages) {
    run("bake-normals h.png -o n.png --bumpiness 6 --occlusion-out ao.dds --bent-out bent.ktx2 --fade 1,2 "
        "--mip-domain slope --occlusion-directions 8");
    const auto ao = read_texture(scratch_.path("ao.dds")), bent = read_texture(scratch_.path("bent.ktx2"));
    ASSERT_TRUE(ao && bent);
    ASSERT_EQ(ao->levels.size(), 10u);
    ASSERT_EQ(bent->levels.size(), 10u);
    const auto base = decode(*ao, 0), half = decode(*ao, 1), flat = decode(*bent, 3);
    ASSERT_TRUE(base && half && flat);
    float largest = 0.0f;
    for (int j = 0; j < 256; ++j) {
        for (int i = 0; i < 256; ++i) {
            const auto at = [&](int x, int y) { return base->planes[0].at(2 * i + x, 2 * j + y); };
            const float mean = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4.0f;
            largest = std::max(largest, std::abs(mean - half->planes[0].at(i, j)));
        }
    }
    EXPECT_LT(largest, 2.0f / 65535.0f);
    double shortest = 2.0;  // of the bent normals, which are unit again
    float leaning = 0.0f;
    for (int j = 0; j < 64; ++j) {
        for (int i = 0; i < 64; ++i) {
            const auto part = [&](std::size_t c) { return 2.0f * flat->planes[c].at(i, j) - 1.0f; };
            shortest = std::min(shortest, std::hypot(part(0), part(1), part(2)) * 1.0);
            leaning = std::max(leaning, std::abs(part(0)));
        }
    }
    EXPECT_GT(shortest, 0.98);
    EXPECT_GT(leaning, 0.1f) << "--fade is for the normals";
    run("bake-normals h.png -o n.png --bumpiness 6 --occlusion-out one.dds --mips none --occlusion-directions 8");
    EXPECT_EQ(read_texture(scratch_.path("one.dds"))->levels.size(), 1u);
}

TEST_F(BakeOcclusion, BytesDoNotDependOnThreads) {
    for (const char* const threads : {"1", "3"}) {
        const std::string t = threads;
        run("bake-normals h.png -o n" + t + ".dds --bumpiness 6 --occlusion-out ao" + t + ".png --threads " + t);
    }
    EXPECT_EQ(scratch_.read("ao1.png"), scratch_.read("ao3.png"));
}

TEST_F(BakeOcclusion, RefusesWhatCannotBe) {
    refuses("bake-normals h.png -o n.png --occlusion-distance 4", "needs --occlusion-out");
    refuses("bake-normals h.png -o n.png --occlusion-out -", "needs a file");
    refuses("bake-normals h.png -o n.png --occlusion-out ao.png --horizon-directions 8", "needs --horizon-out");
    refuses("bake-normals h.png -o n.png --horizon-out hor.png --horizon-directions 65", "at least 4 and at most 64");
    refuses("bake-normals h.png -o n.png --horizon-out hor.png --occlusion-directions 8", "needs --occlusion-out");
    refuses("bake-normals h.png -o n.png --occlusion-out ao.png --occlusion-directions 3",
            "at least 4 and at most 1024");
    refuses("bake-normals h.png -o n.png --occlusion-out n.png", "n.png");
}

}  // namespace
}  // namespace tex::cli
