// SPDX-License-Identifier: Apache-2.0
// ASTC in files: those that astcenc reads and writes, and what commands do with them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

using testing::HasSubstr;

class AstcFiles : public testing::Test {
protected:
    AstcFiles() {
        scratch_.add_sample("waves.png", "a.png");
        does("bake-normals a.png -o a.exr --bumpiness 4 --no-sync");
    }
    std::string does(const std::string& line) {
        const Ran ran = shell(scratch_, line);
        EXPECT_EQ(ran.code, 0) << line << ": " << ran.err;
        return ran.out;
    }
    void refuses(const std::string& line, int code, const std::string& why) {
        const Ran ran = shell(scratch_, line);
        EXPECT_EQ(ran.code, code) << line;
        EXPECT_THAT(ran.err, HasSubstr(why)) << line;
    }
    bool has_astcenc() { return shell(scratch_, "command -v astcenc").code == 0; }

    Scratch scratch_;
};

// astcenc writes 8 bits, which are at most half a code from our decoding.
TEST_F(AstcFiles, AstcencReadsOurs) {
    if (!has_astcenc()) GTEST_SKIP() << "no astcenc here";
    for (const std::string block : {"4x4", "6x5", "8x8"}) {
        does("pack-normals a.exr -o ours.astc --format astc-" + block);
        does("astcenc -dl ours.astc theirs.png -silent");
        does("unpack-normals ours.astc -o ours.exr --format float");
        does("unpack-normals theirs.png --swizzle ra -o theirs.exr --format float");
        does("compare-normals ours.exr theirs.exr --max-mean 0.3 --max 1.5");
    }
}

TEST_F(AstcFiles, WeReadThoseOfAstcenc) {
    if (!has_astcenc()) GTEST_SKIP() << "no astcenc here";
    does("unpack-normals a.exr -o a_n.png --format rgb8");
    for (const std::string block : {"4x4", "5x4", "8x6", "10x8", "12x12"}) {
        does("astcenc -cl a_n.png theirs.astc " + block + " -fast -normal -silent");
        const Ran ran = shell(scratch_, "compare-normals a.exr theirs.astc --max-mean 2");
        EXPECT_EQ(ran.code, 0) << block << ": " << ran.out << ran.err;
    }
}

// What astcenc makes without its mode for normal maps, and what check-normals says and does about it.
TEST_F(AstcFiles, WithOtherLayoutsAreFoundAndFixed) {
    if (!has_astcenc()) GTEST_SKIP() << "no astcenc here";
    does("unpack-normals a.exr -o a_n.png --format rgb8");
    for (const std::string block : {"4x4", "8x8"}) {
        for (const auto& [options, layout] :
             {std::pair("", "the layout is rgb"), std::pair(" -esw 1g1r", "the layout is dxt5nm")}) {
            does("astcenc -cl a_n.png colors.astc " + block + " -medium -silent" + options);
            const auto report = nlohmann::json::parse(does("check-normals --json colors.astc"));
            ASSERT_EQ(report["findings"].size(), 1u) << report;
            const auto& finding = report["findings"][0];
            EXPECT_EQ(finding["id"], "N115");
            EXPECT_THAT(std::string(finding["message"]), HasSubstr(layout));
            does(std::string(finding["fix"]));
            EXPECT_EQ(nlohmann::json::parse(does("check-normals --json FIXED.astc"))["findings"].size(), 0u);
            does("compare-normals a.exr FIXED.astc --max-mean 3");
        }
        does("astcenc -cl a_n.png normals.astc " + block + " -medium -silent -normal");
        EXPECT_EQ(nlohmann::json::parse(does("check-normals --json normals.astc"))["findings"].size(), 0u);
    }
}

// Their blue holds nothing: that is the finding, and its fix makes ASTC with the usual layout.
TEST_F(AstcFiles, OfTwoChannelsAreFoundAndFixed) {
    if (!has_astcenc()) GTEST_SKIP() << "no astcenc here";
    does("bake-normals a.png -o steep.png --bumpiness 12 --format rgb8");
    for (const std::string swizzle : {"rg01", "rg11"}) {
        does("astcenc -cl steep.png two.astc 4x4 -medium -silent -esw " + swizzle);
        const auto report = nlohmann::json::parse(does("check-normals --json two.astc"));
        ASSERT_EQ(report["findings"].size(), 1u) << report;
        EXPECT_EQ(report["findings"][0]["id"], "N209");
        does(std::string(report["findings"][0]["fix"]));
        EXPECT_EQ(nlohmann::json::parse(does("check-normals --json FIXED.astc"))["findings"].size(), 0u);
        does("compare-normals steep.png FIXED.astc --max-mean 3");
    }
}

TEST_F(AstcFiles, HoldOneLevelAndAstcAlone) {
    refuses("bake-normals a.png -o b.astc --mips all", 2, "hold one level");
    refuses("bake-normals a.png -o b.astc --format bc5", 2, "bc5 goes into .dds, .ktx2");
    refuses("bake-normals a.png -o b.dds --format astc-6x6", 2, "astc-6x6 goes into .ktx2, .astc");
    does("bake-normals a.png -o b.astc");
    EXPECT_THAT(does("check-normals b.astc --json"), HasSubstr("\"format\":\"astc-4x4-unorm\""));
    does("bake-normals a.png -o b.ktx2 --format astc-4x4");
    does("compare-normals b.astc b.ktx2 --max 0");
}

TEST_F(AstcFiles, NamesEndInKtx2) {
    does("bake-normals a.png --out-dir out --format astc-8x8 --effort fast");
    does("pack-normals a.exr --out-dir out --name '{stem}_eac{level}.ktx2' --format eac-rg11");
    does("bake-normals a.png --out-dir eac --format eac-rg11");
    EXPECT_TRUE(scratch_.has("out/a.ktx2"));
    EXPECT_TRUE(scratch_.has("eac/a.ktx2"));
}

// 128 texels are no multiple of 5 or 6, and need not be.
TEST_F(AstcFiles, AreSoundToTheCheckAndItsPage) {
    does("bake-normals a.png -o b.ktx2 --format astc-6x5 --bumpiness 4");
    const Ran ran =
        shell(scratch_, "check-normals b.ktx2 --require format=astc-6x5 --require mips=full --report b.html");
    EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("0 errors, 0 warnings, 0 notes"));
    EXPECT_THAT(scratch_.read("b.html"), HasSubstr("data:image/png;base64,"));
    EXPECT_THAT(does("pack-normals b.ktx2 -o again.ktx2 --json"), HasSubstr("astc-6x5"));
}

}  // namespace
}  // namespace tex::cli
