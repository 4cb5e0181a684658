// SPDX-License-Identifier: Apache-2.0
// A model that cannot be read is found as a damaged picture is: with N101, in every document, and baselines know it.

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class CheckDamagedModels : public testing::Test {
protected:
    CheckDamagedModels() {
        scratch_.add_sample("broken/N804-scale-not-positive.glb", "whole.glb");
        const std::string bytes = scratch_.read("whole.glb");
        scratch_.write("torn.glb", bytes.substr(0, bytes.size() / 2));
        scratch_.write("torn.png", "\x89PNG\r\n\x1a\n");
    }
    Ran check(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"torn.glb", "torn.png"});
        return run(scratch_, "check-normals", arguments);
    }
    const Scratch scratch_;
};

TEST_F(CheckDamagedModels, HaveTheFindingOfADamagedPicture) {
    const Ran ran = check({});
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.out.find("torn.glb: error N101 unreadable: "), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("2 files: 2 errors, 0 warnings, 0 notes; 2 unreadable"), std::string::npos) << ran.out;
    const auto json = nlohmann::json::parse(lines_of(check({"--json"}).out).front());
    EXPECT_EQ(json["findings"][0]["id"], "N101") << json;
    EXPECT_EQ(check({"--disable", "N101"}).code, 4) << "unreadable all the same";
}

TEST_F(CheckDamagedModels, StandInEveryDocument) {
    check({"--junit", "j.xml", "--sarif", "s.json"});
    EXPECT_NE(scratch_.read("j.xml").find("torn.glb"), std::string::npos);
    EXPECT_NE(scratch_.read("s.json").find("torn.glb"), std::string::npos);
    EXPECT_NE(check({"--github"}).out.find("::error file=torn.glb,title=N101 unreadable::"), std::string::npos);
}

TEST_F(CheckDamagedModels, AreKnownToBaselines) {
    EXPECT_EQ(check({"--baseline-write", "known.json"}).code, 0);
    const Ran known = check({"--baseline", "known.json"});
    EXPECT_EQ(known.code, 0) << known.out << known.err;
    EXPECT_EQ(check({"--baseline", "known.json", "--github"}).out.find("::error"), std::string::npos);
    std::filesystem::remove(scratch_.path("torn.png"));
    EXPECT_EQ(check({"--baseline", "known.json"}).code, 3) << "what is missing is not known";
}

}  // namespace tex::cli
