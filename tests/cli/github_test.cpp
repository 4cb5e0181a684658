// SPDX-License-Identifier: Apache-2.0
// check-normals --github: the lines that GitHub Actions turns into annotations.

#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class Github : public testing::Test {
protected:
    Github() {
        scratch_.add_sample("waves.png", "waves.png");
        EXPECT_EQ(shell(scratch_,
                        "mkdir art; bake-normals waves.png -o art/up.dds --format rgba8 --bumpiness 8 --no-sync; "
                        "cp art/up.dds 'art/a,b: 100%.dds'")
                      .code,
                  0);
    }
    Ran check(const std::string& arguments) { return shell(scratch_, "check-normals --github " + arguments); }
    Scratch scratch_;
};

TEST_F(Github, HasALineForEachFinding) {
    const Ran ran = check("./art/up.dds --require y=down --require mips=3 --severity N109=warning");
    EXPECT_EQ(ran.code, 1);
    const auto lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), 3u) << ran.out;
    EXPECT_TRUE(lines[0].starts_with("::warning file=art/up.dds,title=N109 wrong-levels::The number of levels "))
        << ran.out;
    EXPECT_TRUE(lines[1].starts_with("::error file=art/up.dds,title=N401 wrong-y::Green or red points the wrong way"))
        << ran.out;
    EXPECT_NE(lines[1].find("%0AFix: mip-normals ./art/up.dds --keep-length --mips 3 --y-in up --y down "),
              std::string::npos)
        << ran.out;
    EXPECT_EQ(lines[2], "1 file: 1 error, 1 warning, 0 notes");
    EXPECT_NE(check("art/up.dds --require y=down --severity N401=note").out.find("::notice file=art/up.dds,"),
              std::string::npos);
}

TEST_F(Github, EscapesWhatGithubReadsAsSyntax) {
    const Ran ran = check("'art/a,b: 100%.dds' --require y=down");
    EXPECT_TRUE(ran.out.starts_with("::error file=art/a%2Cb%3A 100%25.dds,title=N401 wrong-y::")) << ran.out;
    EXPECT_NE(ran.out.find("pack-normals 'art/a,b: 100%25.dds' "), std::string::npos) << ran.out;
    // A name cannot end the line and begin another command.
    EXPECT_EQ(shell(scratch_, "cp art/up.dds $'x\\n::error::y.dds'").code, 0);
    const Ran hostile = check("x* --require y=down");
    ASSERT_EQ(lines_of(hostile.out).size(), 2u) << hostile.out;
    EXPECT_TRUE(hostile.out.starts_with("::error file=x\\x0a%3A%3Aerror%3A%3Ay.dds,")) << hostile.out;
}

TEST_F(Github, AnnotatesFilesThatCannotBeRead) {
    scratch_.write("torn.dds", "DDS |");
    const Ran ran = check("gone.dds torn.dds");
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.out.find("::error file=gone.dds,title=check-normals::no such file"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("::error file=torn.dds,title=N101 unreadable::"), std::string::npos) << ran.out;
}

TEST_F(Github, IsNoJson) {
    const Ran ran = check("art/up.dds --json");
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("--json and --github contradict each other"), std::string::npos) << ran.err;
}

}  // namespace tex::cli
