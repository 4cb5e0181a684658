// SPDX-License-Identifier: Apache-2.0
// Many inputs, and the places of their outputs.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

std::vector<nlohmann::json> json_lines(const Ran& ran) {
    std::vector<nlohmann::json> objects;
    for (const std::string& line : lines_of(ran.out)) objects.push_back(nlohmann::json::parse(line));
    return objects;
}

}  // namespace

class Files : public testing::Test {
protected:
    Files() {
        for (const std::string name : {"a.png", "b.png", "c.png"}) scratch_.add_sample("ramp.png", name);
    }
    Ran bake(std::vector<std::string> arguments, const Setting& setting = {}) {
        arguments.push_back("--no-sync");
        return run(scratch_, "bake-normals", arguments, setting);
    }
    Scratch scratch_;
};

TEST_F(Files, ManyInputsAreReportedInTheirOrder) {
    std::vector<std::string> arguments = {"--out-dir", "out", "--json", "--threads", "4"};
    for (int k = 0; k < 40; ++k) {
        const std::string name = fmt::format("m{}.png", k);
        scratch_.add_sample("ramp.png", name);
        arguments.push_back(name);
    }
    const Ran ran = bake(arguments);
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(without_notes(ran.err), "");
    auto objects = json_lines(ran);
    ASSERT_EQ(objects.size(), 40u);
    for (std::size_t k = 0; k < 40; ++k) {
        EXPECT_EQ(objects[k]["input"], fmt::format("m{}.png", k));
        EXPECT_EQ(objects[k]["output"], fmt::format("out/m{}.dds", k));
        EXPECT_EQ(objects[k]["bytes"], std::filesystem::file_size(scratch_.path(fmt::format("out/m{}.dds", k))));
    }
}

TEST_F(Files, OneFailureDoesNotStopTheOthersAndTheHighestCodeCounts) {
    scratch_.write("damaged.png", scratch_.read("a.png").substr(0, 60));
    const Ran ran = bake({"a.png", "missing.png", "damaged.png", "b.png", "--out-dir", "out", "--json"});
    EXPECT_EQ(ran.code, 4);
    auto objects = json_lines(ran);
    ASSERT_EQ(objects.size(), 4u);
    EXPECT_EQ(objects[1]["error"]["code"], "io");
    EXPECT_EQ(objects[2]["error"]["code"], "bad-data");
    EXPECT_FALSE(objects[3].contains("error"));
    EXPECT_TRUE(scratch_.has("out/a.dds"));
    EXPECT_TRUE(scratch_.has("out/b.dds"));
    EXPECT_FALSE(scratch_.has("out/damaged.dds"));
    const auto errors = lines_of(without_notes(ran.err));
    ASSERT_EQ(errors.size(), 2u) << ran.err;
    EXPECT_TRUE(errors[0].starts_with("bake-normals: error: missing.png: ")) << errors[0];
    EXPECT_TRUE(errors[1].starts_with("bake-normals: error: damaged.png: ")) << errors[1];
    // --quiet suppresses warnings; errors are still printed.
    EXPECT_EQ(lines_of(bake({"missing.png", "-o", "x.dds", "--quiet"}).err).size(), 1u);
}

TEST_F(Files, NamesAreMadeFromPatterns) {
    std::filesystem::create_directories(scratch_.path("maps/deep"));
    scratch_.add_sample("ramp.png", "maps/deep/d.png");
    EXPECT_EQ(bake({"maps/deep/d.png", "a.png", "--out-dir", "out", "--name", "{dir}/{stem}_{format}.dds"}).code, 0);
    EXPECT_TRUE(scratch_.has("out/maps/deep/d_dxt5nm.dds"));
    EXPECT_TRUE(scratch_.has("out/a_dxt5nm.dds"));
    EXPECT_EQ(bake({"maps/deep/d.png", "--name", "{dir}/{stem}_n{ext}"}).code, 0);
    EXPECT_TRUE(scratch_.has("maps/deep/d_n.png"));
    EXPECT_EQ(bake({"a.png", "--out-dir", "out", "--format", "rgb8"}).code, 0);
    EXPECT_TRUE(scratch_.has("out/a.png"));  // the input's extension, because the output is not block-compressed
    EXPECT_EQ(bake({"a.png", "--out-dir", "out", "--container", "ktx2"}).code, 0);
    EXPECT_TRUE(scratch_.has("out/a.ktx2"));
}

TEST_F(Files, EachLevelCanHaveAFileOfItsOwn) {
    const Ran ran = bake({"a.png", "--out-dir", "out", "--name", "{stem}_mip{level}.png", "--json"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    auto object = nlohmann::json::parse(ran.out);
    ASSERT_EQ(object["levels"], 7);  // of 64 texels
    ASSERT_EQ(object["output"].size(), 7u);
    EXPECT_EQ(object["output"][6], "out/a_mip6.png");
    EXPECT_TRUE(scratch_.has("out/a_mip6.png"));
    EXPECT_FALSE(scratch_.has("out/a_mip7.png"));
    EXPECT_EQ(bake({"a.png", "--out-dir", "two", "--name", "{stem}{level}.png", "--mips", "2"}).code, 0);
    EXPECT_TRUE(scratch_.has("two/a1.png"));
    EXPECT_FALSE(scratch_.has("two/a2.png"));
}

TEST_F(Files, ListsMayHoldLinesOrNulSeparatedNames) {
    Setting lines, nul;
    lines.input = "a.png\n\nb.png";
    EXPECT_EQ(bake({"--files-from", "-", "--out-dir", "lines"}, lines).code, 0);
    EXPECT_TRUE(scratch_.has("lines/a.dds"));
    EXPECT_TRUE(scratch_.has("lines/b.dds"));
    std::filesystem::rename(scratch_.path("c.png"), scratch_.path("two\nlines.png"));
    nul.input = std::string("a.png\0two\nlines.png\0", 20);
    EXPECT_EQ(bake({"--files-from", "-", "--out-dir", "nul"}, nul).code, 0);
    EXPECT_TRUE(scratch_.has("nul/two\nlines.dds"));
    scratch_.write("list", "a.png\n");
    EXPECT_EQ(bake({"b.png", "--files-from", "list", "--out-dir", "both"}).code, 0);
    EXPECT_TRUE(scratch_.has("both/a.dds"));
    EXPECT_TRUE(scratch_.has("both/b.dds"));
    EXPECT_EQ(bake({"--files-from", "nowhere", "--out-dir", "out"}).code, 3);
    scratch_.write("empty", "");
    const Ran refused = bake({"--files-from", "empty", "--out-dir", "out"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.err, "bake-normals: error: --files-from: empty names no input; --allow-empty accepts that\n");
    EXPECT_EQ(bake({"--files-from", "empty", "--allow-empty", "--out-dir", "out"}).code, 0);
}

TEST_F(Files, TheOutputFolderIsCreatedButNotItsParents) {
    EXPECT_EQ(bake({"a.png", "--out-dir", "new"}).code, 0);
    EXPECT_TRUE(scratch_.has("new/a.dds"));
    const Ran deep = bake({"a.png", "--out-dir", "not/there"});
    EXPECT_EQ(deep.code, 3);
    EXPECT_NE(deep.err.find("not/there: cannot create this folder"), std::string::npos) << deep.err;
    EXPECT_EQ(bake({"a.png", "-o", "not/there.dds"}).code, 3);
    EXPECT_EQ(bake({"a.png", "--out-dir", "b.png"}).code, 3);
}

TEST_F(Files, NoClobberKeepsWhatIsThere) {
    scratch_.write("a.dds", "precious");
    const Ran ran = bake({"a.png", "-o", "a.dds", "--no-clobber"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_EQ(ran.err, "bake-normals: error: a.dds: exists, and --no-clobber is given\n");
    EXPECT_EQ(scratch_.read("a.dds"), "precious");
    EXPECT_EQ(bake({"a.png", "-o", "new.dds", "--no-clobber"}).code, 0);
    EXPECT_EQ(bake({"a.png", "-o", "a.dds"}).code, 0);
    EXPECT_NE(scratch_.read("a.dds"), "precious");
}

TEST_F(Files, DirectoriesAreNoInputs) {
    std::filesystem::create_directory(scratch_.path("folder"));
    const Ran ran = bake({"folder", "-o", "a.dds"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_NE(ran.err.find("directory; name its files"), std::string::npos) << ran.err;
}

TEST_F(Files, NamesThatLookLikeOptionsFollowTwoDashes) {
    std::filesystem::rename(scratch_.path("c.png"), scratch_.path("--json"));
    EXPECT_EQ(run(scratch_, "bake-normals", {"-o", "x.dds", "--", "--json"}).code, 0);
    std::filesystem::rename(scratch_.path("b.png"), scratch_.path("[b]"));
    EXPECT_EQ(bake({"[b]", "-o", "y.dds"}).code, 0);
}

TEST_F(Files, TheDepfileTellsWhatWasWritten) {
    const Ran ran = bake({"a.png", "missing.png", "--out-dir", "out", "--depfile", "out.d"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_EQ(scratch_.read("out.d"), "out/a.dds: \\\n  a.png\n");
    EXPECT_EQ(bake({"a.png", "-o", "a.dds", "--depfile", "not/there.d"}).code, 3);
}

TEST_F(Files, TerminalsAreSafeFromFileNames) {
    const Ran ran = bake({"\x1b[31mred\n.png", "-o", "a.dds"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_EQ(lines_of(ran.err).size(), 1u);
    EXPECT_EQ(ran.err.find('\x1b'), std::string::npos);
}

}  // namespace tex::cli
