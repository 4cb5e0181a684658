// SPDX-License-Identifier: Apache-2.0
// Misuse that every command must refuse: it exits with 2, prints one clear sentence and writes nothing.

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class EveryUsage : public testing::TestWithParam<std::string> {
protected:
    EveryUsage() {
        scratch_.add_sample("hemisphere.png", "a.png");
        scratch_.add_sample("ramp.png", "b.png");
        std::filesystem::create_directory(scratch_.path("folder"));
        std::filesystem::create_symlink("a.png", scratch_.path("soft.png"));
        std::filesystem::create_hard_link(scratch_.path("a.png"), scratch_.path("hard.png"));
        before_ = scratch_.list();
    }

    // Expects the command to refuse these arguments with a sentence that contains `part`.
    void refuses(const std::vector<std::string>& arguments, const std::string& part) {
        std::vector<std::string> all = arguments;
        if (GetParam() == "scale-normals") all.insert(all.begin(), {"--scale", "2"});
        if (GetParam() == "convert-normals") all.insert(all.begin(), {"--mesh", "sheet.obj", "--decoder-in", "godot"});
        const Ran ran = run(scratch_, GetParam(), all);
        std::string line;
        for (const std::string& argument : arguments) line += " " + argument;
        EXPECT_EQ(ran.code, 2) << line;
        EXPECT_EQ(ran.out, "") << line;
        EXPECT_TRUE(ran.err.starts_with(GetParam() + ": error: ")) << line << "\n" << ran.err;
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << line << "\n" << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << line << "\n" << ran.err;
        EXPECT_EQ(scratch_.list(), before_) << line;
    }

    [[nodiscard]] bool has_option(const std::string& name) const {
        return run(scratch_, GetParam(), {"--list-options"}).out.find("\n" + name + "\t") != std::string::npos;
    }
    // Whether -o takes many inputs, which become one output.
    [[nodiscard]] bool joins() const {
        return run(scratch_, GetParam(), {"--help"}).out.find("of all inputs together") != std::string::npos;
    }

    Scratch scratch_;
    std::vector<std::string> before_;
};

// A test's name may not contain "-".
std::string test_name(const testing::TestParamInfo<std::string>& instance) {
    std::string name = instance.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

// Checks and comparisons write no output.
bool only_reads(const std::string& command) { return command == "check-normals" || command == "compare-normals"; }

std::vector<std::string> commands_that(bool read) {
    std::vector<std::string> names;
    for (const std::string& name : commands()) {
        if (name == "build-normals") continue;  // takes a manifest
        if (only_reads(name) == read) names.push_back(name);
    }
    return names;
}

INSTANTIATE_TEST_SUITE_P(Cli, EveryUsage, testing::ValuesIn(commands_that(false)), test_name);

class EveryReaderUsage : public EveryUsage {};
INSTANTIATE_TEST_SUITE_P(Cli, EveryReaderUsage, testing::ValuesIn(commands_that(true)), test_name);

TEST_P(EveryReaderUsage, OptionsAndValuesAreChecked) {
    refuses({"a.png", "b.png", "--theads", "2"}, "unknown option --theads; did you mean --threads?");
    refuses({"a.png", "b.png", "-o", "a.dds"}, "unknown option -o");
    refuses({"a.png", "b.png", "--threads", "1", "--threads=2"}, "--threads is given more than once");
    refuses({"a.png", "b.png", "--threads", "two"}, "--threads: 'two' is not a whole number");
    refuses({"a.png", "b.png", "--json=yes"}, "--json takes no value");
}

TEST_P(EveryReaderUsage, InputsAreNeeded) {
    refuses({},
            GetParam() == "check-normals" ? "no input; see check-normals --help" : "two files are compared: A and B");
}

TEST_P(EveryUsage, UnknownOptionsComeWithASuggestion) {
    refuses({"a.png", "-o", "a.dds", "--theads", "2"}, "unknown option --theads; did you mean --threads?");
    refuses({"a.png", "-o", "a.dds", "--teapot=3"}, "unknown option --teapot");
    refuses({"a.png", "-o", "a.dds", "-x"}, "unknown option -x");
}

TEST_P(EveryUsage, OptionsAreGivenOnce) {
    refuses({"a.png", "-o", "a.dds", "-o", "b.dds"}, "--output is given more than once");
    refuses({"a.png", "-o", "a.dds", "--threads", "1", "--threads=2"}, "--threads is given more than once");
}

TEST_P(EveryUsage, ValuesAreChecked) {
    refuses({"a.png", "-o", "a.dds", "--threads", "-1"}, "--threads: -1 is not at least 0");
    refuses({"a.png", "-o", "a.dds", "--threads", "two"}, "--threads: 'two' is not a whole number");
    refuses({"a.png", "-o", "a.dds", "--progress", "allways"},
            "--progress: must be one of auto, always, never, not 'allways'; did you mean always?");
    refuses({"a.png", "-o", "a.dds", "--max-texels", "1.5M"}, "--max-texels: '1.5M' is not a count");
    refuses({"a.png", "-o", "a.dds", "--json=yes"}, "--json takes no value");
    refuses({"a.png", "-o", "a.dds", "--threads="}, "--threads needs a value");
    refuses({"a.png", "-o"}, "-o needs a value");
    refuses({"a.png", "--out-dir", ""}, "--out-dir: needs a value");
}

TEST(Usage, WordsMayBeInCapitalsAndHaveOtherNames) {
    const Scratch scratch;
    scratch.add_sample("ramp.png", "a.png");
    const auto bake = [&](const std::string& output, const std::string& format, const std::string& y) {
        const Ran ran =
            run(scratch, "bake-normals", {"a.png", "-o", output, "--format", format, "--y", y, "--no-sync"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        return scratch.read(output);
    };
    const std::string down = bake("a.dds", "bc5", "down");
    EXPECT_TRUE(down != bake("b.dds", "bc5", "up"));
    for (const char* y : {"DirectX", "dx", "DX", "d3d", "DOWN"}) EXPECT_TRUE(bake("b.dds", "BC5", y) == down) << y;
    for (const char* y : {"OpenGL", "gl", "Up"})
        EXPECT_TRUE(bake("b.dds", "ATI2", y) == bake("c.dds", "bc5", "up")) << y;
    EXPECT_TRUE(bake("b.dds", "BC3nm", "up") == bake("c.dds", "dxt5nm", "up"));
    const auto check = [&](const std::string& demand) {
        return run(scratch, "check-normals", {"a.dds", "--require", demand, "--fail-on", "error"}).code;
    };
    EXPECT_EQ(check("format=BC5"), 0);
    EXPECT_EQ(check("format=BC3nm"), 1);
    EXPECT_EQ(check("y=DirectX"), check("y=down"));
    EXPECT_EQ(check("y=west"), 2);
}

TEST_P(EveryUsage, InputsAndOutputsMustFit) {
    refuses({}, "no input");
    refuses({"-o", "a.dds"}, "no input");
    refuses({"", "-o", "a.dds"}, "an input name is empty");
    refuses({"a.png"}, "no output");
    if (!joins()) refuses({"a.png", "b.png", "-o", "a.dds"}, "--out-dir takes many");
    refuses({"a.png", "-o", "a.dds", "--out-dir", "out"}, "--output and --out-dir contradict each other");
    refuses({"a.png", "-o", "folder"}, "is a folder");
    refuses({"a.png", "-o", "new/"}, "is a folder");
    refuses({"-", "-", "--out-dir", "out"}, "standard input can only be read once");
    refuses({"-", "--files-from", "-", "--out-dir", "out"}, "standard input can only be read once");
    refuses({"a.png", "-o", "-", "--json"}, "both want standard output");
}

TEST_P(EveryUsage, OutputsNeedAKnownKind) {
    refuses({"a.png", "-o", "a.foo"}, ".dds, .ktx2, .astc, .png, .exr, .tif, .tiff, .tga, .bmp, .jpg, .jpeg");
    refuses({"a.png", "-o", "noextension"}, "a name without an extension");
    refuses({"a.png", "-o", "a.dds", "--container", "ktx2"}, "a.dds says dds, --container says ktx2");
    if (has_option("--format") && GetParam() != "integrate-normals")  // heights have other formats
        refuses({"a.png", "-o", "n.png", "--format", "bc5"}, "bc5 goes into .dds, .ktx2");
}

TEST_P(EveryUsage, NamePatternsAreChecked) {
    refuses({"a.png", "--out-dir", "out", "--name", "{stm}.dds"}, "did you mean stem?");
    refuses({"a.png", "--out-dir", "out", "--name", "{stem.dds"}, "has a { without its }");
    refuses({"../a.png", "--out-dir", "out", "--name", "{dir}/{stem}.dds"}, "leads out of --out-dir");
}

TEST_P(EveryUsage, AListNeedsANameWhereOneOutputIsWanted) {
    scratch_.write("list", "\n");
    before_ = scratch_.list();
    refuses({"--files-from", "list", "--allow-empty", "-o", "x.dds"}, "no input for -o: list names none");
}

TEST_P(EveryUsage, OnlyOneInputGoesToStandardOutput) {
    refuses({"a.png", "b.png", "--name", "-", "--container", "dds"}, "-o - writes there");
}

TEST_P(EveryUsage, OutputsMustNotBeInputs) {
    // One command mends files in place, if they are named so.
    if (GetParam() != "repair-normals") refuses({"a.png", "-o", "a.png"}, "the output a.png is the input a.png");
    refuses({"a.png", "-o", "./folder/../a.png"}, "is the input a.png");
    refuses({"a.png", "-o", "soft.png"}, "the output soft.png is the input a.png");
    refuses({"a.png", "-o", "hard.png"}, "the output hard.png is the input a.png");
    refuses({"soft.png", "-o", "a.png"}, "is the input soft.png");
    refuses({"a.png", "b.png", "--name", "{stem}.png"}, "is the input");
    refuses({"a.png", "-o", "x.dds", "--depfile", "a.png"}, "is the input");
    refuses({"a.png", "-o", "x.dds", "--depfile", "./x.dds"}, "--depfile: ./x.dds is an output");
    scratch_.write("list.dds", "a.png\n");
    before_ = scratch_.list();
    refuses({"--files-from", "list.dds", "--name", "list.dds"}, "the output list.dds is the file of --files-from");
    refuses({"--files-from", "list.dds", "--name", "x.dds", "--depfile", "list.dds"},
            "the output list.dds is the file of --files-from");
}

TEST_P(EveryUsage, OutputsMustDiffer) {
    refuses({"a.png", "a.png", "--out-dir", "out", "--name", "{stem}.dds"}, "the input a.png is given twice");
    refuses({"a.png", "b.png", "--out-dir", "out", "--name", "all.dds"},
            "a.png and b.png have the same output out/all.dds");
    refuses({"a.png", "folder/../a.png", "--out-dir", "out", "--name", "{stem}.dds"}, "the same output");
    // The target of a link need not exist yet.
    std::filesystem::create_directory_symlink("folder", scratch_.path("link"));
    for (const char* name : {"l1.dds", "l2.dds"})
        std::filesystem::create_symlink("folder/new.dds", scratch_.path(name));
    std::filesystem::create_symlink("l1.dds", scratch_.path("l3.dds"));
    scratch_.write("l1.png", "");
    scratch_.write("l2.png", "");
    before_ = scratch_.list();
    refuses({"l1.png", "l2.png", "--name", "{stem}.dds"}, "l1.png and l2.png have the same output l2.dds");
    refuses({"a.png", "-o", "l3.dds", "--depfile", "link/new.dds"}, "--depfile: link/new.dds is an output");
}

}  // namespace tex::cli
