// SPDX-License-Identifier: Apache-2.0
// check-normals on folders, and what it says at its end: the direction of green, rules without files, a baseline that
// is out of date, warnings that pass.

#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class CheckFolders : public testing::Test {
protected:
    CheckFolders() {
        scratch_.add_sample("waves.png", "waves.png");
        go("mkdir -p art/deep art/.git;"
           "bake-normals waves.png -o art/up.dds --bumpiness 8 --no-sync;"
           "bake-normals waves.png -o art/deep/down.PNG --container png --y down --bumpiness 8 --no-sync;"
           "cp art/up.dds art/.git/hidden.dds; echo text > art/readme.txt; echo more > art/deep/notes.md");
    }
    void go(const std::string& script) {
        const Ran ran = shell(scratch_, "set -e; " + script);
        EXPECT_EQ(ran.code, 0) << script << ran.err;
    }
    Ran check(const std::string& arguments) { return shell(scratch_, "check-normals " + arguments); }
    static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
    Scratch scratch_;
};

TEST_F(CheckFolders, StandForTheirPictures) {
    for (const char* folder : {"art", "art/", "./art"}) {
        const Ran ran = check(std::string(folder) + " --list-y --disable N105");
        EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
        EXPECT_TRUE(has(ran.out, "art/up.dds: green points up\n")) << ran.out;
        EXPECT_TRUE(has(ran.out, "art/deep/down.PNG: green points down, or red points left\n")) << ran.out;
        EXPECT_EQ(lines_of(ran.out).back(),
                  "2 files: 0 errors, 0 warnings, 0 notes; 2 files left out, which are no pictures")
            << ran.out;
    }
    EXPECT_EQ(shell(scratch_, "cd art && check-normals . | tail -1").out.substr(0, 7), "2 files");
    go("mkdir empty; echo text > empty/a.txt");
    const Ran none = check("empty");
    EXPECT_EQ(none.code, 3);
    EXPECT_TRUE(has(none.err, "empty: no file in this folder is a picture")) << none.err;
}

// A tree is checked as its artists made it, before and after a build; what a build made is checked if it is named.
TEST_F(CheckFolders, LeaveOutWhatABuildMadeOfThem) {
    scratch_.write("normals.toml", R"(version = 1
[defaults]
out-dir = "built"
[[rule]]
match = ["art/*.dds", "art/deep/*.PNG"]
steps = [{ pack = {} }]
)");
    go("build-normals --no-sync");
    const Ran ran = check(". --disable N105 --disable N210");
    EXPECT_TRUE(has(lines_of(ran.out).back(), "3 files: 0 errors")) << ran.out << ran.err;
    EXPECT_TRUE(has(lines_of(ran.out).back(), "; 2 files left out, which build-normals made")) << ran.out;
    EXPECT_EQ(lines_of(check("built --disable N105").out).back().substr(0, 7), "2 files");
    go("mkdir -p alone; echo 'not a state' > art/.x.state");
    EXPECT_EQ(lines_of(check("art --disable N105").out).back().substr(0, 7), "2 files");
}

TEST_F(CheckFolders, WarningsPassAndTheLastLineSaysSo) {
    const Ran ran = check("art/up.dds --require mips=3 --severity N109=warning");
    EXPECT_EQ(ran.code, 0);
    EXPECT_TRUE(has(lines_of(ran.out).back(), "; warnings pass, --fail-on warning refuses them")) << ran.out;
    const Ran refused = check("art/up.dds --require mips=3 --severity N109=warning --fail-on warning");
    EXPECT_EQ(refused.code, 1);
    EXPECT_FALSE(has(refused.out, "warnings pass")) << refused.out;
}

TEST_F(CheckFolders, FindingsOfTheBaselineThatAreGoneAreCounted) {
    go("check-normals art --require y=up --require mips=3 --baseline-write known.json");
    EXPECT_EQ(check("art --require y=up --require mips=3 --baseline known.json").err, "");
    go("pack-normals art/up.dds -o art/up.ktx2 --no-sync --mips keep; rm art/up.dds;"
       "bake-normals waves.png -o art/deep/down.PNG --container png --bumpiness 8 --no-sync");
    const Ran ran = check("art --require y=up --require mips=3 --baseline known.json");
    EXPECT_TRUE(has(ran.err, "warning: known.json: ")) << ran.err;
    EXPECT_TRUE(has(ran.err, " findings are gone; --baseline-write known.json, in a run over all files, drops them"))
        << ran.err;
    go("check-normals art --require y=up --require mips=3 --baseline known.json --baseline-write known.json");
    EXPECT_EQ(check("art --require y=up --require mips=3 --baseline known.json").err, "");
    go("check-normals art --require y=up --require mips=3 --baseline-write known.json");
    EXPECT_EQ(check("art/up.ktx2 --require mips=3 --baseline known.json").err, "") << "other files are not gone";
}

TEST_F(CheckFolders, RulesWithoutFilesAreNamed) {
    scratch_.write("ci/checks.toml",
                   "[[rule]]\nmatch = \"deep/*\"\nrequire = [\"y=down\"]\n\n"
                   "[[rule]]\nmatch = [\"ui/**\", \"hud/**\"]\n");
    const Ran ran = check("art --config ci/checks.toml");
    EXPECT_TRUE(has(ran.err, "ci/checks.toml: line 1: no file that is checked is of this rule (deep/*)")) << ran.err;
    EXPECT_TRUE(has(ran.err, "line 5: no file that is checked is of this rule (ui/**, hud/**)")) << ran.err;
    const Ran rooted = check("art --config ci/checks.toml --root art");
    EXPECT_FALSE(has(rooted.err, "line 1:")) << rooted.err;
    EXPECT_TRUE(has(rooted.err, "line 5:")) << rooted.err;
    EXPECT_EQ(check("art --root art").code, 2);
}

}  // namespace tex::cli
