// SPDX-License-Identifier: Apache-2.0
// build-normals with long paths, other spellings of names, loops of links, and a clock that was set back.

#include <chrono>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cli/texture_tree.h"

namespace tex::cli {

class BuildPaths : public TextureTree {
protected:
    void write_manifest(const std::string& name) const {
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nmatch = \"art/**/*.png\"\nname = \"" + name +
                                           "\"\nsteps = [ { bake = {} } ]\n");
    }
};

TEST_F(BuildPaths, APathOf4000CharactersIsMadeOrRefused) {
    write_manifest("{dir}/{stem}.dds");
    // Too long for one call of mkdir(), because the name of the scratch folder comes before it.
    const std::string folder = "art/" + [] {
        std::string deep;
        for (int k = 0; k < 19; ++k) deep += std::string(200, 'd') + "/";
        return deep;
    }();
    ASSERT_EQ(shell(scratch_, "mkdir -p '" + folder + "' && cp art/wall_h.png '" + folder + "p.png'").code, 0);
    ASSERT_GT(folder.size(), 3800u);
    EXPECT_EQ(build().code, 0);
    EXPECT_EQ(done_[folder + "p.png"], "made");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), done_.size());
    // The output's path is longer than the system takes. All others are made.
    write_manifest("out/" + std::string(200, 'o') + "/" + std::string(100, 'o') + "/{dir}/{stem}.dds");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 3) << ran.err;
    EXPECT_NE(ran.err.find(": cannot create this folder: file name too long"), std::string::npos) << ran.err;
    EXPECT_EQ(count("made"), done_.size() - 1);
    EXPECT_EQ(count("failed"), 1u);
}

TEST_F(BuildPaths, LoopsOfLinksEnd) {
    write_manifest("out/{dir}/{stem}.dds");
    fs::create_directory_symlink("..", scratch_.path("art/sub/up"));
    fs::create_directory_symlink(".", scratch_.path("art/self"));
    fs::create_symlink("ping.png", scratch_.path("art/pong.png"));
    fs::create_symlink("pong.png", scratch_.path("art/ping.png"));
    const Ran ran = build();
    EXPECT_EQ(ran.code, 3);
    EXPECT_EQ(count("failed"), 2u) << ran.err;
    EXPECT_NE(ran.err.find("art/ping.png: too many symbolic links, or a loop of them"), std::string::npos) << ran.err;
    EXPECT_EQ(count("made"), done_.size() - 2) << ran.err;
    EXPECT_EQ(done_["art/wall_h.png"], "made");
}

// Times of files are only compared for equality, so they may be in the future, and go back.
TEST_F(BuildPaths, AClockThatWasSetBackDoesNoHarm) {
    ASSERT_EQ(shell(scratch_, "touch -d '+1 year' art/*.png art/sub/* shared/*").code, 0);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 3u);
    ASSERT_EQ(shell(scratch_, "touch -d '+1 year' out/art/* .normals.toml.state").code, 0);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 3u);
    scratch_.add_sample("hemisphere.png", "new.png");
    ASSERT_EQ(shell(scratch_, "cat new.png >art/wall_h.png").code, 0);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_["art/wall_h.png"], "made");
    EXPECT_EQ(count("current"), 2u);
    // Equal size, equal time: the rest of the stamp shows that the file was written.
    ASSERT_EQ(shell(scratch_, "touch -d 2001-01-01 art/wall_h.png").code, 0);
    ASSERT_EQ(build().code, 0);
    ASSERT_EQ(shell(scratch_,
                    "printf x | dd of=art/wall_h.png bs=1 seek=900 conv=notrunc 2>/dev/null; touch -d 2001-01-01 "
                    "art/wall_h.png")
                  .code,
              0);
    EXPECT_NE(build().code, 0) << "the file is damaged now";
    EXPECT_EQ(done_["art/wall_h.png"], "failed");
}

// An output of one rule that another reads is found under every spelling of its name.
TEST_F(BuildPaths, NeedsAreFoundUnderOtherSpellings) {
    for (const std::string name :
         {"out/shared/grain.dds", "./out/shared/grain.dds", "out//shared/../shared/grain.dds"}) {
        std::string manifest = kManifest;
        const std::string plain = "out/shared/grain.dds";
        manifest.replace(manifest.find(plain), plain.size(), name);
        scratch_.write("normals.toml", manifest);
        const Ran plan = run(scratch_, "build-normals", {"--plan", "-"});
        int found = 0;
        for (const std::string& line : lines_of(plan.out)) {
            const auto json = nlohmann::json::parse(line);
            if (json.value("input", "") != "art/wall_h.png") continue;
            EXPECT_EQ(json["needs"], nlohmann::json::array({"shared/grain.png"})) << name;
            ++found;
        }
        EXPECT_EQ(found, 1) << plan.err;
        fs::remove_all(scratch_.path("out"));
        const Ran ran = build({"--threads", "1"});
        EXPECT_EQ(ran.code, 0) << name << ran.err;
    }
}

}  // namespace tex::cli
