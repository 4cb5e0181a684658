// SPDX-License-Identifier: Apache-2.0
// --supercompress makes KTX2 files smaller and changes no texel.

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

class Supercompress : public testing::Test {
protected:
    Supercompress() {
        scratch_.add_sample("bricks.png", "a.png");
        does("bake-normals a.png --bumpiness 1 -o plain.ktx2");
    }
    void does(const std::string& line) {
        const Ran ran = shell(scratch_, line + " --no-sync");
        EXPECT_EQ(ran.code, 0) << line << ": " << ran.err;
        EXPECT_EQ(without_notes(ran.err), "") << line;
    }
    void expect_same_texels(const std::string& file) {
        does("unpack-normals plain.ktx2 --level all --name '{stem}_{level}.exr' --out-dir wanted");
        does("unpack-normals " + file + " --level all --name 'plain_{level}.exr' --out-dir got");
        EXPECT_EQ(shell(scratch_, "diff -r wanted got").out, "");
    }

    Scratch scratch_;
};

TEST_F(Supercompress, TheTexelsStayAndTheFileIsSmaller) {
    does("bake-normals a.png --bumpiness 1 -o packed.ktx2 --supercompress zstd");
    EXPECT_LT(scratch_.read("packed.ktx2").size(), scratch_.read("plain.ktx2").size() * 9 / 10);
    expect_same_texels("packed.ktx2");
    does("bake-normals a.png --bumpiness 1 -o smaller.ktx2 --supercompress zstd:19");
    EXPECT_LE(scratch_.read("smaller.ktx2").size(), scratch_.read("packed.ktx2").size());
    expect_same_texels("smaller.ktx2");
    does("pack-normals packed.ktx2 -o from_packed.ktx2 --format bc5");
    does("pack-normals plain.ktx2 -o from_plain.ktx2 --format bc5");
    EXPECT_TRUE(scratch_.read("from_packed.ktx2") == scratch_.read("from_plain.ktx2"));
    EXPECT_EQ(shell(scratch_, "check-normals packed.ktx2 --require mips=full").code, 0);
}

TEST_F(Supercompress, TheBytesAreTheSameForAllThreadsAndTargets) {
    does("bake-normals a.png --bumpiness 1 -o one.ktx2 --supercompress zstd --threads 1");
    const std::string wanted = scratch_.read("one.ktx2");
    does("bake-normals a.png --bumpiness 1 -o eight.ktx2 --supercompress zstd --threads 8");
    does(
        "set -o pipefail; bake-normals a.png --bumpiness 1 -o - --container ktx2 --supercompress zstd:9 --no-sync | "
        "cat > pipe.ktx2 "
        "#");
    for (const char* file : {"eight.ktx2", "pipe.ktx2"}) EXPECT_TRUE(scratch_.read(file) == wanted) << file;
}

TEST_F(Supercompress, LevelFilesAndRoughnessFilesAreWritten) {
    does("mip-normals plain.ktx2 --out-dir levels --name '{stem}_{level}.ktx2' --supercompress zstd");
    does("unpack-normals levels/plain_0.ktx2 -o level.exr");
    does("mip-normals plain.ktx2 -o mips.ktx2");
    does("unpack-normals mips.ktx2 -o wanted.exr");
    EXPECT_TRUE(scratch_.read("level.exr") == scratch_.read("wanted.exr"));
    does("mip-normals plain.ktx2 -o m.ktx2 --supercompress zstd --roughness-out rough.ktx2");
    does("mip-normals plain.ktx2 -o m.ktx2 --supercompress zstd --roughness-out rough.dds");
    EXPECT_TRUE(scratch_.has("rough.dds"));
}

TEST_F(Supercompress, OtherFilesAndLevelsAreErrors) {
    const std::pair<const char*, const char*> cases[] = {
        {"-o b.dds --supercompress zstd", "bake-normals: error: b.dds: --supercompress needs a KTX2 file\n"},
        {"-o b.ktx2 --supercompress zstd:0",
         "bake-normals: error: --supercompress: 'zstd:0' is not zstd, zstd:N with N from 1 to 22, or none\n"},
        {"-o b.ktx2 --supercompress lz4",
         "bake-normals: error: --supercompress: 'lz4' is not zstd, zstd:N with N from 1 to 22, or none\n"}};
    for (const auto& [arguments, message] : cases) {
        const Ran ran = shell(scratch_, std::string("bake-normals a.png ") + arguments);
        EXPECT_EQ(ran.code, 2);
        EXPECT_EQ(ran.err, message);
    }
    EXPECT_FALSE(scratch_.has("b.dds") || scratch_.has("b.ktx2"));
}

}  // namespace
}  // namespace tex::cli
