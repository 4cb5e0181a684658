// SPDX-License-Identifier: Apache-2.0
// Data beside the normals in a manifest: for each output, in the key, and from step to step.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

class BuildExtras : public testing::Test {
protected:
    BuildExtras() {
        for (const std::string name : {"a", "b"}) {
            std::filesystem::create_directories(scratch_.path("art/" + name));
            scratch_.add_sample("bricks.png", "art/" + name + "/" + name + "_h.png");
            does("bake-normals art/" + name + "/" + name + "_h.png -o art/" + name + "/" + name +
                 "_n.png --bumpiness 6 --no-sync --quiet");
        }
    }
    void does(const std::string& line) const {
        const Ran ran = shell(scratch_, line);
        ASSERT_EQ(ran.code, 0) << line << '\n' << ran.out << ran.err;
    }
    void manifest(const std::string& rule) const {
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nmatch = \"art/**/*_n.png\"\n" + rule);
    }
    // What a run has made, as the summary counts it.
    [[nodiscard]] std::string made() const {
        const Ran ran = shell(scratch_, "build-normals --json --no-sync");
        EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
        const std::size_t at = ran.out.rfind("\"made\":");
        return at == std::string::npos ? ran.out : ran.out.substr(at + 7, 1);
    }

    Scratch scratch_;
};

TEST_F(BuildExtras, EachOutputHasItsOwn) {
    manifest(
        "steps = [ { mip = {} } ]\noutputs = [\n"
        "  { format = \"rgba8\", alpha = \"{dir}/{stem:-_n}_h.png\", kind = \"height\", name = "
        "\"out/{stem}_h.dds\" },\n"
        "  { format = \"bc5\", name = \"out/{stem}.dds\" },\n"
        "  { format = \"rgba8\", alpha = \"0.5\", name = \"out/{stem}_half.dds\" },\n ]\n");
    EXPECT_EQ(made(), "2");
    for (const std::string name : {"a", "b"}) {
        const std::string in = "art/" + name + "/" + name, out = "out/" + name + "_n";
        does("mip-normals " + in + "_n.png -o 1.dds --format rgba8 --alpha " + in +
             "_h.png --kind height --no-sync; cmp 1.dds " + out + "_h.dds; mip-normals " + in +
             "_n.png -o 2.dds --format bc5 --no-sync --quiet; cmp 2.dds " + out + ".dds; mip-normals " + in +
             "_n.png -o 3.dds --format rgba8 --alpha 0.5 --no-sync; cmp 3.dds " + out + "_half.dds");
    }
    EXPECT_EQ(made(), "0");
    const Ran elsewhere = run(scratch_, "build-normals", {scratch_.path("normals.toml"), "--json", "--no-sync"});
    EXPECT_EQ(elsewhere.code, 0) << elsewhere.err << "words and numbers are no files below the root";
    EXPECT_NE(elsewhere.out.find("\"made\":0"), std::string::npos) << elsewhere.out;
    does("convert art/b/b_h.png -negate art/b/b_h.png");
    EXPECT_EQ(made(), "1") << "the file is in the key";
    does(
        "mip-normals art/b/b_n.png -o 1.dds --format rgba8 --alpha art/b/b_h.png --kind height --no-sync; "
        "cmp 1.dds out/b_n_h.dds");
    std::filesystem::remove(scratch_.path("art/a/a_h.png"));
    const Ran ran = shell(scratch_, "build-normals --no-sync");
    EXPECT_NE(ran.code, 0);
    EXPECT_NE(ran.err.find("a_h.png"), std::string::npos) << ran.err;
}

TEST_F(BuildExtras, AlphaGoesAlongFromStepToStep) {
    manifest(
        "steps = [ { scale = { scale = 0.5, alpha = \"{dir}/{stem:-_n}_h.png\" } }, { blend = { detail = "
        "\"art/a/a_n.png\" } }, { mip = {} } ]\noutputs = [ { format = \"rgba16\", name = \"out/{stem}.ktx2\" } ]\n");
    EXPECT_EQ(made(), "2");
    does(
        "scale-normals art/b/b_n.png --scale 0.5 -o 1.exr --format rgba32f --alpha art/b/b_h.png --no-sync;"
        "blend-normals 1.exr --detail art/a/a_n.png -o 2.exr --format rgba32f --no-sync;"
        "mip-normals 2.exr -o 3.ktx2 --format rgba16 --no-sync; cmp 3.ktx2 out/b_n.ktx2");
    // In a later step, a pattern still names a file after the rule's input.
    manifest(
        "steps = [ { scale = { scale = 0.5 } }, { mip = { alpha = \"{dir}/{stem:-_n}_h.png\" } } ]\n"
        "outputs = [ { format = \"rgba8\", name = \"out/{stem}.ktx2\" } ]\n");
    EXPECT_EQ(made(), "2");
    does("mip-normals 1.exr -o 4.ktx2 --format rgba8 --no-sync; cmp 4.ktx2 out/b_n.ktx2");
    EXPECT_EQ(made(), "0");
    does("convert art/b/b_h.png -negate art/b/b_h.png");
    EXPECT_EQ(made(), "1") << "the file of a later step is in the key";
}

TEST_F(BuildExtras, WhatCannotBeIsAnErrorOfTheManifest) {
    const auto refuses = [this](const std::string& rule, const std::string& words) {
        manifest(rule);
        const Ran ran = shell(scratch_, "build-normals --no-sync");
        EXPECT_EQ(ran.code, 2) << ran.out << ran.err;
        EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
        EXPECT_FALSE(scratch_.has("out"));
    };
    refuses(
        "name = \"out/{stem}.dds\"\nsteps = [ { mip = {} } ]\noutputs = [ { format = \"bc5\", alpha = \"x.png\" } ]\n",
        "bc5 has no room for --alpha");
    refuses("name = \"out/{stem}.dds\"\nsteps = [ { mip = {} } ]\noutputs = [ { alpah = \"x.png\" } ]\n",
            "did you mean");
    refuses("name = \"out/{stem}.dds\"\nsteps = [ { scale = { scale = 2, length = \"x.png\" } }, { mip = {} } ]\n",
            "length: only the last step can have it");
}

}  // namespace
}  // namespace tex::cli
