// SPDX-License-Identifier: Apache-2.0
// Baselines: accepted findings stay accepted after an edit, a rename, and in another folder; other findings do not.

#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

// art/down.dds has one finding, N401, that art/known.json accepts.
class Baselines : public testing::Test {
protected:
    Baselines() {
        scratch_.add_sample("waves.png", "waves.png");
        go("mkdir art; bake-normals waves.png -o art/down.dds --y down --bumpiness 8 --no-sync;"
           "bake-normals waves.png -o other.dds --y down --bumpiness 4 --no-sync;"
           "check-normals art/down.dds --require y=up --baseline-write art/known.json");
    }
    void go(const std::string& script) {
        const Ran ran = shell(scratch_, "set -e; " + script);
        EXPECT_EQ(ran.code, 0) << script << ran.err;
    }
    int check(const std::string& script) { return shell(scratch_, script).code; }
    Scratch scratch_;
};

TEST_F(Baselines, HoldInAnyFolder) {
    EXPECT_EQ(check("cd art && check-normals down.dds --require y=up --baseline known.json"), 0);
    EXPECT_EQ(check("mkdir x && cd x && check-normals ../art/down.dds --require y=up --baseline ../art/known.json"), 0);
    EXPECT_EQ(check("check-normals \"$PWD/art/down.dds\" --require y=up --baseline art/known.json"), 0);
    go("mkdir clone; mv art clone");  // and edited
    go("cp other.dds clone/art/down.dds");
    EXPECT_EQ(check("check-normals clone/art/down.dds --require y=up --baseline clone/art/known.json"), 0);
}

TEST_F(Baselines, KnowFilesThatWereRenamed) {
    go("mkdir new; mv art/down.dds new/name.dds");
    EXPECT_EQ(check("check-normals new/name.dds --require y=up --baseline art/known.json"), 0);
    EXPECT_EQ(check("check-normals new/name.dds --require y=up --require mips=3 --baseline art/known.json"), 1)
        << "another rule";
    EXPECT_EQ(check("check-normals other.dds --require y=up --baseline art/known.json"), 1) << "another file";
}

TEST_F(Baselines, NameFilesBesideThemselves) {
    const std::string text = scratch_.read("art/known.json");
    EXPECT_NE(text.find("\"version\": 2"), std::string::npos) << text;
    EXPECT_NE(text.find("{\"file\":\"down.dds\",\"id\":\"N401\",\"level\":0,\"content\":\""), std::string::npos)
        << text;
    go("check-normals $PWD/other.dds art/down.dds --require y=up --baseline-write art/more.json");
    EXPECT_NE(scratch_.read("art/more.json").find("{\"file\":\"../other.dds\""), std::string::npos);
    EXPECT_EQ(check("check-normals - --require y=up --baseline-write art/more.json < other.dds"), 0);
    EXPECT_EQ(scratch_.read("art/more.json").find("content"), std::string::npos) << "a stream cannot be read again";
}

TEST_F(Baselines, PagesShowWhatIsAccepted) {
    EXPECT_EQ(check("check-normals art/down.dds --require y=up --baseline art/known.json --report page.html"), 0);
    const std::string page = scratch_.read("page.html");
    EXPECT_NE(page.find("1 accepted</span>"), std::string::npos);
    EXPECT_NE(page.find("Accepted by the baseline:"), std::string::npos);
    EXPECT_NE(page.find("N401 wrong-y</a>"), std::string::npos);
    EXPECT_EQ(page.find("nothing found</span>"), std::string::npos);
}

// A damaged file is accepted as it is; one that breaks later is not.
TEST_F(Baselines, KnowDamagedFilesByTheirBytes) {
    scratch_.write("art/broken.dds", "DDS and no more");
    EXPECT_EQ(check("check-normals art/broken.dds"), 4);
    go("check-normals art/broken.dds art/down.dds --baseline-write art/known.json");
    const Ran ran = shell(scratch_,
                          "check-normals art/broken.dds --baseline art/known.json --junit j.xml "
                          "--sarif s.json --report page.html");
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("1 file: 0 errors, 0 warnings, 0 notes; 1 known and accepted"), std::string::npos)
        << ran.out;
    EXPECT_NE(scratch_.read("j.xml").find("failures=\"0\" errors=\"0\""), std::string::npos);
    EXPECT_NE(scratch_.read("s.json").find("\"executionSuccessful\": true"), std::string::npos);
    EXPECT_NE(scratch_.read("page.html").find("1 accepted</span>"), std::string::npos);
    go("mv art/broken.dds art/renamed.dds; check-normals art/renamed.dds --baseline art/known.json");
    scratch_.write("art/renamed.dds", "DDS and no less");
    EXPECT_EQ(check("check-normals art/renamed.dds --baseline art/known.json"), 4);
    scratch_.write("art/down.dds", "DDS and no less");
    EXPECT_EQ(check("check-normals art/down.dds --baseline art/known.json"), 4) << "a map that broke";
}

// Files are as they were given: relative to the folder of the run.
TEST_F(Baselines, OfVersion1AreStillRead) {
    scratch_.write("art/old.json",
                   R"({"version": 1, "findings": [{"file": "art/down.dds", "id": "N401", "level": 0}]})");
    EXPECT_EQ(check("check-normals art/down.dds --require y=up --baseline art/old.json"), 0);
    EXPECT_EQ(check("check-normals ./art/../art/down.dds --require y=up --baseline art/old.json"), 0);
    EXPECT_EQ(check("cd art && check-normals down.dds --require y=up --baseline old.json"), 1);
    EXPECT_EQ(check("check-normals other.dds --require y=up --baseline art/old.json"), 1);
    scratch_.write("art/old.json", R"({"version": 3, "findings": []})");
    EXPECT_EQ(check("check-normals art/down.dds --baseline art/old.json"), 4);
}

}  // namespace tex::cli
