// SPDX-License-Identifier: Apache-2.0
// --quality sets the quality of JPEG files, and of nothing else. ImageMagick reads it back from their tables.

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

TEST(Quality, IsThatOfTheTablesInAJpeg) {
    const Scratch scratch;
    scratch.add_sample("bricks.png", "a.png");
    for (const char* quality : {"1", "60", "95", "100"}) {
        const Ran ran = shell(scratch, std::string("bake-normals a.png -o b.jpg --no-sync --quality ") + quality);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(shell(scratch, "identify -format %Q b.jpg").out, quality);
    }
    EXPECT_EQ(shell(scratch, "bake-normals a.png -o plain.jpg --no-sync; identify -format %Q plain.jpg").out, "95");
    EXPECT_EQ(shell(scratch,
                    "bake-normals a.png -o stream.jpg --no-sync --quality 60 --threads 4; "
                    "pack-normals plain.jpg -o again.jpg --quality 60; identify -format '%Q ' stream.jpg "
                    "again.jpg")
                  .out,
              "60 60 ");
}

TEST(Quality, IsRefusedForOtherFiles) {
    const Scratch scratch;
    scratch.add_sample("bricks.png", "a.png");
    const std::pair<const char*, const char*> cases[] = {
        {"-o b.png --quality 90",
         "bake-normals: error: --quality: needs a JPEG file; WebP is written without loss, and of blocks it is "
         "--effort\n"},
        {"-o b.jpg --quality 0", "bake-normals: error: --quality: 0 is not at least 1 and at most 100\n"},
        {"-o b.jpg --quality 101", "bake-normals: error: --quality: 101 is not at least 1 and at most 100\n"}};
    for (const auto& [arguments, message] : cases) {
        const Ran ran = shell(scratch, std::string("bake-normals a.png ") + arguments);
        EXPECT_EQ(ran.code, 2);
        EXPECT_EQ(ran.err, message);
    }
    EXPECT_FALSE(scratch.has("b.png") || scratch.has("b.jpg"));
}

}  // namespace
}  // namespace tex::cli
