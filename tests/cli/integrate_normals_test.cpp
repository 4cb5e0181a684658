// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

const std::filesystem::path kShared = TEX_SOURCE_DIR "/../shared/data";

}  // namespace

class IntegrateNormals : public testing::Test {
protected:
    IntegrateNormals() {
        for (const char* name : {"waves.png", "bricks.png"}) scratch_.add_sample(name, name);
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    void does(const std::string& command, const std::vector<std::string>& arguments) {
        const Ran ran = go(command, arguments);
        ASSERT_EQ(ran.code, 0) << ran.err;
    }
    nlohmann::json report_of(std::vector<std::string> arguments) {
        arguments.emplace_back("--json");
        const Ran ran = go("integrate-normals", arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return nlohmann::json::parse(ran.out);
    }
    void refuses(std::vector<std::string> arguments, int code, const std::string& part) {
        const Ran ran = go("integrate-normals", std::move(arguments));
        EXPECT_EQ(ran.code, code) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
    }
    Image image_of(const std::string& name) {
        auto image = read_image(scratch_.path(name));
        EXPECT_TRUE(image) << name;
        return std::move(*image);
    }
    Plane<float> heights_of(const std::string& name) { return std::move(image_of(name).planes.front()); }
    // The largest difference of two pictures after their lowest heights have been made equal.
    double difference(const std::string& a, const std::string& b, double factor = 1.0) {
        const Plane<float> first = heights_of(a), second = heights_of(b);
        EXPECT_EQ(first.extent(), second.extent());
        const auto lowest = [](const Plane<float>& plane) {
            float low = plane.at(0, 0);
            for (int j = 0; j < plane.extent().height; ++j)
                low = std::min(low, *std::min_element(plane.row(j), plane.row(j) + plane.extent().width));
            return low;
        };
        const float low_a = lowest(first), low_b = lowest(second);
        double largest = 0.0;
        for (int j = 0; j < first.extent().height; ++j) {
            for (int i = 0; i < first.extent().width; ++i) {
                const auto above_a = static_cast<double>(first.at(i, j) - low_a);
                const auto above_b = static_cast<double>(second.at(i, j) - low_b);
                largest = std::max(largest, std::abs(factor * above_a - above_b));
            }
        }
        return largest;
    }
    Scratch scratch_;
};

TEST_F(IntegrateNormals, IsTheInverseOfBakeNormalsInEveryUnit) {
    const std::vector<std::vector<std::string>> strengths = {{"--bumpiness", "-6"},
                                                             {"--uv-height", "0.05"},
                                                             {"--height-range", "0.2", "--world-size", "2x1.5"},
                                                             {"--kernel", "scharr", "--bumpiness", "4"},
                                                             {"--wrap", "clamp,mirror", "--kernel", "forward"}};
    for (const std::vector<std::string>& strength : strengths) {
        std::vector<std::string> bake = {"waves.png", "-o", "n.exr", "--format", "float"};
        std::vector<std::string> integrate = {"n.exr", "-o", "h.exr"};
        for (std::vector<std::string>* all : {&bake, &integrate})
            all->insert(all->end(), strength.begin(), strength.end());
        does("bake-normals", bake);
        does("integrate-normals", integrate);
        EXPECT_LT(difference("h.exr", "waves.png"), 1e-3) << strength.front();
    }
}

// Bakers leave NaN outside of charts.
TEST_F(IntegrateNormals, TexelsThatAreNotFiniteFollowFromTheOthers) {
    does("bake-normals", {"waves.png", "-o", "n.dds", "--format", "float", "--mips", "none", "--bumpiness", "8"});
    std::string bytes = scratch_.read("n.dds");
    const std::size_t texel = bytes.size() / (128 * 128);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t k = 0; k < 9; ++k) {
        const std::size_t before_end = 128 * 128 - ((60 + k / 3) * 128 + 40 + k % 3);
        std::memcpy(bytes.data() + bytes.size() - before_end * texel, &nan, sizeof nan);
    }
    scratch_.write("holes.dds", bytes);
    const auto sound = report_of({"n.dds", "-o", "sound.exr", "--bumpiness", "8"});
    const auto holes =
        report_of({"holes.dds", "-o", "h.exr", "--bumpiness", "8", "--curvature-out", "c.exr", "--curl-out", "d.exr"});
    EXPECT_EQ(sound["unknown_texels"], 0);
    EXPECT_EQ(holes["unknown_texels"], 9);
    EXPECT_NE(holes["warnings"].dump().find("9 of 16384 texels have no slope"), std::string::npos);
    EXPECT_LT(difference("h.exr", "sound.exr"), 0.01);
    for (const char* name : {"c.exr", "d.exr"}) {
        const Plane<float> plane = heights_of(name);
        for (int k = 0; k < 128 * 128; ++k) ASSERT_TRUE(std::isfinite(plane.at(k % 128, k / 128))) << name;
    }
}

TEST_F(IntegrateNormals, SixteenBitsAreStretchedAndTheReportSaysHowToUndoIt) {
    does("bake-normals", {"bricks.png", "-o", "n.exr", "--format", "float", "--bumpiness", "8"});
    const auto report = report_of({"n.exr", "-o", "h.png", "--bumpiness", "8"});
    EXPECT_EQ(image_of("h.png").bits, 16);
    EXPECT_EQ(report["format"], "r16");
    EXPECT_EQ(report["unknown_texels"], 0);
    EXPECT_LT(report["curl"]["max"].get<double>(), 0.01);
    const double highest = report["heights"]["highest"];
    EXPECT_LT(difference("h.png", "bricks.png", highest), 1e-3);
    const auto bumpiness = report["heights"]["bumpiness"][0].get<double>();
    does("bake-normals",
         {"h.png", "-o", "again.exr", "--format", "float", "--bumpiness", fmt::format("{}", bumpiness)});
    EXPECT_EQ(run(scratch_, "compare-normals", {"n.exr", "again.exr", "--max", "0.1"}).code, 0);
}

// What a user would otherwise copy from one command line to the next. Options that are given win.
TEST_F(IntegrateNormals, FilesStateTheStrengthThatBakesThemBack) {
    does("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "6", "--format", "rgb16"});
    for (const std::string name : {"h.png", "h.exr", "h.tif", "h.ktx2"}) {
        SCOPED_TRACE(name);
        const auto report = report_of({"n.png", "-o", name});
        const std::string strength = fmt::format("{}", report["heights"]["bumpiness"][0].get<float>());
        does("bake-normals", {name, "-o", "given.png", "--bumpiness", strength});
        const Ran ran = go("bake-normals", {name, "-o", "stated.png"});
        EXPECT_EQ(ran.out, fmt::format("{}: --bumpiness {}, as the file states\n", name, strength)) << ran.err;
        EXPECT_EQ(scratch_.read("stated.png"), scratch_.read("given.png"));
        does("bake-normals", {name, "-o", "one.png", "--bumpiness", "1"});
        EXPECT_EQ(scratch_.read("one.png") == scratch_.read("given.png"), strength == "1") << strength;
        EXPECT_NE(go("bake-normals", {name, "-o", "auto.png", "--bumpiness", "auto"}).out.find("auto is"),
                  std::string::npos);
    }
    // A step of a manifest reads it, too.
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"h.png\"\nname = \"made.dds\"\n"
                   "steps = [ { bake = {} }, { mip = { format = \"rgb8\" } } ]\n");
    does("build-normals", {});
    does("bake-normals", {"h.png", "-o", "direct.exr", "--format", "float"});
    does("mip-normals", {"direct.exr", "-o", "by_hand.dds", "--format", "rgb8"});
    EXPECT_EQ(scratch_.read("made.dds"), scratch_.read("by_hand.dds"));
}

TEST_F(IntegrateNormals, HeightsAreStoredAsAsked) {
    does("bake-normals", {"waves.png", "-o", "n.exr", "--format", "float", "--bumpiness", "8"});
    const double highest = report_of({"n.exr", "-o", "raw.exr", "--bumpiness", "8"})["heights"]["highest"];
    const auto top = [&](const std::string& name) {
        const Plane<float> plane = heights_of(name);
        float high = 0.0f;
        for (int j = 0; j < plane.extent().height; ++j)
            high = std::max(high, *std::max_element(plane.row(j), plane.row(j) + plane.extent().width));
        return static_cast<double>(high);
    };
    EXPECT_NEAR(top("raw.exr"), highest, 1e-6);
    does("integrate-normals", {"n.exr", "-o", "fit.exr", "--bumpiness", "8", "--heights", "fit"});
    EXPECT_NEAR(top("fit.exr"), 1.0, 1e-6);
    does("integrate-normals", {"n.exr", "-o", "half.png", "--bumpiness", "8", "--heights", "0,2"});
    EXPECT_NEAR(top("half.png"), highest / 2.0, 1e-4);
    does("integrate-normals", {"n.exr", "-o", "r8.tga", "--bumpiness", "8"});
    EXPECT_EQ(image_of("r8.tga").bits, 8);
    does("integrate-normals", {"n.exr", "-o", "h.exr", "--format", "half"});
    EXPECT_EQ(image_of("h.exr").bits, 16);
    for (const char* name : {"h.dds", "h.ktx2", "h.tif"}) does("integrate-normals", {"n.exr", "-o", name});
}

TEST_F(IntegrateNormals, EveryTextureWorksAndDirectXMapsToo) {
    for (const std::string format : {"dxt5nm", "bc5", "bc5-snorm", "rgb8", "rg16", "half"}) {
        does("bake-normals", {"waves.png", "-o", "n.dds", "--bumpiness", "8", "--format", format, "--y", "down"});
        does("integrate-normals", {"n.dds", "-o", "h.exr", "--bumpiness", "8"});
        EXPECT_LT(difference("h.exr", "waves.png"), 0.05) << format;
    }
}

TEST_F(IntegrateNormals, LevelsAreIntegratedOneByOne) {
    does("bake-normals", {"waves.png", "-o", "n.ktx2", "--format", "half", "--uv-height", "0.05"});
    EXPECT_EQ(report_of({"n.ktx2", "-o", "h.png", "--level", "2"})["extent"][0], 32);
    const auto report = report_of({"n.ktx2", "--level", "all", "--name", "h{level}.exr", "--uv-height", "0.05"});
    EXPECT_EQ(report["levels"], 8);
    EXPECT_EQ(report["output"].size(), 8u);
    const Ran said =
        run(scratch_, "integrate-normals", {"n.ktx2", "--level", "all", "-o", "g{level}.exr", "--no-sync"});
    EXPECT_EQ(said.out.rfind("g{level}.exr: bake-normals", 0), 0u) << said.out;
    EXPECT_EQ(heights_of("h7.exr").extent(), (Extent{1, 1}));
    EXPECT_EQ(heights_of("h0.exr").extent(), (Extent{128, 128}));
    EXPECT_EQ(report_of({"n.ktx2", "-o", "all.exr", "--level", "all"})["levels"], 8);
    refuses({"n.ktx2", "-o", "x.png", "--level", "9"}, 4, "has no level 9, only 8");
    refuses({"n.ktx2", "-o", "x.png", "--level", "all"}, 2, "png files hold one level");
}

TEST_F(IntegrateNormals, CurvatureAndCurlAreMapsOfTheirOwn) {
    does("bake-normals", {"waves.png", "-o", "n.exr", "--format", "float", "--bumpiness", "8"});
    const auto report = report_of({"n.exr", "-o", "h.png", "--curvature-out", "c.png", "--curl-out", "curl.exr"});
    EXPECT_EQ(report["output"], "h.png");
    EXPECT_EQ(report["curvature"]["output"], "c.png");
    EXPECT_EQ(report["curl"]["output"], "curl.exr");
    EXPECT_EQ(report["curvature"]["kind"], "mean");
    EXPECT_LT(report["curvature"]["values"][0].get<double>(), 0.0);
    const Image picture = image_of("c.png");
    EXPECT_EQ(picture.bits, 16);
    does("integrate-normals", {"n.exr", "-o", "h.png", "--curvature-out", "c.exr", "--curl-out", "curl.png"});
    const Plane<float> floats = heights_of("c.exr");
    const double range = report["curvature"]["range"];
    for (const auto& [i, j] : {std::pair{3, 5}, {64, 64}, {127, 100}}) {
        const double shown = std::clamp(0.5 + 0.5 * static_cast<double>(floats.at(i, j)) / range, 0.0, 1.0);
        EXPECT_NEAR(static_cast<double>(picture.planes.front().at(i, j)), shown, 1e-4);
    }
    EXPECT_EQ(image_of("curl.png").planes.size(), 3u);
    EXPECT_EQ(image_of("curl.exr").planes.size(), 1u);
    does("integrate-normals",
         {"n.exr", "--out-dir", "out", "--curvature-out", "{stem}_c.png", "--curl-max", "3", "--curl-out",
          "{stem}_curl.tif", "--curvature", "divergence", "--curvature-range", "0.1"});
    for (const char* name : {"out/n.png", "out/n_c.png", "out/n_curl.tif"})
        EXPECT_TRUE(std::filesystem::exists(scratch_.path(name))) << name;
}

TEST_F(IntegrateNormals, BadInputIsRefusedWithItsReason) {
    does("bake-normals", {"waves.png", "-o", "n.png"});
    refuses({"n.png", "-o", "h.png", "--bumpiness", "0"}, 2, "a strength of 0");
    refuses({"n.png", "-o", "h.png", "--uv-height", "1e-60"}, 4, "the strength is too small");
    refuses({"n.png", "-o", "h.png", "--heights", "1,0"}, 2, "LOW must be less than HIGH");
    refuses({"n.png", "-o", "h.png", "--heights", "nan,1"}, 2, "--heights");
    refuses({"n.png", "-o", "h.png", "--heights", "most"}, 2, "fit, raw or LOW,HIGH");
    refuses({"n.png", "-o", "h.png", "--format", "float"}, 2, "png files cannot hold heights as float");
    refuses({"n.png", "-o", "h.png", "--steepest", "0"}, 2, "--steepest");
    refuses({"n.png", "-o", "h.png", "--curl-out", "h.png"}, 2, "h.png");
    refuses({"n.png", "-o", "h.png", "--curl-out", "c"}, 2, "unsupported output format");
    refuses({"n.png", "-o", "h.png", "--curvature-out", "c.astc"}, 2, "cannot hold such a map");
    EXPECT_FALSE(scratch_.has("h.png"));
    refuses({"n.png", "-o", "h.png", "--curvature", "mean"}, 2, "does nothing without --curvature-out");
    refuses({"n.png", "--out-dir", "out", "--name", "{stem}_{format}.png"}, 2, "{format} has no meaning");
    refuses({"waves.png", "-o", "h.png"}, 4, "waves.png");  // a grey picture
    EXPECT_FALSE(std::filesystem::exists(scratch_.path("h.png")));
}

TEST_F(IntegrateNormals, TheBytesDoNotDependOnThreads) {
    does("bake-normals", {"bricks.png", "-o", "n.png", "--bumpiness", "8"});
    for (const std::string threads : {"1", "3"}) {
        does("integrate-normals",
             {"n.png", "-o", "h" + threads + ".png", "--threads", threads, "--curvature-out", "c" + threads + ".png"});
    }
    EXPECT_EQ(scratch_.read("h1.png"), scratch_.read("h3.png"));
    EXPECT_EQ(scratch_.read("c1.png"), scratch_.read("c3.png"));
}

TEST_F(IntegrateNormals, IsAStepOfAManifest) {
    does("bake-normals", {"waves.png", "-o", "a_n.png", "--bumpiness", "4"});
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"*_n.png\"\nname = \"{stem:-_n}_built.png\"\n"
                   "steps = [ { integrate = { bumpiness = 4, wrap = \"clamp\" } } ]\n");
    EXPECT_EQ(run(scratch_, "build-normals", {"normals.toml"}).code, 0);
    does("integrate-normals", {"a_n.png", "-o", "a.png", "--bumpiness", "4", "--wrap", "clamp"});
    EXPECT_EQ(scratch_.read("a_built.png"), scratch_.read("a.png"));
}

TEST_F(IntegrateNormals, RealObjectSpaceMapsAreRefused) {
    const auto map = kShared / "normal/panels_OBJECTSPACE_512.png";
    if (!std::filesystem::exists(map)) GTEST_SKIP() << "no ../shared/data";
    refuses({map.string(), "-o", "h.png"}, 4, "as in object-space maps");
}

}  // namespace tex::cli
